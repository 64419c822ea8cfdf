// The table of tissues. Shear moduli at small strain as measured in the living where there is such
// a measurement; excised tissue is stiffer.
#include "engine/tissue_table.h"

#include <cmath>

#include "base/options.h"
#include "solver/material.h"

namespace trocar {

namespace {

// A neo-Hookean material by its shear modulus mu [Pa].
SceneMaterial neo_hookean(double mu, double density, std::vector<SceneProny> prony = {}) {
  SceneMaterial m;
  m.poisson_ratio = 0.45;
  m.young_modulus = 2 * mu * (1 + m.poisson_ratio);
  m.density = density;
  m.prony = std::move(prony);
  return m;
}

SceneMaterial liver() {
  SceneMaterial m;
  m.model = MaterialModel::yeoh;
  m.c1 = 900, m.c2 = 300;
  m.density = 1060;
  m.prony = {{0.25, 2}, {0.25, 40}};
  return m;
}

SceneMaterial brain() {
  SceneMaterial m;
  m.model = MaterialModel::ogden;
  m.ogden = {{842, -4.7}};
  m.density = 1040;
  m.prony = {{0.450, 0.5}, {0.365, 50}};
  return m;
}

SceneMaterial skin() {
  SceneMaterial m;
  m.model = MaterialModel::holzapfel_gasser_ogden;
  m.poisson_ratio = 0.45;
  m.young_modulus = 2 * 0.2e6 * (1 + m.poisson_ratio);
  m.k1 = 24.5e6, m.k2 = 0.133, m.kappa = 0.15;
  m.fibre_angle = 0.7155849933176751;  // 41 degrees
  m.density = 1100;
  return m;
}

// What differs from a material without constants, as the scene would say it.
std::string constants_text(const SceneMaterial& m) {
  std::string text;
  const auto add = [&](const char* key, double x, const char* unit) {
    if (!std::isnan(x))
      text += (text.empty() ? "" : ", ") + std::string(key) + " " + number_text(x) + unit;
  };
  add("E", m.young_modulus, " Pa");
  add("c10", m.c10, " Pa");
  add("c01", m.c01, " Pa");
  add("c1", m.c1, " Pa");
  add("c2", m.c2, " Pa");
  add("c3", m.c3, " Pa");
  for (const SceneOgden& term : m.ogden) {
    add("mu", term.mu, " Pa");
    add("alpha", term.alpha, "");
  }
  add("eta", m.eta, " Pa");
  add("k1", m.k1, " Pa");
  add("k2", m.k2, "");
  add("kappa", m.kappa, "");
  add("fibre_angle", m.fibre_angle, " rad");
  return text;
}

std::string prony_text(const SceneMaterial& m) {
  std::string text;
  for (const SceneProny& branch : m.prony)
    text += (text.empty() ? "" : ", ") + number_text(branch.share) + " in " +
            number_text(branch.time) + " s";
  return text.empty() ? "-" : text;
}

}  // namespace

const std::vector<Tissue>& tissue_table() {
  static const std::vector<Tissue> table = {
      {"liver", liver(),
       "mu 1.8 kPa and density: PMC6925591, table 1. c2 (tangent 3.6 times as stiff at 30 % "
       "compression) and the relaxation by half over minutes: literature knowledge; nonlinear "
       "viscoelastic fits in Capilnasiu et al. 2020, Biomech Model Mechanobiol 19:1641."},
      {"kidney", neo_hookean(3000, 1050, {{0.3, 1}}),
       "Cortex, mu 2 to 5 kPa and strong stiffening with rate: literature knowledge (qualitatively "
       "Snedeker et al. 2005; Johnson 2021, Biomechanics 1:264). The capsule is not in it."},
      {"spleen", neo_hookean(3565, 1060),
       "mu at 60 Hz: Mannelli et al. 2010, AJR 195:387 (3565 +- 586 Pa in 16 volunteers), so "
       "rather too stiff for slow motion. Density: literature knowledge."},
      {"uterus", neo_hookean(2700, 1050),
       "mu 2.7 +- 0.3 kPa by elastography in the living: Karakas et al. 2026, Front Med 1743585. "
       "Density: literature knowledge."},
      {"uterus-excised", neo_hookean(10000, 1050),
       "Lower end of the dynamic Young's modulus, 30 to 90 kPa: Kiss et al. 2006, PMC3690800."},
      {"myoma", neo_hookean(20000, 1050),
       "Lower end of 60 to 220 kPa for E, excised: Kiss et al. 2006, PMC3690800."},
      {"brain", brain(),
       "Ogden term and relaxation: Miller and Chinzei 2002, J Biomech 35:483, as commonly quoted "
       "(literature knowledge). Density: literature knowledge."},
      {"fat", neo_hookean(1100, 920),
       "Breast fat, E 3.25 +- 0.9 kPa: Samani et al. 2007, Phys Med Biol 52:1565, as commonly "
       "quoted (literature knowledge)."},
      {"skin", skin(),
       "Excised human back: Ni Annaidh et al. 2012, Ann Biomed Eng 40:1666, as commonly quoted "
       "(literature knowledge; to be checked). In the living it is under tension of its own. Its "
       "stable step is about a twentieth of the liver's."}};
  return table;
}

const Tissue* find_tissue(const std::string& name) {
  for (const Tissue& tissue : tissue_table())
    if (tissue.name == name) return &tissue;
  return nullptr;
}

std::vector<std::string> known_tissues() {
  std::vector<std::string> names;
  for (const Tissue& tissue : tissue_table()) names.emplace_back(tissue.name);
  return names;
}

std::string tissues_text() {
  std::string text = "Tissues for [tissue.material] tissue = \"…\":\n";
  for (const Tissue& tissue : tissue_table())
    text += "\n" + std::string(tissue.name) + ": " + model_name(tissue.material.model) + ", " +
            constants_text(tissue.material) + "\n  " + tissue.source + "\n";
  return text;
}

std::string tissues_markdown() {
  std::string text =
      "# Tissues\n\n"
      "Starting values by name: `[tissue.material]` `tissue = \"liver\"`; keys beside it change "
      "single values. This file is written by `trocar help tissues --markdown`.\n\n"
      "| Name | Model | Constants | Density [kg/m^3] | Relaxing shares | Source |\n"
      "|---|---|---|---|---|---|\n";
  for (const Tissue& tissue : tissue_table())
    text += "| " + std::string(tissue.name) + " | " + model_name(tissue.material.model) + " | " +
            constants_text(tissue.material) + " | " + number_text(tissue.material.density) + " | " +
            prony_text(tissue.material) + " | " + tissue.source + " |\n";
  return text;
}

}  // namespace trocar
