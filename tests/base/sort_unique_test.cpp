#include "base/sort_unique.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace trocar {
namespace {

// Of `count` numbers within [least, greatest].
std::vector<std::int32_t> some_numbers(std::size_t count, std::int32_t least,
                                       std::int32_t greatest) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> number(least, greatest);
  std::vector<std::int32_t> values(count);
  for (std::int32_t& value : values) value = number(random);
  return values;
}

constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min(),
                       highest = std::numeric_limits<std::int32_t>::max();

// Few and many numbers, close together (by bits) and far apart (by sorting).
TEST(SortUnique, leaves_each_number_once_and_ascending) {
  for (const std::size_t count : {0U, 1U, 63U, 64U, 65U, 5000U})
    for (const auto& [least, greatest] : std::vector<std::pair<std::int32_t, std::int32_t>>{
             {7, 7}, {0, 63}, {0, 64}, {-100, 1000}, {1000000, 1200000}, {lowest, highest}}) {
      std::vector<std::int32_t> values = some_numbers(count, least, greatest);
      const std::set<std::int32_t> expected(values.begin(), values.end());
      sort_unique(values);
      EXPECT_EQ(values, std::vector<std::int32_t>(expected.begin(), expected.end()));
    }
}

TEST(SortUnique, keeps_the_ends_of_a_full_range) {
  std::vector<std::int32_t> values(1000, highest - 1000);
  values.push_back(highest);
  sort_unique(values);
  EXPECT_EQ(values, (std::vector<std::int32_t>{highest - 1000, highest}));
}

TEST(SortUniqueBy, keeps_the_first_of_those_with_equal_keys) {
  using Pair = std::pair<std::int32_t, char>;
  std::vector<Pair> values = {{3, 'a'}, {1, 'b'}, {3, 'c'}, {1, 'd'}, {2, 'e'}};
  sort_unique_by(values, &Pair::first);
  EXPECT_EQ(values, (std::vector<Pair>{{1, 'b'}, {2, 'e'}, {3, 'a'}}));
}

TEST(SortUnique, makes_a_list_in_which_a_value_has_a_place) {
  const std::vector<std::int32_t> values = {3, 5, 9};
  for (std::int32_t k = 0; k < 3; ++k) EXPECT_EQ(place_in(values, values[std::size_t(k)]), k);
  EXPECT_EQ(place_in(values, 6), 2);
  for (std::int32_t k = 0; k < 3; ++k) EXPECT_EQ(find_in(values, values[std::size_t(k)]), k);
  for (const std::int32_t missing : {2, 6, 10}) EXPECT_EQ(find_in(values, missing), -1);
  EXPECT_EQ(find_in({}, 3), -1);
}

TEST(United, has_all_that_are_in_one_or_both_once) {
  EXPECT_EQ(united(std::vector<std::int32_t>{1, 4, 6}, std::vector<std::int32_t>{2, 4, 9}),
            (std::vector<std::int32_t>{1, 2, 4, 6, 9}));
  EXPECT_EQ(united({}, std::vector<std::int32_t>{3}), std::vector<std::int32_t>{3});
  EXPECT_TRUE(united({}, {}).empty());
}

}  // namespace
}  // namespace trocar
