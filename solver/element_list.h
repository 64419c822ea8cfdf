// Every element, in the order of Formulation. A new one is a header, its set-up and a line here and
// in element_setup.cpp.
#pragma once

#include "solver/element_hex8.h"
#include "solver/element_hex8_full.h"
#include "solver/element_one_point.h"
#include "solver/element_tet4.h"
#include "solver/element_tet4_nodal_pressure.h"
#include "solver/element_tri3.h"
#include "solver/element_tri3_plane_stress.h"
#include "solver/type_list.h"

namespace trocar {

using ElementList = TypeList<OnePoint<ElementTri3>, ElementTri3PlaneStress, OnePoint<ElementTet4>,
                             Tet4NodalPressure, OnePoint<ElementHex8>,
                             OnePoint<ElementHex8Enhanced>, ElementHex8Full>;
inline constexpr int n_formulations = ElementList::size;

}  // namespace trocar
