// The bytes of an array in a VTU file: base64 or raw, plain or in zlib blocks.
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "mesh/file_reader.h"

namespace trocar {

struct VtuEncoding {
  bool is_zlib = false;
  bool is_base64 = true;
  bool swaps_bytes = false;
  std::size_t n_header_bytes = 4;  // of each number of a header: 4 or 8
};

// The array of n_bytes at the beginning of `text`. Throws InputError (at the place of `in`) if
// there are more, fewer or broken bytes. What is announced is compared with the bytes there are
// before anything is allocated.
std::string decode_vtu_data(const FileReader& in, const VtuEncoding& encoding,
                            std::string_view text, std::size_t n_bytes);

// Base64 with zlib blocks and 8-byte headers, appended to `text`.
void append_vtu_data(std::string_view bytes, std::string& text);

}  // namespace trocar
