#include "engine/sleep.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/event_log.h"
#include "engine/settling.h"
#include "engine/simulation.h"

namespace trocar {

namespace {

constexpr double quiet_share = 1. / 16, watch_share = 1. / 4;  // of the bound
constexpr double least_quiet_time = 0.5;                       // [s]

bool has_left(const std::vector<double>& from, double reach, const State& state, std::int64_t i) {
  for (std::int64_t k = 3 * i; k < 3 * i + 3; ++k)
    if (!(std::abs(state.u[k] - from[k]) <= reach)) return true;  // NaN, too
  return false;
}

void drop_anchor(Sleep& sleep, const State& state, std::int64_t i) {
  std::copy_n(state.u.begin() + 3 * i, 3, sleep.anchor.begin() + 3 * i);
  sleep.quiet[i] = 0;
}

void note_motion(Sleep& sleep, const State& state) {
  for (std::int64_t i = 0; i < std::ssize(sleep.quiet); ++i)
    if (sleep.quiet[i] < 0 || has_left(sleep.anchor, quiet_share * sleep.bound, state, i))
      drop_anchor(sleep, state, i);
    else
      ++sleep.quiet[i];
}

// What is held or touched moves with that, which asks nobody, and has not been quiet when it is let
// go.
void disquiet_touched(Simulation& s) {
  std::vector<std::int32_t>& quiet = s.sleep->quiet;
  for (const PrescribedNode& held : s.holds.prescribed) quiet[held.node] = 0;
  if (!s.contact) return;
  for (const Contact& contact : s.contact->contacts)
    for (const std::int32_t node : contact.node)
      if (const std::int32_t local = s.part.owned(node); local >= 0) quiet[local] = 0;
}

// Each tool's force and its moment about the origin, each support's way.
std::vector<double> actions_on(const Simulation& s, std::span<const ToolRow> tools) {
  std::vector<double> actions;
  const auto add = [&](const Vec3& v) { actions.insert(actions.end(), v.begin(), v.end()); };
  for (const ToolRow& tool : tools) {
    add(tool.force);
    add(tool.position.cross(tool.force));
  }
  const double time = s.scene.time.at(s.frame + 1);
  for (const DisplacementPath& path : s.holds.paths) add(path.at(time));
  return actions;
}

// Of what has moved the body as far as it is: that moves it by no more than the quarter of the
// bound. At least as exact as contact finds forces, at most a hundredth, as forces may also hold a
// body where it is at rest. Collective.
double share_unseen(const Simulation& s) {
  double most = 0;
  for (std::int64_t k = 0; k < 3 * s.part.n_owned; ++k)
    most = std::max(most, std::abs(s.state.u[k]));
  most = s.communicator->all_max(most);
  return std::clamp(watch_share * s.sleep->bound / most, 1e-3, 1e-2);
}

// [frames]
double frames_to_sleep(const Simulation& s) {
  return std::max(1.0, std::max(least_quiet_time, s.sleep->quiet_time) * s.scene.time.frame_rate);
}

// (n_local) 1 for nodes that have been quiet long enough.
std::vector<double> find_quiet(Simulation& s) {
  const double least = frames_to_sleep(s);
  std::vector<double> is_quiet(static_cast<std::size_t>(s.model.n_local), 0.0);
  for (std::size_t i = 0; i < s.sleep->quiet.size(); ++i)
    is_quiet[i] = s.sleep->quiet[i] >= least ? 1 : 0;
  HaloExchange(s.halo, 1).exchange(is_quiet, *s.communicator);
  return is_quiet;
}

// Calls body(corners of a lane's element as (first, stride, n)).
template <class Body>
void for_lanes(const Model& model, const Body& body) {
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t n =
        std::ssize(blocks.corner) / (std::int64_t{blocks.n_blocks} * blocks.lanes);
    for (std::int64_t lane = 0; lane < blocks.n_elements; ++lane)
      body(blocks.corner.data() + first_of_lane(lane, blocks.lanes, n), blocks.lanes, n);
  }
}

// Marks all corners of elements that have a corner with mark[i] == value.
template <class Mark>
std::vector<std::uint8_t> spread(const Model& model, const std::vector<Mark>& mark, Mark value) {
  std::vector<std::uint8_t> reached(mark.size(), 0);
  for_lanes(model, [&](const std::int32_t* corner, std::int64_t stride, std::int64_t n) {
    bool is_marked = false;
    for (std::int64_t a = 0; a < n; ++a) is_marked |= mark[corner[a * stride]] == value;
    for (std::int64_t a = 0; a < n && is_marked; ++a) reached[corner[a * stride]] = 1;
  });
  return reached;
}

// The nodes of a cluster of scaled masses push each other, so they sleep all or none.
void keep_clusters_together(const MassClusters& clusters, std::vector<double>& sleeps) {
  for (std::size_t c = 0; c < clusters.total.size(); ++c) {
    const std::span nodes(clusters.node.begin() + clusters.offset[c],
                          clusters.node.begin() + clusters.offset[c + 1]);
    if (std::any_of(nodes.begin(), nodes.end(), [&](std::int32_t i) { return sleeps[i] == 0; }))
      for (const std::int32_t i : nodes) sleeps[i] = 0;
  }
}

// (n_local) Quiet nodes whose neighbours are all quiet.
std::vector<std::uint8_t> find_sleepers(Simulation& s) {
  const std::vector<std::uint8_t> is_disturbed = spread(s.model, find_quiet(s), 0.0);
  std::vector<double> sleeps(is_disturbed.size());
  for (std::size_t i = 0; i < sleeps.size(); ++i) sleeps[i] = is_disturbed[i] == 0 ? 1 : 0;
  keep_clusters_together(s.model.clusters, sleeps);
  HaloExchange(s.halo, 1).exchange(sleeps, *s.communicator);
  return {sleeps.begin(), sleeps.end()};
}

std::vector<std::uint8_t> find_sleeping_blocks(const Model& model,
                                               const std::vector<std::uint8_t>& is_asleep) {
  std::vector<std::uint8_t> sleeps;
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t n = std::ssize(blocks.corner) / blocks.n_blocks;
    for (std::int64_t first = 0; first < std::ssize(blocks.corner); first += n)
      sleeps.push_back(std::all_of(blocks.corner.begin() + first, blocks.corner.begin() + first + n,
                                   [&](std::int32_t i) { return is_asleep[i] != 0; }));
  }
  return sleeps;
}

// Everything that follows from sleep.is_asleep.
void follow_sleepers(Simulation& s) {
  Sleep& sleep = *s.sleep;
  for (std::size_t i = 0; i < sleep.is_asleep.size(); ++i)
    if (sleep.is_asleep[i] != 0)
      std::fill_n(s.state.v.begin() + 3 * static_cast<std::ptrdiff_t>(i), 3, 0.0);
  const std::vector<std::uint8_t> near = spread(s.model, sleep.is_asleep, std::uint8_t{1});
  for (std::size_t i = 0; i < sleep.is_beside.size(); ++i) {
    const std::uint8_t was_beside = sleep.is_beside[i];
    sleep.is_beside[i] = sleep.is_asleep[i] == 0 ? near[i] : 0;
    if (sleep.is_beside[i] > was_beside) std::copy_n(&s.state.u[3 * i], 3, &sleep.watched[3 * i]);
  }
  sleep.block_sleeps = find_sleeping_blocks(s.model, sleep.is_asleep);
  show_asleep(s);
}

// Of owned nodes that sleep and of those that didn't `before`, over all ranks.
std::array<std::uint64_t, 2> count_sleepers(const Simulation& s,
                                            const std::vector<std::uint8_t>& before) {
  std::array<std::uint64_t, 2> n{};
  for (std::size_t i = 0; i < s.sleep->quiet.size(); ++i) {
    n[0] += s.sleep->is_asleep[i];
    n[1] += s.sleep->is_asleep[i] > before[i] ? 1 : 0;
  }
  s.communicator->all_sum(n);
  return n;
}

double share_of(std::uint64_t n_sleepers, const Simulation& s) {
  return static_cast<double>(n_sleepers) / s.mesh.n_nodes();
}

bool has_any(const Simulation& s, const std::vector<std::uint8_t>& sleepers) {
  return s.communicator->all_max(std::ranges::count(sleepers, 1) > 0 ? 1 : 0) > 0;
}

bool is_touched(const Simulation& s) {
  const std::vector<std::uint8_t>& is_asleep = s.sleep->is_asleep;
  const auto sleeps = [&](std::int32_t node) {
    const std::int32_t local = s.part.node_local[node];
    return local >= 0 && is_asleep[local] != 0;
  };
  if (s.contact)
    for (const Contact& contact : s.contact->contacts)
      if (std::any_of(contact.node.begin(), contact.node.end(), sleeps)) return true;
  for (const PrescribedNode& held : s.holds.prescribed)
    if (is_asleep[held.node] != 0) return true;
  const SceneTime& time = s.scene.time;
  if (do_loads_change(s.loads, time.at(s.frame), time.at(s.frame + 1))) return true;
  return !s.drag.node.empty() ||
         std::any_of(s.cuts.begin(), s.cuts.end(),
                     [](const CutStage& stage) { return stage.is_engaged; });
}

}  // namespace

void begin_sleep(Simulation& s) {
  if (s.scene.solver.sleep == 0) return;
  s.sleep.emplace().bound = s.scene.solver.sleep;
  fit_sleep(s);
}

void fit_sleep(Simulation& s) {
  Sleep& sleep = *s.sleep;
  sleep.quiet_time = 0;  // a flap is slower than the body that it is cut from
  const auto n = static_cast<std::size_t>(s.model.n_owned);
  sleep.anchor.resize(3 * n);
  sleep.quiet.resize(n, -1);
  sleep.is_asleep.resize(static_cast<std::size_t>(s.model.n_local));
  sleep.is_beside.resize(n);
  sleep.watched.resize(3 * n);
  sleep.awake_fixed = s.model.fixed;
}

void wake_all(Simulation& s) {
  Sleep& sleep = *s.sleep;
  show_awake(s);
  std::fill(sleep.is_asleep.begin(), sleep.is_asleep.end(), std::uint8_t{0});
  std::fill(sleep.is_beside.begin(), sleep.is_beside.end(), std::uint8_t{0});
  std::fill(sleep.quiet.begin(), sleep.quiet.end(), -1);
  sleep.block_sleeps.clear();
  sleep.share = 0;
  sleep.range.low.clear();
  sleep.range.high.clear();
}

void show_awake(Simulation& s) {
  s.model.fixed = s.sleep->awake_fixed;
  s.scratch.is_asleep.clear();
}

void show_asleep(Simulation& s) {
  const Sleep& sleep = *s.sleep;
  for (std::size_t i = 0; i < s.model.fixed.size(); ++i)
    s.model.fixed[i] = sleep.is_asleep[i] != 0 ? all_components : sleep.awake_fixed[i];
  s.scratch.is_asleep = sleep.block_sleeps;
}

void fall_asleep(Simulation& s, std::span<const ToolRow> tools) {
  const PhaseScope scope(s.timers, phase_watch);
  Sleep& sleep = *s.sleep;
  const std::vector<double> actions = actions_on(s, tools);
  note_actions(actions, static_cast<std::size_t>(frames_to_sleep(s)), sleep.range);
  if (leave_range(sleep.range)) wake_all(s);
  note_motion(sleep, s.state);
  disquiet_touched(s);
  std::vector<std::uint8_t> sleepers = find_sleepers(s);
  if (sleep.quiet_time == 0 && has_any(s, sleepers)) {
    show_awake(s);  // some may sleep already
    sleep.quiet_time = std::max(least_quiet_time, settling_time(s));
    show_asleep(s);
    if (sleep.quiet_time == longest_settling)
      note_event(s, s.scene.time.at(s.frame + 1),
                 "nothing falls asleep (solver.sleep): the body's slowest motion was not found");
    sleepers = find_sleepers(s);
  }
  std::swap(sleepers, sleep.is_asleep);
  if (sleepers != sleep.is_asleep) follow_sleepers(s);
  const auto [n, n_new] = count_sleepers(s, sleepers);
  sleep.share = share_of(n, s);
  if (n_new > 0) narrow_range(actions.size(), share_unseen(s), sleep.range);
}

void wake_touched(Simulation& s) {
  if (s.sleep->share == 0) return;
  if (s.communicator->all_max(is_touched(s) ? 1 : 0) > 0) wake_all(s);
}

bool wake_disturbed(Simulation& s) {
  const Sleep& sleep = *s.sleep;
  if (sleep.share == 0) return false;
  bool is_disturbed = false;
  for (std::int64_t i = 0; i < std::ssize(sleep.is_beside); ++i)
    is_disturbed |=
        sleep.is_beside[i] != 0 && has_left(sleep.watched, watch_share * sleep.bound, s.state, i);
  if (s.communicator->all_max(is_disturbed ? 1 : 0) == 0) return false;
  wake_all(s);
  return true;
}

std::vector<double> gather_sleep(Simulation& s) {
  const Sleep& sleep = *s.sleep;
  std::vector<double> local;
  for (std::size_t i = 0; i < sleep.quiet.size(); ++i) {
    local.insert(local.end(), &sleep.anchor[3 * i], &sleep.anchor[3 * i] + 3);
    local.insert(local.end(), &sleep.watched[3 * i], &sleep.watched[3 * i] + 3);
    local.push_back(sleep.is_asleep[i] != 0 ? -2 - sleep.quiet[i] : sleep.quiet[i]);
  }
  std::vector<double> memory = gather_field(s.part, 7, local, *s.communicator);
  if (!memory.empty()) memory.push_back(sleep.quiet_time);
  return memory;
}

void restore_sleep(std::span<const double> memory, Simulation& s) {
  Sleep& sleep = *s.sleep;
  sleep.quiet_time = memory.back();
  const auto of_node = [&](std::size_t k) {
    return memory.subspan(7 * static_cast<std::size_t>(s.part.node_global[k]), 7);
  };
  for (std::size_t k = 0; k < sleep.is_asleep.size(); ++k)
    sleep.is_asleep[k] = of_node(k)[6] <= -2 ? 1 : 0;
  follow_sleepers(s);
  for (std::size_t i = 0; i < sleep.quiet.size(); ++i) {
    std::copy_n(of_node(i).begin(), 3, &sleep.anchor[3 * i]);
    std::copy_n(of_node(i).begin() + 3, 3, &sleep.watched[3 * i]);
    const double quiet = of_node(i)[6];
    sleep.quiet[i] = static_cast<std::int32_t>(quiet <= -2 ? -2 - quiet : quiet);
  }
  sleep.share = share_of(count_sleepers(s, sleep.is_asleep)[0], s);
}

}  // namespace trocar
