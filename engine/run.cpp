#include "engine/run.h"

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "base/error.h"
#include "base/log.h"
#include "engine/build.h"
#include "engine/bytes.h"
#include "engine/checkpoint_output.h"
#include "engine/energy_ledger.h"
#include "engine/equilibrium.h"
#include "engine/film_studio.h"
#include "engine/frame.h"
#include "engine/frame_report.h"
#include "engine/output_check.h"
#include "engine/resume.h"
#include "engine/summary.h"
#include "engine/tissue.h"

namespace trocar {

namespace {

std::atomic<bool> stop_asked = false;
constexpr const char* stopped_by_signal = "stopped by a signal";
static_assert(std::atomic<bool>::is_always_lock_free);

// A second signal ends this rank at once, and mpirun the others: outputs are consistent at any
// time.
void ask_to_stop(int) {
  if (stop_asked.exchange(true)) std::_Exit(75);
}

void listen_to_signals() {
  stop_asked = false;
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, ask_to_stop);
  if (std::signal(SIGHUP, ask_to_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
}

bool is_stopped(const Communicator& communicator) {
  return communicator.all_max(stop_asked ? 1 : 0) > 0;
}

// start: of this process's first frame, on the monotonic clock.
std::string progress_note(const Simulation& s, double start) {
  const double wall = monotonic_seconds() - start;
  const double rate = s.scene.time.frame_rate;
  const double done = static_cast<double>(s.frame - s.first_frame) / rate;
  char note[96];
  std::snprintf(note, sizeof note, "%.2f of %.2f s, real-time factor %.2f",
                static_cast<double>(s.frame) / rate, s.scene.time.duration,
                wall > 0 ? done / wall : 0.0);
  return note;
}

// All frames, until the end, a signal or trouble, and the checkpoint there; the sentence of the
// trouble, "" if none.
std::string run_frames(Simulation& s, Outputs& outputs) {
  const auto n_frames = std::llround(s.scene.time.duration * s.scene.time.frame_rate);
  ProgressBar bar(s.scene.name);
  const double start = monotonic_seconds();
  s.start_seconds = start - static_cast<double>(s.frame) / s.scene.time.frame_rate;
  while (s.frame < n_frames && !is_stopped(*s.communicator)) {
    const FrameStart frame_start = start_of_frame(s);
    try {
      run_frame(s, outputs);
    } catch (const SimulationError& trouble) {
      write_checkpoint(s, outputs, &frame_start);
      return trouble.what();
    }
    bar.update(static_cast<double>(s.frame) / static_cast<double>(n_frames),
               progress_note(s, start));
  }
  write_checkpoint(s, outputs);
  return s.frame < n_frames ? stopped_by_signal : "";
}

// What comes before the first frame if the scene asks for it; the sentence of the trouble, "" if
// none.
std::string prepare_start(const LoadedScene& loaded, Simulation& s) {
  if (s.scene.start.state != StartState::equilibrium) return "";
  try {
    return start_in_equilibrium(loaded, s, &stop_asked) ? "" : stopped_by_signal;
  } catch (const SimulationError& trouble) {
    return trouble.what();
  }
}

// has_begun: the frames; before, there is nothing to go on from.
void report_stop(const Simulation& s, bool has_begun) {
  if (!has_begun)
    log_warning(
        "stopped by a signal during the search for equilibrium, of which nothing is kept: start it "
        "anew, without --resume");
  else if (s.scene.checkpoint.every > 0)
    log_warning("stopped by a signal after frame " + std::to_string(s.frame) +
                ": --resume goes on from there");
}

// The sentence of what can't be written any more on this rank, "" if all is: the summary still has
// what the run found.
std::string trouble_in_closing(Outputs& outputs) {
  try {
    finish_outputs(outputs);
  } catch (const MachineError& trouble) {
    return trouble.what();
  }
  return "";
}

// unfinished: what could not be written before.
void write_summary(const std::string& text, const std::string& file,
                   const std::string& unfinished) {
  std::ofstream stream(file);
  if ((stream << text).flush()) return;
  throw MachineError((unfinished.empty() ? "" : unfinished + "; ") + file +
                     ": can't be written (disk full or no permission)");
}

}  // namespace

LoadedScene share_scene(const std::string& file, const std::vector<std::string>& overrides,
                        Communicator& communicator) {
  LoadedScene mine;
  const auto bytes = read_on_root(communicator, [&] {
    mine = load_scene(file, overrides);
    ByteWriter writer;
    writer.put_text(echo_options(scene_options(), &mine.scene));
    writer.put_text(mine.folder);
    return writer.take();
  });
  if (communicator.is_root()) return mine;
  ByteReader reader(bytes);
  const std::string echo = reader.get_text();
  read_options_text(scene_options(), echo, "scene", {}, &mine.scene, mine.where);
  mine.folder = reader.get_text();
  return mine;
}

// Throws on every rank what the root finds wrong.
static void check_outputs(const RunOptions& options, const LoadedScene& loaded,
                          Communicator& communicator) {
  read_on_root(communicator, [&] {
    check_inputs_stay(loaded, options.scene_file, options.folder);
    if (!options.resume) warn_of_outputs(loaded.scene, options.folder);
    return std::vector<std::byte>();
  });
}

bool run_scene(const RunOptions& options, Communicator& communicator) {
  const double start = monotonic_seconds();
  listen_to_signals();
  const LoadedScene loaded = share_scene(options.scene_file, options.overrides, communicator);
  check_outputs(options, loaded, communicator);
  std::optional<Checkpoint> checkpoint;
  if (options.resume) checkpoint = load_checkpoint(options.folder, loaded, communicator);
  const auto simulation = build(loaded, communicator);
  std::string trouble;
  if (checkpoint)
    restore_checkpoint(*checkpoint, *simulation);
  else
    trouble = prepare_start(loaded, *simulation);
  Outputs outputs =
      open_outputs(*simulation, options.folder, echo_in(options.folder, loaded, options.scene_file),
                   checkpoint ? &*checkpoint : nullptr);
  RunTimes times{.setup_seconds = monotonic_seconds() - start};

  const bool has_begun = trouble.empty();
  if (has_begun) trouble = run_frames(*simulation, outputs);
  if (trouble.empty()) {
    note_idle_tools(*simulation);
    note_balance(*simulation);
  }
  times.loop_seconds = monotonic_seconds() - start - times.setup_seconds;
  const bool is_stopped_by_signal = trouble == stopped_by_signal;
  const std::string unfinished = trouble_in_closing(outputs);
  times.finish_seconds = monotonic_seconds() - start - times.setup_seconds - times.loop_seconds;
  if (outputs.studio) times.drawing_seconds = outputs.studio->seconds();
  const std::string summary =
      make_summary(*simulation, times, trouble.empty() ? unfinished : trouble);
  if (communicator.is_root()) write_summary(summary, options.folder + "/summary.json", unfinished);
  if (!unfinished.empty()) throw MachineError(unfinished);
  if (is_stopped_by_signal) report_stop(*simulation, has_begun);
  if (!trouble.empty() && !is_stopped_by_signal) throw SimulationError(trouble);
  return !is_stopped_by_signal;
}

}  // namespace trocar
