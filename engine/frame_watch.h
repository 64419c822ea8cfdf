// What is looked at after the substeps of a frame, and what is done about trouble.
#pragma once

#include <limits>
#include <string>

#include "engine/simulation.h"
#include "solver/frequency.h"

namespace trocar {

inline constexpr int most_roll_backs = 4;
// Stable step over that of the undeformed mesh below which an element counts as crushed. A frame
// then costs hundreds of times as much, and det F reaches zero next: a body held too near its
// supports ran 11 minutes for one frame. Sound runs stay above 1/10.
inline constexpr double crushed_step = 0.01;

// Strain since the last look at the elements below which they are not looked at again: det F and
// the stable step, which has the margin of solver.step_factor, differ by less than a percent.
inline constexpr double unseen_strain = 2e-3;

// With stable_step = "frequency" the step is that of a search for the body's highest frequency,
// less by the root of the largest growth of an element's omega^2 since then: that of the body has
// grown by no more (docs/architecture-measured.md). Beyond this growth the body is searched
// again, as the most stiffened element may be one that does not set the step, and after so many
// steps, as what has softened is not seen. A search takes as long as some 20 steps.
inline constexpr double most_growth = 1.1;
inline constexpr std::int64_t most_steps_of_search = 3000;

// Counts the time of its own life as that of element forces, but what it waits for neighbours as
// exchange.
class ForceScope {
 public:
  explicit ForceScope(Simulation& s);
  ~ForceScope();
  ForceScope(const ForceScope&) = delete;
  ForceScope& operator=(const ForceScope&) = delete;

 private:
  Simulation& s_;
  double start_, waited_;
};

// Sets s.watch to that of all ranks: nodes always, elements if they may have been strained. Ends
// the last step's exchange; with an energy ledger, volume changes averaged at nodes become those of
// the present displacement. Elements are looked at while the forces of the next step are computed.
// Collective.
void watch_state(Simulation& s);
// 2 / omega of the body's highest frequency less the search's margin; 0 if the search doesn't end.
// It starts from nothing: modes are local, and a search that starts where the fastest one was does
// not see another that has overtaken it elsewhere (docs/architecture-measured.md). One that clearly
// gives more than `enough` ends early, with some step above it. more: adds forces to those of
// elements. Collective. [s]
double search_step(RankBody& body, double amplitude, const Communicator& communicator,
                   double enough = std::numeric_limits<double>::infinity(),
                   const ForceOfDisplacement& more = {});
// Takes the present state, where `step` is stable [s], for the one that the step follows from.
void follow_from_here(Simulation& s, double step);
// s.look.stiffening, from s.look.u(). Collective.
void find_stiffening_at_look(Simulation& s);
// Forces of a step dt in place of those at this moment, with solver.multirate. Collective.
void refine_forces(Simulation& s, double dt);
// s.loads as they act at a time [s] on the body as it is.
void find_loads_at(Simulation& s, double time);
// Of all nodes of all ranks. Collective. [m/s]
double largest_speed(const Simulation& s);
// Sets s.watch to whether all is finite now and which element is the most compressed, and keeps no
// look at it. Collective.
void look_for_inversion(Simulation& s);
// A sentence with element or node and cause, "" if all is well. The same on every rank.
std::string find_trouble(const Simulation& s);
// Notes that the frame is done again with the stable step of its end, which its own exceeded;
// throws as roll_back does.
void repeat_frame(Simulation& s, const FrameSpan& span, int tries);
// Halves the step for what follows; throws SimulationError after most_roll_backs tries, which says
// where and beside what. `failed`: of the frame. Collective.
void roll_back(Simulation& s, const FrameSpan& span, const Watch& failed,
               const std::string& trouble, int tries);

// Until the deadline of the frame that has been computed, by the monotonic clock [s]; frame k's is
// k frames after the start, however late others were. Negative: it is past.
double left_of_frame(const Simulation& s, double now);
// Sleeps until the frame's deadline if the scene runs in real time, and counts a miss.
void wait_for_deadline(Simulation& s);

}  // namespace trocar
