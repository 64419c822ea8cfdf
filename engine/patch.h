// A part of the body as one of its own. The highest modes of a mesh are local: one that an edit or
// a deformation made faster is found in a patch, the elements that changed and some rings around
// them with all else held. With the step known before, which holds for the rest, that takes a time
// of the patch's size.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/global_state.h"
#include "engine/simulation.h"
#include "mesh/sub_mesh.h"
#include "solver/history.h"

namespace trocar {

// A body of this rank's own; every rank makes the same one, so that nobody waits for another.
struct Patch : RankBody {
  SubMesh sub;
};

// Rings of nodes around the changed elements that move in a patch; patch_test.cpp prints
// what more give.
inline constexpr int patch_rings = 1;

// After the edit: the state of nodes, which gets those of the patch (all of these collective),
// copies of history (history.h; none without viscosity) and the origins of all elements of the
// patch.
struct PatchState {
  GlobalState& global;
  std::span<const double> history = {};
  const ElementOrigins* origins = nullptr;
};
std::unique_ptr<Patch> make_patch(const Simulation& s, std::span<const std::int32_t> edited,
                                  const PatchState& state);

// These elements and the rings around them as they are, their nodes' velocities zero, without
// history; null if these are more than `most` elements. Collective.
std::unique_ptr<Patch> make_present_patch(const Simulation& s,
                                          std::span<const std::int32_t> elements, std::size_t most);
// The same of the elements that have these nodes.
std::unique_ptr<Patch> make_present_patch_around(const Simulation& s,
                                                 std::span<const std::int32_t> nodes,
                                                 std::size_t most);

// All that the forces of these nodes depend on: pressures averaged at nodes take one ring more.
std::vector<std::int32_t> elements_of_forces(const Simulation& s,
                                             std::span<const std::int32_t> nodes);

// All elements of a patch around edited elements that have these nodes.
std::vector<std::int32_t> elements_of_patch(const Simulation& s,
                                            std::span<const std::int32_t> nodes);

// Of all elements that the nodes' forces depend on, everything but these nodes held, with the
// velocities of `state`: what an edit changes of the body's energy it changes of this one, for the
// same nodes before and after (all corners of edited elements, before and after). [J]
double patch_energy(const Simulation& s, std::span<const std::int32_t> nodes,
                    const PatchState& state);

// These elements alone, without scaled masses; nothing but supports is held.
std::unique_ptr<Patch> make_patch_of(const Simulation& s, std::span<const std::int32_t> elements,
                                     const PatchState& state);

// The body's watch, where it is of before the edit, as it is after it: the smaller of both steps is
// stable (by the margin of the search), and from here on what the elements stiffen counts. Local
// steps, if there are any, are as they were beyond the edited elements.
void watch_edit(Simulation& s, std::span<const std::int32_t> edited, const PatchState& state);

}  // namespace trocar
