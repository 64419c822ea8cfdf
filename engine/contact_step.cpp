#include "engine/contact_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/sort_unique.h"
#include "collision/contact_tilt.h"
#include "engine/body_search.h"
#include "engine/gather_items.h"
#include "engine/local_steps.h"
#include "engine/part_search.h"
#include "engine/patch.h"

namespace trocar {

template <class Archive>
static void visit(Archive& a, Tilt& tilt) {
  a(tilt.place, tilt.edge, tilt.normal, tilt.turn);
}

namespace {

// Of 2 / omega of elements and contact together. The squares of both frequencies add up to more
// than the square of that: as much where they meet in one place, as in tetrahedra, but the fastest
// modes of hexahedra don't tilt their faces.
constexpr double most_of_limit = 0.98;

// On every rank; places are those of the mesh. Collective.
std::vector<Tilt> tilts_of_all(const Simulation& s, std::vector<Tilt> mine) {
  for (Tilt& tilt : mine)
    for (std::int32_t& place : tilt.place) place = s.contact->set.node[place];
  return all_gather_items(*s.communicator, mine);
}

std::vector<std::int32_t> corners_of(std::span<const Tilt> tilts) {
  std::vector<std::int32_t> nodes;
  for (const Tilt& tilt : tilts) nodes.insert(nodes.end(), tilt.place.begin(), tilt.place.end());
  sort_unique(nodes);
  return nodes;
}

// Adds the tilts' forces to those of the patch's elements; places are those of the patch.
void add_tilt_forces(std::span<const Tilt> tilts, const State& start, const std::vector<double>& u,
                     std::vector<double>& force) {
  for (const Tilt& tilt : tilts) {
    std::array<Vec3, 3> moved, of_tilt{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t k = 3 * static_cast<std::size_t>(tilt.place[a]);
      moved[a] = Vec3::Map(&u[k]) - Vec3::Map(&start.u[k]);
    }
    add_tilt_force(tilt, moved, of_tilt);
    for (std::size_t a = 0; a < 3; ++a)
      Vec3::Map(&force[3 * static_cast<std::size_t>(tilt.place[a])]) += of_tilt[a];
  }
}

// 2 / omega of the tissue around the contact and of this together, less the search's margin; 0 if
// the search doesn't end or has more than `most` elements. Collective.
double search_around(const Simulation& s, std::vector<Tilt> tilts, double enough,
                     std::size_t most) {
  const std::unique_ptr<Patch> patch = make_present_patch_around(s, corners_of(tilts), most);
  if (!patch) return 0;
  for (Tilt& tilt : tilts)
    for (std::int32_t& place : tilt.place) place = place_in(patch->sub.node, place);
  const auto with_tilts = [&](const std::vector<double>& u, std::vector<double>& force) {
    add_tilt_forces(tilts, patch->state, u, force);
  };
  return search_step(*patch, search_amplitude(s.model, s.edge_length), Communicator(), enough,
                     with_tilts);
}

// As many elements as may be searched for less than the steps of a frame that are lost otherwise.
std::size_t elements_worth(const Simulation& s, const FrameSpan& span, double lost) {
  constexpr double steps_of_search = 100;  // which makes its patch, too
  return static_cast<std::size_t>(lost * static_cast<double>(span.n_substeps) *
                                  s.mesh.n_elements() / steps_of_search);
}

}  // namespace

double step_limit_of_contact(Simulation& s, const FrameSpan& span) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (!s.contact) return none;
  const double stable = step_share(s) * s.watch.stable_step;
  const PhaseScope scope(s.timers, phase_watch);
  const std::vector<Tilt> tilts = find_tilts(s.contact->detector, span.n_substeps, s.contact->set);
  const double of_contact = s.communicator->all_max(tilt_frequency2(tilts, s.contact->set));
  const double room = most_of_limit / s.step_factor;
  const double sum = room * stable / std::sqrt(1 + of_contact * stable * stable / 4);
  if (sum >= stable) return none;
  if (!can_search_part(s)) return sum;
  const double found = room * search_around(s, tilts_of_all(s, tilts), stable / room,
                                            elements_worth(s, span, stable / sum - 1));
  return found >= stable ? none : std::max(sum, found);
}

}  // namespace trocar
