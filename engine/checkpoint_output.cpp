#include "engine/checkpoint_output.h"

#include <algorithm>

#include "base/check.h"
#include "base/on_root.h"
#include "engine/checkpoint_file.h"
#include "engine/film_studio.h"

namespace trocar {

namespace {

std::vector<OutputMark> output_marks(const Simulation& s, const Outputs& outputs) {
  std::vector<OutputMark> marks;
  for (std::size_t k = 0; k < outputs.slots.size(); ++k)
    if (!is_picture(outputs.slots[k].kind))
      marks.push_back({.kind = outputs.slots[k].kind,
                       .file = s.scene.outputs[k].file,
                       .last_frame = outputs.slots[k].last_frame,
                       .pending = outputs.slots[k].pending});
  return marks;
}

void save(Checkpoint checkpoint, Outputs& outputs) {
  CHECK(!outputs.folder.empty());
  for (const OutputSlot& slot : outputs.slots)
    if (slot.recording) slot.recording->sync();
  if (outputs.studio) outputs.studio->wait_for_pictures();
  replace_file(outputs.folder + "/" + checkpoint_name, [&](const ByteSink& sink) {
    put_checkpoint(checkpoint, outputs.rows_in_checkpoints, sink);
  });
}

}  // namespace

bool is_checkpoint_due(const Simulation& s) {
  const double every = s.scene.checkpoint.every;
  if (every == 0) return false;
  return s.frame % s.scene.time.interval(every) == 0;
}

void write_checkpoint(Simulation& s, Outputs& outputs, const FrameStart* failed) {
  if (s.scene.checkpoint.every == 0 || s.frame == outputs.last_checkpoint) return;
  if (failed && s.state.step != failed->step) return;
  const double start = monotonic_seconds();
  Checkpoint checkpoint = failed ? take_checkpoint_of_start(s, *failed) : take_checkpoint(s);
  checkpoint.outputs = output_marks(s, outputs);
  on_root(*s.communicator, [&] { save(std::move(checkpoint), outputs); });
  outputs.last_checkpoint = s.frame;
  s.timers.add(phase_checkpoint, monotonic_seconds() - start);
}

}  // namespace trocar
