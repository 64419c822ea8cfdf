// The order in which a step sums the corner forces of nodes.
#pragma once

#include "solver/model.h"

namespace trocar {

// Fills sum_node, sum_first_block and sum_last_block of a model with blocks and n_owned.
void order_sums(Model& model);

}  // namespace trocar
