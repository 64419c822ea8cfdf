// Table 1 of Serby, Harders and Szekely 2001 again, the printed figures beside ours.
#pragma once

#include <string>
#include <vector>

#include "study/cut2d_trial.h"

namespace trocar {

struct Cut2dRow {
  int configuration = 0;  // 0: a mesh of the user
  std::string kind;       // "I", "OR", "NR"
  std::string source;     // "printed", "ours", "published mode", "robust mode"
  PlaneStatistics statistics;
  double best_seconds = 0, median_seconds = 0;  // 0: not given
  std::string note;
};

// All rows, each configuration cut along its path in every mode; times over so many repetitions.
std::vector<Cut2dRow> paper_rows(int repetitions);

// Decimals of the paper: area 2, edges 1. "#" marks what differs from the printed line of rows I
// and OR, which nothing is free in; rows NR depend on where the paper cut.
std::string rows_text(const std::vector<Cut2dRow>& rows);
std::string rows_markdown(const std::vector<Cut2dRow>& rows);

}  // namespace trocar
