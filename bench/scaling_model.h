// What a step costs on ranks that this machine doesn't have: elements at their measured time, and a
// message's time as latency + bytes / bandwidth (Hockney 1994). Cubes of elements on cubes of
// ranks; nothing of the exchange is hidden behind elements, so the truth is better.
#pragma once

#include <algorithm>
#include <cmath>

namespace trocar {

struct ScalingParameters {
  double latency = 0;    // of a message, with packing and waiting [s]
  double bandwidth = 0;  // [bytes/s]
  // Of an element in a part that a core's own cache holds, and in one that it does not. [s]
  double small_element_step = 0, large_element_step = 0;
  double step_overhead = 0;  // of a rank's step, whatever its size [s]
  double collectives = 0;    // of a frame
  double looks = 0;          // force evaluations of a frame for its stable step
  double step_per_edge = 0;  // stable step over the edge of an element [s/m]
  double side = .1;          // of the body [m]
  double bytes_per_node = 24;
};

struct ScalingPoint {
  double elements = 0;
  int ranks = 1;
};

// Edge of a rank's cube, in elements.
inline double part_edge(const ScalingPoint& p) {
  return std::cbrt(p.elements / p.ranks);
}

// A rank computes all elements at its nodes: half a layer more on each side that has a neighbour.
inline double elements_of_rank(const ScalingPoint& p) {
  if (p.ranks == 1) return p.elements;
  const double n = part_edge(p), extra = p.ranks < 8 ? .5 : 1;
  return std::pow(n + extra, 3);
}

// Cubes touch at faces, edges and corners; up to 8 ranks all touch each other.
inline double neighbours_of_rank(const ScalingPoint& p) {
  return std::min(26, p.ranks - 1);
}

inline double bytes_of_rank(const ScalingPoint& p, const ScalingParameters& m) {
  if (p.ranks == 1) return 0;
  const double n = part_edge(p), extra = p.ranks < 8 ? 1 : 2;
  return m.bytes_per_node * (std::pow(n + extra, 3) - std::pow(n, 3));
}

// Elements of the parts of which both are measured.
constexpr int small_part_edge = 20, large_part_edge = 40;

// In between by the logarithm of the size.
inline double element_step(double elements, const ScalingParameters& m) {
  const double small = std::pow(small_part_edge, 3), large = std::pow(large_part_edge, 3);
  const double share = std::clamp(std::log(elements / small) / std::log(large / small), 0., 1.);
  return m.small_element_step + share * (m.large_element_step - m.small_element_step);
}

inline double step_seconds(const ScalingPoint& p, const ScalingParameters& m) {
  const double elements = elements_of_rank(p);
  return m.step_overhead + element_step(elements, m) * elements +
         m.latency * neighbours_of_rank(p) + bytes_of_rank(p, m) / m.bandwidth;
}

inline double steps_of_frame(const ScalingPoint& p, const ScalingParameters& m, double rate) {
  const double dt = m.step_per_edge * m.side / std::cbrt(p.elements);
  return std::ceil(1 / (rate * dt));
}

// A reduction goes up and down a binary tree.
inline double frame_seconds(const ScalingPoint& p, const ScalingParameters& m, double rate) {
  return (steps_of_frame(p, m, rate) + m.looks) * step_seconds(p, m) +
         m.collectives * 2 * std::ceil(std::log2(p.ranks)) * m.latency;
}

inline double real_time_factor(const ScalingPoint& p, const ScalingParameters& m, double rate) {
  return 1 / (rate * frame_seconds(p, m, rate));
}

// The most elements that run in real time, by bisection; 0 if not even one does.
inline double most_elements(int ranks, const ScalingParameters& m, double rate) {
  double low = 1, high = 1e12;
  if (real_time_factor({low, ranks}, m, rate) < 1) return 0;
  while (high / low > 1.001) {
    const double middle = std::sqrt(low * high);
    (real_time_factor({middle, ranks}, m, rate) >= 1 ? low : high) = middle;
  }
  return low;
}

}  // namespace trocar
