// One plane mesh cut in one way, measured: what `trocar cut2d` shows.
#pragma once

#include <string>
#include <vector>

#include "cutting/cut_plane.h"
#include "cutting/cut_plane_statistics.h"

namespace trocar {

// As published, as Trocar cuts by default, or by subdivision (the paper's "OR").
enum class Cut2dMode { paper, robust, subdivision };

constexpr double mm = 1e-3;           // [m]
using Cut2dPath = std::vector<Vec3>;  // (>= 2) [m]

struct Cut2dTrial {
  Mesh before, after;
  std::vector<Cut2dPath> paths;
  PlaneStatistics statistics_before, statistics_after;
  CutFigures figures;  // of all cuts; of subdivision the opened facets alone
  int n_new_nodes = 0, n_new_elements = 0;
  double altitude_ratio = 0;                    // least altitude after / before
  double step_ratio = 0;                        // least_step_bound after / before
  double best_seconds = 0, median_seconds = 0;  // of all cuts, over the repetitions
};

struct Cut2dOptions {
  Cut2dMode mode = Cut2dMode::robust;
  CutPlaneOptions plane;                       // of the other modes; set by options_of
  int repetitions = 1;                         // 0: as many as begin within 0.25 s
  double least_step_ratio = plane_step_ratio;  // floor of robust cuts under the step after / before
};
Cut2dOptions options_of(Cut2dMode mode, int repetitions,
                        double least_step_ratio = plane_step_ratio);

// Cuts along the paths one after another. Throws InputError for a mesh of other elements than
// triangles, and for subdivision along a path that is not straight.
Cut2dTrial run_trial(const Mesh& mesh, const std::vector<Cut2dPath>& paths,
                     const Cut2dOptions& options);

}  // namespace trocar
