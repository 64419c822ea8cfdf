// Which rank owns which node: chosen when a run begins, and anew when cuts have upset the balance.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Of s.mesh. Collective.
void choose_owners(Simulation& s);
// Once clusters of scaled mass are whole, too: what later growth of imbalance is compared with.
void note_imbalance(Simulation& s);
// After an edit that took hexahedra apart. Returns whether owners were chosen anew. Collective.
bool rebalance(Simulation& s);

}  // namespace trocar
