// Two bodies as one mesh.
#pragma once

#include "mesh/mesh.h"

namespace trocar {

// Elements and nodes of `other` follow those of `mesh`, whose node sets stay.
Mesh joined(Mesh mesh, const Mesh& other);

}  // namespace trocar
