// What local steps ([solver] multirate) save: the same scene with and without them, frame by frame
// in turn, all that a frame does included. Without a scene: swinging blocks with a layer of thin
// elements, with one sliver, and with nothing small. JSON to stdout.
// bench_rates [elements, about (default 20000) | SCENE.toml] [threads]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/log.h"
#include "bench/machine.h"
#include "bench/usage.h"
#include "engine/build.h"
#include "engine/equilibrium.h"
#include "engine/frame.h"
#include "mesh_write.h"
#include "solver_multirate.h"
#include "test_files.h"

using namespace trocar;

namespace {

struct Run {
  std::unique_ptr<Simulation> s;
  Outputs outputs;
  double seconds = 0;
};

Run start(const std::string& scene, bool is_multirate, Communicator& alone) {
  const LoadedScene loaded =
      load_scene(scene, {"output=[]", "checkpoint.every=0",
                         std::string("solver.multirate=") + (is_multirate ? "true" : "false")});
  Run run{.s = build(loaded, alone)};
  if (loaded.scene.start.state == StartState::equilibrium) start_in_equilibrium(loaded, *run.s);
  return run;
}

void advance(Run& run) {
  const double begin = bench_seconds();
  run_frame(*run.s, run.outputs);
  run.seconds += bench_seconds() - begin;
}

void report(const std::string& name, const std::string& scene, bool is_first) {
  Communicator alone;
  Run plain = start(scene, false, alone), local = start(scene, true, alone);
  for (auto n = plain.s->scene.time.n_frames(); n > 0; --n)
    for (Run* run : {&plain, &local}) advance(*run);
  const MultiRate* const m = local.s->multirate.get();
  std::printf(
      "%s\n  {\"body\": \"%s\", \"elements\": %d, \"local_steps\": %zu, \"share_of_elements\": "
      "%.4f, \"steps\": %lld, \"steps_with\": %lld, \"seconds\": %.3f, \"seconds_with\": %.3f, "
      "\"speed_up\": %.3f}",
      is_first ? "" : ",", name.c_str(), local.s->mesh.n_elements(),
      m != nullptr ? m->steps.gain.size() : std::size_t{1}, m != nullptr ? m->share : 0,
      static_cast<long long>(plain.s->state.step), static_cast<long long>(local.s->state.step),
      plain.seconds, local.seconds, plain.seconds / local.seconds);
  std::fflush(stdout);
}

void report_block(const std::string& name, const Mesh& mesh, bool is_first) {
  const TestFolder folder;
  write_mesh(mesh, folder.file("m.msh"));
  const std::string scene =
      write_text(folder.file("s.toml"),
                 "[time]\nduration = \"1 s\"\nframe_rate = \"30 Hz\"\n"
                 "[tissue]\nmesh = \"m.msh\"\n[solver]\ngravity = [0, 0, -0.5]\n"
                 "[[region]]\nname = \"left\"\nlow = [-1, -1, -1]\n"
                 "high = [1e-3, 1, 1]\n[[support]]\nregion = \"left\"\n");
  report(name, scene, is_first);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage = "bench_rates [elements (20000) | SCENE.toml] [threads (1)]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  start_log(0, true);
  const std::string what = argc > 1 ? argv[1] : "20000";
  set_thread_count(argc > 2 ? std::atoi(argv[2]) : 1);
  const bool is_scene = what.ends_with(".toml");
  const double n_elements = is_scene ? 1 : std::atof(what.c_str());
  if (!(n_elements >= 1)) return print_usage(usage, stderr);
  std::printf("{\"threads\": %d, \"peak_gflops\": %.1f, \"triad_gbytes\": %.1f, \"scenes\": [",
              thread_count(), peak_gflops(), triad_gbytes());
  const auto finer = [&](double of_one) {
    return std::max(1, static_cast<int>(std::lround(std::cbrt(n_elements / of_one))));
  };
  if (is_scene) {
    report(what, what, true);
  } else {
    const int n_hex = finer(90), n_tet = finer(540);
    report_block("hex8 with a thin layer", with_thin_layer(BoxElements::hex8, n_hex), true);
    report_block("tet4 with a thin layer", with_thin_layer(BoxElements::tet4_kuhn, n_tet), false);
    report_block("tet4 with a sliver", with_sliver(BoxElements::tet4_kuhn, 5, n_tet), false);
    report_block("tet4, even",
                 make_box(Vec3(0, 0, 0), Vec3(.1, .03, .03), {10 * n_tet, 3 * n_tet, 3 * n_tet},
                          BoxElements::tet4_kuhn),
                 false);
  }
  std::printf("\n]}\n");
}
