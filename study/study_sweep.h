// All cases of a sweep, coarse ones first, each with its error and its cost.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "study/study_problem.h"

namespace trocar {

struct SweepOptions {
  std::vector<int> sizes;               // empty: the problem's
  std::vector<std::string> elements;    // empty: all that fit the problem
  std::vector<std::string> precisions;  // empty: both
  std::vector<double> step_factors;     // empty: the problem's; unused where nothing moves in time
  double budget = std::numeric_limits<double>::infinity();  // [s] of processor time
  int repeats = 3;                                          // of runs below short_run; tests take 1
};

inline constexpr double short_run = 0.3;  // [s]

struct Run {
  std::string method, precision, size;  // "hex8", "double", "n = 8"
  double step_factor = 0;               // 0: static
  double sleep = 0;                     // [m]
  int n = 0;
  Outcome outcome;
  double error = 0;              // relative, not below the reference's own; infinite if broken
  double error_length = 0;       // the same in metres, 0: not a length
  bool is_at_reference = false;  // the difference is below the reference's own error
  bool is_reference = false;     // this run is what the others are compared with
};

struct Study {
  Problem problem;  // for scenes reference and reference_error are those of the sweep
  std::vector<Run> runs;
  std::vector<std::string> notes;  // what was left out and why
};

Study sweep(const Problem& problem, const SweepOptions& options);

// Errors of all runs, from values or samples; scenes get their reference here: of the runs with
// the finest mesh the one that refinement of its own method changed least.
void rate(Study& study);

bool is_sound(const Run& run);
// "hex8 single, step factor 0.9, sleep 0.1 mm"
std::string method_text(const Run& run);
// The same with its size: "hex8 single, step factor 0.9, n = 8"
std::string case_text(const Run& run);
// Processor seconds per second that the run simulated; of the whole run where nothing moves in
// time. Of sound runs.
double cost_of(const Study& study, const Run& run);
double element_steps(const Run& run);

}  // namespace trocar
