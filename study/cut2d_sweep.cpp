#include "study/cut2d_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/quantile.h"
#include "base/timers.h"
#include "cutting/cut_plane_paper.h"
#include "mesh/edit.h"
#include "mesh/quality.h"
#include "study/cut2d_trial.h"

namespace trocar {

namespace {

constexpr double boundary_margin = 10 * mm,
                 shortest = 12 * mm;  // room between ends and the boundary

// Uniform in [a, b), with the same bits from every library.
class Random {
 public:
  double operator()(double a, double b) {
    return a + (b - a) * (static_cast<double>(generator_()) / 4294967296.0);
  }

 private:
  std::mt19937 generator_{20010101};
};

std::vector<Vec3> random_path(Random& random, double top) {
  std::vector<Vec3> path;
  do {
    path.clear();
    for (int k = 0; k < 2; ++k) {
      const double x = random(boundary_margin, 60 * mm),
                   y = random(boundary_margin, top - boundary_margin);
      path.emplace_back(x, y, 0);
    }
  } while ((path[1] - path[0]).norm() < shortest);
  return path;
}

double area_sigma(const Mesh& before, const Mesh& after) {
  double squares = 0;
  for (std::int32_t e = 0; e < before.n_elements(); ++e) {
    const double ratio = element_volume(after, e, after.X) / element_volume(before, e, before.X);
    squares += (ratio - 1) * (ratio - 1);
  }
  return std::sqrt(squares / before.n_elements());
}

struct Collected {
  std::vector<double> ratio, seconds;
  double sigma = 0;
  int n_refused = 0;
};

void cut_once(const Mesh& mesh, const std::vector<Vec3>& path, const CutPlaneOptions& options,
              Collected& all) {
  const std::vector<std::uint8_t> is_held(mesh.X.size(), 0);
  const double start = thread_seconds();  // a sweep shares the machine
  const PlaneCut cut = cut_plane(mesh, path, -1, {is_held}, options);
  const double seconds = thread_seconds() - start;
  if (cut.edit.is_empty()) {
    ++all.n_refused;
    return;
  }
  Mesh after = mesh;
  apply_edit(cut.edit, after);
  all.seconds.push_back(seconds);
  all.ratio.push_back(least_step_bound(after) / least_step_bound(mesh));
  all.sigma += area_sigma(mesh, after);
}

}  // namespace

const char* const cut2d_setting_names[n_cut2d_settings] = {"springs and particles alone",
                                                           "as published", "robust"};

CutPlaneOptions cut2d_setting(int setting) {
  CutPlaneOptions options = setting == 2 ? CutPlaneOptions{} : published_options();
  if (setting == 0) options.area_sweeps = 0;
  return options;
}

Cut2dSample sample_cuts(const CutPlaneOptions& options, int n_cuts_a_mesh) {
  Collected all;
  for (int c = 1; c <= 4; ++c) {
    const Mesh mesh = paper_mesh(c);
    double top = 0;
    for (const Vec3& X : mesh.X) top = std::max(top, X.y());
    Random random;
    for (int k = 0; k < n_cuts_a_mesh; ++k) cut_once(mesh, random_path(random, top), options, all);
  }
  const auto n_valid = static_cast<double>(all.ratio.size());
  return {.n_cuts = 4 * n_cuts_a_mesh,
          .n_refused = all.n_refused,
          .worst = quantile(all.ratio, 0),
          .low = quantile(all.ratio, 0.05),
          .median = quantile(all.ratio, 0.5),
          .area_sigma = n_valid > 0 ? all.sigma / n_valid : 0,
          .seconds = quantile(all.seconds, 0.5)};
}

namespace {

template <typename Number>
Cut2dParameter numbers(const char* name, const char* meaning, Number CutPlaneOptions::*member,
                       const std::vector<std::pair<const char*, Number>>& values) {
  Cut2dParameter parameter{name, meaning, {}};
  for (const auto& [label, value] : values)
    parameter.values.push_back({label, [=](CutPlaneOptions& o) { o.*member = value; }, {}});
  return parameter;
}

Cut2dParameter exponents() {
  Cut2dParameter parameter{"exponents", "n and m of the Lennard-Jones potential, eq. 5", {}};
  constexpr std::array<std::array<int, 2>, 6> pairs = {
      {{4, 2}, {8, 4}, {12, 6}, {12, 10}, {18, 9}, {24, 12}}};
  for (const auto& [n, m] : pairs)
    parameter.values.push_back({std::to_string(n) + ", " + std::to_string(m),
                                [n = n, m = m](CutPlaneOptions& o) {
                                  o.repulsion = n;
                                  o.attraction = m;
                                },
                                {}});
  return parameter;
}

}  // namespace

std::vector<Cut2dParameter> cut2d_parameters() {
  using O = CutPlaneOptions;
  return {
      numbers<double>("spring", "s_spring of eq. 6, the particles' factor staying the same",
                      &O::spring,
                      {{"0", 0}, {"0.25", 0.25}, {"0.5", 0.5}, {"1", 1}, {"1.5", 1.5}, {"2", 2}}),
      numbers<double>("particle", "s_particle of eq. 6, the springs' factor being 1", &O::particle,
                      {{"0", 0},
                       {"0.03", 0.03},
                       {"0.1", 0.1},
                       {"0.2", 0.2},
                       {"0.3", 0.3},
                       {"0.6", 0.6},
                       {"1", 1}}),
      exponents(),
      numbers<int>("rings", "vicinity of the cut whose nodes move, in rings of edges", &O::rings,
                   {{"1", 1}, {"2", 2}, {"3", 3}, {"4", 4}, {"6", 6}}),
      numbers<double>(
          "threshold", "displacement that ends the homogenisation, in mean edges", &O::threshold,
          {{"1e-1", 1e-1}, {"1e-2", 1e-2}, {"1e-3", 1e-3}, {"1e-4", 1e-4}, {"1e-5", 1e-5}}),
      numbers<int>("steps", "largest number of steps of the homogenisation", &O::most_steps,
                   {{"0", 0}, {"2", 2}, {"4", 4}, {"8", 8}, {"20", 20}, {"60", 60}, {"150", 150}}),
      numbers<int>("area sweeps", "sweeps of the area step over all nodes", &O::area_sweeps,
                   {{"0", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"10", 10}})};
}

void sample_parameter(Cut2dParameter& parameter, int n_cuts_a_mesh) {
  for (Cut2dValue& value : parameter.values) {
    value.samples.clear();
    for (int s = 0; s < n_cut2d_settings; ++s) {
      CutPlaneOptions options = cut2d_setting(s);
      value.set(options);
      value.samples.push_back(sample_cuts(options, n_cuts_a_mesh));
    }
  }
}

}  // namespace trocar
