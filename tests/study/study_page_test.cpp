#include "study/study_page.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "study_made_up.h"

namespace trocar {
namespace {

std::vector<std::string> page_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(cell);
  return cells;
}

TEST(StudyPage, a_table_has_a_heading_of_its_own_for_each_column) {
  for (const double length : {0., 1.}) {
    Study study = made_up_study();
    study.problem.length = length;
    std::istringstream table(front_table(study));
    std::string head, line;
    std::getline(table, head);
    const std::vector<std::string> names = page_cells(head);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << head;
    while (std::getline(table, line)) EXPECT_EQ(page_cells(line).size(), names.size()) << line;
  }
}

}  // namespace
}  // namespace trocar
