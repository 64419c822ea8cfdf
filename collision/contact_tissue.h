// The constraints between tissue and tissue in one step, and the impulses from which the next
// step's solution begins: they are nearly right where tissue rests on tissue.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/contact_set.h"

namespace trocar {

struct TissueStep {
  std::int64_t number = 0;  // within the frame
  double dt = 0;            // [s]
};

// Each node is kept out of the nearest triangle of its pairs. release as of add_constraint [m].
void add_tissue(const TissueStep& step, double release, ContactSet& set);

// (set.node.size()) In other tissue, by the pairs that steps have found; x (n_nodes) positions at
// this moment. [m]
std::vector<double> depths_in_tissue(const ContactSet& set, std::span<const Vec3> x);

void begin_tissue(std::int64_t step, double friction, ContactSet& set);
void end_tissue(std::int64_t step, ContactSet& set);

}  // namespace trocar
