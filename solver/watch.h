// A look at a whole body: the stable step of the deformed elements, inversion, non-finite values,
// energies. A frame's look goes along with its forces (element_watch.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/partition.h"
#include "solver/model.h"

namespace trocar {

struct Watch {
  // Least over this rank's elements in the present deformation: the undeformed bound of
  // element_setup.h over the root of Material::stiffening. 0 where an element is not finite. [s]
  double stable_step = 0;
  std::int32_t stable_element = -1;  // global number of the element that sets it
  // Least det F (hex8: of the mean F); -infinity where it is not finite.
  double least_J = 0;
  std::int32_t least_J_element = -1;
  bool is_finite = true;       // all owned u and v, and below 1e9 (m, m/s)
  std::int32_t bad_node = -1;  // global number of the first that is not
};
// Of state.theta and state.u, see average_volume_change. Ties go to the lower global element
// number. Unless empty, `stiffening` (elements of the part) gets by how much the bound of each
// one's omega^2 has grown over that at rest, at least 1.
Watch watch(const Model& model, const Part& part, const State& state,
            std::span<double> stiffening = {});
// An element that has become stiffer.
struct GrownElement {
  std::int32_t element = -1;  // global number
  double stiffening = 1;      // as above
};
// Those of this rank whose stiffening is more than `growth` times that of `earlier` (elements of
// the part), in any order; some more than `most` where there are more. Of state.theta and state.u,
// too.
std::vector<GrownElement> find_grown(const Model& model, const Part& part, const State& state,
                                     std::span<const double> earlier, double growth,
                                     std::size_t most);
// Global number of the first owned node with a value that is not finite or too large, -1 if none.
std::int32_t first_bad_node(const Model& model, const Part& part, const State& state);

// Strain energies of single items, so that engine can add them exactly in any order. [J]
struct EnergyTerms {
  std::vector<double> strain;     // of elements whose lowest global node is owned here
  std::vector<double> hourglass;  // of the same elements, in the same order
  // Of owned nodes: strain energy of averaged volume changes (element_tet4_nodal_pressure.h), which
  // the elements leave out. Empty without such elements.
  std::vector<double> volumetric;
};
void energy_terms(const Model& model, const Part& part, const State& state, EnergyTerms& terms);

}  // namespace trocar
