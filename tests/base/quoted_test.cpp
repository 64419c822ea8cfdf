#include "base/quoted.h"

#include <gtest/gtest.h>

#include <random>

namespace trocar {
namespace {

// The definition, without a table: every way to align the two texts.
std::size_t distance_by_definition(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::size_t replaced =
      distance_by_definition(a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1);
  std::size_t least = std::min({replaced, distance_by_definition(a.substr(1), b) + 1,
                                distance_by_definition(a, b.substr(1)) + 1});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
    least = std::min(least, distance_by_definition(a.substr(2), b.substr(2)) + 1);
  return least;
}

TEST(EditDistance, equals_its_definition_for_random_words) {
  std::mt19937 random(3);
  const auto word = [&] {
    std::string text(random() % 6, 'a');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  for (int i = 0; i < 500; ++i) {
    const std::string a = word();
    const std::string b = word();
    EXPECT_EQ(edit_distance(a, b), distance_by_definition(a, b)) << a << " " << b;
  }
}

TEST(EditDistance, counts_a_swap_as_one) {
  EXPECT_EQ(edit_distance("denstiy", "density"), 1u);
}

TEST(NearestName, is_the_first_of_the_nearest) {
  const std::string names[] = {"length", "density", "dentist"};
  EXPECT_EQ(nearest_name("densty", names), "density");
  EXPECT_EQ(nearest_name("den", names), "density");
  const std::string sides[] = {"x-", "z-"};
  EXPECT_EQ(nearest_name("Z-", sides), "z-");
  EXPECT_EQ(nearest_name("x", {}), "");
  EXPECT_EQ(nearest_name(std::string(1 << 20, 'x'), names), "");
}

TEST(NearestName, is_none_where_more_than_a_third_of_the_letters_differ) {
  const std::string names[] = {"gravity", "lame-mode"};
  EXPECT_EQ(nearest_name("gravty", names), "gravity");
  EXPECT_EQ(nearest_name("gvarity", names), "gravity");
  EXPECT_EQ(nearest_name("zzzqqq", names), "");
  EXPECT_EQ(nearest_name("mode", names), "");
}

TEST(InQuotes, cuts_between_characters_and_hides_control_characters) {
  EXPECT_EQ(in_quotes("a\nb"), "\"a?b\"");
  std::string umlauts;
  for (int i = 0; i < 50; ++i) umlauts += "ü";  // 2 bytes each
  EXPECT_EQ(in_quotes("x" + umlauts), "\"x" + umlauts.substr(0, 58) + "…\"");
}

TEST(NamesHint, says_what_is_near_and_what_there_is) {
  const std::vector<std::string> names = {"top", "bottom"};
  EXPECT_EQ(names_hint("botom", names),
            "; the nearest is \"bottom\"; there are \"top\", \"bottom\"");
  EXPECT_EQ(names_hint("left", names), "; there are \"top\", \"bottom\"");
  EXPECT_EQ(names_hint("left", {}), "; there are none");
  EXPECT_TRUE(
      names_hint("left", std::vector<std::string>(23, "a")).ends_with(", \"a\" and 3 more"));
}

TEST(Letters, of_ascii_alone_become_small_or_capital) {
  EXPECT_EQ(in_small_letters("AzÄ_9Z"), "azÄ_9z");
  EXPECT_EQ(in_capital_letters("AzÄ_9a"), "AZÄ_9A");
}

TEST(FirstCharacters, are_whole_ones_of_utf_8) {
  const std::string_view text = "aä€😀b";
  EXPECT_EQ(n_characters(text), 5u);
  EXPECT_EQ(first_characters(text, 0), "");
  EXPECT_EQ(first_characters(text, 2), "aä");
  EXPECT_EQ(first_characters(text, 4), "aä€😀");
  EXPECT_EQ(first_characters(text, 6), text);
}

}  // namespace
}  // namespace trocar
