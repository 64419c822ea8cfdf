#include "base/grouped.h"

#include <gtest/gtest.h>

#include <random>

namespace trocar {
namespace {

TEST(Grouped, items_are_those_put_into_each_group_in_their_order) {
  std::mt19937 random(1);
  constexpr std::size_t n_groups = 7;
  std::vector<std::size_t> group(100);
  for (std::size_t& k : group) k = random() % (n_groups - 1);  // the last stays empty
  const Grouped<> groups = group_items(n_groups, [&](const auto& put) {
    for (std::int32_t i = 0; i < 100; ++i) put(group[i], i);
  });
  ASSERT_EQ(groups.offset.size(), n_groups + 1);
  for (std::size_t k = 0; k < n_groups; ++k) {
    std::vector<std::int32_t> expected;
    for (std::int32_t i = 0; i < 100; ++i)
      if (group[i] == k) expected.push_back(i);
    const std::span<const std::int32_t> found = groups.of(static_cast<std::int64_t>(k));
    EXPECT_EQ(std::vector(found.begin(), found.end()), expected);
  }
}

TEST(Grouped, nothing_makes_empty_groups) {
  const auto none = [](const auto&) {};
  const Grouped<double> groups = group_items<double>(2, none);
  EXPECT_EQ(groups.offset, (std::vector<std::int32_t>{0, 0, 0}));
  EXPECT_TRUE(groups.of(0).empty() && groups.of(1).empty() && groups.item.empty());
  EXPECT_EQ(group_items(0, none).offset, (std::vector<std::int32_t>{0}));
}

}  // namespace
}  // namespace trocar
