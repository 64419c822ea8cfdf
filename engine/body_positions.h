// Where nodes are while blades cut: what is around a blade comes to all ranks, which cut alike, and
// the rest stays with the ranks that own it.
#pragma once

#include "cutting/cut_positions.h"
#include "engine/simulation.h"

namespace trocar {

// In s.cut_state, from the state that the simulation has when it is made. All members are
// collective.
class BodyPositions final : public PresentPositions {
 public:
  explicit BodyPositions(Simulation& s);

  std::span<const Vec3> x() const override { return s_.cut_state.x; }
  void find(std::span<const std::int32_t> nodes) override;
  std::vector<std::int32_t> nodes_near(const Box& box) override;
  // The elements whose nodes these are.
  std::vector<std::int32_t> elements_around(const Box& box);

 private:
  Simulation& s_;
  double way_ = 0;  // of s.boxes, see elements_near
};

}  // namespace trocar
