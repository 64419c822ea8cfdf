#include "study_made_up.h"

namespace trocar {

Run made_up_run(const std::string& method, int n, double error, double seconds) {
  Run run{.method = method, .precision = "double", .size = "n = " + std::to_string(n)};
  run.step_factor = 0.9;
  run.n = n;
  run.outcome = {.value = 1 + error,
                 .h = 1. / n,
                 .dt = 1e-3,
                 .n_elements = n * n * n,
                 .n_steps = 1000,
                 .stepping_seconds = seconds};
  run.error = run.error_length = error;
  return run;
}

Study made_up_study() {
  Study study;
  study.problem = {.name = "made-up",
                   .title = "Made up: a < b & \"c\"",
                   .quantity = "deflection",
                   .unit = "m",
                   .reference = 1,
                   .reference_error = 1e-4,
                   .source = "closed form",
                   .simulated_seconds = 1,
                   .length = 1};
  study.runs = {made_up_run("slow", 2, .08, .1),   made_up_run("slow", 4, .02, 1.6),
                made_up_run("slow", 8, .005, 25),  made_up_run("quick", 2, .1, .01),
                made_up_run("quick", 4, .03, .16), made_up_run("quick", 8, .008, 2.5)};
  return study;
}

}  // namespace trocar
