// Which instruction set the kernels run with. The scalar instance is the one that the others are
// compared with.
#pragma once

#include "solver/kernels.h"

namespace trocar {

enum class Simd { scalar, sse2, avx2, avx512 };
inline constexpr int n_simd = 4;

const char* name_of(Simd simd);
bool is_supported(Simd simd);  // by this machine
const Kernels& kernels_of(Simd simd);

// The one picked by select_simd (step.h), else the widest that the machine has. Tables of others
// may hold instructions that the machine has not, and so may what makes them.
Simd active_simd();
const Kernels& active_kernels();

}  // namespace trocar
