#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "engine/blob.h"
#include "engine/bytes.h"
#include "engine/database.h"
#include "engine/recording.h"
#include "engine/recording_schema.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

Blob read_blob(const Statement& row, int k) {
  return {.packed = row.bytes(k),
          .plain_size = static_cast<std::uint64_t>(row.integer(k + 1)),
          .crc = static_cast<std::uint32_t>(row.integer(k + 2))};
}

std::vector<double> to_doubles(const std::vector<std::byte>& bytes) {
  std::vector<double> values(bytes.size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

// Numbers that a checksum does not vouch for: another program may have written them.
bool is_within(std::int64_t number, std::int64_t n) {
  return number >= 0 && number < n;
}

bool has_parts(const ElementSplit& split, const Mesh& mesh) {
  if (!is_within(split.element, mesh.n_elements())) return false;
  const ElementType type = mesh.element_type[split.element];
  return type == ElementType::hex8
             ? split.n_tets == n_hex_tets
             : type == ElementType::tet4 && split.n_tets >= 2 && split.n_tets <= max_split_tets;
}

bool inserted_fit(const MeshEdit& edit, const Mesh& mesh) {
  return std::all_of(edit.inserted.begin(), edit.inserted.end(), [&](const EdgeNode& node) {
    return node.end[0] >= 0 && node.end[0] < node.end[1] && node.end[1] < mesh.n_nodes() &&
           node.s > 0 && node.s < 1;
  });
}

// Whether the node is a corner of the element or lies on one of its edges.
bool is_of_element(std::int32_t node, std::span<const std::int32_t> own, const MeshEdit& edit,
                   std::int32_t n_nodes) {
  const auto is_own = [&](std::int32_t i) {
    return std::find(own.begin(), own.end(), i) != own.end();
  };
  const std::int64_t k = std::int64_t{node} - n_nodes;
  if (!is_within(k, std::ssize(edit.inserted))) return is_own(node);
  return std::ranges::all_of(edit.inserted[k].end, is_own);
}

bool splits_fit(const MeshEdit& edit, const Mesh& mesh) {
  std::int32_t last = -1;
  return std::all_of(edit.splits.begin(), edit.splits.end(), [&](const ElementSplit& split) {
    const bool is_next = split.element > last && has_parts(split, mesh);
    if (!is_next) return false;
    last = split.element;
    const auto own = mesh.corners(split.element);
    return std::ranges::all_of(split.tets(), [&](const auto& tet) {
      return std::ranges::all_of(
          tet, [&](std::int32_t i) { return is_of_element(i, own, edit, mesh.n_nodes()); });
    });
  });
}

bool fits(const MeshEdit& edit, const Mesh& mesh) {
  if (!inserted_fit(edit, mesh) || !splits_fit(edit, mesh)) return false;
  const SplitNumbers numbers(edit.splits, mesh.n_elements());
  const std::int64_t n_elements = mesh.n_elements(),
                     n_nodes = mesh.n_nodes() + std::ssize(edit.inserted);
  const std::int64_t n_after = n_elements + n_added(edit.splits);
  std::int64_t n_all = n_nodes;
  const auto has_element = [&](const auto& change) { return is_within(change.element, n_after); };
  const auto has_corner = [&](const CornerChange& change) {
    const std::int32_t e = numbers.whole(change.element);
    return is_within(change.corner, numbers.is_split(e) ? 4 : std::ssize(mesh.corners(e)));
  };
  return std::all_of(edit.moves.begin(), edit.moves.end(),
                     [&](const NodeMove& move) {
                       return is_within(move.node, n_nodes) && is_within(move.host, n_elements);
                     }) &&
         std::all_of(edit.duplicate_parent.begin(), edit.duplicate_parent.end(),
                     [&](std::int32_t node) { return is_within(node, n_all++); }) &&
         std::all_of(edit.corners.begin(), edit.corners.end(),
                     [&](const CornerChange& change) {
                       return has_element(change) && is_within(change.node, n_all) &&
                              has_corner(change);
                     }) &&
         std::all_of(edit.cut_facets.begin(), edit.cut_facets.end(), has_element) &&
         std::all_of(edit.density.begin(), edit.density.end(), has_element);
}

// The columns of `frame` in front of u, in the order of the table; true if they are as they were
// written.
struct FrameRowRead {
  RecordedFrame frame;
  FramePlace at;
  std::uint64_t u_size = 0;
  std::uint32_t u_crc = 0;
};
constexpr const char* frame_columns =
    "frame, place, n_edits, step, time, digest, tool_forces, size, crc, row_crc";

bool read_frame_row(const Statement& row, FrameRowRead& r) {
  r.frame = {.frame = row.integer(0),
             .step = row.integer(3),
             .time = row.real(4),
             .digest = static_cast<std::uint64_t>(row.integer(5)),
             .tool_forces = to_doubles(row.bytes(6))};
  r.at = {.place = row.integer(1), .n_edits = row.integer(2)};
  r.u_size = static_cast<std::uint64_t>(row.integer(7));
  r.u_crc = static_cast<std::uint32_t>(row.integer(8));
  const RecordedFrame& f = r.frame;
  return row.integer(9) == row_crc("frame", f.frame, r.at.place, r.at.n_edits, f.step, f.time,
                                   f.digest, f.tool_forces, r.u_crc);
}

}  // namespace

struct RecordingReader::Tables {
  std::string name;
  Database file;
  RecordingHead head;
  std::vector<std::pair<std::int64_t, double>> frames;
  std::vector<std::string> damage;
  // The mesh with the first n_applied edits: reading forward applies each edit once.
  Mesh mesh;
  std::int64_t n_applied = 0;

  explicit Tables(const std::string& n) : name(n), file(n, Database::Mode::read) {}
  void read_head();
  void read_tools(std::int64_t n_tools);
  void read_frame_list();
  void check_closing(const FramePlace& end);
  RecordedFrame read_frame(std::int64_t number, FramePlace& at, bool with_u);
  void apply_edits_up_to(std::int64_t n_edits);
};

void RecordingReader::Tables::read_head() {
  Statement row(file, "SELECT format, version, scene, n_tools, row_crc, mesh, size, crc FROM head");
  if (!row.step()) throw InputError(name + ": is an empty recording");
  if (row.integer(0) < 1) throw InputError(name + ": damaged (it does not tell its format)");
  if (row.integer(0) != recording_format)
    throw InputError(name + ": has recording format " + std::to_string(row.integer(0)) +
                     ", this program reads " + std::to_string(recording_format));
  head.version = row.text(1);
  head.scene = row.text(2);
  const Blob packed = read_blob(row, 5);
  if (row.integer(4) != row_crc("head", head.version, head.scene, row.integer(3), packed.crc))
    throw InputError(name + ": damaged (the checksum of version and scene does not match)");
  head.mesh = mesh_from_bytes(unpack_blob(packed, 1, name + ": mesh"));
  const std::vector<std::string> faults = validate(head.mesh, 1);
  if (!faults.empty()) throw InputError(name + ": mesh: " + faults.front());
  mesh = head.mesh;
  read_tools(row.integer(3));
}

void RecordingReader::Tables::read_tools(std::int64_t n_tools) {
  Statement row(file, "SELECT number, row_crc, surface, size, crc FROM tool ORDER BY number");
  while (row.step()) {
    const std::string which =
        name + ": instrument surface " + std::to_string(head.tool_meshes.size());
    const Blob packed = read_blob(row, 2);
    if (row.integer(0) != static_cast<std::int64_t>(head.tool_meshes.size()) ||
        row.integer(1) != row_crc("tool", row.integer(0), packed.crc))
      throw InputError(which + ": damaged (its checksum does not match)");
    head.tool_meshes.push_back(surface_from_bytes(unpack_blob(packed, 1, which), which));
  }
  if (static_cast<std::int64_t>(head.tool_meshes.size()) != n_tools)
    throw InputError(name + ": has " + std::to_string(head.tool_meshes.size()) +
                     " instrument surfaces instead of " + std::to_string(n_tools));
}

void RecordingReader::Tables::read_frame_list() {
  Statement row(file, std::string("SELECT ") + frame_columns + " FROM frame ORDER BY frame");
  FramePlace end;
  while (row.step()) {
    FrameRowRead r;
    if (!read_frame_row(row, r)) {
      damage.push_back("frame " + std::to_string(r.frame.frame) +
                       ": damaged (its checksum does not match)");
      ++end.place;
      continue;
    }
    if (r.at.place != end.place)
      damage.push_back("frame " + std::to_string(r.frame.frame) + ": " +
                       std::to_string(r.at.place) + " frames were recorded before it, found " +
                       std::to_string(end.place));
    end = {.place = r.at.place + 1, .n_edits = r.at.n_edits};
    frames.emplace_back(r.frame.frame, r.frame.time);
  }
  check_closing(end);
}

void RecordingReader::Tables::check_closing(const FramePlace& end) {
  Statement row(file, "SELECT n_frames, n_edits, row_crc FROM closing");
  if (!row.step()) return;  // the run was killed: its last frame is the end
  if (row.integer(2) != row_crc("closing", row.integer(0), row.integer(1)))
    damage.push_back("the closing entry: damaged (its checksum does not match)");
  else if (row.integer(0) != end.place)
    damage.push_back("the run recorded " + std::to_string(row.integer(0)) + " frames, found " +
                     std::to_string(end.place));
}

RecordedFrame RecordingReader::Tables::read_frame(std::int64_t number, FramePlace& at,
                                                  bool with_u) {
  const std::string which = name + ": frame " + std::to_string(number);
  Statement row(file, std::string("SELECT ") + frame_columns + ", u FROM frame WHERE frame = ?");
  if (!row.bind(0, number).step()) throw InputError(which + ": is not recorded");
  FrameRowRead r;
  if (!read_frame_row(row, r) || r.frame.frame != number)
    throw InputError(which + ": damaged (its checksum does not match)");
  at = r.at;
  if (with_u)
    r.frame.u = to_doubles(unpack_blob(
        {.packed = row.bytes(10), .plain_size = r.u_size, .crc = r.u_crc}, sizeof(double), which));
  return std::move(r.frame);
}

void RecordingReader::Tables::apply_edits_up_to(std::int64_t n_edits) {
  if (n_edits < n_applied) {
    mesh = head.mesh;
    n_applied = 0;
  }
  Statement row(file,
                "SELECT number, frame, row_crc, change, size, crc FROM edit WHERE number >= ? AND "
                "number < ? ORDER BY number");
  row.bind(0, n_applied).bind(1, n_edits);
  for (; n_applied < n_edits; ++n_applied) {
    const std::string which = name + ": edit " + std::to_string(n_applied);
    if (!row.step()) throw InputError(which + ": is missing");
    const Blob packed = read_blob(row, 3);
    if (row.integer(0) != n_applied ||
        row.integer(2) != row_crc("edit", n_applied, row.integer(1), packed.crc))
      throw InputError(which + ": damaged (its checksum does not match)");
    const MeshEdit edit = edit_from_bytes(unpack_blob(packed, 1, which));
    if (!fits(edit, mesh)) throw InputError(which + ": does not fit the mesh");
    apply_edit(edit, mesh);
  }
}

RecordingReader::RecordingReader(const std::string& file)
    : tables_(std::make_unique<Tables>(file)) {
  tables_->read_head();
  tables_->read_frame_list();
}
RecordingReader::~RecordingReader() = default;
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;

const RecordingHead& RecordingReader::head() const {
  return tables_->head;
}
const std::vector<std::pair<std::int64_t, double>>& RecordingReader::frames() const {
  return tables_->frames;
}
const std::vector<std::string>& RecordingReader::damage() const {
  return tables_->damage;
}

RecordedFrame RecordingReader::read(std::int64_t number) {
  FramePlace at;
  return tables_->read_frame(number, at, true);
}

const Mesh& RecordingReader::mesh_at(std::int64_t number) {
  FramePlace at;
  tables_->read_frame(number, at, false);
  tables_->apply_edits_up_to(at.n_edits);
  return tables_->mesh;
}

std::int64_t RecordingReader::n_edits() const {
  return tables_->n_applied;
}

}  // namespace trocar
