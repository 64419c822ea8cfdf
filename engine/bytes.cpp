#include "engine/bytes.h"

#include <algorithm>

#include "base/error.h"

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

void put_mesh(ByteWriter& writer, const Mesh& mesh) {
  writer.put_vector(mesh.X);
  writer.put_vector(mesh.element_type);
  writer.put_vector(mesh.corner_offset);
  writer.put_vector(mesh.corner_node);
  writer.put_vector(mesh.element_region);
  writer.put_vector(mesh.density_factor);
  writer.put_vector(mesh.cut_facets);
  writer.put_vector(mesh.fibre);
  writer.put(static_cast<std::uint64_t>(mesh.region_name.size()));
  for (const std::string& name : mesh.region_name) writer.put_text(name);
  writer.put(static_cast<std::uint64_t>(mesh.node_sets.size()));
  for (const NodeSet& set : mesh.node_sets) {
    writer.put_text(set.name);
    writer.put_vector(set.node);
    writer.put_vector(set.left_out);
  }
  writer.put_vector(mesh.copied_node);
  writer.put_vector(mesh.hex_split_rank);
  writer.put_vector(mesh.split_hexahedra);
}

std::size_t n_bytes_of(const Mesh& mesh) {
  std::size_t n = 0;
  ByteWriter writer([&](std::span<const std::byte> bytes) { n += bytes.size(); });
  put_mesh(writer, mesh);
  writer.flush();
  return n;
}

std::vector<std::byte> mesh_to_bytes(const Mesh& mesh) {
  ByteWriter writer;
  put_mesh(writer, mesh);
  return writer.take();
}

Mesh mesh_from_bytes(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  Mesh mesh;
  mesh.X = reader.get_vector<Vec3>();
  mesh.element_type = reader.get_vector<ElementType>();
  mesh.corner_offset = reader.get_vector<std::int32_t>();
  mesh.corner_node = reader.get_vector<std::int32_t>();
  mesh.element_region = reader.get_vector<std::int32_t>();
  mesh.density_factor = reader.get_vector<double>();
  mesh.cut_facets = reader.get_vector<std::uint8_t>();
  mesh.fibre = reader.get_vector<Vec3>();
  check_arrays(mesh);
  mesh.region_name.resize(reader.get_count(8));
  for (std::string& name : mesh.region_name) name = reader.get_text();
  mesh.node_sets.resize(reader.get_count(24));
  for (NodeSet& set : mesh.node_sets) {
    set.name = reader.get_text();
    set.node = reader.get_vector<std::int32_t>();
    set.left_out = reader.get_vector<FacetNodes>();
  }
  mesh.copied_node = reader.get_vector<std::int32_t>();
  mesh.hex_split_rank = reader.get_vector<std::uint8_t>();
  mesh.split_hexahedra = reader.get_vector<SplitHexahedron>();
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
  ByteWriter writer;
  writer.put(static_cast<std::uint64_t>(edit.inserted.size()));
  for (const EdgeNode& node : edit.inserted) {
    writer.put(node.end);
    writer.put(node.s);
  }
  writer.put_vector(edit.splits);
  writer.put(static_cast<std::uint64_t>(edit.moves.size()));
  for (const NodeMove& move : edit.moves) {
    writer.put(move.node);
    for (int i = 0; i < 3; ++i) writer.put(move.X[i]);
    writer.put(move.host);
    writer.put(move.weight);
  }
  writer.put_vector(edit.duplicate_parent);
  writer.put_vector(edit.corners);
  // Member by member: padding bytes would differ from run to run.
  writer.put(static_cast<std::uint64_t>(edit.cut_facets.size()));
  for (const CutFacets& change : edit.cut_facets) {
    writer.put(change.element);
    writer.put(change.mask);
  }
  writer.put(static_cast<std::uint64_t>(edit.density.size()));
  for (const DensityChange& change : edit.density) {
    writer.put(change.element);
    writer.put(change.factor);
  }
  return writer.take();
}

MeshEdit edit_from_bytes(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  MeshEdit edit;
  edit.inserted.resize(reader.get_count(16));
  for (EdgeNode& node : edit.inserted) {
    node.end = reader.get<std::array<std::int32_t, 2>>();
    node.s = reader.get<double>();
  }
  edit.splits = reader.get_vector<ElementSplit>();
  edit.moves.resize(reader.get_count(8 + (3 + max_corners) * sizeof(double)));
  for (NodeMove& move : edit.moves) {
    move.node = reader.get<std::int32_t>();
    for (int i = 0; i < 3; ++i) move.X[i] = reader.get<double>();
    move.host = reader.get<std::int32_t>();
    move.weight = reader.get<std::array<double, max_corners>>();
  }
  edit.duplicate_parent = reader.get_vector<std::int32_t>();
  edit.corners = reader.get_vector<CornerChange>();
  edit.cut_facets.resize(reader.get_count(5));
  for (CutFacets& change : edit.cut_facets) {
    change.element = reader.get<std::int32_t>();
    change.mask = reader.get<std::uint8_t>();
  }
  edit.density.resize(reader.get_count(12));
  for (DensityChange& change : edit.density) {
    change.element = reader.get<std::int32_t>();
    change.factor = reader.get<double>();
  }
  return edit;
}

}  // namespace trocar
