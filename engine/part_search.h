// The stable step where a few elements have stiffened, under an instrument, say: a search of these
// and of what is around them takes a time of theirs, not of the body's.
#pragma once

#include <span>
#include <vector>

#include "engine/simulation.h"

namespace trocar {

// Growth of an element's omega^2 over that of the last search beyond which the part that has grown
// is searched.
inline constexpr double most_growth_of_part = 1.05;
// What has grown by more than this is the part.
inline constexpr double least_growth_of_part = 1.0125;
// The body instead, if the part with what is around it has more than this share of the elements, or
// where the body was searched more than so many steps ago: it may have softened.
inline constexpr double largest_part = 1.0 / 8;
inline constexpr std::int64_t most_steps_of_parts = 1000;

template <class Archive>
void visit(Archive& a, GrownElement& e) {
  a(e.element, e.stiffening);
}

// A part has neither history nor nodes that sleep, take substeps or have scaled masses.
bool can_search_part(const Simulation& s);
// Growth of the body's omega^2 since the last search of the whole body where its elements have
// grown by `growth` at most: less than that if the fastest mode around the most grown ones is known
// from a search, whose elements then count from there. Collective.
double search_grown_part(Simulation& s, double growth);

// Puts what was searched later in its place among the stiffening of a rank's elements.
void take_searched(const Part& part, std::span<const GrownElement> searched,
                   std::vector<double>& stiffening);

}  // namespace trocar
