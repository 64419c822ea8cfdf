#include "study/study_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "study_made_up.h"

namespace trocar {
namespace {

// Cells of a line; quotes as in RFC 4180.
std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"') {
      if (is_quoted && k + 1 < line.size() && line[k + 1] == '"')
        cells.back() += line[k++];
      else
        is_quoted = !is_quoted;
    } else if (line[k] == ',' && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[k];
    }
  }
  return cells;
}

Study study_with_trouble() {
  Study study = made_up_study();
  study.runs[2].outcome.trouble = "inverted, \"badly\"";
  study.runs[2].error = std::numeric_limits<double>::infinity();
  study.notes = {"one left out"};
  return study;
}

TEST(StudyTable, json_gives_back_what_the_study_holds) {
  const Study study = study_with_trouble();
  const nlohmann::json all = nlohmann::json::parse(study_json(study, "use \"quick\""));
  EXPECT_EQ(all["advice"], "use \"quick\"");
  EXPECT_EQ(all["notes"], nlohmann::json::array({"one left out"}));
  EXPECT_EQ(all["problem"]["title"], study.problem.title);
  EXPECT_EQ(all["problem"]["reference_relative_error"], study.problem.reference_error);
  ASSERT_EQ(all["runs"].size(), study.runs.size());
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const auto& run = study.runs[k];
    const nlohmann::json& row = all["runs"][k];
    EXPECT_EQ(row["elements"], run.method);
    EXPECT_EQ(row["size"], run.size);
    EXPECT_EQ(row["h_m"], run.outcome.h);
    EXPECT_EQ(row["element_steps"], element_steps(run));
    EXPECT_EQ(row["stepping_cpu_s"], run.outcome.stepping_seconds);
    EXPECT_EQ(row["relative_error"].is_null(), k == 2);
    if (k != 2) {
      EXPECT_EQ(row["relative_error"], run.error);
    }
  }
  EXPECT_EQ(all["runs"][2]["trouble"], study.runs[2].outcome.trouble);
}

TEST(StudyTable, csv_has_the_same_cells_as_json) {
  const Study study = study_with_trouble();
  const nlohmann::ordered_json all = nlohmann::ordered_json::parse(study_json(study, ""));
  std::stringstream csv(study_csv(study));
  std::string line;
  std::getline(csv, line);
  const std::vector<std::string> names = csv_cells(line);
  std::size_t n_rows = 0;
  while (std::getline(csv, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    ASSERT_EQ(cells.size(), names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      const nlohmann::ordered_json& value = all["runs"][n_rows][names[k]];
      const std::string text = value.is_null()     ? ""
                               : value.is_string() ? value.get<std::string>()
                                                   : value.dump();
      EXPECT_EQ(cells[k], text) << names[k];
    }
    ++n_rows;
  }
  EXPECT_EQ(n_rows, study.runs.size());
  EXPECT_EQ(names.size(), all["runs"][0].size());
}

}  // namespace
}  // namespace trocar
