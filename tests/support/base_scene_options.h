// A small scene with every kind of option, for the tests of reading, echo and help.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/options.h"

namespace trocar {

enum class Law { neo_hookean, linear };

struct Material {
  Law law = Law::neo_hookean;
  double young_modulus = 3000;
  double poisson_ratio = 0.45;
  double density = 0;
};
struct Keyframe {
  double time = 0;
  Vec3 position = Vec3::Zero();
};
struct Tissue {
  std::string mesh;
  Material material{.density = 1000};
};
struct Camera {
  std::array<int, 2> size{640, 480};
  double view_angle = 1;
};
struct Instrument {
  double radius = 0.002;
  int n_sides = 8;
  std::vector<Keyframe> path;
};
struct Scene {
  std::string name = "no name";
  bool is_fast = false;
  double duration = std::numeric_limits<double>::infinity();
  Vec3 gravity{0, 0, -9.81};
  Tissue tissue;
  std::optional<Camera> camera;
  std::vector<Instrument> instrument;
};

Options<Material> material_options();

Options<Instrument> instrument_options();

Options<Scene> scene_options();

// What was read: the struct and the places of its keys.
template <class T>
struct Located {
  T value;
  SourceMap where;
};

template <class T>
Located<T> read_options(const Options<T>& options, const std::string& file,
                        const std::vector<std::string>& overrides = {}) {
  Located<T> located;
  OptionErrors errors(located.where);
  read_options(options, file, overrides, &located.value, located.where, errors);
  errors.throw_if_any();
  return located;
}

Located<Scene> read_scene(const std::string& text, const std::vector<std::string>& overrides = {});

// The message of the error that reading gives, "" if there is none.
std::string scene_error(const std::string& text, const std::vector<std::string>& overrides = {});

void expect_part(const std::string& text, const std::string& part);

}  // namespace trocar
