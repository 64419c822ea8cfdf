// The highest frequency of a body in its present deformation, whatever its elements and materials:
// the largest eigenvalue of M^-1 K from differences of the forces, by the iteration of Lanczos
// (1950). It comes from below; the bounds of single elements (element_setup.h) come from above and
// lie 1.4 to 3.3 times higher, more with slivers.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/communicator.h"
#include "mesh/partition.h"
#include "solver/model.h"

namespace trocar {

// Largest displacement of the differences of a search: small beside an element, large beside the
// rounding of the elements' numbers. [m]
double search_amplitude(const Model& model, double edge);

struct FrequencyOptions {
  double amplitude = 1e-9;  // see search_amplitude [m]
  double tolerance = 0.01;  // residual that ends the search
  int most_iterations = 100;
  // A search that is clearly below this ends: nobody needs to know by how much. [1/s]
  double of_interest = 0;
  std::span<const double> force = {};  // of the state, if known [N]
};

struct HighestFrequency {
  double omega = 0;      // root of the Rayleigh quotient w2 of the mode x found [1/s]
  double residual = 0;   // |M^-1 K x - w2 x| / w2: an eigenvalue lies within w2 (1 +- residual)
  int n_iterations = 0;  // forces computed, less those at rest
  bool is_converged = false;
};

// A search that has converged to the default tolerance was below the largest eigenvalue's root by
// less than this (tests/solver/frequency_test.cpp prints by how much).
inline constexpr double frequency_margin = 1.02;

// Fills `force` (n_owned * 3) with the forces of displacements u (n_local * 3), owned ones set.
// Collective.
using ForceOfDisplacement = std::function<void(std::vector<double>& u, std::vector<double>& force)>;

// Starts from node numbers alone. The result does not depend on ranks and threads. Collective.
HighestFrequency find_highest_frequency(const Model& model, const Part& part, const State& state,
                                        const ForceOfDisplacement& forces,
                                        const FrequencyOptions& options,
                                        const Communicator& communicator);

}  // namespace trocar
