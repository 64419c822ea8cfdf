// The cut ledger of the summary, one record a stroke, and what puts edits into it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cutting/cut_figures.h"
#include "mesh/edit.h"

namespace trocar {

struct Simulation;

// How far a blade has gone while it met resistance, and the tissue at its edge with it. [m]
struct BladePush {
  double way = 0, along = 0;
};

// One stroke of a blade, from entry to exit.
struct CutRecord {
  std::string tool;
  double start = 0, end = 0;  // [s]
  CutFigures figures;         // of all edits
  std::int64_t n_edits = 0;
  std::int64_t n_ranks = 0;   // that cut together, at most
  std::int64_t n_askew = 0;   // edits of an edge that did not face its way
  std::int64_t n_pieces = 1;  // of the whole body after the stroke, or so far
  std::int64_t n_elements_added = 0, n_elements_dissolved = 0;
  // Least stable step after / before, of the elements around, worst edit.
  double stable_step_ratio = 1;
  double scene_step_ratio = 1;       // of the whole body, after or so far / before the stroke
  double scene_step_before = 0;      // [s]
  double least_quality = 1;          // of elements around an edit, after it
  double mass_change = 0;            // largest |relative| of an edit
  double momentum_change = 0;        // |P after - P before| / sum |m v| around the cut, largest
  double kinetic_energy_change = 0;  // summed [J]
  double strain_energy_change = 0;   // largest |relative| of the edited elements by an edit
  double blade_travel = 0;           // of the edge's middle with some of it inside [m]
  double deepest = 0;                // of the edge inside [m]
  BladePush push;
  // Of a stroke that has ended in a body in space, see SweptArea. [m^2]
  double swept_area = 0, parted_area = 0;
  double seconds = 0, worst_seconds = 0;  // of all frames, of the longest one
};

// Applies an edit, of which there may be none, and puts it into the stroke's record. Collective.
void note_edit(Simulation& s, const MeshEdit& edit, const CutFigures& figures, CutRecord& record);

}  // namespace trocar
