// The stable step from searches for the highest frequency of the body, and what elements have
// stiffened since.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/simulation.h"
#include "solver/frequency.h"

namespace trocar {

// With stable_step = "frequency" the step is that of a search for the body's highest frequency,
// less by the root of the largest growth of an element's omega^2 since then: that of the body has
// grown by no more (docs/architecture-measured.md). Beyond this growth the body is searched
// again, as the most stiffened element may be one that does not set the step, and after so many
// steps, as what has softened is not seen. A search takes as long as some 20 steps.
inline constexpr double most_growth = 1.1;
inline constexpr std::int64_t most_steps_of_search = 3000;

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
// The same after a look at the elements, with what they have stiffened since the last search or
// nothing; without a search the step is 0.
void note_look(Simulation& s, double step, std::vector<double> stiffening);
// Whether the step follows from the last search of the body.
bool follows_search(const Simulation& s);
// The step of the last search, less by what any element has stiffened since (`growth`, at most of
// this rank); a new search where that is much, or where the last one was long ago and the tissue
// may have softened again. Collective. [s]
double step_by_frequency(Simulation& s, double growth);

}  // namespace trocar
