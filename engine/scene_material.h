// Materials of a scene: which parameters each model has, what a tissue's name stands for, and what
// the solver gets.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/options.h"
#include "base/vec.h"
#include "solver/material.h"

namespace trocar {

struct SceneProny {
  double share = 0;
  double time = 0;
};

struct SceneOgden {
  double mu = 0;
  double alpha = 0;
};

// Numbers that are not given are NaN until complete_material() puts what stands for them.
struct SceneMaterial {
  static constexpr double absent = std::numeric_limits<double>::quiet_NaN();
  std::string tissue;  // a name of tissue_table.h; "" for none
  MaterialModel model = MaterialModel::neo_hookean;
  double young_modulus = absent, poisson_ratio = absent, density = absent;
  double c10 = absent, c01 = absent;
  double c1 = absent, c2 = absent, c3 = absent;
  double eta = absent;
  double k1 = absent, k2 = absent, kappa = absent, fibre_angle = absent;
  Vec3 fibre{1, 0, 0}, fibre_normal{0, 0, 1};
  std::vector<SceneOgden> ogden;
  std::vector<SceneProny> prony;
};

Options<SceneMaterial> material_options();
// "neo-hookean"
std::string model_name(MaterialModel model);

// Fills in the tissue's values and the defaults, and checks that what is given belongs to the
// model. `path` is that of its table.
void complete_material(const std::string& path, SceneMaterial& material, OptionErrors& errors);
// Of a complete one; defaults stand for what is still absent.
Material to_material(const SceneMaterial& material);

}  // namespace trocar
