#include "engine/scene_material.h"

#include <array>
#include <cmath>
#include <initializer_list>

#include "base/quoted.h"
#include "engine/tissue_table.h"
#include "solver/material_setup.h"

namespace trocar {

namespace {

const std::vector<std::pair<std::string, MaterialModel>> models = {
    {"linear", MaterialModel::linear},
    {"st-venant-kirchhoff", MaterialModel::st_venant_kirchhoff},
    {"neo-hookean", MaterialModel::neo_hookean},
    {"mooney-rivlin", MaterialModel::mooney_rivlin},
    {"yeoh", MaterialModel::yeoh},
    {"ogden", MaterialModel::ogden},
    {"transversely-isotropic", MaterialModel::transversely_isotropic},
    {"holzapfel-gasser-ogden", MaterialModel::holzapfel_gasser_ogden}};

constexpr unsigned bit(MaterialModel model) {
  return 1U << static_cast<unsigned>(model);
}
constexpr unsigned has_young =
    bit(MaterialModel::linear) | bit(MaterialModel::st_venant_kirchhoff) |
    bit(MaterialModel::neo_hookean) | bit(MaterialModel::transversely_isotropic) |
    bit(MaterialModel::holzapfel_gasser_ogden);
constexpr unsigned all_models = ~0U;
constexpr unsigned is_hgo = bit(MaterialModel::holzapfel_gasser_ogden);

// A number of a material: who has it, and what stands for it when absent (NaN: it is needed).
struct Parameter {
  const char* key;
  double SceneMaterial::*member;
  double Material::*of_solver;
  Dimension dimension;
  Range range;
  unsigned of_models;
  double otherwise;
  const char* doc;
};

const std::vector<Parameter>& parameters() {
  constexpr double needed = SceneMaterial::absent;
  constexpr Range poisson{.low = -1, .high = 0.5, .is_low_open = true, .is_high_open = true};
  static const std::vector<Parameter> list = {
      {"young_modulus", &SceneMaterial::young_modulus, &Material::young_modulus, dim::pressure,
       positive, has_young, 3000,
       "Young's modulus E (of what is between the fibres); 3 kPa if absent. Not for mooney-rivlin, "
       "yeoh and ogden, whose constants say it."},
      {"poisson_ratio", &SceneMaterial::poisson_ratio, &Material::poisson_ratio, dim::none, poisson,
       all_models, 0.45,
       "Poisson's ratio nu, which gives K = 2 mu (1 + nu) / (3 (1 - 2 nu)) with the shear modulus "
       "mu at small strain; 0.45 if absent; 0.5 itself has no finite stable step."},
      {"density", &SceneMaterial::density, &Material::density, dim::density, positive, all_models,
       1060, "Mass density rho; 1060 kg/m^3 if absent."},
      {"c10", &SceneMaterial::c10, &Material::c10, dim::pressure, any,
       bit(MaterialModel::mooney_rivlin), needed, "mooney-rivlin: mu = 2 (c10 + c01)."},
      {"c01", &SceneMaterial::c01, &Material::c01, dim::pressure, any,
       bit(MaterialModel::mooney_rivlin), 0, "mooney-rivlin."},
      {"c1", &SceneMaterial::c1, &Material::c1, dim::pressure, positive, bit(MaterialModel::yeoh),
       needed, "yeoh: mu = 2 c1."},
      {"c2", &SceneMaterial::c2, &Material::c2, dim::pressure, any, bit(MaterialModel::yeoh), 0,
       "yeoh."},
      {"c3", &SceneMaterial::c3, &Material::c3, dim::pressure, any, bit(MaterialModel::yeoh), 0,
       "yeoh."},
      {"eta", &SceneMaterial::eta, &Material::eta, dim::pressure, not_negative,
       bit(MaterialModel::transversely_isotropic), needed,
       "transversely-isotropic: fibre modulus."},
      {"k1", &SceneMaterial::k1, &Material::k1, dim::pressure, not_negative, is_hgo, needed,
       "holzapfel-gasser-ogden: fibre modulus."},
      {"k2", &SceneMaterial::k2, &Material::k2, dim::none, positive, is_hgo, needed,
       "holzapfel-gasser-ogden: exponent."},
      {"kappa",
       &SceneMaterial::kappa,
       &Material::kappa,
       dim::none,
       {.low = 0, .high = 1.0 / 3},
       is_hgo,
       0,
       "holzapfel-gasser-ogden: dispersion, 0 aligned … 1/3 isotropic."},
      {"fibre_angle",
       &SceneMaterial::fibre_angle,
       &Material::fibre_angle,
       dim::angle,
       {.low = 0, .high = 1.5707963},
       is_hgo,
       0,
       "holzapfel-gasser-ogden: two families at plus and minus this angle to fibre, in the plane "
       "across fibre_normal; 0: one family. \"30 deg\"."}};
  return list;
}

// What the scene does not say, the tissue does. Whether there is one that fits.
bool take_tissue(const std::string& path, SceneMaterial& m, OptionErrors& errors) {
  const Tissue* tissue = find_tissue(m.tissue);
  if (tissue == nullptr) {
    errors.add(path + ".tissue",
               "there is no tissue \"" + m.tissue + "\"" + names_hint(m.tissue, known_tissues()));
    return false;
  }
  const SceneMaterial& base = tissue->material;
  if (errors.where().places.contains(path + ".model") && m.model != base.model) {
    errors.add(path + ".model", "tissue \"" + m.tissue + "\" is of model " +
                                    model_name(base.model) + ": leave model or tissue out");
    return false;
  }
  m.model = base.model;
  for (const Parameter& p : parameters())
    if (std::isnan(m.*p.member)) m.*p.member = base.*p.member;
  if (m.ogden.empty()) m.ogden = base.ogden;
  if (m.prony.empty() && !errors.where().places.contains(path + ".prony")) m.prony = base.prony;
  return true;
}

std::string parameters_of(MaterialModel model) {
  std::string list;
  for (const Parameter& p : parameters())
    if ((p.of_models & bit(model)) != 0) list.append(list.empty() ? "" : ", ").append(p.key);
  return list;
}

// Whether the model has what is given, and gets what it needs.
bool check_parameters(const std::string& path, const SceneMaterial& m, OptionErrors& errors) {
  const std::string model = model_name(m.model);
  std::string lacking;
  bool is_sound = true;
  for (const Parameter& p : parameters()) {
    const bool is_absent = std::isnan(m.*p.member), belongs = (p.of_models & bit(m.model)) != 0;
    if (is_absent && belongs && std::isnan(p.otherwise))
      lacking.append(lacking.empty() ? "" : " and ").append(p.key);
    if (is_absent || belongs) continue;
    errors.add(path + "." + p.key, std::string(p.key) + " is no parameter of model " + model +
                                       ", which has " + parameters_of(m.model));
    is_sound = false;
  }
  if (!lacking.empty()) errors.add(path + ".model", "model " + model + " needs " + lacking);
  return is_sound && lacking.empty();
}

// The same of the terms of Ogden's energy.
bool check_terms(const std::string& path, const SceneMaterial& m, OptionErrors& errors) {
  const bool needs = m.model == MaterialModel::ogden;
  if (needs && m.ogden.empty())
    errors.add(path + ".model", "model ogden needs terms: ogden = [{mu = \"1 kPa\", alpha = 2}]");
  else if (!needs && !m.ogden.empty())
    errors.add(path + ".ogden", "ogden terms belong to model ogden");
  else if (m.ogden.size() > 3)
    errors.add(path + ".ogden", "at most three terms are allowed");
  else
    return true;
  return false;
}

void fill_defaults(SceneMaterial& m) {
  for (const Parameter& p : parameters())
    if (std::isnan(m.*p.member) && (p.of_models & bit(m.model)) != 0) m.*p.member = p.otherwise;
}

}  // namespace

std::string model_name(MaterialModel model) {
  return models[static_cast<std::size_t>(model)].first;
}

Options<SceneMaterial> material_options() {
  Options<SceneOgden> term("A term of Ogden's energy.");
  term.number("mu", &SceneOgden::mu, dim::pressure, positive, "Its share of the shear modulus.",
              Need::required);
  term.number("alpha", &SceneOgden::alpha, dim::none, any, "Its exponent, not 0.", Need::required);
  Options<SceneProny> branch("A branch of the relaxing isochoric stress.");
  branch.number("share", &SceneProny::share, dim::none, {.low = 0, .high = 1, .is_low_open = true},
                "g of G(t) / G(0) = 1 - sum g (1 - exp(-t / time)).", Need::required);
  branch.number("time", &SceneProny::time, dim::time, positive, "Time constant.", Need::required);
  Options<SceneMaterial> m("What the tissue is made of.");
  m.text("tissue", &SceneMaterial::tissue,
         "Name of a tissue whose values stand for what is absent here (docs/tissues.md).");
  m.choice("model", &SceneMaterial::model, models,
           "neo-hookean: W = mu/2 (I1bar - 3) + K/2 (J - 1)^2; linear only for small strains; "
           "st-venant-kirchhoff not for compression. All but these two have the volumetric "
           "energy K/2 (J - 1)^2.");
  for (const Parameter& p : parameters()) m.number(p.key, p.member, p.dimension, p.range, p.doc);
  m.vector(
      "fibre", &SceneMaterial::fibre, dim::none, any,
      "Direction of the fibres where the mesh gives none (cell data \"fibre\" of a .vtk or .vtu).");
  m.vector("fibre_normal", &SceneMaterial::fibre_normal, dim::none, any,
           "Normal of the plane of two families.");
  m.list("ogden", &SceneMaterial::ogden, term,
         "ogden: up to three terms 2 mu/alpha^2 (sum of stretches^alpha - 3).");
  m.list("prony", &SceneMaterial::prony, branch,
         "Viscoelasticity of any model, up to four branches. [] leaves out that of a tissue.");
  return m;
}

void complete_material(const std::string& path, SceneMaterial& m, OptionErrors& errors) {
  if (!m.tissue.empty() && !take_tissue(path, m, errors)) return;
  const bool has_terms = check_terms(path, m, errors);
  if (!check_parameters(path, m, errors) || !has_terms) return;
  fill_defaults(m);
  const MaterialFault fault = fault_of(to_material(m));
  if (!fault.sentence.empty()) errors.add(path + "." + fault.member, fault.sentence);
}

Material to_material(const SceneMaterial& given) {
  SceneMaterial m = given;
  fill_defaults(m);
  Material material{.model = m.model, .fibre = m.fibre, .fibre_normal = m.fibre_normal};
  for (const Parameter& p : parameters())
    if (!std::isnan(m.*p.member)) material.*p.of_solver = m.*p.member;
  for (std::size_t k = 0; k < m.ogden.size() && k < material.ogden.size(); ++k)
    material.ogden[k] = {m.ogden[k].mu, m.ogden[k].alpha};
  for (const SceneProny& branch : m.prony) material.prony.push_back({branch.share, branch.time});
  return material;
}

}  // namespace trocar
