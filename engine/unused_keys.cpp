#include "engine/unused_keys.h"

#include <algorithm>
#include <cmath>

#include "mesh/quality.h"

namespace trocar {

namespace {

struct Use {
  std::string key;
  bool is_given = false;
  bool has_effect = false;
  const char* needs = "";  // "only … have it"
};
using Uses = std::vector<Use>;

Uses of_time(const SceneTime& t) {
  const SceneTime d;
  return {{"time.overrun", t.overrun != d.overrun, t.pace == Pace::real_time,
           "only pace = \"real-time\" has deadlines"}};
}

Uses of_solver(const Scene& scene, const Mesh& mesh) {
  const SceneSolver& s = scene.solver;
  const SceneSolver d;
  const bool has_hexahedra = has_type(mesh, ElementType::hex8);
  const bool has_tetrahedra =
      has_type(mesh, ElementType::tet4) || (has_hexahedra && has_blades(scene));
  return {{"solver.triangle", s.triangle != d.triangle, has_type(mesh, ElementType::tri3),
           "the body has no triangles"},
          {"solver.tetrahedron", s.tetrahedron != d.tetrahedron, has_tetrahedra,
           "the body has no tetrahedra"},
          {"solver.hexahedron", s.hexahedron != d.hexahedron, has_hexahedra,
           "the body has no hexahedra"},
          {"solver.hourglass", s.hourglass != d.hourglass,
           has_hexahedra && s.hexahedron == Formulation::hex8_one_point,
           "only hexahedra of hexahedron = \"one-point\" have this stiffness"}};
}

Uses of_shape(const Scene& scene) {
  if (!scene.tissue.shape) return {};
  const SceneShape& s = *scene.tissue.shape;
  const SceneShape d;
  const bool is_box = s.kind == ShapeKind::box;
  const bool is_round = s.kind == ShapeKind::ball || s.kind == ShapeKind::cylinder;
  const char* const kind = "this kind of shape has none";
  return {{"tissue.shape.radius", s.radius != d.radius, is_round, kind},
          {"tissue.shape.height", s.height != d.height, s.kind == ShapeKind::cylinder, kind},
          {"tissue.shape.centre", s.centre != d.centre, is_round, kind},
          {"tissue.shape.low", s.low != d.low, is_box, "only a box has this corner"},
          {"tissue.shape.high", s.high != d.high, !is_round, "balls and cylinders have a radius"},
          {"tissue.shape.elements", s.elements != d.elements, is_box || is_round,
           "plane shapes are of triangles"}};
}

Uses of_material(const SceneMaterial& m, const std::string& path) {
  const SceneMaterial d;
  const bool has_plane = m.model == MaterialModel::holzapfel_gasser_ogden && m.fibre_angle > 0;
  return {{path + ".fibre", m.fibre != d.fibre, has_fibres(m.model), "the model has no fibres"},
          {path + ".fibre_normal", m.fibre_normal != d.fibre_normal, has_plane,
           "only holzapfel-gasser-ogden with a fibre_angle has two families"}};
}

bool any_has_fibres(const SceneTissue& tissue) {
  return any_material(tissue, [](const SceneMaterial& m) { return has_fibres(m.model); });
}

Uses of_tissue(const Scene& scene, const Mesh& mesh) {
  const SceneTissue& t = scene.tissue;
  const SceneTissue d;
  const char* const file = "only a mesh file is read with it";
  return {{"tissue.thickness", t.thickness != d.thickness, mesh.dimension() == 2,
           "only a plane body has it"},
          {"tissue.scale", t.scale != d.scale, !t.shape, file},
          {"tissue.renumber", t.is_renumbered != d.is_renumbered, !t.shape, file},
          {"the mesh's cell data \"fibre\"", !mesh.fibre.empty(), any_has_fibres(t),
           "no material has fibres"}};
}

Uses of_cutting(const Scene& scene, const Mesh& mesh) {
  const SceneCutting& c = scene.cutting;
  const SceneCutting d;
  const bool is_plane = mesh.dimension() == 2, cuts = has_blades(scene);
  const bool is_published = is_plane && c.mode == CutMode::paper;
  const bool is_tets = std::ranges::all_of(
      mesh.element_type, [](ElementType type) { return type == ElementType::tet4; });
  const char* const plane = cuts ? "only cuts of plane bodies have it" : "nothing cuts";
  return {{"cutting.advance", c.advance != d.advance, cuts && !is_plane,
           cuts ? "cuts of plane bodies don't have it" : "nothing cuts"},
          {"cutting.least_step_ratio", !std::isnan(c.least_step_ratio), cuts && !is_published,
           cuts ? "mode = \"paper\" has no floor" : "nothing cuts"},
          {"cutting.split_step_ratio", c.split_step_ratio != d.split_step_ratio, cuts && is_tets,
           cuts ? "only cuts of tetrahedra have it" : "nothing cuts"},
          {"cutting.resistance", c.resistance != d.resistance, cuts, "nothing cuts"},
          {"cutting.mode", c.mode != d.mode, cuts && is_plane, plane},
          {"cutting.spring", c.spring != d.spring, cuts && is_plane, plane},
          {"cutting.particle", c.particle != d.particle, cuts && is_plane, plane}};
}

Uses of_contact(const Scene& scene) {
  const SceneContact& c = scene.contact;
  const SceneContact d;
  const bool has_tools = !scene.instruments.empty();
  return {{"contact.friction", c.friction != d.friction, has_tools || c.has_tissue,
           "there are no instruments, and contact.tissue is false"},
          {"contact.release_speed", c.release_speed != d.release_speed, has_tools,
           "there are no instruments"}};
}

Uses of_start(const Scene& scene) {
  const SceneStart& s = scene.start;
  const SceneStart d;
  const bool is_sought = s.state == StartState::equilibrium;
  const char* const needs = "only state = \"equilibrium\" is sought";
  return {{"start.tolerance", s.tolerance != d.tolerance, is_sought, needs},
          {"start.max_iterations", s.max_iterations != d.max_iterations, is_sought, needs}};
}

Uses of_instrument(const SceneInstrument& i, const std::string& path) {
  const SceneInstrument d;
  return {
      {path + ".blade_length", i.blade_length != d.blade_length, has_blade(i.kind),
       "only scalpels and scissors have blades"},
      {path + ".grip_radius", i.grip_radius != d.grip_radius, i.kind == InstrumentKind::grasper,
       "only graspers grip"},
      {path + ".grip_force", i.grip_force != d.grip_force, i.kind == InstrumentKind::grasper,
       "only graspers grip"},
      {path + ".scale", i.scale != d.scale, !i.mesh.empty(), "only a mesh file is read with it"}};
}

Uses of_output(const SceneOutput& o, const std::string& path) {
  const SceneOutput d;
  const char* const needs = "only pictures have it";
  return {{path + ".camera", o.camera != d.camera, is_picture(o.kind), needs},
          {path + ".size", o.size != d.size, is_picture(o.kind), needs}};
}

}  // namespace

std::vector<std::string> unused_keys(const Scene& scene, const Mesh& mesh) {
  std::vector<std::string> sentences;
  const auto tell = [&](const Uses& uses) {
    for (const Use& use : uses)
      if (use.is_given && !use.has_effect)
        sentences.push_back(use.key + " has no effect: " + use.needs + "; leave it out");
  };
  tell(of_time(scene.time));
  tell(of_tissue(scene, mesh));
  tell(of_shape(scene));
  tell(of_material(scene.tissue.material, "tissue.material"));
  const std::vector<std::int64_t> n_elements = elements_by_region(mesh);
  for (std::size_t k = 0; k < scene.tissue.region_materials.size(); ++k) {
    const SceneRegionMaterial& of_region = scene.tissue.region_materials[k];
    const std::string path = item_path("tissue.region_material", k);
    const auto region = static_cast<std::size_t>(
        std::ranges::find(mesh.region_name, of_region.region) - mesh.region_name.begin());
    tell({{path, true, region < n_elements.size() && n_elements[region] > 0,
           "no element is of its region"}});
    tell(of_material(of_region.material, path + ".material"));
  }
  tell(of_solver(scene, mesh));
  tell(of_contact(scene));
  tell(of_cutting(scene, mesh));
  tell(of_start(scene));
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    tell(of_instrument(scene.instruments[k], item_path("instrument", k)));
  for (std::size_t k = 0; k < scene.outputs.size(); ++k)
    tell(of_output(scene.outputs[k], item_path("output", k)));
  return sentences;
}

}  // namespace trocar
