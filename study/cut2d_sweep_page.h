// The sweep of the plane cut's parameters as a page with plots, docs/cutting-parameters.md.
#pragma once

#include <string>
#include <vector>

#include "study/cut2d_sweep.h"

namespace trocar {

// One panel: median (solid) and 5 % quantile (dashed) of the stable step's ratio, a colour a
// setting.
std::string parameter_svg(const Cut2dParameter& parameter);
// File name of the plot, "cutting_exponents.svg".
std::string parameter_file(const Cut2dParameter& parameter);
// Table of one parameter as Markdown, and what follows from it for the robust mode.
std::string parameter_section(const Cut2dParameter& parameter);
std::string sweep_page(const std::vector<Cut2dParameter>& parameters, int n_cuts_a_mesh);

}  // namespace trocar
