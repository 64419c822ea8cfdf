// A study as a table: CSV for spreadsheets, JSON for programs. nlohmann-json is seen by
// study_table.cpp and cut2d_json.cpp.
#pragma once

#include <string>

#include "study/study_sweep.h"

namespace trocar {

// One line a run, after a line of names; empty cells where there is nothing to say.
std::string study_csv(const Study& study);
// The problem with its reference, the runs, the notes and the sentence of advice.
std::string study_json(const Study& study, const std::string& advice);

}  // namespace trocar
