#include "engine/predict.h"

#include <cmath>
#include <cstdio>

#include "base/heap.h"
#include "base/threads.h"
#include "base/timers.h"
#include "engine/frame.h"
#include "engine/simulation.h"
#include "mesh/quality.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Seconds of one step at rest, the slowest rank's, from about a quarter of a second of steps on a
// copy of the state.
double measure_step(Simulation& s, double dt) {
  const State kept = s.state;
  const double start = monotonic_seconds();
  int n = 0;
  double elapsed = 0;
  while (elapsed < 0.25) {
    for (int k = 0; k < 20; ++k, ++n) step_alone(s, dt);
    // All ranks make the same number of rounds.
    elapsed = s.communicator->all_max(monotonic_seconds() - start);
  }
  finish_exchange(s.neighbours, s.state);
  s.state = kept;
  return elapsed / n;
}

std::string line(const char* name, const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  char row[240];
  std::snprintf(row, sizeof row, "  %-22s %s\n", name, text);
  return row;
}

}  // namespace

std::string predict(Simulation& s) {
  const double program = s.communicator->all_max(static_cast<double>(peak_memory_bytes()));
  const double frame = 1 / s.scene.time.frame_rate;
  const double limit = s.step_factor * s.watch.stable_step;
  const double n_substeps = std::ceil(frame / limit);
  const double step_seconds = measure_step(s, frame / n_substeps);
  std::uint64_t mine = memory_bytes(s.model, s.scratch);
  if (s.multirate) mine += memory_bytes(s.multirate->model, s.multirate->scratch);
  const std::uint64_t bytes = s.communicator->all_sum(mine);
  std::string text = s.scene.name + "\n";
  text += line("nodes", "%.0f", s.mesh.n_nodes());
  text += line("elements", "%.0f", s.mesh.n_elements());
  text += line("body", "%.4g m on its longest side", bounding_box(s.mesh.X).size().maxCoeff());
  text += line("least quality", "%.3f (mean ratio, 1 is ideal)",
               element_statistics(s.mesh).quality_min);
  text += line("stable step", "%.4g ms", 1e3 * s.watch.stable_step);
  text += line("set by element", "%.0f", s.watch.stable_element);
  if (s.added_mass)
    text += line("added mass", "%.3g %% of the body's, against deformation only",
                 100 * s.added_mass->share);
  if (s.multirate)
    text +=
        line("local steps", "%.0f a step", static_cast<double>(s.multirate->steps.gain.size())) +
        line("of the elements", "%.3g %%", 100 * s.multirate->share);
  text += line("steps a frame", "%.0f", n_substeps);
  text += line("steps a second", "%.0f (without contact, cuts and pictures)", 1 / step_seconds);
  text +=
      line("memory", "%.1f MB for model and scratch, all ranks", static_cast<double>(bytes) / 1e6);
  text += line("program's memory", "%.0f MB to build and watch the body, on the rank that has most",
               program / 1e6);
  text += line("ranks", "%.0f", s.communicator->size()) +
          line("threads a rank", "%.0f", thread_count());
  text += line("real-time factor", "%.2f predicted for the steps alone",
               frame / (n_substeps * step_seconds));
  return text;
}

}  // namespace trocar
