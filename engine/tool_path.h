// Where an instrument is at any time: positions by cubic interpolation of the key positions that
// goes forwards along each leg (Fritsch and Carlson 1980, no overshoot), rotations by that of their
// quaternions, normalised.
// Only + - * / sqrt: the path is part of the simulation's bits.
#pragma once

#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "engine/scene.h"

namespace trocar {

// The instrument's frame: origin at the tip, z from tip to handle, x where the cutting edge faces.
class ToolPath {
 public:
  explicit ToolPath(const std::vector<InstrumentKey>& keys);
  Pose at(double time) const;  // constant before the first key and after the last
  // Largest distance that a point of the box, in the instrument's frame, travels in [t0, t1], from
  // `samples` positions: that of a corner. [m]
  double travel(double t0, double t1, const Box& box) const;
  // The leg that is farthest from the straight line between its keys.
  struct Bulge {
    double width = 0;           // [m]
    double begin = 0, end = 0;  // [s]
  };
  Bulge largest_bulge() const;

 private:
  std::vector<double> time_;
  std::vector<Vec3> position_, slope_;
  std::vector<Quat> rotation_;  // neighbours on the same side of the sphere
  std::vector<Eigen::Vector4d> turn_slope_;
};

// Positions of [[support]] paths by the same rule.
class DisplacementPath {
 public:
  explicit DisplacementPath(const std::vector<SupportKey>& keys);
  Vec3 at(double time) const;                 // zero without keys
  double travel(double t0, double t1) const;  // as of a tool's point

 private:
  std::vector<double> time_;
  std::vector<Vec3> position_, slope_;
};

// The frame's rotation for a pointing direction and the direction that the edge faces.
Quat tool_rotation(const Vec3& direction, const Vec3& forward);

}  // namespace trocar
