// Numbers that can be computed with but are hardly meant: a unit that slipped, as a rule.
#pragma once

#include "engine/scene.h"

namespace trocar {

// Warns of densities that no tissue has, of gravity of more than ten times the Earth's, and of
// keys of paths between which instruments or supports are faster than any hand.
void warn_of_implausible(const Scene& scene);

}  // namespace trocar
