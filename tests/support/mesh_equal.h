// All arrays of two meshes, bit for bit.
#pragma once

#include "base/error.h"
#include "mesh/mesh.h"

namespace trocar::test {

void expect_equal(const Mesh& a, const Mesh& b);

bool is_equal(const Mesh& a, const Mesh& b);

// The message of the InputError that f throws.
template <class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace trocar::test
