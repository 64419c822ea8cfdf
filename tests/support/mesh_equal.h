// All arrays of two meshes, bit for bit.
#pragma once

#include "mesh/mesh.h"

namespace trocar::test {

void expect_equal(const Mesh& a, const Mesh& b);

}  // namespace trocar::test
