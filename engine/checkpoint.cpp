#include "engine/checkpoint.h"

#include <array>
#include <numeric>

#include "base/check.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/log.h"
#include "engine/body_search.h"
#include "engine/build.h"
#include "engine/frame_report.h"
#include "engine/owners.h"
#include "engine/state_digest.h"
#include "engine/version.h"
#include "solver/history.h"
#include "solver/step.h"

namespace trocar {

namespace {

CutMemory memory_of(const CutStage& stage) {
  return {stage, stage.tet.stroke()};
}

void remember(const CutMemory& memory, CutStage& stage) {
  static_cast<CutProgress&>(stage) = memory;
  stage.tet.set_stroke(memory.stroke);
  stage.keepers.clear();
}

// A field of owned nodes (n_owned * 3) as one of all nodes on the root. Collective.
std::vector<double> gather_owned(const Simulation& s, std::span<const double> owned) {
  return gather_field(s.part, 3, owned, *s.communicator);
}

// Back again; empty if the field is.
std::vector<double> of_owned(std::span<const double> field, const Part& part) {
  return field.empty() ? std::vector<double>() : scatter_field(part, 3, field, part.n_owned);
}

void check_fit(const Checkpoint& c, const Simulation& s) {
  if (c.body_crc != s.body_crc)
    throw InputError(
        "the body or an instrument's surface is not the one that the checkpoint was made with: a "
        "mesh "
        "file has changed; put the old one back, or start without --resume");
  const std::size_t n = c.mesh->X.size();
  if (c.u.size() != 3 * n || c.v.size() != 3 * n || c.fixed.size() != n ||
      (!c.looked_at.empty() && c.looked_at.size() != 3 * n) ||
      c.sleep.size() != (s.sleep ? 7 * n + 1 : 0) || c.cuts.size() != s.cuts.size() ||
      c.is_open.size() != s.tools.size())
    throw InputError("the checkpoint does not fit the scene; start without --resume");
}

// Bits are promised for one program and one instruction set.
void check_machine(const Checkpoint& c) {
  if (c.version != version_text() || c.simd != simd_name())
    log_warning("the checkpoint was made by " + c.version + " with " + c.simd +
                " kernels, this is " + version_text() + " with " + simd_name() +
                ": the result may differ in its last digits from that of an uninterrupted run");
}

// What the next watch starts from, and the energy ledger; one that the checkpoint lacks starts
// here.
void restore_searches(const Checkpoint& c, Simulation& s) {
  s.look.displacements = std::make_shared<std::vector<double>>(of_owned(c.looked_at, s.part));
  s.look.is_done = !c.looked_at.empty();
  static_cast<SearchMemory&>(s.look) = c.searches;
  s.look.stiffening.reset();
  if (c.has_stiffening) find_stiffening_at_look(s);
  take_verdict(c.local_steps, s);
  if (s.energy && c.has_energies)
    s.energy->memory = c.energy;
  else if (s.energy)
    open_energy_ledger(s);
}

}  // namespace

Checkpoint take_checkpoint(Simulation& s) {
  constexpr std::array<int, 1> root = {0};
  for (CutStage& stage : s.cuts) bring_stroke(s, root, stage);
  Checkpoint c{.version = version_text(),
               .simd = simd_name(),
               .scene = echo_options(scene_options(), &s.scene),
               .body_crc = s.body_crc,
               .frame = s.frame,
               .digest = state_digest(s),
               .mesh = {std::shared_ptr<void>(), &s.mesh},
               .fixed = s.fixed,
               .duplicate_parent = s.duplicate_parent,
               .duplicate_node = s.duplicate_node,
               .u = gather_owned(s, s.state.u),
               .v = gather_owned(s, s.state.v),
               .time = s.state.time,
               .last_dt = s.state.last_dt,
               .step = s.state.step,
               .step_scale = s.step_scale,
               .held_step = s.held_step,
               .held_by_contact = s.held_by_contact,
               .watch = s.watch,
               .holds = s.holds.holds,
               .is_open = s.holds.is_open,
               .tally = s.log,
               .rows = {std::shared_ptr<void>(), &s.log.rows},
               .history = s.communicator->gather(copy_history(s.model, s.part, s.state)),
               .history_time = s.state.history_time,
               .has_energies = s.energy != nullptr};
  if (s.energy) c.energy = s.energy->memory;
  if (s.look.is_done) c.looked_at = gather_owned(s, s.look.u());
  c.searches = s.look;
  c.has_stiffening = s.look.is_done && s.look.stiffening;
  c.local_steps = local_step_verdict(s);
  if (s.sleep) {
    c.sleep = gather_sleep(s);
    c.quiet_range = s.sleep->range;
  }
  for (const CutStage& stage : s.cuts) c.cuts.push_back(memory_of(stage));
  return c;
}

void restore_checkpoint(const Checkpoint& c, Simulation& s) {
  check_fit(c, s);
  check_machine(c);
  s.mesh = *c.mesh;
  s.corners = {};
  s.fixed = c.fixed;
  choose_owners(s);
  s.duplicate_parent = c.duplicate_parent;
  s.duplicate_node = c.duplicate_node;
  s.holds.holds = c.holds;
  s.holds.is_open = c.is_open;
  rebuild_topology(s);
  s.state.time = c.time;
  s.state.last_dt = c.last_dt;
  s.state.step = c.step;
  s.state.history_time = c.history_time;
  scatter_state(s, {.u = c.u, .v = c.v});
  if (!c.history.empty())
    restore_history(s.model, s.part, c.history, unedited_elements(s.mesh.n_elements()), s.state);
  if (s.sleep) {
    restore_sleep(c.sleep, s);
    s.sleep->range = c.quiet_range;
  }
  for (std::size_t k = 0; k < s.cuts.size(); ++k) remember(c.cuts[k], s.cuts[k]);
  s.step_scale = c.step_scale;
  s.held_step = c.held_step;
  s.held_by_contact = c.held_by_contact;
  s.watch = c.watch;
  static_cast<RunTally&>(s.log) = c.tally;
  s.log.rows = *c.rows;
  s.frame = s.first_frame = c.frame;
  restore_searches(c, s);
  if (s.contact) refresh_surface(s);
  prepare_for_cuts(s);
  if (state_digest(s) != c.digest)
    throw InputError("the checkpoint does not give the state that it was made of: its digest is " +
                     digest_text(state_digest(s)) + " instead of " + digest_text(c.digest));
}

// Of the stiffening only whether it was known: a checkpoint has no more of it.
static ElementLook without_stiffening(const ElementLook& look) {
  ElementLook without{look, look.is_done, look.displacements, {}, look.decisive, look.reach};
  if (look.stiffening) without.stiffening.emplace();
  return without;
}

FrameStart start_of_frame(const Simulation& s) {
  return {.step = s.state.step,
          .watch = s.watch,
          .step_scale = s.step_scale,
          .holds = s.holds.holds,
          .is_open = s.holds.is_open,
          .look = without_stiffening(s.look),
          .sleep = s.sleep,
          .local_steps = local_step_verdict(s),
          .n_events = s.log.events.size(),
          .told = s.log.told,
          .n_roll_backs = s.log.n_roll_backs,
          .searches = s.log.searches};
}

Checkpoint take_checkpoint_of_start(Simulation& s, const FrameStart& start) {
  CHECK_OP(s.state.step, ==, start.step);
  s.look = start.look;
  if (s.sleep) static_cast<SleepRoll&>(*s.sleep) = *start.sleep;
  s.holds.holds = start.holds;
  s.holds.is_open = start.is_open;
  localise_holds(s.holds, s.part);
  Checkpoint c = take_checkpoint(s);
  c.watch = start.watch;
  c.step_scale = start.step_scale;
  c.local_steps = start.local_steps;
  c.tally.events.resize(start.n_events);
  c.tally.told = start.told;
  c.tally.n_roll_backs = start.n_roll_backs;
  c.tally.searches = start.searches;
  return c;
}

}  // namespace trocar
