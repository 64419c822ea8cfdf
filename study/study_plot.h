// The work-precision plot of a study as SVG: error against processor time, and against
// element-steps, which no machine changes. One curve a method through the sizes.
#pragma once

#include <string>

#include "study/study_sweep.h"

namespace trocar {

std::string study_svg(const Study& study);

}  // namespace trocar
