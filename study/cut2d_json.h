// What `trocar cut2d` found, for programs.
#pragma once

#include <string>
#include <vector>

#include "study/cut2d_table.h"

namespace trocar {

std::string trial_json(const Cut2dTrial& trial, const std::string& mode);
std::string rows_json(const std::vector<Cut2dRow>& rows);

}  // namespace trocar
