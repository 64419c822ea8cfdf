// What a frame costs beyond its steps where the scene has nothing but tissue, swinging in its
// weight and at rest: the time of run_frame against that of as many bare steps on the same body, a
// few of each in turn. Also what a search for the highest frequency takes, in steps. JSON to
// stdout. bench_frame [cells along an edge (default 20)] [threads]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/log.h"
#include "bench/machine.h"
#include "bench/usage.h"
#include "engine/body_search.h"
#include "engine/build.h"
#include "engine/equilibrium.h"
#include "engine/frame.h"
#include "solver/frequency.h"
#include "solver/step.h"

using namespace trocar;

namespace {

LoadedScene empty_scene(int n, const std::string& stable_step) {
  const std::string cells = std::to_string(n) + "," + std::to_string(n) + "," + std::to_string(n);
  return load_scene(
      TROCAR_SOURCE "/configs/block_hex.toml",
      {"instrument=[]", "output=[]", "checkpoint.every=0", "tissue.shape.cells=[" + cells + "]",
       "solver.stable_step='" + stable_step + "'"});
}

template <class Body>
double seconds_of(const Body& body) {
  const double start = bench_seconds();
  body();
  return bench_seconds() - start;
}

void run_steps(Simulation& s, std::int64_t n, double dt) {
  for (std::int64_t k = 0; k < n; ++k) step_alone(s, dt);
  finish_exchange(s.neighbours, s.state);
}

// Least of a few in a row, so that caches hold what the one before left there.
template <class Body>
double least_of(const Body& body) {
  double least = 1e300;
  for (int k = 0; k < 5; ++k) least = std::min(least, body());
  return least;
}

// Seconds of a frame, of as many steps by themselves and of a search, all for one step.
struct Seconds {
  double frame = 1e300, step = 1e300, search = 1e300;
};

Seconds time_frames(Simulation& s, const Communicator& alone, std::int64_t& n_steps) {
  Seconds least;
  Outputs outputs;
  for (int round = 0; round < 8; ++round) {
    least.frame = std::min(least.frame, least_of([&] {
                             const double seconds = seconds_of([&] { run_frame(s, outputs); });
                             n_steps = s.log.rows.back().n_substeps;
                             return seconds / static_cast<double>(n_steps);
                           }));
    const double dt = s.log.rows.back().dt;
    const State kept = s.state;
    const Scratch kept_scratch = s.scratch;
    least.step = std::min(least.step, least_of([&] {
                            const double seconds = seconds_of([&] { run_steps(s, n_steps, dt); });
                            return seconds / static_cast<double>(n_steps);
                          }));
    s.state = kept;
    const double amplitude = search_amplitude(s.model, s.edge_length);
    least.search =
        std::min(least.search,
                 least_of([&] { return seconds_of([&] { search_step(s, amplitude, alone); }); }));
    s.scratch = kept_scratch;
  }
  return least;
}

void report(int n, const std::string& stable_step, bool is_at_rest) {
  Communicator alone;
  const LoadedScene loaded = empty_scene(n, stable_step);
  const auto s = build(loaded, alone);
  if (is_at_rest) start_in_equilibrium(loaded, *s);
  std::int64_t n_steps = 0;
  const Seconds least = time_frames(*s, alone, n_steps);
  std::printf(
      "%s\n  {\"stable_step\": \"%s\", \"state\": \"%s\", \"elements\": %d, \"steps\": %lld, "
      "\"frame_us_a_step\": %.2f, \"step_us\": %.2f, \"frame_over_steps\": %.4f, "
      "\"search_over_step\": %.2f}",
      is_at_rest || stable_step != "element-bound" ? "," : "", stable_step.c_str(),
      is_at_rest ? "at rest" : "swinging", s->mesh.n_elements(), static_cast<long long>(n_steps),
      1e6 * least.frame, 1e6 * least.step, least.frame / least.step, least.search / least.step);
}

}  // namespace

int main(int argc, char** argv) {
  if (const int code =
          answer_options(argc, argv, "bench_frame [cells along an edge (default 20)] [threads]");
      code >= 0)
    return code;
  start_log(0, true);
  const int n = argc > 1 ? std::atoi(argv[1]) : 20;
  set_thread_count(argc > 2 ? std::atoi(argv[2]) : 1);
  std::printf("{\"threads\": %d, \"peak_gflops\": %.1f, \"triad_gbytes\": %.1f, \"frames\": [",
              thread_count(), peak_gflops(), triad_gbytes());
  for (const bool is_at_rest : {false, true})
    for (const char* stable_step : {"element-bound", "frequency"})
      report(n, stable_step, is_at_rest);
  std::printf("\n]}\n");
}
