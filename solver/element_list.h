// Every element, in the order of ElementType. A new one is a header, its set-up and a line here.
#pragma once

#include "solver/element_hex8.h"
#include "solver/element_tet4.h"
#include "solver/element_tri3.h"
#include "solver/type_list.h"

namespace trocar {

using ElementList = TypeList<ElementTri3, ElementTet4, ElementHex8>;

}  // namespace trocar
