#include "engine/bytes.h"

#include <algorithm>

#include "base/error.h"
#include "engine/archive.h"

namespace trocar {

void ByteWriter::put_raw(const void* data, std::size_t size) {
  std::span<const std::byte> rest(static_cast<const std::byte*>(data), size);
  while (sink_ && rest.size() >= piece_size - bytes_.size()) {
    const std::size_t n = piece_size - bytes_.size();
    bytes_.insert(bytes_.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(n));
    rest = rest.subspan(n);
    flush();
  }
  bytes_.insert(bytes_.end(), rest.begin(), rest.end());
}

void ByteWriter::flush() {
  if (bytes_.empty()) return;
  sink_(bytes_);
  bytes_.clear();
}

void ByteWriter::put_text(const std::string& text) {
  put(static_cast<std::uint64_t>(text.size()));
  put_raw(text.data(), text.size());
}

std::size_t ByteReader::get_count(std::size_t item_size) {
  const auto count = get<std::uint64_t>();
  if (count > bytes_.size() / item_size)
    throw InputError("stored data end early: " + std::to_string(count) + " items announced");
  return count;
}

void ByteReader::get_raw(void* data, std::size_t size) {
  if (size > bytes_.size()) throw InputError("stored data end early");
  if (size > 0) std::memcpy(data, bytes_.data(), size);
  bytes_ = bytes_.subspan(size);
}

// No other byte is a bool's: as one it would be undefined.
bool ByteReader::get_bool() {
  const auto byte = get<std::uint8_t>();
  if (byte > 1) throw InputError("stored data are damaged: a yes or no is " + std::to_string(byte));
  return byte == 1;
}

std::string ByteReader::get_text() {
  std::string text(get_count(1), '\0');
  get_raw(text.data(), text.size());
  return text;
}

namespace {

// What Mesh::corners relies on.
void check_arrays(const Mesh& mesh) {
  for (const ElementType type : mesh.element_type)
    if (static_cast<int>(type) >= n_element_types)
      throw InputError("stored mesh has an element of unknown type " +
                       std::to_string(static_cast<int>(type)));
  bool is_sound = mesh.corner_offset.size() == mesh.element_type.size();
  for (std::size_t e = 0; e < mesh.element_type.size() && is_sound; ++e) {
    const std::int64_t first = mesh.corner_offset[e];
    is_sound =
        first >= 0 && first + n_corners(mesh.element_type[e]) <= std::ssize(mesh.corner_node);
  }
  if (!is_sound) throw InputError("stored mesh has elements whose corners it has not");
}

void check_copies(const Mesh& mesh) {
  const auto n_uncut =
      static_cast<std::int64_t>(mesh.X.size()) - static_cast<std::int64_t>(mesh.copied_node.size());
  // A copy is of the uncut mesh or of a node on an edge, which names itself.
  const auto is_original = [&](std::int64_t i) {
    return i < n_uncut || mesh.copied_node[i - n_uncut] == i;
  };
  bool is_sound = n_uncut >= 0;
  for (std::int64_t k = 0; k < std::ssize(mesh.copied_node) && is_sound; ++k) {
    const std::int32_t i = mesh.copied_node[k];
    is_sound = i >= 0 && i <= n_uncut + k && is_original(i);
  }
  if (!is_sound) throw InputError("stored mesh has copies of nodes that it has not");
  const auto n_ranks = static_cast<std::int64_t>(mesh.hex_split_rank.size());
  if (n_ranks != 0 && n_ranks != n_uncut)
    throw InputError("stored mesh has ranks of nodes that it has not");
}

}  // namespace

template <class Archive>
static void visit(Archive& a, NodeSet& set) {
  a(set.name, set.node, set.left_out);
}
template <class Archive>
static void visit_members(Archive& a, Mesh& m) {
  a(m.X, m.element_type, m.corner_offset, m.corner_node, m.element_region, m.density_factor,
    m.cut_facets, m.fibre, m.region_name, m.node_sets, m.copied_node, m.hex_split_rank,
    m.split_hexahedra);
}
template <class Archive>
static void visit(Archive& a, EdgeNode& node) {
  a(node.end, node.s);
}
template <class Archive>
static void visit(Archive& a, NodeMove& move) {
  a(move.node, move.X, move.host, move.weight);
}
template <class Archive>
static void visit(Archive& a, CutFacets& change) {
  a(change.element, change.mask);
}
template <class Archive>
static void visit(Archive& a, DensityChange& change) {
  a(change.element, change.factor);
}
template <class Archive>
static void visit_members(Archive& a, MeshEdit& edit) {
  a(edit.inserted, edit.splits, edit.moves, edit.duplicate_parent, edit.corners, edit.cut_facets,
    edit.density);
}

void put_mesh(Saver& save, const Mesh& mesh) {
  visit_members(save, const_cast<Mesh&>(mesh));  // which a Saver doesn't change
}

std::size_t n_bytes_of(const Mesh& mesh) {
  std::size_t n = 0;
  Saver save([&](std::span<const std::byte> bytes) { n += bytes.size(); });
  put_mesh(save, mesh);
  save.writer().flush();
  return n;
}

std::vector<std::byte> mesh_to_bytes(const Mesh& mesh) {
  Saver save;
  put_mesh(save, mesh);
  return save.take();
}

Mesh mesh_from_bytes(std::span<const std::byte> bytes) {
  Loader load(bytes);
  Mesh mesh;
  visit_members(load, mesh);
  check_arrays(mesh);
  check_copies(mesh);
  return mesh;
}

std::vector<std::byte> surface_to_bytes(const TriangleMesh& surface) {
  Mesh carrier{.X = surface.X};
  for (const auto& triangle : surface.triangle) add_element(carrier, ElementType::tri3, triangle);
  return mesh_to_bytes(carrier);
}

TriangleMesh surface_from_bytes(std::span<const std::byte> bytes, const std::string& name) {
  const Mesh carrier = mesh_from_bytes(bytes);
  TriangleMesh surface{.X = carrier.X};
  if (carrier.corner_node.size() % 3 != 0) throw InputError(name + ": is not made of triangles");
  for (std::size_t k = 0; k < carrier.corner_node.size(); k += 3) {
    surface.triangle.push_back(
        {carrier.corner_node[k], carrier.corner_node[k + 1], carrier.corner_node[k + 2]});
    for (const std::int32_t node : surface.triangle.back())
      if (node < 0 || node >= carrier.n_nodes())
        throw InputError(name + ": a triangle has no such vertex");
  }
  return surface;
}

std::vector<std::byte> edit_to_bytes(const MeshEdit& edit) {
  Saver save;
  visit_members(save, const_cast<MeshEdit&>(edit));
  return save.take();
}

MeshEdit edit_from_bytes(std::span<const std::byte> bytes) {
  Loader load(bytes);
  MeshEdit edit;
  visit_members(load, edit);
  return edit;
}

}  // namespace trocar
