#include <optional>

#include "engine/blob.h"
#include "engine/bytes.h"
#include "engine/database.h"
#include "engine/recording.h"
#include "engine/recording_schema.h"

namespace trocar {

namespace {

constexpr const char* insert_edit = "INSERT INTO edit VALUES (?, ?, ?, ?, ?, ?)";
constexpr const char* insert_frame = "INSERT INTO frame VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";

void bind_blob(Statement& statement, int k, const Blob& blob) {
  statement.bind(k, std::span<const std::byte>(blob.packed));
  statement.bind(k + 1, static_cast<std::int64_t>(blob.plain_size));
  statement.bind(k + 2, static_cast<std::int64_t>(blob.crc));
}

}  // namespace

struct RecordingWriter::Tables {
  Database file;
  FramePlace next;
  std::optional<Statement> add_edit, add_frame;

  Tables(const std::string& name, const RecordingHead& head) : file(name, Database::Mode::create) {
    write_head(head);
    prepare();
  }
  Tables(const std::string& name, std::int64_t last_frame) : file(name, Database::Mode::extend) {
    go_back_to(last_frame);
    prepare();
  }
  // Once the tables are there.
  void prepare() {
    add_edit.emplace(file, insert_edit);
    add_frame.emplace(file, insert_frame);
  }
  void go_back_to(std::int64_t last_frame);
  void write_head(const RecordingHead& head);
  void write_tool(std::int64_t number, const TriangleMesh& surface);
  void write_edit(const MeshEdit& edit, std::int64_t frame);
  void write_frame(const RecordedFrame& frame);
};

void RecordingWriter::Tables::write_head(const RecordingHead& head) {
  file.run(std::string("BEGIN;") + recording_tables);
  const Blob mesh = pack_blob(mesh_to_bytes(head.mesh), 1);
  const auto n_tools = static_cast<std::int64_t>(head.tool_meshes.size());
  Statement insert(file, "INSERT INTO head VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(0, std::int64_t{recording_format})
      .bind(1, head.version)
      .bind(2, head.scene)
      .bind(3, n_tools);
  insert.bind(4, std::int64_t{row_crc("head", head.version, head.scene, n_tools, mesh.crc)});
  bind_blob(insert, 5, mesh);
  insert.step();
  for (std::int64_t k = 0; k < n_tools; ++k) write_tool(k, head.tool_meshes[k]);
  file.run("COMMIT");
}

void RecordingWriter::Tables::go_back_to(std::int64_t last_frame) {
  if (last_frame > 0) {
    Statement row(file, "SELECT place, n_edits FROM frame WHERE frame = ?");
    if (!row.bind(0, last_frame).step())
      file.fail("frame " + std::to_string(last_frame) + " is not recorded");
    next = {.place = row.integer(0) + 1, .n_edits = row.integer(1)};
  }
  const std::string number = std::to_string(last_frame);
  file.run("BEGIN; DELETE FROM frame WHERE frame > " + number +
           "; DELETE FROM edit WHERE number >= " + std::to_string(next.n_edits) +
           "; DELETE FROM closing; COMMIT");
}

void RecordingWriter::Tables::write_tool(std::int64_t number, const TriangleMesh& surface) {
  const Blob packed = pack_blob(surface_to_bytes(surface), 1);
  Statement add_tool(file, "INSERT INTO tool VALUES (?, ?, ?, ?, ?)");
  add_tool.bind(0, number).bind(1, std::int64_t{row_crc("tool", number, packed.crc)});
  bind_blob(add_tool, 2, packed);
  add_tool.step();
}

void RecordingWriter::Tables::write_edit(const MeshEdit& edit, std::int64_t frame) {
  const Blob change = pack_blob(edit_to_bytes(edit), 1);
  const std::int64_t number = next.n_edits++;
  add_edit->bind(0, number).bind(1, frame).bind(
      2, std::int64_t{row_crc("edit", number, frame, change.crc)});
  bind_blob(*add_edit, 3, change);
  add_edit->step();
  add_edit->reset();
}

void RecordingWriter::Tables::write_frame(const RecordedFrame& frame) {
  const Blob u = pack_blob(std::as_bytes(std::span(frame.u)), sizeof(double));
  const std::int64_t place = next.place++;
  add_frame->bind(0, frame.frame)
      .bind(1, place)
      .bind(2, next.n_edits)
      .bind(3, frame.step)
      .bind(4, frame.time);
  add_frame->bind(5, static_cast<std::int64_t>(frame.digest))
      .bind(6, std::as_bytes(std::span(frame.tool_forces)));
  add_frame->bind(7, static_cast<std::int64_t>(u.plain_size)).bind(8, std::int64_t{u.crc});
  add_frame->bind(9, std::int64_t{row_crc("frame", frame.frame, place, next.n_edits, frame.step,
                                          frame.time, frame.digest, frame.tool_forces, u.crc)});
  add_frame->bind(10, std::span<const std::byte>(u.packed));
  add_frame->step();
  add_frame->reset();
}

RecordingWriter::RecordingWriter(const std::string& file, const RecordingHead& head)
    : tables_(std::make_unique<Tables>(file, head)) {}
RecordingWriter::RecordingWriter(const std::string& file, std::int64_t last_frame)
    : tables_(std::make_unique<Tables>(file, last_frame)) {}
RecordingWriter::~RecordingWriter() = default;
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;

void RecordingWriter::add(std::span<const MeshEdit> edits, const RecordedFrame& frame) {
  Tables& t = *tables_;
  t.file.run("BEGIN");
  for (const MeshEdit& edit : edits) t.write_edit(edit, frame.frame);
  t.write_frame(frame);
  t.file.run("COMMIT");
}

// In WAL mode a commit reaches the disk with the next emptying of the write-ahead log.
void RecordingWriter::sync() {
  tables_->file.run("PRAGMA wal_checkpoint(FULL)");
}

void RecordingWriter::finish() {
  Tables& t = *tables_;
  {
    Statement close(t.file, "INSERT INTO closing VALUES (?, ?, ?)");
    close.bind(0, t.next.place).bind(1, t.next.n_edits);
    close.bind(2, std::int64_t{row_crc("closing", t.next.place, t.next.n_edits)}).step();
  }
  // Empties the write-ahead log into the file and leaves WAL mode: a finished recording is one file
  // that can be read in a read-only folder.
  t.file.run("PRAGMA journal_mode=DELETE");
}

}  // namespace trocar
