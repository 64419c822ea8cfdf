// What the parameters of the paper's combined mass-spring and particle system do, which Serby,
// Harders and Szekely (2001) left to future work: random cuts for each value.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cutting/cut_plane.h"

namespace trocar {

// Random straight cuts with both ends inside, on the paper's meshes 1 to 4 together.
struct Cut2dSample {
  int n_cuts = 0, n_refused = 0;
  // Bound of the stable time step, least 2 A / sqrt(sum l^2), after the cut / before: worst, 5 %
  // and median of all cuts.
  double worst = 0, low = 0, median = 0;
  double area_sigma = 0;  // mean over the cuts of sigma of A / A before
  double seconds = 0;     // median processor time of a cut
};
Cut2dSample sample_cuts(const CutPlaneOptions& options, int n_cuts_a_mesh);

// The ways to cut that are compared: springs and particles alone, with the area step (as
// published), and the robust mode.
inline constexpr int n_cut2d_settings = 3;
extern const char* const cut2d_setting_names[n_cut2d_settings];
CutPlaneOptions cut2d_setting(int setting);

struct Cut2dValue {
  std::string label;
  std::function<void(CutPlaneOptions&)> set;
  std::vector<Cut2dSample> samples;  // (n_cut2d_settings)
};
struct Cut2dParameter {
  std::string name, meaning;
  std::vector<Cut2dValue> values;
};
// The parameters with their values, not yet sampled.
std::vector<Cut2dParameter> cut2d_parameters();
void sample_parameter(Cut2dParameter& parameter, int n_cuts_a_mesh);

}  // namespace trocar
