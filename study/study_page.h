// docs/accuracy.md: the built-in problems with their plots, Pareto fronts and advice.
#pragma once

#include <string>
#include <vector>

#include "study/study_sweep.h"

namespace trocar {

// The Pareto front as a table in Markdown.
std::string front_table(const Study& study);
// `image_folder` is relative to the page; plots are called accuracy_<problem>.svg.
std::string accuracy_page(const std::vector<Study>& studies, const std::string& image_folder);

}  // namespace trocar
