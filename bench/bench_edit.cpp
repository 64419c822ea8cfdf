// What an edit of a running scene costs: the same incision as in bench_cut scaling, 6 cells long
// and 3 deep, in ever larger boxes of elements at rest, through the whole of cut_along_blades
// (bench_cut times the cut alone). Markdown to stdout.
// bench_edit [--thin] [--energy] [--hexahedra] [--viscous] [--sleep] [--scaled] [--local-steps]
// [--once] [--threads] [N]...: boxes of N cells a side (default 15, 30); --thin: strips N cells
// long, 6 wide and one thick, which a blade shaves (nodes are put on edges); --energy: with the
// ledger that a metrics output keeps; --hexahedra: of hexahedra, which the blade splits; --viscous:
// of a material with history; --sleep: what is at rest sleeps; --scaled: elements beside the cut
// get scaled masses; --local-steps: a sliver far from the cut takes substeps of its own; --once:
// one run in place of the quickest of five; --threads: on all cores in place of one thread
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/heap.h"
#include "base/threads.h"
#include "base/timers.h"
#include "bench/machine.h"
#include "bench/usage.h"
#include "engine/cut_stage.h"
#include "engine/energy_ledger.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "engine_started.h"

using namespace trocar;

namespace {

constexpr double cell = 4e-3, frame_rate = 250, blade_depth = 3.1;

std::string number(double value) {
  return std::to_string(value);
}

// The blade comes down, runs along x in half cells a frame and goes up again.
// `shift`: of the middle between nodes [cells].
std::string path_of(double top, double shift) {
  const auto key = [&](double time, double x, double y, double z) {
    return "{ time = " + number(time) + ", position = [" + number(cell * (x + shift)) + ", " +
           number(cell * (y + shift)) + ", " + number(z) +
           "], direction = [0, 0, -1], forward = [1, 0.2, 0] },\n";
  };
  const double high = top + cell, low = top - blade_depth * cell;
  return "path = [\n" + key(0, -3.2, 0.3, high) + key(0.033, -3.2, 0.3, low) +
         key(0.085, 3.3, 1.6, low) + key(0.118, 3.3, 1.6, high) + "]\n";
}

// The blade lies across a strip and goes down through it along x, by an eighth of a cell a cell.
std::string path_through_strip() {
  const auto key = [&](double time, double x, double z) {
    return "{ time = " + number(time) + ", position = [" + number(cell * x) + ", " +
           number(3.5 * cell) + ", " + number(cell * z) +
           "], direction = [0, 1, 0], forward = [1, 0, -0.125] },\n";
  };
  return "path = [\n" + key(0, -6.4, 1.3) + key(0.12, 6.4, -0.3) + "]\n";
}

struct Trial {
  bool is_thin = false, has_energy = false, is_of_hexahedra = false, is_viscous = false,
       does_sleep = false, is_scaled = false, has_local_steps = false;
  int n_runs = 5, n_threads = 1;
};

// A body about x = y = 0 and above z = 0, what holds it, and the blade. [m]
struct Setting {
  double half_x, half_y, height;
  std::string elements, cells, support, blade_length, path;
};

Setting box_of(int n) {
  const double side = cell * n;
  const std::string cells = std::to_string(n);
  return {side / 2,
          side / 2,
          side,
          "tet4-kuhn",
          cells + ", " + cells + ", " + cells,
          "z-",
          "16 mm",
          path_of(side, n % 2 == 1 ? 0.5 : 0)};
}

Setting strip_of(int n) {
  return {
      cell * n / 2,        3 * cell, cell, "tet4-five", std::to_string(n) + ", 6, 1", "x-", "28 mm",
      path_through_strip()};
}

std::string scene_of(int n, const Trial& trial) {
  const Setting setting = trial.is_thin ? strip_of(n) : box_of(n);
  const std::string x = number(setting.half_x), y = number(setting.half_y);
  return "[time]\nduration = 1\nframe_rate = " + number(frame_rate) +
         "\n[tissue.shape]\nkind = \"box\"\nelements = \"" +
         (trial.is_of_hexahedra ? "hex8" : setting.elements) + "\"\nlow = [-" + x + ", -" + y +
         ", 0]\nhigh = [" + x + ", " + y + ", " + number(setting.height) + "]\ncells = [" +
         setting.cells +
         "]\n[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\ndensity = 1000\n" +
         (trial.is_viscous ? "[[tissue.material.prony]]\nshare = 0.3\ntime = 0.1\n" : "") +
         "[solver]\n" + (trial.does_sleep ? "sleep = \"0.1 mm\"\n" : "") +
         (trial.is_scaled ? "mass_scaling_step = \"0.45 ms\"\n" : "") +
         (trial.has_local_steps ? "multirate = true\n" : "") + "[[support]]\nregion = \"" +
         setting.support +
         "\"\nfix = \"xyz\"\n[[instrument]]\nkind = \"scalpel\"\nblade_length = \"" +
         setting.blade_length + "\"\n" + setting.path;
}

struct Cost {
  int n_elements = 0;
  std::vector<double> edits, others;  // frames that edit, others with the blade in the body [s]
};

// As build leaves it, of a mesh and for threads that have changed.
void start_anew(Simulation& s) {
  rebuild_topology(s);
  s.corners = node_corners(s.mesh);
  s.boxes = make_element_boxes(s.mesh, s.mesh.X);
  watch_state(s);
}

// A face of the inner cell beside the lowest corner comes close to the opposite one.
void make_sliver(Simulation& s) {
  const Vec3 face = s.mesh.X.front() + Vec3(cell, 1.5 * cell, 1.5 * cell);
  for (Vec3& X : s.mesh.X)
    if ((X - face).norm() < 0.75 * cell) X.x() += 0.98 * cell;
  start_anew(s);
  if (!s.multirate) std::fprintf(stderr, "bench_edit: the sliver takes no substeps\n");
}

Cost cut_box(int n, const Trial& trial) {
  const auto started = built(scene_of(n, trial));
  Simulation& s = *started->s;
  if (trial.n_threads > 1) {
    set_thread_count(trial.n_threads);
    start_anew(s);
  }
  if (trial.has_local_steps) make_sliver(s);
  if (trial.has_energy) open_energy_ledger(s);
  Cost cost{.n_elements = s.mesh.n_elements()};
  const CutStage& stage = s.cuts.front();
  for (; s.frame < 31; ++s.frame) {
    const double t0 = static_cast<double>(s.frame) / frame_rate;
    const std::int64_t before = stage.strokes.empty() ? 0 : stage.strokes.back().n_edits;
    const double start = bench_seconds();
    cut_along_blades(s, {.t0 = t0, .t1 = t0 + 1 / frame_rate});
    const double seconds = bench_seconds() - start;
    refresh_surface(s);
    if (stage.strokes.empty()) continue;
    const bool has_edit = stage.strokes.back().n_edits > before;
    if (has_edit || stage.is_in_stroke) (has_edit ? cost.edits : cost.others).push_back(seconds);
  }
  return cost;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

// Frame by frame the quickest of some runs: others may use the machine.
Cost least_cost(int n, const Trial& trial) {
  Cost best = cut_box(n, trial);
  for (int run = 1; run < trial.n_runs; ++run) {
    const Cost cost = cut_box(n, trial);
    for (std::size_t k = 0; k < best.edits.size(); ++k)
      best.edits[k] = std::min(best.edits[k], cost.edits[k]);
    for (std::size_t k = 0; k < best.others.size(); ++k)
      best.others[k] = std::min(best.others[k], cost.others[k]);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage =
      "bench_edit [--thin] [--energy] [--hexahedra] [--viscous] [--sleep] "
      "[--scaled] [--local-steps] [--once] [--threads] [N]...";
  if (is_help_asked(argc, argv)) return print_usage(usage, stdout);
  keep_freed_memory();
  std::vector<int> cells;
  Trial trial;
  for (int k = 1; k < argc; ++k)
    if (std::strcmp(argv[k], "--thin") == 0)
      trial.is_thin = true;
    else if (std::strcmp(argv[k], "--energy") == 0)
      trial.has_energy = true;
    else if (std::strcmp(argv[k], "--hexahedra") == 0)
      trial.is_of_hexahedra = true;
    else if (std::strcmp(argv[k], "--viscous") == 0)
      trial.is_viscous = true;
    else if (std::strcmp(argv[k], "--sleep") == 0)
      trial.does_sleep = true;
    else if (std::strcmp(argv[k], "--scaled") == 0)
      trial.is_scaled = true;
    else if (std::strcmp(argv[k], "--local-steps") == 0)
      trial.has_local_steps = true;
    else if (std::strcmp(argv[k], "--once") == 0)
      trial.n_runs = 1;
    else if (std::strcmp(argv[k], "--threads") == 0)
      trial.n_threads = available_cores();
    else if (const int n = std::atoi(argv[k]); n > 0)
      cells.push_back(n);
    else
      return print_usage(usage, stderr);
  if (cells.empty()) cells = {15, 30};
  std::printf(
      "| elements | edits | median, longest frame with an edit [ms] | median without |\n"
      "|---|---|---|---|\n");
  for (const int n : cells) {
    const Cost cost = least_cost(n, trial);
    std::printf("| %d | %zu | %.2f, %.2f | %.2f |\n", cost.n_elements, cost.edits.size(),
                1e3 * median(cost.edits),
                1e3 * *std::max_element(cost.edits.begin(), cost.edits.end()),
                1e3 * median(cost.others));
    std::fflush(stdout);
  }
}
