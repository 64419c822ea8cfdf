#include "cutting/cut_plane_reaches.h"

namespace trocar {
namespace {

using Path = std::vector<Vec3>;

TEST(CutPlaneReaches, begin_at_sharp_bends_and_where_the_path_would_cross_itself) {
  const auto sizes = [](const Path& path) {
    std::vector<std::size_t> result;
    for (const Path& reach : reaches(path)) result.push_back(reach.size());
    return result;
  };
  using Sizes = std::vector<std::size_t>;
  EXPECT_EQ(sizes({{0, 0, 0}, {10, 0, 0}}), Sizes{2});
  EXPECT_EQ(sizes({{0, 0, 0}, {10, 0, 0}, {16, 10, 0}}), Sizes{3});  // 59 degrees
  EXPECT_EQ(sizes({{0, 0, 0}, {10, 0, 0}, {15, 10, 0}, {16, 30, 0}}),
            (Sizes{2, 3}));  // 63, then 24
  // An octagon's sides, 45 degrees each, and on across the first one.
  EXPECT_EQ(sizes({{0, 0, 0},
                   {9, 0, 0},
                   {14, 5, 0},
                   {14, 12, 0},
                   {9, 17, 0},
                   {2, 17, 0},
                   {-3, 12, 0},
                   {-3, 5, 0},
                   {2, 1, 0},
                   {8, -7, 0}}),
            (Sizes{9, 2}));
  const Path path = {{0, 0, 0}, {30, 0, 0}, {10, 5, 0}, {30, 10, 0}};
  const std::vector<Path> parts = reaches(path);
  ASSERT_EQ(parts.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(parts[k], (Path{path[k], path[k + 1]}));
}

}  // namespace
}  // namespace trocar
