#include "engine/gather_items.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

struct Sent {
  std::uint8_t kind = 0;
  std::int64_t number = 0;
  std::array<Vec3, 2> ends{Vec3::Zero(), Vec3::Zero()};
  double value = 0;
};

template <class Archive>
void visit(Archive& a, Sent& s) {
  a(s.kind, s.number, s.ends, s.value);
}

TEST(GatherItems, gives_a_single_rank_its_own) {
  const Communicator alone;
  EXPECT_TRUE(all_gather_items(alone, std::vector<Sent>()).empty());
  const std::vector<Sent> mine = {
      {.kind = 3, .number = (std::int64_t{1} << 60) + 1, .ends = {Vec3(1, 2, 3), Vec3(4, 5, 6)}},
      {.kind = 5, .value = -0.1}};
  const std::vector<Sent> all = all_gather_items(alone, mine);
  ASSERT_EQ(all.size(), 2u);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].kind, mine[k].kind);
    EXPECT_EQ(all[k].number, mine[k].number);
    EXPECT_EQ(all[k].ends, mine[k].ends);
    EXPECT_EQ(all[k].value, mine[k].value);
  }
}

}  // namespace
}  // namespace trocar
