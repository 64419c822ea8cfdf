// Doubles and singles in a register of the instruction set that is being compiled.
#pragma once

namespace trocar {

namespace scalar {
inline constexpr int doubles = 1, singles = 1;
}
namespace sse2 {
inline constexpr int doubles = 2, singles = 4;
}
namespace avx2 {
inline constexpr int doubles = 4, singles = 8;
}
namespace avx512 {
inline constexpr int doubles = 8, singles = 16;
}

}  // namespace trocar
