// Stress, and with it hourglass forces, of elements that relax.
#pragma once

#include "solver/block_ranges.h"

namespace trocar {

// In place of the strains of the task in the stash, which is of these blocks; their history
// ([block][number][lane]) goes to the present.
void put_viscous_stress(const ElementBlocks& blocks, const BlockKernels& kernels,
                        const BlockTask& task, const ViscousStep& step, double* history);

}  // namespace trocar
