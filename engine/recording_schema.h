// Tables of a recording, shared by its writer and its reader. What is not inside a packed blob
// (which has a checksum of its own) is covered by the checksum of its row; places and counts find
// rows that are missing.
#pragma once

#include <string>
#include <type_traits>

#include "base/digest.h"
#include "engine/blob.h"
#include "engine/bytes.h"

namespace trocar {

inline constexpr int recording_format = 4;

// head: version, scene and first mesh; tool: the user's surfaces; edit: changes of topology before
// a frame; frame: forces and displacements, its place (0, 1, … in the order of writing) and the
// number of edits up to it; closing: how much there is, written at the end of the run. The small
// columns stand first, so that listing frames does not read displacements.
inline constexpr const char* recording_tables =
    "CREATE TABLE head (format INTEGER, version TEXT, scene TEXT, n_tools INTEGER, row_crc INTEGER,"
    " mesh BLOB, size INTEGER, crc INTEGER);"
    "CREATE TABLE tool (number INTEGER PRIMARY KEY, row_crc INTEGER, surface BLOB, size INTEGER, "
    "crc INTEGER);"
    "CREATE TABLE edit (number INTEGER PRIMARY KEY, frame INTEGER, row_crc INTEGER, change BLOB, "
    "size INTEGER, crc INTEGER);"
    "CREATE TABLE frame (frame INTEGER PRIMARY KEY, place INTEGER, n_edits INTEGER, step INTEGER, "
    "time REAL, digest INTEGER,"
    " tool_forces BLOB, size INTEGER, crc INTEGER, row_crc INTEGER, u BLOB);"
    "CREATE TABLE closing (n_frames INTEGER, n_edits INTEGER, row_crc INTEGER);";

// CRC32C of the values of a row, each with its length; the table's name first, so that a row of
// another table never passes.
template <class... Values>
std::uint32_t row_crc(const std::string& table, const Values&... values) {
  ByteWriter row;
  row.put_text(table);
  const auto put = [&row](const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
      row.put_text(value);
    else if constexpr (std::is_trivially_copyable_v<std::decay_t<decltype(value)>>)
      row.put(value);
    else
      row.put_vector(value);
  };
  (put(values), ...);
  return crc32c(row.take());
}

// Where a frame stands in the recording.
struct FramePlace {
  std::int64_t place = 0;    // frames before it
  std::int64_t n_edits = 0;  // up to it
};

}  // namespace trocar
