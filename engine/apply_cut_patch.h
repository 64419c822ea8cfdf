// The stable step after an edit. The highest modes of a mesh are local: one that the edit made
// faster is found in a patch, the edited elements and some rings around them with all else held.
// With the step known before, which holds for the rest, that takes a time of the patch's size.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/apply_cut.h"
#include "mesh/sub_mesh.h"

namespace trocar {

// A body of this rank's own; every rank makes the same one, so that nobody waits for another.
struct Patch : RankBody {
  SubMesh sub;
};

// Rings of nodes around the edited elements that move in a patch; apply_cut_patch_test.cpp prints
// what others give.
inline constexpr int patch_rings = 3;

// After the edit: the state of all nodes, and copies of the history (history.h) of the elements
// that `parent` names, times `scale`.
struct PatchState {
  const GlobalState& global;
  std::span<const double> history;
  std::span<const std::int32_t> parent;  // (n_elements)
  std::span<const double> scale;         // (n_elements)
  int n_rings = patch_rings;
};
std::unique_ptr<Patch> make_patch(const Simulation& s, std::span<const std::int32_t> edited,
                                  const PatchState& state);

// Where the energies that an edit changes are: the edited elements, with those around them if they
// share nodes of split hexahedra or averaged pressures. With a ledger, all that the forces of their
// corners depend on. Before the edit or after it; nodes: the corners of both, ascending.
std::vector<std::int32_t> elements_of_energy(const Simulation& s, const MeshEdit& edit,
                                             std::span<const std::int32_t> edited,
                                             std::span<const std::int32_t> nodes);
// Of these elements, with the velocities of `state`, without scaled masses, supports alone held:
// what an edit changes of the body's energy it changes of this one.
std::unique_ptr<Patch> make_patch_of(const Simulation& s, std::span<const std::int32_t> elements,
                                     const PatchState& state);
// Strain and hourglass energy of the present displacement. [J]
double strain_energy(RankBody& body);
// All that an energy ledger counts, less overstress of viscous elements. [J]
double patch_energy(Patch& patch);

// Least bounds of its elements and, if the scene's step is a frequency's and they are below that of
// s.watch, the step of its highest frequency; elements by their numbers in the mesh.
Watch watch_patch(const Simulation& s, Patch& patch);

// The body's watch, where it is of before the edit, as it is after it: the smaller of both steps is
// stable (by the margin of the search), and from here on what the elements stiffen counts. The
// scene has no multirate, whose step does not follow from its elements alone.
void watch_edit(Simulation& s, std::span<const std::int32_t> edited, const PatchState& state);

}  // namespace trocar
