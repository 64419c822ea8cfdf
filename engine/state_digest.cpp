#include "engine/state_digest.h"

#include <array>

#include "base/digest.h"

namespace trocar {

std::uint64_t state_digest(const Simulation& s) {
  std::uint64_t sum = 0;
  for (std::int32_t i = 0; i < s.part.n_owned; ++i) {
    const auto k = static_cast<std::size_t>(i) * 3;
    const auto global = static_cast<std::uint64_t>(s.part.node_global[i]);
    const Vec3& X = s.mesh.X[global];
    const std::array<double, 9> values = {X[0],
                                          X[1],
                                          X[2],
                                          s.state.u[k],
                                          s.state.u[k + 1],
                                          s.state.u[k + 2],
                                          s.state.v[k],
                                          s.state.v[k + 1],
                                          s.state.v[k + 2]};
    sum += digest_item(global, values);
  }
  // Every rank has all elements.
  for (std::int32_t e = s.communicator->rank(); e < s.mesh.n_elements();
       e += s.communicator->size())
    sum += digest_item((std::uint64_t{1} << 40) + static_cast<std::uint64_t>(e), s.mesh.corners(e));
  sum = s.communicator->all_sum(sum);
  const std::array<double, 2> clock = {s.state.time, s.state.last_dt};
  sum += digest_item((std::uint64_t{1} << 41) + static_cast<std::uint64_t>(s.state.step), clock);
  return sum;
}

}  // namespace trocar
