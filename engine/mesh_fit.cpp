#include "engine/mesh_fit.h"

#include <algorithm>

#include "base/number_text.h"
#include "base/quoted.h"
#include "engine/markers.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

struct RegionNames {
  std::vector<std::string> of_body, of_file;  // which may name some that have nothing of the body
};

// `what` the items of a list name: one of the body's. No hint beyond the errors that are shown.
template <class Items>
void check_regions(const std::string& list, const Items& items, const std::string& what,
                   const RegionNames& names, OptionErrors& errors) {
  std::vector<std::string> known = names.of_body;
  std::erase(known, "");
  for (std::size_t k = 0; k < items.size(); ++k) {
    const std::string& region = items[k].region;
    if (std::ranges::count(names.of_body, region) > 0) continue;
    std::string hint = errors.is_full() ? "" : names_hint(region, known);
    if (std::ranges::count(names.of_file, region) > 0)
      hint = ": its file names it, and puts nothing of the body there" + hint;
    errors.add(item_path(list, k) + ".region",
               "the body has no " + what + " \"" + region + "\"" + hint);
  }
}

// Supports and loads have regions of nodes and of elements, materials those of elements alone, also
// where there are none (unused_keys). [[region]] itself tells of an empty box.
void check_all_regions(const Scene& scene, const Mesh& mesh, OptionErrors& errors) {
  const RegionNames of_elements{.of_body = mesh.region_name, .of_file = {}};
  RegionNames all{.of_body = {}, .of_file = mesh.region_name};
  for (const NodeSet& set : mesh.node_sets) {
    const bool is_of_scene = std::ranges::count(scene.regions, set.name, &SceneRegion::name) > 0;
    if (!set.node.empty() || is_of_scene) all.of_body.push_back(set.name);
    all.of_file.push_back(set.name);
  }
  const std::vector<std::int64_t> n_elements = elements_by_region(mesh);
  for (std::size_t k = 0; k < n_elements.size(); ++k)
    if (const std::string& name = mesh.region_name[k];
        n_elements[k] > 0 && !name.empty() && !find_node_set(mesh, name))
      all.of_body.push_back(name);
  check_regions("tissue.region_material", scene.tissue.region_materials, "region of elements",
                of_elements, errors);
  check_regions("support", scene.supports, "region", all, errors);
  check_regions("load", scene.loads, "region", all, errors);
}

void check_plane(const Scene& scene, OptionErrors& errors) {
  if (scene.tissue.translate.z() != 0)
    errors.add("tissue.translate", "a plane body stays at z = 0");
  if (scene.contact.has_tissue)
    errors.add("contact.tissue", "this body is plane: only volumes touch themselves");
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (scene.instruments[k].kind == InstrumentKind::scissors)
      errors.add(item_path("instrument", k) + ".kind",
                 "scissors cut volumes only: a scalpel cuts this plane body");
}

// The edge has points half an element's edge apart, of which each frame makes a band.
void check_blades(const Scene& scene, const Mesh& mesh, OptionErrors& errors) {
  constexpr double most_edges = 1e5;
  if (!has_blades(scene)) return;
  const double edge = mean_edge_length(mesh);
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    const SceneInstrument& instrument = scene.instruments[k];
    if (!has_blade(instrument.kind) || instrument.blade_length <= most_edges * edge) continue;
    errors.add(item_path("instrument", k) + ".blade_length",
               "the blade is longer than 100,000 edges of the mesh, which have " +
                   short_text(edge) + " m: does its unit fit the mesh's?");
  }
}

void check_markers(const Scene& scene, const Mesh& mesh, OptionErrors& errors) {
  const std::vector<Location> markers = locate_markers(scene.markers, mesh);
  for (std::size_t k = 0; k < markers.size(); ++k)
    if (markers[k].element < 0)
      errors.add(item_path("marker", k) + ".position",
                 "marker \"" + scene.markers[k].name + "\" lies outside the undeformed body");
}

}  // namespace

void check_fit(const Scene& scene, const Mesh& mesh, OptionErrors& errors) {
  check_all_regions(scene, mesh, errors);
  if (mesh.dimension() == 2) check_plane(scene, errors);
  check_blades(scene, mesh, errors);
  check_markers(scene, mesh, errors);
}

}  // namespace trocar
