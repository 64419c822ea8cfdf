// The ways to compute a body that a study compares. A new formulation joins by one line in
// study_method.cpp.
#pragma once

#include <span>
#include <string>

#include "mesh/generate.h"
#include "solver/model.h"

namespace trocar {

struct Method {
  const char* name = "";
  Formulation formulation = Formulation::hex8_one_point;
  BoxElements elements = BoxElements::hex8;  // that generated boxes are made of
};

std::span<const Method> methods();
// Throws InputError with the nearest known name.
const Method& method_named(const std::string& name);
// "double", "single"; throws InputError.
Precision precision_named(const std::string& name);

// With the method's shape computed by its formulation.
SolverOptions solver_options(const Method& method, Precision precision);

}  // namespace trocar
