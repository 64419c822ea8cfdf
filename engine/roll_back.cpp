#include "engine/roll_back.h"

#include "base/error.h"
#include "base/number_text.h"
#include "engine/event_log.h"
#include "engine/local_steps.h"
#include "engine/suspect.h"

namespace trocar {

namespace {

// What both ways back to the frame's beginning have in common; the sentence's beginning.
std::string go_back(Simulation& s, const FrameSpan& span, const Watch& failed,
                    const std::string& trouble, int tries) {
  if (tries >= most_roll_backs) {
    const Suspect suspect = find_suspect(s, failed, span);
    throw SimulationError("in the frame after " + short_text(span.t0) + " s: " + trouble +
                          suspect.place + "; " + std::to_string(tries) +
                          " roll-backs with smaller steps did not help: " + suspect.cure + " may");
  }
  ++s.log.n_roll_backs;
  s.look.is_done = false;  // it was of a state that is gone
  s.look.displacements.reset();
  return "rolled back: " + trouble;
}

}  // namespace

void repeat_frame(Simulation& s, const FrameSpan& span, int tries) {
  const double stable = step_share(s) * s.watch.stable_step;
  const std::string trouble = "the tissue's stable step fell to " + short_text(stable) + " s, " +
                              (stable < span.dt ? "below" : "too near") + " the step of " +
                              short_text(span.dt) + " s";
  note_event(s, span.t0, go_back(s, span, s.watch, trouble, tries));
}

void roll_back(Simulation& s, const FrameSpan& span, const Watch& failed,
               const std::string& trouble, int tries) {
  const std::string sentence = go_back(s, span, failed, trouble, tries);
  s.step_scale *= 0.5;
  note_event(s, span.t0,
             sentence + find_suspect(s, failed, span).place + "; step scale now " +
                 short_text(s.step_scale));
}

}  // namespace trocar
