#include "study/study_plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "study_made_up.h"

namespace trocar {
namespace {

// What is wrong with the text as XML, "" if it is well-formed: tags close in order, attributes are
// quoted and none occurs twice, and < and & stand for nothing else.
std::string xml_fault(const std::string& text) {
  std::vector<std::string> open;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t tag = text.find('<', at);
    const std::string between = text.substr(at, tag - at);
    for (std::size_t k = between.find('&'); k != std::string::npos; k = between.find('&', k + 1))
      if (between.find(';', k) == std::string::npos || between.find(';', k) > k + 5)
        return "bare & in: " + between;
    if (open.empty() && between.find_first_not_of(" \n") != std::string::npos)
      return "text outside: " + between;
    if (tag == std::string::npos) break;
    std::size_t k = text.find_first_of(" />", tag + 1);
    if (text[tag + 1] == '/') {
      k = text.find('>', tag);
      if (open.empty() || open.back() != text.substr(tag + 2, k - tag - 2)) return "wrong end tag";
      open.pop_back();
      at = k + 1;
      continue;
    }
    open.push_back(text.substr(tag + 1, k - tag - 1));
    std::vector<std::string> names;
    while (text[k] == ' ') {
      const std::size_t equals = text.find('=', k), quote = equals + 1;
      names.push_back(text.substr(k + 1, equals - k - 1));
      if (std::count(names.begin(), names.end(), names.back()) > 1) return "twice: " + names.back();
      if (text[quote] != '"') return "unquoted " + names.back();
      k = text.find('"', quote + 1) + 1;
      if (text.substr(quote, k - quote).find('<') != std::string::npos) return "< in an attribute";
    }
    if (text[k] == '/') {
      open.pop_back();
      ++k;
    }
    if (text[k] != '>') return "tag does not end: " + text.substr(tag, 60);
    at = k + 1;
  }
  return open.empty() ? "" : "never closed: " + open.back();
}

int count_of(const std::string& text, const std::string& word) {
  int n = 0;
  for (std::size_t k = text.find(word); k != std::string::npos; k = text.find(word, k + 1)) ++n;
  return n;
}

std::vector<double> numbers_after(const std::string& text, const std::string& word) {
  std::vector<double> numbers;
  for (std::size_t k = text.find(word); k != std::string::npos; k = text.find(word, k + 1))
    numbers.push_back(std::atof(text.c_str() + k + word.size()));
  return numbers;
}

TEST(StudyPlot, it_is_well_formed_and_has_each_run_once_a_panel) {
  const std::string svg = study_svg(made_up_study());
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(count_of(svg, "class=\"point\""), 2 * 6);
  EXPECT_EQ(count_of(svg, "real time"), 1);
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(xml_fault("<a><b></a></b>"), "");  // the check can fail
}

TEST(StudyPlot, all_points_lie_inside_the_picture) {
  const std::string svg = study_svg(made_up_study());
  for (const double x : numbers_after(svg, "cx=\"")) EXPECT_TRUE(x >= 0 && x <= 1080) << x;
  for (const double y : numbers_after(svg, "cy=\"")) EXPECT_TRUE(y >= 70 && y <= 560) << y;
}

TEST(StudyPlot, equal_ratios_are_equal_distances) {
  // slow at n = 2, 4, 8 has errors of ratio 4 each: the points descend in equal steps.
  const std::vector<double> y = numbers_after(study_svg(made_up_study()), "cy=\"");
  ASSERT_GE(y.size(), 3u);
  EXPECT_NEAR(y[1] - y[0], y[2] - y[1], .11);  // coordinates have one place
  EXPECT_GT(y[1], y[0]);
}

TEST(StudyPlot, runs_that_cannot_be_rated_are_left_out) {
  Study study = made_up_study();
  study.runs[0].outcome.trouble = "inverted";
  study.runs[1].is_reference = true;
  EXPECT_EQ(count_of(study_svg(study), "class=\"point\""), 2 * 4);
  study.runs.clear();
  EXPECT_EQ(xml_fault(study_svg(study)), "");
}

}  // namespace
}  // namespace trocar
