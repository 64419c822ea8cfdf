// Instruments begin outside of the tissue: one that is inside would have to be pushed out. Their
// jaws need time.
#pragma once

#include <string>
#include <vector>

#include "engine/scene.h"
#include "engine/simulation.h"

namespace trocar {

// Throws InputError, naming the first key of its path, if an instrument reaches deeper than
// `allowed` [m] into the body as it lies at time zero. `what`: the body, in the sentence.
void check_instruments_outside(const LoadedScene& loaded, double allowed, const std::string& what,
                               Simulation& s);

// Warns of instruments that are made longer than the scene says (least_length).
void warn_of_short_tools(const Scene& scene);
// Warns of jaws that have to turn round before they have closed or opened.
void warn_of_hasty_jaws(const Scene& scene);
// Warns of turns of 170 degrees or more between two keys: which way round is not said.
void warn_of_half_turns(const Scene& scene);

// Says where instruments go far beside the straight lines between their keys. edge: mean edge
// length of the body [m].
void tell_of_bulges(const std::vector<Tool>& tools, double edge);

}  // namespace trocar
