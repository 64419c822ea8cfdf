#include <algorithm>
#include <map>

#include "collision/surface_tree.h"
#include "collision_random.h"
#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh_joined.h"

namespace trocar {
namespace {

constexpr double reach = 0.004, depth = 0.002;

// {node, triangle}, their opposition and which triangle of the node's it is of.
using Pairs = std::map<std::array<std::int32_t, 2>, std::pair<double, std::int32_t>>;

struct Bodies {
  Mesh mesh;
  std::vector<Vec3> ahead;
  std::vector<std::array<std::int32_t, 3>> triangle;

  Bodies(Mesh of, unsigned seed, double speed) : mesh(std::move(of)) {
    Random random(seed);
    for (Vec3& x : mesh.X) x += random.in_box(0.001);
    for (const Vec3& x : mesh.X) ahead.push_back(x + random.in_box(speed));
    triangle = boundary_surface(mesh).triangle;
  }
  Triangle corners(std::size_t t, const std::vector<Vec3>& x) const {
    const auto at = [&](std::size_t a) { return x[triangle[t][a]]; };
    return {at(0), at(1), at(2)};
  }
  Vec3 normal(std::size_t t) const { return *unit_normal(corners(t, mesh.X)); }
  double height(const Vec3& p, std::size_t t, const std::vector<Vec3>& x) const {
    return normal(t).dot(p - corners(t, x)[0]);
  }
  // As the node sees it, the triangle's box sweeps the box of its corners relative to the node.
  bool comes_near(std::size_t i, std::size_t t) const {
    Box now, later, way;
    for (const Vec3& c : corners(t, mesh.X)) now.add(Vec3(c - mesh.X[i]));
    for (const Vec3& c : corners(t, ahead)) later.add(Vec3(c - ahead[i]));
    way.add(now);
    way.add(later);
    return way.distance2(Vec3::Zero()) < reach * reach;
  }
  bool may_meet(std::int32_t node, std::size_t t) const {
    if (std::find(triangle[t].begin(), triangle[t].end(), node) != triangle[t].end()) return false;
    const auto i = static_cast<std::size_t>(node);
    const double now = height(mesh.X[i], t, mesh.X), later = height(ahead[i], t, ahead);
    return std::max(now, later) > -depth && std::min(now, later) < reach && comes_near(i, t);
  }
  Pairs facing_by_a_plain_loop() const {
    Pairs found;
    for (std::size_t s = 0; s < triangle.size(); ++s)
      for (std::size_t t = 0; t < triangle.size(); ++t) {
        const double opposition = normal(s).dot(normal(t));
        if (opposition >= -0.1) continue;
        for (const std::int32_t node : triangle[s]) {
          if (!may_meet(node, t)) continue;
          const std::pair own(opposition, static_cast<std::int32_t>(s));
          const auto at = found.try_emplace({node, static_cast<std::int32_t>(t)}, own);
          at.first->second = std::min(at.first->second, own);
        }
      }
    return found;
  }
};

Mesh unlike_blocks() {
  return joined(make_box({0, 0, 0}, {0.04, 0.03, 0.02}, {6, 5, 3}, BoxElements::tet4_kuhn),
                make_box({0, 0, 0.022}, {0.04, 0.03, 0.04}, {5, 4, 3}, BoxElements::hex8));
}

TEST(SurfaceTree, finds_what_faces_each_other_like_a_plain_loop) {
  const Mesh bodies[] = {unlike_blocks(),
                         joined(make_ball(Vec3(0, 0, 0), 0.02, 5, BoxElements::tet4_kuhn),
                                make_ball(Vec3(0.038, 0.01, 0), 0.02, 5, BoxElements::tet4_kuhn))};
  unsigned seed = 1;
  for (const Mesh& body : bodies)
    for (const double speed : {0.0, 0.002, 0.01}) {
      const Bodies b(body, seed++, speed);
      const SurfaceTree tree(b.triangle, b.mesh.X);
      const Pairs expected = b.facing_by_a_plain_loop();
      EXPECT_GT(expected.size(), 20u);
      Pairs found;
      for (const SurfaceTree::Facing& f : tree.facing(b.ahead, reach, depth))
        found.emplace_hint(found.end(), std::array{f.node, f.triangle},
                           std::pair(f.opposition, f.own));
      EXPECT_EQ(found, expected);
    }
}

TEST(SurfaceTree, finds_nothing_that_faces_itself_on_a_ball) {
  const Mesh mesh = make_ball(Vec3::Zero(), 0.03, 8, BoxElements::tet4_kuhn);
  const SurfaceTree tree(boundary_surface(mesh).triangle, mesh.X);
  EXPECT_TRUE(tree.facing(mesh.X, reach, depth).empty());
}

}  // namespace
}  // namespace trocar
