// The history of viscoelastic elements: its steps in time, and how it survives a new model after a
// cut.
#pragma once

#include <vector>

#include "mesh/partition.h"
#include "solver/model.h"
#include "solver/viscous_step.h"

namespace trocar {

// The factors of a step of length dt >= 0, without libm.
ViscousStep viscous_step(const std::vector<PronyBranch>& prony, double dt);

// Numbers of history of an element of the list, 0 for one without viscosity.
int history_width(const ElementBlocks& blocks);
// Length of State::history, and where each list begins (ElementBlocks::first_history).
std::int64_t place_history(std::vector<ElementBlocks>& lists);

// The history of this rank's elements, one after the other: global number, count, numbers.
std::vector<double> copy_history(const Model& model, const Part& part, const State& state);
// What copies of all ranks, one behind the other, say of the part's elements. Element e gets the
// numbers of the one that it was or was a part of, parent[e], multiplied by scale[e]: its volume
// over the parent's, since stresses are stored times the volume of the whole element. One of a
// single point whose parent had several gets their mean.
void restore_history(const Model& model, const Part& part, std::span<const double> copies,
                     std::span<const std::int32_t> parent, std::span<const double> scale,
                     State& state);

}  // namespace trocar
