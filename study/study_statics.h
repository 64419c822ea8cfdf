// A box relaxed into equilibrium between supports and moved nodes: what the static problems share.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "study/study_body.h"
#include "study/study_problem.h"

namespace trocar {

struct StaticBox {
  Vec3 size;  // the box is [0, size] [m]
  std::array<int, 3> n;
  Material material;
  std::function<FixedMask(const Vec3& X)> fixed;            // components that stay
  std::function<std::optional<Vec3>(const Vec3& X)> moved;  // displacement of nodes that are held
};

// `value` reads the result off the body; scratch.force is minus what holds each node.
Outcome relax_box(const Case& c, const StaticBox& box,
                  const std::function<double(const StudyBody&)>& value);

// Force of supports and holders on the nodes with z >= least_z. [N]
Vec3 reaction_above(const StudyBody& body, double least_z);

}  // namespace trocar
