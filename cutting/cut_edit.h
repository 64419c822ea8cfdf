// A decided cut as a change of the mesh, as figures, and as what its stroke remembers.
#pragma once

#include "cutting/cut_figures.h"
#include "cutting/cut_survey.h"
#include "mesh/edit.h"

namespace trocar {

MeshEdit make_edit(const Mesh& mesh, const TetCut& cut);
CutFigures make_figures(const TetCut& cut, bool is_last);
// mesh: before the edit; copies are numbered from its end.
void remember(const TetCut& cut, const Mesh& mesh, CutStroke& stroke);

}  // namespace trocar
