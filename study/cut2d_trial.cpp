#include "study/cut2d_trial.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "base/error.h"
#include "base/quantile.h"
#include "base/timers.h"
#include "cutting/cut_plane_reaches.h"
#include "cutting/cut_plane_slit.h"
#include "cutting/cut_plane_subdivide.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

constexpr double least_seconds = 0.25;  // of repetitions whose number is left open

// What of a reach does not run in slits that are there.
PathFromSlit outside_slits(const Mesh& mesh, const Cut2dPath& reach, std::int32_t tip, double h) {
  PathFromSlit path = past_slit(mesh, reach, tip, h);
  path.point = before_slit(mesh, path, h);
  return path;
}

// Time from mesh and path to the edited mesh.
double displace(const Cut2dOptions& options, Cut2dTrial& trial) {
  double seconds = 0;
  trial.figures = {};
  trial.after = trial.before;
  CutPlaneOptions plane = options.plane;
  if (options.mode == Cut2dMode::robust)
    plane.least_step = options.least_step_ratio * least_step_bound(trial.before);
  const double h = mean_edge_length(trial.before);
  for (const Cut2dPath& path : trial.paths) {
    std::int32_t tip = -1;   // where the last reach ended
    std::vector<Vec3> rest;  // of it
    for (Cut2dPath reach : reaches(path)) {
      if (!rest.empty()) reach.front() = rest.front();
      const std::vector<std::uint8_t> is_held(trial.after.X.size(), 0);
      const double start = monotonic_seconds();
      PathFromSlit from{reach, tip};
      if (options.mode == Cut2dMode::robust && trial.figures.n_opened_facets > 0)
        from = outside_slits(trial.after, reach, tip, h);
      if (from.point.size() < 2) continue;
      const PlaneCut cut = cut_plane(trial.after, from.point, from.tip, {is_held}, plane);
      apply_edit(cut.edit, trial.after);
      seconds += monotonic_seconds() - start;
      tip = cut.tip;
      rest = cut.rest;
      add(cut.figures, true, trial.figures);
    }
  }
  return seconds;
}

double subdivide(Cut2dTrial& trial) {
  double seconds = 0;
  trial.after = trial.before;
  for (const Cut2dPath& path : trial.paths) {
    if (path.size() != 2)
      throw InputError("the subdivision cuts along straight lines: give --path two points");
    const double start = monotonic_seconds();
    trial.after = subdivide_along(trial.after, path.front(), path.back());
    seconds += monotonic_seconds() - start;
  }
  int n_lips = 0;
  for (const std::uint8_t mask : trial.after.cut_facets) n_lips += std::popcount(mask);
  trial.figures.n_opened_facets = n_lips / 2;
  return seconds;
}

// A quarter of a second holds hundreds of cuts, the fastest of which a noisy machine has left in
// peace.
bool is_more_to_do(int repetitions, std::size_t n_done, double start) {
  return repetitions > 0 ? n_done < static_cast<std::size_t>(repetitions)
                         : monotonic_seconds() - start < least_seconds;
}

double smallest_altitude(const Mesh& mesh) {
  double least = std::numeric_limits<double>::max();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    least = std::min(least, least_altitude(mesh, e, mesh.X));
  return least;
}

}  // namespace

Cut2dOptions options_of(Cut2dMode mode, int repetitions, double least_step_ratio) {
  return {mode, mode == Cut2dMode::paper ? published_options() : CutPlaneOptions{}, repetitions,
          least_step_ratio};
}

Cut2dTrial run_trial(const Mesh& mesh, const std::vector<Cut2dPath>& paths,
                     const Cut2dOptions& options) {
  Cut2dTrial trial;
  trial.before = mesh;
  trial.paths = paths;
  std::vector<double> seconds;
  const double start = monotonic_seconds();
  do {
    seconds.push_back(options.mode == Cut2dMode::subdivision ? subdivide(trial)
                                                             : displace(options, trial));
  } while (is_more_to_do(options.repetitions, seconds.size(), start));
  trial.best_seconds = quantile(seconds, 0);
  trial.median_seconds = quantile(seconds, 0.5);
  trial.statistics_before = plane_statistics(mesh);
  trial.statistics_after = plane_statistics(trial.after);
  trial.n_new_nodes = trial.after.n_nodes() - mesh.n_nodes();
  trial.n_new_elements = trial.after.n_elements() - mesh.n_elements();
  trial.altitude_ratio = smallest_altitude(trial.after) / smallest_altitude(mesh);
  trial.step_ratio = least_step_bound(trial.after) / least_step_bound(mesh);
  return trial;
}

}  // namespace trocar
