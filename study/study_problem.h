// What a study computes: a problem with a number that is known, or a scene that is compared with
// its own finest run. A case is one point of the sweep, an outcome what it gave and what it cost.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "study/study_method.h"

namespace trocar {

struct Case {
  Method method;
  Precision precision = Precision::in_double;
  double step_factor = 0.9;  // time step / stable step, where there is time
  int n = 4;                 // cells along the edge that the problem names; index of a mesh file
  double sleep = 0;          // scenes: solver.sleep [m]
};

struct Outcome {
  double value = 0;           // [unit of the problem]
  std::vector<Vec3> samples;  // scenes: displacements of the sample points at the sample times [m]
  double h = 0, dt = 0;       // edge of a cell [m], mean time step [s] (0: static)
  std::int64_t n_elements = 0, n_steps = 0;
  double setup_seconds = 0, stepping_seconds = 0;  // processor seconds of one thread
  double least_stepping_seconds = 0;  // of repetitions, of which the above is the median; 0: none
  std::string trouble;                // "" if the run is sound
};

struct Problem {
  std::string name, title;
  std::string quantity, unit;                    // "force on the indenter", "N"
  double reference = 0;                          // [unit]
  double reference_error = 0;                    // relative
  std::string source;                            // of the reference
  bool is_scene = false;                         // compared with its own finest run
  double simulated_seconds = 0;                  // 0: static
  double length = 0;                             // of a relative error of 1 [m]; 0: not a length
  std::vector<int> sizes;                        // of the default sweep
  std::string size_meaning;                      // "cells over the half width"
  int size_multiple = 1;                         // sizes are multiples of this
  double growth = 4;                             // cost ~ n^growth, edges^-growth
  std::vector<double> edges;                     // of mesh files 1, 2, … [m]; empty: ~ 1 / n
  std::vector<Method> methods;                   // that can compute it
  std::vector<double> factors;                   // of the default sweep
  std::vector<double> sleeps = {0};              // scenes: solver.sleep [m]
  std::function<std::string(int n)> size_label;  // empty: "n = 8"
  std::function<Outcome(const Case&)> solve;

  bool is_static() const { return simulated_seconds == 0; }
};

// The built-in problems, one file each.
Problem problem_indentation();
Problem problem_bonded_cube();
Problem problem_lame_mode();
Problem problem_bending_column();

std::vector<Problem> built_in_problems();

// Methods for bodies in space.
std::vector<Method> solid_methods();

}  // namespace trocar
