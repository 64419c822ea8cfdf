#include "engine/body_check.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/number_text.h"
#include "base/options.h"
#include "engine/plausible_check.h"
#include "engine/support_check.h"
#include "engine/unused_keys.h"
#include "solver/material_check.h"
#include "solver/material_response.h"

namespace trocar {

namespace {

// Whether a load could move any of the nodes; which way a pressure pushes is open.
bool can_move(const Simulation& s, const SceneLoad& load, const NodeSet& region) {
  FixedMask pushed = load.pressure != 0 ? all_components : FixedMask{0};
  for (int j = 0; j < 3; ++j)
    if (load.force[j] != 0) pushed = static_cast<FixedMask>(pushed | (1 << j));
  std::vector<std::uint8_t> is_carried(s.mesh.X.size());  // by a moving support
  for (const Hold& hold : s.holds.holds) is_carried[hold.node] = 1;
  return std::any_of(region.node.begin(), region.node.end(), [&](std::int32_t node) {
    const auto i = static_cast<std::size_t>(node);
    return is_carried[i] == 0 && (pushed & ~s.fixed[i]) != 0;
  });
}

void check_loads(const Simulation& s, OptionErrors& errors) {
  const LoadedAreas areas = find_loaded_areas(s.scene.loads, s.mesh, s.surface);
  for (std::size_t k = 0; k < s.scene.loads.size(); ++k) {
    const SceneLoad& load = s.scene.loads[k];
    const NodeSet& region = *find_node_set(s.mesh, load.region);
    if (load.pressure != 0 && areas.of_load[k].empty())
      errors.add(item_path("load", k) + ".region",
                 "no face of the surface lies in region \"" + load.region +
                     "\" with all its nodes: nothing for the pressure to act on");
    if (!can_move(s, load, region))
      log_warning(item_path("load", k) + " moves nothing: supports hold all nodes of region \"" +
                  load.region + "\", or the body is plane and the force across it");
  }
}

// A plane body stays in its plane.
void check_plane(const Simulation& s) {
  if (s.mesh.dimension() != 2) return;
  const auto warn = [](const std::string& key, const std::string& what) {
    log_warning(key + ": " + what + " along z does nothing, as the body is plane");
  };
  if (s.scene.solver.gravity.z() != 0) warn("solver.gravity", "gravity");
  for (std::size_t k = 0; k < s.scene.supports.size(); ++k)
    if (std::ranges::any_of(s.scene.supports[k].path,
                            [](const SupportKey& key) { return key.displacement.z() != 0; }))
      warn(item_path("support", k) + ".path", "motion");
}

// What two families of fibres lie about must not lie across their plane.
void check_fibres(const Simulation& s, OptionErrors& errors) {
  constexpr double least_sine = 1e-6;
  for (std::size_t e = 0; e < s.mesh.fibre.size(); ++e) {
    const Material& material = s.materials[s.mesh.element_region[e]];
    if (material.model != MaterialModel::holzapfel_gasser_ogden || !(material.fibre_angle > 0))
      continue;
    const Vec3& normal = material.fibre_normal;
    if (normal.cross(s.mesh.fibre[e]).norm() < least_sine * normal.norm())
      return errors.add("tissue.mesh", "the fibre of element " + std::to_string(e) +
                                           " lies along fibre_normal, about which fibre_angle has "
                                           "two families turn: give another fibre_normal");
  }
}

// Keys of paths that come after the end of the run, and so never.
template <class Items>
void tell_late_keys(const Scene& scene, const std::string& list, const Items& items) {
  for (std::size_t k = 0; k < items.size(); ++k) {
    const auto n = std::ranges::count_if(
        items[k].path, [&](const auto& key) { return key.time > scene.time.duration; });
    if (n > 0)
      log_info(item_path(list, k) + ".path: " + std::to_string(n) + " of " +
               std::to_string(items[k].path.size()) + " keys come after the end, at " +
               short_text(scene.time.duration) + " s");
  }
}

// Graspers take hold and let go at the beginning of a frame.
void tell_late_acts(const Scene& scene) {
  const double last = scene.time.at(scene.time.n_frames() - 1);
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    for (const InstrumentKey& key : scene.instruments[k].path)
      if (scene.instruments[k].kind == InstrumentKind::grasper && key.action != GraspAction::none &&
          key.time > last && key.time <= scene.time.duration)
        log_info(item_path("instrument", k) + ".path: what it does at " + short_text(key.time) +
                 " s comes after the beginning of the last frame, at " + short_text(last) +
                 " s, and so never");
}

void check_markers(const Scene& scene) {
  if (!scene.markers.empty() && !has_metrics(scene))
    log_warning(
        "markers do nothing: there is no [[output]] of kind \"metrics\" to tell where they are");
}

// Cuts make tetrahedra of hexahedra in the middle of the run: what these can't be made of is
// refused at its start.
void check_converted(const Simulation& s, OptionErrors& errors) {
  if (s.cuts.empty()) return;
  const SolverOptions options = solver_options(s.scene);
  std::vector<std::uint8_t> has_hexahedra(s.materials.size(), 0);
  for (std::size_t e = 0; e < s.mesh.element_type.size(); ++e)
    if (s.mesh.element_type[e] == ElementType::hex8) has_hexahedra[s.mesh.element_region[e]] = 1;
  for (std::size_t r = 0; r < s.materials.size(); ++r) {
    if (has_hexahedra[r] == 0) continue;
    if (const std::string fault = misfit_of(s.materials[r], options.tet4, options.precision);
        !fault.empty())
      errors.add("solver.tetrahedron", "a cut makes tetrahedra of hexahedra: " + fault);
  }
}

void warn_of_softening(const SceneMaterial& material, const std::string& path) {
  if (const std::string softening = softening_of(to_material(material)); !softening.empty())
    log_warning(path + ": with these constants " + softening +
                ": tissue strained so far gives way without end, and the run fails there; choose "
                "constants whose stress grows up to the strains of the scene");
}

void check_materials_harden(const Scene& scene) {
  warn_of_softening(scene.tissue.material, "tissue.material");
  for (std::size_t k = 0; k < scene.tissue.region_materials.size(); ++k)
    warn_of_softening(scene.tissue.region_materials[k].material,
                      item_path("tissue.region_material", k) + ".material");
}

}  // namespace

void check_body(const Simulation& s, OptionErrors& errors) {
  check_supports(s.scene, s.mesh, errors);
  check_loads(s, errors);
  check_plane(s);
  check_fibres(s, errors);
  tell_late_keys(s.scene, "support", s.scene.supports);
  tell_late_keys(s.scene, "load", s.scene.loads);
  tell_late_keys(s.scene, "instrument", s.scene.instruments);
  tell_late_acts(s.scene);
  check_markers(s.scene);
  check_converted(s, errors);
  check_materials_harden(s.scene);
  warn_of_implausible(s.scene);
  for (const std::string& sentence : unused_keys(s.scene, s.mesh)) log_warning(sentence);
}

}  // namespace trocar
