// Scalar products of long vectors that are spread over ranks.
#pragma once

#include <cstdint>
#include <span>

#include "base/communicator.h"

namespace trocar {

// The largest size of a component; NaN if one is not finite.
double largest_size(std::span<const double> x);

// a·b over all ranks with the same bits however the components are spread, and 10 times as fast as
// an ExactSum of them: products are rounded to multiples of a quantum so coarse that their sums are
// exact, then what that left is once more (Demmel & Nguyen 2013, "Fast reproducible floating-point
// summation"). n: components on all ranks, at most 2^30. `most`: no product of any rank is
// larger, the same however they are spread. Error: products' own rounding and at most 12 n^3 2^-104
// of it, 1e-12 for a million; NaN if it is not finite. Collective.
double reproducible_dot(std::span<const double> a, std::span<const double> b, std::int64_t n,
                        double most, const Communicator& communicator);

}  // namespace trocar
