// Where a segment comes nearest to a point, in the plane or in space.
#pragma once

#include <algorithm>

namespace trocar {

// Share s of the way `d` from `a` on whose line a + s d comes nearest to p; 0 of no way.
template <class Vec>
double share_on_line(const Vec& a, const Vec& d, const Vec& p) {
  const double length2 = d.squaredNorm();
  return length2 > 0 ? (p - a).dot(d) / length2 : 0;
}
// The same between a and a + d.
template <class Vec>
double share_to(const Vec& a, const Vec& d, const Vec& p) {
  return std::clamp(share_on_line(a, d, p), 0.0, 1.0);
}
template <class Vec>
Vec nearest_on_segment(const Vec& a, const Vec& b, const Vec& p) {
  const Vec d = b - a;
  return a + share_to(a, d, p) * d;
}

}  // namespace trocar
