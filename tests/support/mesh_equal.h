// All arrays of two meshes, number by number.
#pragma once

#include "mesh/mesh.h"

namespace trocar::test {

// Says which ones differ.
void expect_equal(const Mesh& a, const Mesh& b);

}  // namespace trocar::test
