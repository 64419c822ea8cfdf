// Where nodes are while blades cut: what is around a blade comes to the ranks that cut, and the
// rest stays with the ranks that own it.
#pragma once

#include "cutting/cut_positions.h"
#include "engine/cut_group.h"
#include "engine/simulation.h"
#include "mesh/element_boxes.h"

namespace trocar {

// Begins s.cut_state anew, from the present state, and fits s.boxes where they are outrun. Returns
// the way of nodes since that (elements_near). Collective.
double begin_positions(Simulation& s);

// In s.cut_state; way: of s.boxes. All members are called by all ranks of the group alike.
class BodyPositions final : public PresentPositions {
 public:
  BodyPositions(Simulation& s, const CutGroup& group, double way)
      : s_(s), group_(group), way_(way) {}

  std::span<const Vec3> x() const override { return s_.cut_state.x; }
  void find(std::span<const std::int32_t> nodes) override { group_.find(nodes); }
  std::vector<std::int32_t> nodes_near(const OrientedBox& box) override;
  // Those whose boxes overlap this one, and so the same whatever the ranks and the age of s.boxes.
  std::vector<std::int32_t> elements_near(const Box& box);

 private:
  template <class AnyBox, class Overlaps>
  std::vector<std::int32_t> find_elements(const AnyBox& box, const Overlaps& overlaps);

  Simulation& s_;
  const CutGroup& group_;
  double way_ = 0;
};

}  // namespace trocar
