// How thick a sheet in plane stress is.
#pragma once

#include "solver/model.h"

namespace trocar {

// Present thickness over that at rest of an element in plane stress (position in
// Part::element_global), by its law without relaxation; 1 of other elements.
double thickness_stretch(const Model& model, const State& state, std::int32_t element);

}  // namespace trocar
