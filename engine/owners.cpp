#include "engine/owners.h"

#include <cmath>
#include <string>

#include "base/log.h"
#include "mesh/partition.h"

namespace trocar {

namespace {

// Hexahedra that became tetrahedra take longer: where imbalance has grown by more than this since
// owners were chosen, they are chosen anew. Choosing takes as long as 30 to 70 steps. It pays after
// 300 to 640 steps at an imbalance of 1.16, at 1.05 after 740 and more, or never (docs/scaling.md).
constexpr double tolerated_growth = 0.1;

double imbalance_now(const Simulation& s) {
  return imbalance(s.mesh, s.node_owner, s.communicator->size());
}

}  // namespace

void choose_owners(Simulation& s) {
  s.node_owner = partition_nodes(s.mesh, *s.communicator);
  s.chosen_imbalance = 0;
}

void note_imbalance(Simulation& s) {
  if (s.communicator->size() > 1 && s.chosen_imbalance == 0) s.chosen_imbalance = imbalance_now(s);
}

bool rebalance(Simulation& s) {
  if (s.communicator->size() == 1) return false;
  const double now = imbalance_now(s);
  if (now <= s.chosen_imbalance + tolerated_growth) return false;
  choose_owners(s);
  log_info("after a cut the busiest rank has " + std::to_string(std::lround(100 * (now - 1))) +
           " % more work than the mean: parts are chosen anew");
  return true;
}

}  // namespace trocar
