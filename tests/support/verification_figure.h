// What a verification problem reports: its number beside the reference. Every figure is checked
// against its tolerance; with TROCAR_VERIFICATION_RECORD=<file> it is also appended there as one
// line of JSON, from which scripts/verification makes the table of docs/verification.md.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace trocar {

struct Figure {
  std::string problem;   // "V11 Bonded cube"
  std::string quantity;  // "reaction at +20 % [N]"
  std::string mesh;      // "hex8 8 x 8 x 16"
  double number = 0;     // Trocar's
  double reference = 0;
  double tolerance = 0;  // of the error: relative, or absolute where the reference is 0
  std::string source = "closed form";
  double order = 0;  // of convergence to this mesh from the one before, 0: none
};

// Whether this run makes the report: larger meshes and longer runs are due.
bool is_report();

double error_of(const Figure& figure);

// How far a number may be from its reference, from itself and that of a mesh half as fine: the grid
// convergence index of Roache (J. Fluids Eng. 116, 1994) with his factor 3 for two meshes. The
// error falls by 2^order in theory, so that `fine` would be off by (coarse - fine) / (2^order - 1).
double two_mesh_tolerance(double coarse, double fine, double reference, double order = 2);

void record(const Figure& figure);

void check_figure(const Figure& figure);

}  // namespace trocar
