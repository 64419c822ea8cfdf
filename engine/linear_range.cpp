#include "engine/linear_range.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/number_text.h"
#include "base/threads.h"
#include "engine/element_gradient.h"
#include "engine/event_log.h"

namespace trocar {

namespace {

constexpr std::int64_t frames_between = 10;  // it takes as long as some steps
constexpr const char* beyond = "the linear material is used beyond small strains and rotations";

struct Strained {
  double norm = 0;            // of the displacement gradient
  std::int32_t element = -1;  // global number

  void take(double other, std::int32_t number) {
    if (other < norm || (other == norm && (element < 0 || number > element))) return;
    norm = other;
    element = number;
  }
};

Mat3 present_gradient(const Simulation& s, std::int32_t e) {
  return displacement_gradient(s.mesh, e, [&](std::int32_t i) -> Vec3 {
    return Vec3::Map(&s.state.u[3 * static_cast<std::size_t>(s.part.node_local[i])]);
  });
}

// The largest singular value, which that of all components bounds; 0 where it is not above `enough`
// in any case.
double norm_above(const Mat3& H, double enough) {
  if (!(H.squaredNorm() > enough * enough)) return 0;
  Eigen::SelfAdjointEigenSolver<Mat3> squares;
  squares.computeDirect(H.transpose() * H, Eigen::EigenvaluesOnly);
  return std::sqrt(squares.eigenvalues()[2]);
}

bool is_linear(const Simulation& s, std::int32_t e) {
  const auto region = static_cast<std::size_t>(s.mesh.element_region[e]);
  return s.materials[region].model == MaterialModel::linear;
}

Strained most_strained(const Simulation& s) {
  Strained most;
  std::mutex mutex;
  const auto n = static_cast<std::int64_t>(s.part.element_global.size());
  parallel_for(n, [&](std::int64_t begin, std::int64_t end) {
    Strained mine;
    for (std::int64_t k = begin; k < end; ++k) {
      const std::int32_t e = s.part.element_global[k];
      if (is_linear(s, e)) mine.take(norm_above(present_gradient(s, e), mine.norm), e);
    }
    const std::scoped_lock lock(mutex);
    if (mine.element >= 0) most.take(mine.norm, mine.element);
  });
  return most;
}

}  // namespace

void watch_linear_range(Simulation& s, double time) {
  const bool has_linear =
      std::any_of(s.materials.begin(), s.materials.end(),
                  [](const Material& m) { return m.model == MaterialModel::linear; });
  if (!has_linear || s.frame % frames_between != 0 || is_told(s, beyond)) return;
  const Strained mine = most_strained(s);
  const double norm = s.communicator->all_max(mine.norm);
  if (norm <= linear_range) return;
  const std::int32_t element = s.communicator->lowest(mine.norm == norm ? mine.element : -1);
  warn_event(s, time,
             std::string(beyond) + ": the displacement gradient of element " +
                 std::to_string(element) + " is " + short_text(norm) + ", and beyond " +
                 short_text(linear_range) +
                 " its forces are wrong by a tenth or more; tissue.material.model = "
                 "\"neo-hookean\" is for large ones");
}

}  // namespace trocar
