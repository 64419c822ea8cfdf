#include "engine/tool_path.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar {

namespace {

constexpr int samples = 4;  // of a travel

// The weighted harmonic mean of both legs' velocities (Fritsch and Butland 1984) with the inverse
// v / |v|^2 of a vector v, times the cosine of the turn: along both legs it is positive and at most
// three times their velocity, so that the cubic goes forwards, whatever the axes.
template <class Vector>
Vector slope_between(const Vector& v0, const Vector& v1, double w0, double w1) {
  const double square0 = v0.dot(v0), square1 = v1.dot(v1), product = v0.dot(v1);
  if (!(product > 0)) return Vector::Zero();
  const Vector inverse = w0 / square0 * v0 + w1 / square1 * v1;
  const double cosine = product / std::sqrt(square0 * square1);
  return cosine * (w0 + w1) / inverse.dot(inverse) * inverse;
}

// Zero at both ends, at keys that stop, and where the way turns by 90 degrees or more.
// way(from, to): between neighbouring keys.
template <class Key, class Way>
auto smooth_slopes(const std::vector<Key>& keys, const Way& way) {
  using Vector = decltype(way(0, 0));
  std::vector<Vector> slope(keys.size(), Vector::Zero());
  for (std::size_t k = 1; k + 1 < keys.size(); ++k) {
    if (keys[k].stops) continue;
    const double h0 = keys[k].time - keys[k - 1].time, h1 = keys[k + 1].time - keys[k].time;
    slope[k] =
        slope_between<Vector>(-way(k, k - 1) / h0, way(k, k + 1) / h1, 2 * h1 + h0, h1 + 2 * h0);
  }
  return slope;
}

template <class Key>
std::vector<Vec3> slopes_of_positions(const std::vector<Key>& keys,
                                      const std::vector<Vec3>& position) {
  return smooth_slopes(keys, [&](std::size_t from, std::size_t to) -> Vec3 {
    return position[to] - position[from];
  });
}

// The arc between two unit quaternions as a vector along the sphere at `from`: of length
// 3 sin / (2 + cos) of its angle, which is Snellius' for the angle itself (0.2 % off for 90 degrees
// of the instrument). With chords the rate through equal turns of those would vary by 25 %.
Eigen::Vector4d arc_from(const Quat& from, const Quat& to) {
  const Eigen::Vector4d chord = to.coeffs() - from.coeffs();
  const double cosine_less_1 = chord.dot(from.coeffs());
  return 3 / (3 + cosine_less_1) * (chord - cosine_less_1 * from.coeffs());
}

// Key interval of `t` and the place in it, both clamped to the path.
std::pair<std::size_t, double> find_interval(const std::vector<double>& time, double t) {
  if (t <= time.front() || time.size() == 1) return {0, 0.0};
  if (t >= time.back()) return {time.size() - 2, 1.0};
  const auto above = std::upper_bound(time.begin(), time.end(), t);
  const auto k = static_cast<std::size_t>(above - time.begin()) - 1;
  return {k, (t - time[k]) / (time[k + 1] - time[k])};
}

Vec3 interpolate(const std::vector<double>& time, const std::vector<Vec3>& value,
                 const std::vector<Vec3>& slope, double t) {
  const auto [k, s] = find_interval(time, t);
  if (time.size() == 1) return value[0];
  if (value[k] == value[k + 1]) return value[k];  // at rest, without rounding
  const double h = time[k + 1] - time[k];
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * value[k] + (s3 - 2 * s2 + s) * h * slope[k] +
         (3 * s2 - 2 * s3) * value[k + 1] + (s3 - s2) * h * slope[k + 1];
}

}  // namespace

Quat tool_rotation(const Vec3& direction, const Vec3& forward) {
  Mat3 axes;
  const Vec3 z = -direction / std::sqrt(direction.dot(direction));
  Vec3 x = forward - z * z.dot(forward);
  x /= std::sqrt(x.dot(x));
  axes.col(0) = x;
  axes.col(1) = z.cross(x);
  axes.col(2) = z;
  return Quat(axes);
}

ToolPath::ToolPath(const std::vector<InstrumentKey>& keys) {
  for (const InstrumentKey& key : keys) {
    time_.push_back(key.time);
    position_.push_back(key.position);
    Quat rotation = tool_rotation(key.direction, key.forward);
    if (!rotation_.empty() && rotation_.back().dot(rotation) < 0) rotation.coeffs() *= -1.0;
    rotation_.push_back(rotation);
  }
  slope_ = slopes_of_positions(keys, position_);
  turn_slope_ = smooth_slopes(keys, [&](std::size_t from, std::size_t to) {
    return arc_from(rotation_[from], rotation_[to]);
  });
}

Pose ToolPath::at(double time) const {
  const auto [k, s] = find_interval(time_, time);
  Pose pose;
  pose.translation = interpolate(time_, position_, slope_, time);
  if (time_.size() == 1) {
    pose.rotation = rotation_[0];
    return pose;
  }
  const double h = time_[k + 1] - time_[k], smooth = s * s * (3 - 2 * s);
  Eigen::Vector4d q = (1 - smooth) * rotation_[k].coeffs() + smooth * rotation_[k + 1].coeffs();
  q += s * (1 - s) * h * ((1 - s) * turn_slope_[k] - s * turn_slope_[k + 1]);
  q /= std::sqrt(q.dot(q));
  pose.rotation.coeffs() = q;
  return pose;
}

double ToolPath::travel(double t0, double t1, const Box& box) const {
  std::array<Pose, samples + 1> poses;
  for (int k = 0; k <= samples; ++k) poses[k] = at(t0 + (t1 - t0) * k / samples);
  double most = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 point;
    for (unsigned j = 0; j < 3; ++j) point[j] = (corner >> j & 1U) != 0 ? box.high[j] : box.low[j];
    double way = 0;
    for (int k = 1; k <= samples; ++k)
      way += (poses[k].apply(point) - poses[k - 1].apply(point)).norm();
    most = std::max(most, way);
  }
  return most;
}

ToolPath::Bulge ToolPath::largest_bulge() const {
  constexpr int n_places = 32;  // of a leg
  Bulge bulge;
  for (std::size_t k = 0; k + 1 < time_.size(); ++k) {
    const Vec3 leg = position_[k + 1] - position_[k];
    const double length = std::sqrt(leg.dot(leg));
    for (int i = 1; i < n_places && length > 0; ++i) {
      const double t = time_[k] + (time_[k + 1] - time_[k]) * i / n_places;
      const double width = (at(t).translation - position_[k]).cross(leg).norm() / length;
      if (width > bulge.width) bulge = {width, time_[k], time_[k + 1]};
    }
  }
  return bulge;
}

DisplacementPath::DisplacementPath(const std::vector<SupportKey>& keys) {
  for (const SupportKey& key : keys) {
    time_.push_back(key.time);
    position_.push_back(key.displacement);
  }
  slope_ = slopes_of_positions(keys, position_);
}

Vec3 DisplacementPath::at(double time) const {
  return time_.empty() ? Vec3::Zero() : interpolate(time_, position_, slope_, time);
}

double DisplacementPath::travel(double t0, double t1) const {
  double way = 0;
  for (int k = 1; k <= samples; ++k)
    way += (at(t0 + (t1 - t0) * k / samples) - at(t0 + (t1 - t0) * (k - 1) / samples)).norm();
  return way;
}

}  // namespace trocar
