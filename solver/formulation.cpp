#include "solver/formulation.h"

#include <iterator>

#include "solver/element_list.h"

namespace trocar {

const char* name_of(Formulation formulation) {
  constexpr const char* name[] = {
      "tri3-plane-strain", "tri3-plane-stress", "tet4-linear", "tet4-nodal-pressure",
      "hex8-one-point",    "hex8-enhanced",     "hex8-full"};
  static_assert(std::size(name) == n_formulations);
  return name[static_cast<int>(formulation)];
}

const char* name_of(Precision precision) {
  return precision == Precision::in_double ? "double" : "single";
}

}  // namespace trocar
