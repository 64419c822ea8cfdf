// A study with known runs, for tests of what is made of it.
#pragma once

#include "study/study_sweep.h"

namespace trocar {

// Errors and costs as given; one simulated second, a length of 1 m, so that shares are metres.
Run made_up_run(const std::string& method, int n, double error, double seconds);

Study made_up_study();

}  // namespace trocar
