// What is looked at after the substeps of a frame.
#pragma once

#include <string>

#include "engine/simulation.h"

namespace trocar {

// Stable step over that of the undeformed mesh below which an element counts as crushed. A frame
// then costs hundreds of times as much, and det F reaches zero next: a body held too near its
// supports ran 11 minutes for one frame. Sound runs stay above 1/10.
inline constexpr double crushed_step = 0.01;

// Strain since the last look at the elements below which they are not looked at again: det F and
// the stable step, which has the margin of solver.step_factor, differ by less than a percent.
inline constexpr double unseen_strain = 2e-3;

// Sets s.watch to that of all ranks: nodes always, elements if they may have been strained. Ends
// the last step's exchange; with an energy ledger, volume changes averaged at nodes become those of
// the present displacement. Elements are looked at while the forces of the next step are computed.
// Collective.
void watch_state(Simulation& s);
// Whether forces of a frame's end are those of the next one's first step: sleeping elements have
// none, histories keep their time, and averages at nodes are exchanged in every step.
bool keeps_forces(const Simulation& s);
// Of all nodes of all ranks. Collective. [m/s]
double largest_speed(const Simulation& s);
// Sets s.watch to whether all is finite now and which element is the most compressed, and keeps no
// look at it. Collective.
void look_for_inversion(Simulation& s);
// A sentence with element or node and cause, "" if all is well. The same on every rank.
std::string find_trouble(const Simulation& s);

}  // namespace trocar
