#include "base_scene_options.h"

#include "error_of.h"

namespace trocar {

Options<Material> material_options() {
  Options<Material> options("Its material.");
  options.choice("law", &Material::law,
                 {{"neo-hookean", Law::neo_hookean}, {"linear", Law::linear}}, "Constitutive law.");
  options.number("young_modulus", &Material::young_modulus, dim::pressure, positive,
                 "Young's modulus E.");
  options.number("poisson_ratio", &Material::poisson_ratio, dim::none,
                 {.low = 0, .high = 0.5, .is_high_open = true}, "Poisson's ratio.");
  options.number("density", &Material::density, dim::density, positive, "Mass per volume.");
  return options;
}

Options<Instrument> instrument_options() {
  Options<Keyframe> keyframe("A place at a time.");
  keyframe.number("time", &Keyframe::time, dim::time, not_negative, "When.", Need::required);
  keyframe.vector("position", &Keyframe::position, dim::length, any, "Where.");
  Options<Instrument> options("A tool.");
  options.number("radius", &Instrument::radius, dim::length, positive, "Radius of the tip.");
  options.integer("n_sides", &Instrument::n_sides, {.low = 3}, "Sides of the shaft.");
  options.list("path", &Instrument::path, keyframe, "Keyframes.");
  return options;
}

Options<Scene> scene_options() {
  Options<Tissue> tissue("The tissue.");
  tissue.text("mesh", &Tissue::mesh, "Mesh file.", Need::required);
  tissue.table("material", &Tissue::material, material_options());
  Options<Camera> camera("The endoscope.");
  camera.integers("size", &Camera::size, {.low = 1}, "Pixels across and down.");
  camera.number("view_angle", &Camera::view_angle, dim::angle, positive, "Of view | vertical.");
  Options<Scene> scene("A scene.");
  scene.text("name", &Scene::name, "What it is called.");
  scene.boolean("is_fast", &Scene::is_fast, "Whether to run without waiting.");
  scene.number("duration", &Scene::duration, dim::time, positive, "Length of the run.");
  scene.vector("gravity", &Scene::gravity, dim::acceleration, any, "Gravity.");
  scene.table("tissue", &Scene::tissue, tissue, Need::required);
  scene.table("camera", &Scene::camera, camera);
  scene.list("instrument", &Scene::instrument, instrument_options(), "The tools.");
  return scene;
}

Located<Scene> read_scene(const std::string& text, const std::vector<std::string>& overrides) {
  Located<Scene> scene;
  read_options_text(scene_options(), text, "s.toml", overrides, &scene.value, scene.where);
  return scene;
}

std::string scene_error(const std::string& text, const std::vector<std::string>& overrides) {
  return error_of([&] { read_scene(text, overrides); });
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "looked for: " << part << "\nin: " << text;
}

}  // namespace trocar
