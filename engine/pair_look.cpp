#include "engine/pair_look.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/box.h"
#include "base/number_text.h"
#include "base/sort_unique.h"
#include "collision/contact_tissue.h"
#include "engine/energy_ledger.h"
#include "engine/event_log.h"
#include "engine/gather_items.h"
#include "engine/point_text.h"

namespace trocar {

namespace {

// Pairs are found within contact_reach. Of that, tissue may have come this part nearer to tissue
// than it was expected, and between two checks it comes at most the rest.
constexpr double may_have_come = 0.9;
// A check costs a pass over the surface's nodes and a word between all ranks: of quiet tissue it is
// due after so many substeps, in which waves run over as many edges at most.
constexpr std::int64_t most_between = 8;

// A look within a frame goes ahead as far as tissue approaches tissue by this, in contact_reach:
// more would find pairs by the thousand that the next look finds again.
constexpr double most_approach = 8;

// By how much two surface nodes at most have come nearer or apart unexpectedly, and at which speed
// they do and did at the last look.
struct Apart {
  double way = 0, speed = 0, speed_then = 0;  // [m], [m/s]
};
constexpr std::size_t per_rank = 18;

// Of all ranks' boxes.
double diagonal(std::span<const double> corners, std::size_t from) {
  Box all;
  for (std::size_t k = from; k < corners.size(); k += per_rank) {
    all.add(Box{Vec3::Map(&corners[k]), Vec3::Map(&corners[k + 3])});
  }
  return all.size().norm();
}

Apart find_apart(const Simulation& s, double time) {
  const PairLook& look = s.contact->look;
  Box off, speed, then;
  for (std::size_t k = 0; k < s.view.local.size(); ++k) {
    const auto i = 3 * static_cast<std::size_t>(s.view.local[k]);
    speed.add(Vec3::Map(&s.state.v[i]));
    then.add(Vec3::Map(&look.v[3 * k]));
    off.add(Vec3::Map(&s.state.u[i]) - Vec3::Map(&look.u[3 * k]) -
            (time - look.time) * Vec3::Map(&look.v[3 * k]));
  }
  std::vector<double> mine;
  for (const Vec3* corner : {&off.low, &off.high, &speed.low, &speed.high, &then.low, &then.high})
    mine.insert(mine.end(), corner->data(), corner->data() + 3);
  const std::vector<double> all = s.communicator->all_gather(mine);
  return {.way = diagonal(all, 0), .speed = diagonal(all, 6), .speed_then = diagonal(all, 12)};
}

std::int64_t substeps_to_check(const Simulation& s, const FrameSpan& span, double t, double speed) {
  const double most = (1 - may_have_come) * s.contact_reach;
  std::int64_t n = most_between;
  const auto way = [&] {
    const double time = static_cast<double>(n) * span.dt;
    return speed * time + largest_travel(s.holds, s.tools, t, t + time);
  };
  while (n > 1 && way() > most) n /= 2;
  return n;
}

// Those that were found before and are near still stay: what was outside then and lies inside by
// now knows by them on which side it was. In ascending (node, corners).
void add_pairs(std::span<const TissuePair> before, std::span<const Vec3> x, double near,
               std::vector<TissuePair>& pairs) {
  const auto at = [&](std::int32_t i) { return x[i]; };
  for (const TissuePair& p : before) {
    const Triangle triangle = {at(p.corner[0]), at(p.corner[1]), at(p.corner[2])};
    if (touch_tissue(at(p.node), triangle).distance < near) pairs.push_back(p);
  }
  sort_unique_by(pairs, [](const TissuePair& p) { return std::tie(p.node, p.corner); });
}

// Of velocities of the surface.
double largest_difference(const SurfaceView& view) {
  Box speed;
  for (const std::int32_t node : view.node) speed.add(view.v[node]);
  return speed.size().norm();
}

void swap_views(Simulation& s) {
  std::swap(s.view.x, s.contact->look.view_x);
  std::swap(s.view.v, s.contact->look.view_v);
}

struct SunkNode {
  double depth = 0;  // [m]
  std::int32_t node = -1;
};

template <class Archive>
void visit(Archive& a, SunkNode& n) {
  a(n.depth, n.node);
}

// Nodes that contact has found in other tissue and that lie there deeper than contact_reach now, of
// all ranks, deepest first.
std::vector<SunkNode> find_sunk(const Simulation& s) {
  const ContactSet& set = s.contact->set;
  const std::vector<double> depth = depths_in_tissue(set, s.view.x);
  std::vector<SunkNode> mine;
  for (const std::int32_t place : set.owned)
    if (depth[place] > s.contact_reach) mine.push_back({depth[place], set.node[place]});
  std::vector<SunkNode> sunk = all_gather_items(*s.communicator, mine);
  std::ranges::sort(sunk, {}, [](const SunkNode& n) { return std::pair(-n.depth, n.node); });
  return sunk;
}

}  // namespace

ContactBody contact_body(const Simulation& s) {
  return {.part = s.part,
          .node_owner = s.node_owner,
          .mass = s.mass,
          .fixed = s.fixed,
          .scaling = s.mass_scaling ? &*s.mass_scaling : nullptr};
}

void note_pair_look(Simulation& s, const FrameSpan& span, std::int64_t k) {
  PairLook& look = s.contact->look;
  look.time = span.time(k);
  look.next_check = k;
  look.u.clear();
  look.v.clear();
  for (const std::int32_t local : s.view.local) {
    const auto i = 3 * static_cast<std::ptrdiff_t>(local);
    look.u.insert(look.u.end(), s.state.u.begin() + i, s.state.u.begin() + i + 3);
    look.v.insert(look.v.end(), s.state.v.begin() + i, s.state.v.begin() + i + 3);
  }
}

bool is_pair_look_due(Simulation& s, const FrameSpan& span, std::int64_t k) {
  PairLook& look = s.contact->look;
  if (k < look.next_check) return false;
  const double t = span.time(k);
  const Apart apart = find_apart(s, t);
  look.next_check = k + substeps_to_check(s, span, t, apart.speed);
  const bool is_past = look.time > span.t0 &&
                       (t - look.time) * apart.speed_then > (most_approach - 1) * s.contact_reach;
  return is_past || apart.way > may_have_come * s.contact_reach;
}

void look_for_pairs(Simulation& s, const FrameSpan& span, std::int64_t k) {
  ContactStage& contact = *s.contact;
  const std::int64_t next_check = contact.look.next_check;
  SurfaceView& view = s.view;
  contact.look.view_x.resize(view.x.size(), Vec3::Zero());
  swap_views(s);  // that of the frame's beginning is needed if it is repeated
  gather_surface(view, s.mesh.X, s.state.u, *s.communicator);
  gather_velocities(view, s.state.v, *s.communicator);
  contact.detector.refit(view.x);
  const std::vector<TissuePair> before = contact.tissue;
  const double rest = span.t1 - span.time(k), way = rest * largest_difference(view);
  const double most = most_approach * s.contact_reach;
  detect_tissue(contact, view, way > most ? rest * most / way : rest, s.contact_reach);
  add_pairs(before, view.x, 2 * s.contact_reach, contact.tissue);
  renew_frame_contacts(contact, contact_body(s), s.holds, *s.communicator);
  if (s.energy) begin_contact_work(s);
  note_pair_look(s, span, k);
  contact.look.next_check = next_check;
  swap_views(s);
}

void watch_sunk_tissue(Simulation& s, double time) {
  // Of a frame with an edit, the pairs are of the surface before it.
  if (s.log.told.sunk_tissue || !s.log.new_edits.empty()) return;
  const std::vector<SunkNode> sunk = find_sunk(s);
  if (sunk.empty()) return;
  s.contact->detector.refit(s.view.x);
  const auto it = std::ranges::find_if(
      sunk, [&](const SunkNode& n) { return s.contact->detector.lies_in_other_tissue(n.node); });
  if (it == sunk.end()) return;
  s.log.told.sunk_tissue = true;
  warn_event(s, time,
             "tissue has sunk into other tissue: node " + std::to_string(it->node) + " at " +
                 point_text(s.view.x[it->node]) + " m lies " + short_text(1e3 * it->depth) +
                 " mm deep in it, and contact knows the way out of " +
                 short_text(1e3 * s.contact_reach) +
                 " mm, half an edge; from here on it may pass through. Tissue that moves or is "
                 "pressed less hard, elements that are smaller than it is thick, or a higher "
                 "time.frame_rate keep it out");
}

}  // namespace trocar
