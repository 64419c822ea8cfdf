// Recordings: every row of them, and each frame with its mesh as `trocar replay --vtu` writes it.
#include <algorithm>
#include <array>
#include <cstring>

#include "base/check.h"
#include "base/error.h"
#include "engine/database.h"
#include "engine/film_studio.h"
#include "engine/frame_vtu.h"
#include "engine/recording.h"
#include "engine/recording_schema.h"
#include "engine_recording.h"
#include "fuzz_targets.h"
#include "mesh_joined.h"
#include "mesh_split.h"
#include "test_files.h"

namespace trocar {

namespace {

void look_at_frame(RecordingReader& reader, std::int64_t number, const std::string& folder) {
  const RecordedFrame frame = reader.read(number);
  const Mesh& mesh = reader.mesh_at(number);
  surface_regions(mesh, boundary_surface(mesh));
  if (frame.u.size() == 3 * mesh.X.size()) write_frame_vtu(mesh, frame, {}, folder);
}

void look_at_recording(const std::string& file) {
  RecordingReader reader(file);
  const std::string folder = std::filesystem::path(file).parent_path();
  for (const auto& [number, time] : reader.frames())
    is_taken([&, frame = number] { look_at_frame(reader, frame, folder); });
}

// The packed parts of a recording: where they stand, and the checksum of their row.
struct PackedColumn {
  const char *table, *column;
  std::size_t item_size;
  const char* others;  // that the row's checksum covers
  std::uint32_t (*crc)(const Statement& row, std::uint32_t of_blob);
};

std::vector<double> doubles_of(const std::vector<std::byte>& bytes) {
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

// The other columns of a row follow four that all have: number, blob, size, crc.
const std::array<PackedColumn, 4> packed_columns = {
    {{"head", "mesh", 1, "version, scene, n_tools",
      [](const Statement& row, std::uint32_t crc) {
        return row_crc("head", row.text(4), row.text(5), row.integer(6), crc);
      }},
     {"tool", "surface", 1, "number",
      [](const Statement& row, std::uint32_t crc) { return row_crc("tool", row.integer(4), crc); }},
     {"edit", "change", 1, "number, frame",
      [](const Statement& row, std::uint32_t crc) {
        return row_crc("edit", row.integer(4), row.integer(5), crc);
      }},
     {"frame", "u", sizeof(double), "frame, place, n_edits, step, time, digest, tool_forces",
      [](const Statement& row, std::uint32_t crc) {
        return row_crc("frame", row.integer(4), row.integer(5), row.integer(6), row.integer(7),
                       row.real(8), static_cast<std::uint64_t>(row.integer(9)),
                       doubles_of(row.bytes(10)), crc);
      }}}};

std::string changed_bytes(const std::vector<std::byte>& plain, std::size_t item_size,
                          const ChangeBytes& change) {
  std::string changed = change({reinterpret_cast<const char*>(plain.data()), plain.size()});
  changed.resize(changed.size() / item_size * item_size);
  return changed;
}

void change_row(Database& file, const PackedColumn& at, std::uint64_t random,
                const ChangeBytes& change) {
  const std::string table = at.table, column = at.column;
  Statement row(file, "SELECT rowid, " + column + ", size, crc, " + at.others + " FROM " + table +
                          " ORDER BY rowid LIMIT 1 OFFSET " + std::to_string(random % 8));
  if (!row.step()) return;
  const Blob blob{.packed = row.bytes(1),
                  .plain_size = static_cast<std::uint64_t>(row.integer(2)),
                  .crc = static_cast<std::uint32_t>(row.integer(3))};
  const std::string plain =
      changed_bytes(unpack_blob(blob, at.item_size, table), at.item_size, change);
  const Blob packed = pack_blob(std::as_bytes(std::span(plain)), at.item_size);
  Statement update(file, "UPDATE " + table + " SET " + column +
                             " = ?, size = ?, crc = ?, row_crc = ? WHERE rowid = ?");
  update.bind(0, std::span<const std::byte>(packed.packed))
      .bind(1, static_cast<std::int64_t>(packed.plain_size))
      .bind(2, std::int64_t{packed.crc})
      .bind(3, std::int64_t{at.crc(row, packed.crc)})
      .bind(4, row.integer(0))
      .step();
}

// Tetrahedron e in two, at a node on its edge.
ElementSplit in_two(const Mesh& mesh, std::int32_t e, const EdgeNode& on, std::int32_t node) {
  ElementSplit split{.element = e, .n_tets = 2};
  for (std::size_t k = 0; k < 2; ++k) {
    std::ranges::copy(mesh.corners(e), split.corner[k].begin());
    std::ranges::replace(split.corner[k], on.end[k], node);
  }
  return split;
}

// Two hexahedra and six tetrahedra; a cut splits a hexahedron, then an edge of the tetrahedra.
ExampleRun solid_run() {
  ExampleRun run;
  Mesh mesh = joined(make_box(Vec3(2, 0, 0), Vec3(3, 1, 1), {2, 1, 1}, BoxElements::hex8),
                     make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::tet4_kuhn));
  mesh.node_sets = {{.name = "left", .node = {0, 1, 2}, .left_out = {{-1, 0, 1, 2}}}};
  mesh.fibre.assign(mesh.element_type.size(), Vec3(1, 0, 0));
  run.head = {.version = "trocar test", .scene = "name = \"a test\"\n", .mesh = mesh};
  MeshEdit of_edge;
  const auto tet = mesh.corners(2);
  of_edge.inserted = {{.end = {std::min(tet[0], tet[1]), std::max(tet[0], tet[1])}, .s = 0.5}};
  for (std::int32_t e = 2; e < mesh.n_elements(); ++e)
    if (std::ranges::all_of(of_edge.inserted[0].end, [&](std::int32_t i) {
          return std::ranges::count(mesh.corners(e), i) > 0;
        }))
      of_edge.splits.push_back(in_two(mesh, e, of_edge.inserted[0], mesh.n_nodes()));
  run.edits = {{}, {{.splits = {split_of(mesh, 0)}}}, {of_edge}};
  run.frames = {example_frame(0, mesh.X.size(), 0), example_frame(1, mesh.X.size(), 0),
                example_frame(2, mesh.X.size() + 1, 0)};
  return run;
}

std::string bytes_of(const ExampleRun& run) {
  const TestFolder folder;
  write_run(run, folder.file("r.trocar"));
  return read_text(folder.file("r.trocar"));
}

}  // namespace

bool read_recording_bytes(std::string_view bytes) {
  const std::string file = hostile_file("r.trocar", bytes);
  return is_taken([&] { look_at_recording(file); });
}

std::vector<FuzzSeed> recording_seeds() {
  return {{"plane.trocar", bytes_of(example_run(4))}, {"solid.trocar", bytes_of(solid_run())}};
}

std::string change_recording(const std::string& file, const ChangeBytes& change,
                             std::uint64_t random) {
  const std::string copy = hostile_file("changed.trocar", file);
  try {
    Database database(copy, Database::Mode::extend);
    change_row(database, packed_columns[random % packed_columns.size()], random >> 32U, change);
  } catch (const std::runtime_error&) {
    return change(file);  // no recording, or its parts are damaged
  }
  return read_text(copy);
}

}  // namespace trocar
