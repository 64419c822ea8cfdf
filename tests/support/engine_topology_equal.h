// All that follows from mesh and owners, compared part by part.
#pragma once

#include "engine/simulation.h"

namespace trocar {

void expect_equal(const Part& a, const Part& b);
void expect_equal(const Surface& a, const Surface& b);
void expect_equal(const MassScaling& a, const MassScaling& b);
void expect_equal(const Sleep& a, const Sleep& b);
void expect_equal(const LocalStepPlan& a, const LocalStepPlan& b);
void expect_equal(const MultiRate& a, const MultiRate& b);
void expect_equal(const Halo& a, const Halo& b);

}  // namespace trocar
