// One table: configuration, promise, kept or not. Exit code 1 if a promise is broken.
// stability [share of the full step counts, 1] [--markdown FILE]
#include "stability.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

using namespace trocar;

static constexpr const char* introduction = R"(# Stability, stress-tested

Written by `build/release/bench/stability 1 --markdown docs/stability.md` (10 s on one core).

The limit of a step is 2/omega of the present deformation, searched for by `solver/frequency` (steps around it: sharp to a percent). How far below it a step must stay was measured, too:
central differences have a third-order resonance where omega dt / 2 = sin(pi/3) = 0.866. A mode of that frequency grows without bound as soon as the strain energy has a cubic term and the
mode is excited at all: by noise in double, by rounding alone in single precision (80,129 steps). A step of 0.9 of the limit leaves modes below the highest one in the resonance, and
diverged in single precision after 158,099 steps of a block whose mode at 0.957 of the highest frequency it met; steps below 0.866 leave none. Hence `solver.step_factor = 0.85`.

)";

static std::string row_text(const StabilityRow& row) {
  return "| " + row.configuration + " | " + row.promise + " | " + row.measured + " | " +
         (row.is_kept ? "kept" : "**not kept**") + " |\n";
}

int main(int argc, char** argv) {
  double scale = 1;
  std::string file;
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--markdown") == 0 && k + 1 < argc)
      file = argv[++k];
    else
      scale = std::atof(argv[k]);
  }
  if (!(scale > 0)) {
    std::fprintf(stderr, "usage: stability [share of the full step counts] [--markdown FILE]\n");
    return 2;
  }
  std::string table = "| configuration | promise | measured | |\n|---|---|---|---|\n";
  std::printf("%s", table.c_str());
  int n_broken = 0;
  for (const StabilityCase run :
       {steps_around_the_limit, third_order_resonance, nearly_incompressible, confined_compression,
        inversion_and_recovery, nodal_noise, stiffness_jumps, slivers, free_fall, long_vibration,
        non_finite_values})
    for (const StabilityRow& row : run(scale)) {
      const std::string text = row_text(row);
      std::printf("%s", text.c_str());
      std::fflush(stdout);
      table += text;
      n_broken += row.is_kept ? 0 : 1;
    }
  if (!file.empty()) std::ofstream(file) << introduction << table;
  return n_broken == 0 ? 0 : 1;
}
