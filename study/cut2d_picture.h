// Plane meshes as SVG, drawn as in Figs. 1 to 3 of Serby, Harders and Szekely 2001.
#pragma once

#include <string>

#include "study/cut2d_trial.h"

namespace trocar {

// Edges thin, outline thick, sides of cuts red, the paths dashed blue; cut nodes are marked.
std::string mesh_svg(const Mesh& mesh, const std::vector<Cut2dPath>& paths,
                     const std::string& title);

}  // namespace trocar
