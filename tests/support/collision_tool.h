// The size of what closed forms of contact are tested with.
#pragma once

namespace trocar {

inline constexpr double tool_radius = 5e-3;     // [m]
inline constexpr double tool_rounding = 1e-15;  // of lengths of about 10 mm [m]

}  // namespace trocar
