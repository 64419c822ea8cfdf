#include "engine/run.h"

#include <memory>
#include <optional>

#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/on_root.h"
#include "base/stop_signals.h"
#include "base/whole_file.h"
#include "engine/build.h"
#include "engine/bytes.h"
#include "engine/checkpoint_output.h"
#include "engine/deadline.h"
#include "engine/energy_ledger.h"
#include "engine/equilibrium.h"
#include "engine/film_studio.h"
#include "engine/folder_lock.h"
#include "engine/frame.h"
#include "engine/output_check.h"
#include "engine/resume.h"
#include "engine/run_files.h"
#include "engine/summary.h"
#include "engine/tool_report.h"

namespace trocar {

namespace {

constexpr const char* stopped_by_signal = "stopped by a signal";

bool is_stopped(const Communicator& communicator) {
  return communicator.all_max(stop_asked() ? 1 : 0) > 0;
}

// start: of this process's first frame, on the monotonic clock.
std::string progress_note(const Simulation& s, double start) {
  const double wall = monotonic_seconds() - start;
  const SceneTime& time = s.scene.time;
  const double done = time.at(s.frame - s.first_frame);
  return with_decimals(time.at(s.frame), 2) + " of " + with_decimals(time.duration, 2) +
         " s, real-time factor " + with_decimals(wall > 0 ? done / wall : 0.0, 2);
}

// How a run ended, and the sentence that says why if it did not go through.
struct Ending {
  ExitCode code = ExitCode::done;
  std::string sentence;
};

// Of a machine that fails, beside what may have ended the run before.
void add_failure(const std::string& failure, Ending& ending) {
  if (failure.empty()) return;
  ending.code = ExitCode::machine;
  if (ending.sentence.find(failure) != std::string::npos) return;
  ending.sentence += (ending.sentence.empty() ? "" : "; ") + failure;
}

// What rank 0 can't write any more, "" if all is well: the run still tells what it found.
// Collective.
template <class Write>
std::string failure_of(const Write& write) {
  try {
    write();
  } catch (const SharedMachineError& failure) {
    return failure.what();
  }
  return "";
}

// Outputs that can't be written end the run without a checkpoint, which would count them as
// written.
Ending run_frame_or_end(Simulation& s, Outputs& outputs) {
  std::optional<FrameStart> frame_start;  // what a checkpoint would go back to
  if (s.scene.checkpoint.every > 0) frame_start = start_of_frame(s);
  try {
    run_frame(s, outputs);
  } catch (const SimulationError& trouble) {
    Ending ending{.code = ExitCode::simulation, .sentence = trouble.what()};
    add_failure(failure_of([&] {
                  if (frame_start) write_checkpoint(s, outputs, &*frame_start);
                }),
                ending);
    return ending;
  } catch (const InputError& trouble) {  // of a mesh that a cut has made
    return {.code = ExitCode::simulation,
            .sentence = "in the frame after " + short_text(s.scene.time.at(s.frame)) +
                        " s a cut leaves a body that can't be computed: " + trouble.what() +
                        "; a finer mesh or another path of the blade may help"};
  } catch (const SharedMachineError& failure) {
    return {.code = ExitCode::machine,
            .sentence = failure.what() + std::string("; the run ends after frame ") +
                        std::to_string(s.frame)};
  }
  return {};
}

// All frames, until the end, a signal, a missed deadline that ends the run, or trouble, and the
// checkpoint there.
Ending run_frames(Simulation& s, Outputs& outputs) {
  const std::int64_t n_frames = s.scene.time.n_frames();
  ProgressBar bar(s.scene.name);
  Ending ending;
  start_clock(s);
  const double start = monotonic_seconds();
  while (s.frame < n_frames && ending.code == ExitCode::done) {
    if (is_stopped(*s.communicator)) {
      ending = {ExitCode::stopped, stopped_by_signal};
      break;
    }
    PhaseTotals before;
    if (s.scene.time.overrun == Overrun::stop) before = s.timers.totals();
    if (Ending failed = run_frame_or_end(s, outputs); failed.code != ExitCode::done) return failed;
    const Deadline deadline = wait_for_deadline(s);
    if (ends_run(s.scene.time, deadline))
      ending = {ExitCode::simulation, missed_text(s, deadline, before)};
    bar.update(static_cast<double>(s.frame) / static_cast<double>(n_frames),
               progress_note(s, start));
  }
  add_failure(failure_of([&] { write_checkpoint(s, outputs); }), ending);
  return ending;
}

// What comes before the first frame if the scene asks for it.
Ending prepare_start(const LoadedScene& loaded, Simulation& s) {
  if (s.scene.start.state != StartState::equilibrium) return {};
  try {
    if (start_in_equilibrium(loaded, s, &stop_asked())) return {};
    return {ExitCode::stopped, stopped_by_signal};
  } catch (const SimulationError& trouble) {
    return {ExitCode::simulation, trouble.what()};
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

// The root's claim on the folder, in which nothing that the run reads is written over. Throws on
// every rank what the root finds wrong. Collective.
static std::unique_ptr<FolderLock> claim_folder(const RunOptions& options,
                                                const LoadedScene& loaded,
                                                Communicator& communicator) {
  std::unique_ptr<FolderLock> lock;
  on_root(communicator, [&] {
    check_inputs_stay(loaded, options.scene_file, options.folder);
    if (!options.is_resumed) make_output_folder(options.folder);
    lock = std::make_unique<FolderLock>(options.folder);
    if (!options.is_resumed) warn_of_outputs(loaded.scene, options.folder);
  });
  return lock;
}

// Closes all files and writes the summary, whatever ended the frames. lock: of the root; times: of
// what came before. Collective.
static void finish_run(Simulation& s, Outputs& outputs, FolderLock* lock, RunTimes& times,
                       Ending& ending) {
  const Communicator& communicator = *s.communicator;
  const double start = monotonic_seconds();
  add_failure(failure_of([&] { on_root(communicator, [&] { finish_outputs(outputs); }); }), ending);
  times.finish_seconds = monotonic_seconds() - start;
  if (outputs.studio) times.drawing_seconds = outputs.studio->seconds();
  const std::string summary = make_summary(s, times, ending.sentence);
  const auto write_summary = [&] {
    lock->give_up_room();
    write_whole_file(outputs.folder + "/" + summary_name, summary);
  };
  add_failure(failure_of([&] { on_root(communicator, write_summary); }), ending);
}

bool run_scene(const RunOptions& options, Communicator& communicator) {
  const double start = monotonic_seconds();
  const LoadedScene loaded = share_scene(options.scene_file, options.overrides, communicator);
  const auto lock = claim_folder(options, loaded, communicator);
  std::optional<Checkpoint> checkpoint;
  if (options.is_resumed) checkpoint = load_checkpoint(options.folder, loaded, communicator);
  const auto simulation = build(loaded, communicator);
  Ending ending;
  if (checkpoint)
    restore_checkpoint(*checkpoint, *simulation);
  else
    ending = prepare_start(loaded, *simulation);
  Outputs outputs =
      open_outputs(*simulation, options.folder, echo_in(options.folder, loaded, options.scene_file),
                   checkpoint ? &*checkpoint : nullptr);
  checkpoint.reset();  // as large as the body, and the run may be long
  RunTimes times{.setup_seconds = monotonic_seconds() - start};

  const bool has_begun = ending.code == ExitCode::done;
  if (has_begun) ending = run_frames(*simulation, outputs);
  if (ending.code == ExitCode::done) {
    note_tools_at_end(*simulation);
    note_balance(*simulation);
  }
  times.loop_seconds = monotonic_seconds() - start - times.setup_seconds;
  finish_run(*simulation, outputs, lock.get(), times, ending);
  if (ending.code == ExitCode::machine) throw SharedMachineError(ending.sentence);
  if (ending.code == ExitCode::simulation) throw SimulationError(ending.sentence);
  if (ending.code == ExitCode::stopped) report_stop(*simulation, has_begun);
  return ending.code == ExitCode::done;
}

}  // namespace trocar
