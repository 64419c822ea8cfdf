// The history of viscoelastic elements: its steps in time, and how it survives a new model after a
// cut.
#pragma once

#include <span>
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

// The history of this rank's elements, or of those of `elements` (ascending) that it has, one after
// the other: global number, how many numbers its points and its hourglass forces have, numbers.
std::vector<double> copy_history(const Model& model, const Part& part, const State& state);
std::vector<double> copy_history(const Model& model, const Part& part, const State& state,
                                 std::span<const std::int32_t> elements);

// What elements were before an edit.
struct ElementOrigins {
  std::vector<std::int32_t> element;  // global numbers, ascending
  std::vector<std::int32_t> parent;   // of each, what it was or was a part of
  std::vector<double> scale;          // of each, its volume over the parent's
};
// Of n elements that no edit has changed.
ElementOrigins unedited_elements(std::int32_t n);
// These elements, where the part has them, get the history of their parents from copies of all
// ranks, one behind the other, multiplied by the scale, since stresses are stored times the volume
// of the whole element. One of a single point whose parent had several gets their mean; of a
// one-point hexahedron's hourglass forces only one-point hexahedra get something. Their
// displacements grow with the volume, too, where the element is stretched along an edge.
void restore_history(const Model& model, const Part& part, std::span<const double> copies,
                     const ElementOrigins& origins, State& state);

}  // namespace trocar
