#include "engine/tissue.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/on_root.h"
#include "cutting/cut_hex.h"
#include "engine/bytes.h"
#include "engine/memory_need.h"
#include "engine/mesh_fit.h"
#include "engine/point_text.h"
#include "mesh/box_cells.h"
#include "mesh/connected_nodes.h"
#include "mesh/generate.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"
#include "mesh/renumber.h"

namespace trocar {

namespace {

Mesh generate_tissue(const SceneShape& s) {
  switch (s.kind) {
    case ShapeKind::box:
      return make_box(s.low, s.high, s.cells, s.elements);
    case ShapeKind::ball:
      return make_ball(s.centre, s.radius, s.cells[0], s.elements);
    case ShapeKind::cylinder:
      return make_cylinder(s.centre, s.radius, s.height, s.cells[0], s.cells[2], s.elements);
    case ShapeKind::rectangle:
      return make_rectangle(s.high.x(), s.high.y(), s.cells[0], s.cells[1]);
    case ShapeKind::triangular_rectangle:
      return make_triangular_rectangle(s.high.x(), s.cells[0], s.cells[1]);
  }
  return {};
}

void place(const SceneTissue& tissue, Mesh& mesh) {
  const Box box = bounding_box(mesh.X);
  const double longest = box.size().maxCoeff();
  const double factor = tissue.longest_side > 0 ? tissue.longest_side / longest : 1;
  const Vec3 origin = tissue.is_centred ? box.middle() : Vec3::Zero();
  for (Vec3& X : mesh.X) X = (X - origin) * factor + tissue.translate;
}

// "from (0, 0, 0) to (0.1, 0.1, 0.1) m"
std::string reach_text(const Mesh& mesh) {
  const Box box = bounding_box(mesh.X);
  return "from " + point_text(box.low) + " to " + point_text(box.high) + " m";
}

bool is_in(const SceneRegion& region, const Vec3& X) {
  const bool is_in_box =
      (X.array() >= region.low.array()).all() && (X.array() <= region.high.array()).all();
  if (!is_in_box || region.shape == RegionShape::box) return is_in_box;
  const Vec3 half = 0.5 * (region.high - region.low), offset = X - 0.5 * (region.low + region.high);
  return (half.array() > 0).select(offset.array() / half.array(), 0).matrix().squaredNorm() <= 1;
}

void add_node_regions(const LoadedScene& loaded, Mesh& mesh, OptionErrors& errors) {
  for (std::size_t k = 0; k < loaded.scene.regions.size(); ++k) {
    const SceneRegion& region = loaded.scene.regions[k];
    const std::string path = item_path("region", k);
    if (find_node_set(mesh, region.name) || std::ranges::count(mesh.region_name, region.name) > 0) {
      errors.add(path + ".name", "the body has a region \"" + region.name + "\" already");
      continue;
    }
    NodeSet set{.name = region.name, .node = {}};
    for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
      if (is_in(region, mesh.X[i])) set.node.push_back(i);
    if (set.node.empty())
      errors.add(path + ".low", "region \"" + region.name + "\" holds no node of the mesh, which " +
                                    "reaches " + reach_text(mesh));
    mesh.node_sets.push_back(std::move(set));
  }
}

// Of [[region]]s that materials name: the elements whose middle lies there, of several the last.
void add_element_regions(const Scene& scene, Mesh& mesh, OptionErrors& errors) {
  for (std::size_t k = 0; k < scene.tissue.region_materials.size(); ++k) {
    const std::string& name = scene.tissue.region_materials[k].region;
    const auto region = std::ranges::find(scene.regions, name, &SceneRegion::name);
    if (region == scene.regions.end()) continue;
    const auto number = static_cast<std::int32_t>(std::ranges::find(mesh.region_name, name) -
                                                  mesh.region_name.begin());
    if (number == std::ssize(mesh.region_name)) mesh.region_name.push_back(name);
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      if (is_in(*region, element_centre(mesh, e))) mesh.element_region[e] = number;
    const NodeSet* const set = find_node_set(mesh, name);
    const bool is_told = set == nullptr || set->node.empty();
    if (!is_told && std::ranges::count(mesh.element_region, number) == 0)
      errors.add(item_path("tissue.region_material", k) + ".region",
                 "region \"" + name + "\" holds the middle of no element: enlarge it or take a " +
                     "finer mesh");
  }
}

// Nodes of a region of elements, such as a physical volume of Gmsh, as a set. Of no use to others
// than supports and loads that name it.
void add_volume_region(const std::string& name, Mesh& mesh) {
  const auto at = std::ranges::find(mesh.region_name, name);
  if (name.empty() || at == mesh.region_name.end() || find_node_set(mesh, name)) return;
  std::vector<std::uint8_t> is_in(mesh.X.size(), 0);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (mesh.element_region[e] == at - mesh.region_name.begin())
      for (const std::int32_t node : mesh.corners(e)) is_in[node] = 1;
  NodeSet set{.name = name, .node = {}};
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (is_in[i] != 0) set.node.push_back(i);
  mesh.node_sets.push_back(std::move(set));
}

// Parts that a mesher has laid side by side fall apart, which is seldom wanted.
void warn_of_pieces(const SceneTissue& tissue, const Mesh& mesh) {
  const auto [n_pieces, n] = piece_statistics(mesh);
  if (n > 0)
    log_warning(
        tissue.mesh + ": is in " + std::to_string(n_pieces) + " pieces, and " + std::to_string(n) +
        " nodes lie where nodes of other pieces do without being joined to them: the mesher "
        "must merge these if the pieces belong together");
}

Mesh read_tissue(const LoadedScene& loaded) {
  const SceneTissue& tissue = loaded.scene.tissue;
  Mesh mesh;
  try {
    mesh = tissue.shape ? generate_tissue(*tissue.shape)
                        : read_mesh(scene_path(loaded, tissue.mesh), tissue.scale);
  } catch (const InputError& trouble) {
    loaded.where.fail(tissue.shape ? "tissue.shape.cells" : "tissue.mesh", trouble.what());
  }
  const std::vector<std::string> faults = validate(mesh, 3);  // in the file's numbers
  if (!faults.empty())
    loaded.where.fail(tissue.shape ? "tissue.shape" : "tissue.mesh",
                      "the mesh can't be used: " + faults.front());
  if (!tissue.shape && tissue.is_renumbered) mesh = in_near_order(mesh);
  place(tissue, mesh);
  if (!tissue.shape) {
    warn_of_size(tissue.mesh, "tissue.scale", mesh.X);
    warn_of_pieces(tissue, mesh);
  }
  if (has_blades(loaded.scene)) mesh.hex_split_rank = hex_split_ranks(mesh);
  OptionErrors errors(loaded.where);
  add_node_regions(loaded, mesh, errors);
  add_element_regions(loaded.scene, mesh, errors);
  for (const SceneSupport& support : loaded.scene.supports) add_volume_region(support.region, mesh);
  for (const SceneLoad& load : loaded.scene.loads) add_volume_region(load.region, mesh);
  check_fit(loaded.scene, mesh, errors);
  errors.throw_if_any();
  return mesh;
}

}  // namespace

std::vector<Material> region_materials(const SceneTissue& tissue, const Mesh& mesh) {
  return of_regions(tissue, mesh, to_material(tissue.material),
                    [](const SceneRegionMaterial& other) { return to_material(other.material); });
}

void warn_of_size(const std::string& file, const std::string& key, std::span<const Vec3> X) {
  constexpr double smallest = 5e-4, largest = 3;  // [m]
  const double longest = bounding_box(X).size().maxCoeff();
  if (longest >= smallest && longest <= largest) return;
  log_warning(file + ": is " + short_text(longest) + " m long: " + key +
              " says what one unit of the file is, \"1 mm\" for a mesh in millimetres");
}

Mesh load_tissue(const LoadedScene& loaded, Communicator& communicator) {
  const Scene& scene = loaded.scene;
  const double left = memory_for_a_rank(communicator);
  const auto check = [&](const BodySize& size) {
    check_memory(size, scene.solver, communicator.size(), left);
  };
  const bool is_generated = scene.tissue.shape.has_value();
  if (is_generated) {
    const BodySize size = size_of(*scene.tissue.shape);
    if (size.n_nodes <= max_generated_nodes) check(size);  // more are refused as they are generated
  }
  const auto bytes = read_on_root(communicator, [&] {
    const Mesh mesh = read_tissue(loaded);
    if (!is_generated) check(size_of(mesh));
    return mesh_to_bytes(mesh);
  });
  return mesh_from_bytes(bytes);
}

}  // namespace trocar
