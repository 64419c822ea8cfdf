#include "study/study_method.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/quoted.h"
#include "solver/element_setup.h"

namespace trocar {

namespace {

constexpr Method all_methods[] = {
    {"hex8", Formulation::hex8_one_point, BoxElements::hex8},
    {"hex8-enhanced", Formulation::hex8_enhanced, BoxElements::hex8},
    {"hex8-full", Formulation::hex8_full, BoxElements::hex8},
    {"tet4", Formulation::tet4, BoxElements::tet4_kuhn},
    {"tet4-nodal-pressure", Formulation::tet4_nodal_pressure, BoxElements::tet4_kuhn},
    {"tri3", Formulation::tri3_plane_strain},
    {"tri3-plane-stress", Formulation::tri3_plane_stress},
};

}  // namespace

std::span<const Method> methods() {
  return all_methods;
}

const Method& method_named(const std::string& name) {
  std::vector<std::string> known;
  for (const Method& method : methods()) {
    if (name == method.name) return method;
    known.emplace_back(method.name);
  }
  throw InputError("--elements: there is no " + in_quotes(name) + names_hint(name, known));
}

Precision precision_named(const std::string& name) {
  if (name == "double") return Precision::in_double;
  if (name == "single") return Precision::in_single;
  throw InputError("--precision: " + in_quotes(name) + " is neither double nor single");
}

SolverOptions solver_options(const Method& method, Precision precision) {
  SolverOptions options;
  options.precision = precision;
  of_shape(shape_of(method.formulation), options.tri3, options.tet4, options.hex8) =
      method.formulation;
  return options;
}

}  // namespace trocar
