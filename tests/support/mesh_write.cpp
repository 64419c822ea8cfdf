#include "mesh_write.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "base/box.h"
#include "base/whole_file.h"

namespace trocar {

namespace {

// Nodes that belong to the same sets make one point entity.
using PointEntities = std::map<std::vector<std::int32_t>, std::vector<std::int32_t>>;

PointEntities make_point_entities(const Mesh& mesh) {
  std::map<std::int32_t, std::vector<std::int32_t>> sets_of_node;
  for (std::size_t s = 0; s < mesh.node_sets.size(); ++s)
    for (const std::int32_t i : mesh.node_sets[s].node)
      sets_of_node[i].push_back(static_cast<std::int32_t>(s));
  PointEntities entities;
  for (const auto& [node, sets] : sets_of_node) entities[sets].push_back(node);
  return entities;
}

template <class... Numbers>
void append_numbers(std::string& text, Numbers... numbers) {
  const auto append = [&](auto number) {
    std::array<char, 32> digits{};
    text.append(digits.data(), std::to_chars(digits.begin(), digits.end(), number).ptr);
    text += ' ';
  };
  (append(numbers), ...);
  text.back() = '\n';
}

void append_name(std::string& text, int dimension, std::size_t tag, const std::string& name) {
  append_numbers(text, dimension, tag);
  text.back() = ' ';
  text.append("\"").append(name).append("\"\n");
}

// The region of a mesh that has only one may have no name.
bool has_named_regions(const Mesh& mesh) {
  return mesh.region_name.size() > 1 || (mesh.region_name.size() == 1 && mesh.region_name[0] != "");
}

void append_names(std::string& text, const Mesh& mesh) {
  const std::size_t n_regions = has_named_regions(mesh) ? mesh.region_name.size() : 0;
  if (n_regions + mesh.node_sets.size() == 0) return;
  text += "$PhysicalNames\n";
  append_numbers(text, n_regions + mesh.node_sets.size());
  for (std::size_t s = 0; s < mesh.node_sets.size(); ++s)
    append_name(text, 0, s + 1, mesh.node_sets[s].name);
  for (std::size_t r = 0; r < n_regions; ++r)
    append_name(text, mesh.dimension(), r + 1, mesh.region_name[r]);
  text += "$EndPhysicalNames\n";
}

void append_point(std::string& text, const Vec3& X) {
  append_numbers(text, X.x(), X.y(), X.z());
}

void append_entities(std::string& text, const Mesh& mesh, const PointEntities& points) {
  const auto [low, high] = mesh.X.empty() ? Box{Vec3::Zero(), Vec3::Zero()} : bounding_box(mesh.X);
  const std::size_t n_regions = std::max<std::size_t>(1, mesh.region_name.size());
  const bool is_plane = mesh.dimension() == 2;
  text += "$Entities\n";
  append_numbers(text, points.size(), 0, is_plane ? n_regions : 0, is_plane ? 0 : n_regions);
  std::size_t tag = 0;
  for (const auto& [sets, nodes] : points) {
    append_numbers(text, ++tag);
    text.back() = ' ';
    append_point(text, mesh.X[nodes[0]]);
    text.back() = ' ';
    append_numbers(text, sets.size());
    for (const std::int32_t s : sets) {
      text.back() = ' ';
      append_numbers(text, s + 1);
    }
  }
  // Each region is a group even where it has no name: gmsh drops what is in none if there are any.
  for (std::size_t r = 0; r < n_regions; ++r)
    append_numbers(text, r + 1, low.x(), low.y(), low.z(), high.x(), high.y(), high.z(), 1, r + 1,
                   0);
  text += "$EndEntities\n";
}

void append_nodes(std::string& text, const Mesh& mesh) {
  text += "$Nodes\n";
  append_numbers(text, 1, mesh.X.size(), 1, mesh.X.size());
  append_numbers(text, mesh.dimension(), 1, 0, mesh.X.size());
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) append_numbers(text, i + 1);
  for (const Vec3& X : mesh.X) append_point(text, X);
  text += "$EndNodes\n";
}

// End of the run of elements of one type and region that begins with e: a block each, so that the
// order of the elements is kept.
std::int32_t run_end(const Mesh& mesh, std::int32_t e) {
  std::int32_t end = e + 1;
  while (end < mesh.n_elements() && mesh.element_type[end] == mesh.element_type[e] &&
         mesh.element_region[end] == mesh.element_region[e])
    ++end;
  return end;
}

void append_run(std::string& text, const Mesh& mesh, std::int32_t e, std::int32_t end) {
  constexpr std::array<int, n_element_types> gmsh_type = {2, 4, 5};
  const ElementType type = mesh.element_type[e];
  append_numbers(text, type == ElementType::tri3 ? 2 : 3, mesh.element_region[e] + 1,
                 gmsh_type[static_cast<std::size_t>(type)], end - e);
  for (; e < end; ++e) {
    append_numbers(text, e + 1);
    for (const std::int32_t i : mesh.corners(e)) {
      text.back() = ' ';
      append_numbers(text, i + 1);
    }
  }
}

void append_elements(std::string& text, const Mesh& mesh, const PointEntities& points) {
  std::size_t n_blocks = points.size(), n = mesh.element_type.size();
  for (std::int32_t e = 0; e < mesh.n_elements(); e = run_end(mesh, e)) ++n_blocks;
  for (const auto& [sets, nodes] : points) n += nodes.size();
  text += "$Elements\n";
  append_numbers(text, n_blocks, n, 1, n);
  for (std::int32_t e = 0; e < mesh.n_elements(); e = run_end(mesh, e))
    append_run(text, mesh, e, run_end(mesh, e));
  std::size_t entity = 0, tag = mesh.element_type.size();
  for (const auto& [sets, nodes] : points) {
    append_numbers(text, 0, ++entity, 15, nodes.size());
    for (const std::int32_t i : nodes) append_numbers(text, ++tag, i + 1);
  }
  text += "$EndElements\n";
}

}  // namespace

void write_mesh(const Mesh& mesh, const std::string& file) {
  const PointEntities points = make_point_entities(mesh);
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  append_names(text, mesh);
  append_entities(text, mesh, points);
  append_nodes(text, mesh);
  append_elements(text, mesh, points);
  write_whole_file(file, text);
}

}  // namespace trocar
