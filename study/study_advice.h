// What a study means in one sentence: the cheapest run that keeps a target error.
#pragma once

#include <string>
#include <vector>

#include "study/study_sweep.h"

namespace trocar {

struct Target {
  double error = 0;  // relative, or in metres
  bool is_length = false;
};

// "1 mm", "2 %"; "" is no target. Throws InputError.
Target read_target(const std::string& text);
// Throws InputError for a length where the problem's result is none.
void require_fits(const Target& target, const Problem& problem);
// 1.1 times the median of the errors on the Pareto front: elements that lock would make it a
// useless one.
Target median_target(const Study& study);

// The cheapest sound run within the target, of those that are as fast within the noise of the
// timing (5 % or the spread of repetitions) the most accurate (to 1 %); nullptr if there is none.
// Runs of another method than `other_than` only, if that is not empty. The reference run itself
// never counts.
const Run* cheapest_within(const Study& study, const Target& target,
                           const std::string& other_than = "");
// Sound runs that no other run beats in both error and cost, by cost.
std::vector<const Run*> pareto_front(const Study& study);

// Throws InputError if a length is asked of a problem whose result is none.
std::string advice(const Study& study, const Target& target);

}  // namespace trocar
