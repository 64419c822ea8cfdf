#include "engine/state_digest.h"

#include <algorithm>
#include <array>

#include "base/digest.h"

namespace trocar {

namespace {

// Numbers of items: nodes from 0 on, and the others each from a first one on.
constexpr std::uint64_t first_element = std::uint64_t{1} << 40, first_step = first_element << 1,
                        first_hold = first_element << 2, first_jaws = first_element << 3;

std::uint64_t digest_of_nodes(const Simulation& s) {
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
  return sum;
}

// Of which every rank has all: each takes its share of them.
std::uint64_t digest_of_elements(const Simulation& s) {
  std::uint64_t sum = 0;
  for (std::int32_t e = s.communicator->rank(); e < s.mesh.n_elements();
       e += s.communicator->size())
    sum += digest_item(first_element + static_cast<std::uint64_t>(e), s.mesh.corners(e));
  return sum;
}

// The same on every rank: nodes that are held, and jaws that are closed.
std::uint64_t digest_of_holds(const Holds& holds) {
  std::uint64_t sum = 0;
  for (const Hold& hold : holds.holds) {
    const std::array<double, 5> values = {static_cast<double>(hold.tool),
                                          static_cast<double>(hold.support), hold.offset[0],
                                          hold.offset[1], hold.offset[2]};
    sum += digest_item(first_hold + static_cast<std::uint64_t>(hold.node), values);
  }
  for (std::size_t k = 0; k < holds.is_open.size(); ++k)
    if (holds.is_open[k] == 0) sum += digest_item(first_jaws + k, std::array<double, 1>{});
  return sum;
}

// The same on every rank.
std::uint64_t digest_of_clock(const Simulation& s) {
  const auto step = static_cast<std::uint64_t>(s.state.step);
  const std::array<double, 2> clock = {s.state.time, s.state.last_dt};
  return digest_item(first_step + step, clock);
}

}  // namespace

std::uint64_t state_digest(const Simulation& s) {
  const std::uint64_t mine = digest_of_nodes(s) + digest_of_elements(s);
  return s.communicator->all_sum(mine) + digest_of_holds(s.holds) + digest_of_clock(s);
}

}  // namespace trocar
