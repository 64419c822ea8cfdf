// Random cuts, five meshes by turns. TROCAR_CUTS sets their number per test.
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "cutting_count.h"
#include "cutting_tet.h"
#include "larger_or_nan.h"

namespace trocar {
namespace {

using namespace cutting_test;

const int n_random_bodies = n_cuts_or(50);

Mesh mesh_of(int kind) {
  const BoxElements elements = kind % 2 == 0 ? BoxElements::tet4_kuhn : BoxElements::tet4_five;
  if (kind % 5 == 4) return make_ball({0.5, 0.5, 0.5}, 0.5, 6, BoxElements::tet4_kuhn);
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {6, 6, 6}, elements);
  if (kind % 5 >= 2) jitter(mesh, 0.2, unsigned(kind));
  return mesh;
}

struct Plane {
  Vec3 centre, normal;
};

Plane random_plane(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  Vec3 normal;
  do normal = {u(random), u(random), u(random)};
  while (normal.norm() > 1 || normal.norm() < 0.1);
  const Vec3 shift(u(random), u(random), u(random));
  return {Vec3(0.5, 0.5, 0.5) + 0.2 * shift, normal.normalized()};
}

// What cuts of a body left: all cuts together, and the planes that they lie in.
struct PlaneCuts {
  std::vector<Plane> plane;
  Ledger ledger;
};

void add_up(const Ledger& of, Ledger& sum) {
  add(of.total, of.n_edits > 0, sum.total);
  sum.n_edits += of.n_edits;
}

// One after the other, from outside to outside.
PlaneCuts part_along(Body& body, std::vector<Plane> planes, int n_steps) {
  PlaneCuts cuts{std::move(planes), {}};
  TetCutter cutter{CutTetOptions{}};
  for (const auto& [centre, normal] : cuts.plane)
    add_up(cut(body, plane_blade(centre, normal, 1.5), normal, n_steps, cutter), cuts.ledger);
  return cuts;
}

int small_steps(double way, double h) {
  return int(way / (0.35 * h));
}

// Nearer to the middle, so that no piece gets thin.
Plane near_middle(const Plane& p) {
  const Vec3 middle(0.5, 0.5, 0.5);
  return {middle + 0.3 * (p.centre - middle), p.normal};
}

// Least angle between two facets of an element, degrees.
double least_dihedral(const Mesh& mesh) {
  double largest = -1;  // cosine
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    std::array<Vec3, 4> normal;
    for (int f = 0; f < 4; ++f) {
      const std::array<int, 4> k = facet_corners(ElementType::tet4, f);
      const auto X = [&](int a) -> const Vec3& { return mesh.X[mesh.corners(e)[k[a]]]; };
      normal[f] = (X(1) - X(0)).cross(X(2) - X(0)).normalized();
      for (int g = 0; g < f; ++g) largest = larger_or_nan(largest, -normal[f].dot(normal[g]));
    }
  }
  return std::acos(largest) * 180 / std::numbers::pi;
}

class Figures {
 public:
  explicit Figures(std::string name) : name_(std::move(name)) {}

  // Distances of the nodes of opened facets from the plane next to them, a node and its partners
  // together as one; of a body that moves the largest one from the surface that the cut took for
  // the blade's.
  void add_deviations(const Mesh& mesh, const PlaneCuts& cuts, double h) {
    if (cuts.plane.empty()) return deviation_.push_back(cuts.ledger.total.largest_deviation / h);
    const Surface surface = boundary_surface(mesh);
    std::set<std::array<double, 3>> places;
    for (std::size_t t = 0; t < surface.triangle.size(); ++t)
      for (const std::int32_t i : surface.triangle[t])
        if (surface.is_cut[t] != 0) places.insert({mesh.X[i].x(), mesh.X[i].y(), mesh.X[i].z()});
    for (const auto& [x, y, z] : places) {
      double least = std::numeric_limits<double>::infinity();
      for (const auto& [centre, normal] : cuts.plane)
        least = std::min(least, std::abs(normal.dot(Vec3(x, y, z) - centre)) / h);
      deviation_.push_back(least);
    }
  }
  void add(const Mesh& mesh, int n_surfaces, double step_ratio) {
    ratio_.push_back(step_ratio);
    dihedral_ = std::min(dihedral_, least_dihedral(mesh));
    n_surfaces_ += n_surfaces;
  }
  void print() {
    std::ranges::sort(ratio_);
    std::ranges::sort(deviation_);
    const std::size_t n = ratio_.size();
    std::printf(
        "%s: least step bound after / before: min %.3f, 5 %% %.3f, median %.3f; least dihedral "
        "angle %.1f degrees; nodes off the planes: 95 %% %.3f h, largest %.3f h\n",
        name_.c_str(), ratio_[0], ratio_[n / 20], ratio_[n / 2], dihedral_, deviation(0.95),
        deviation(1));
  }
  double least_ratio() const { return *std::ranges::min_element(ratio_); }
  double least_dihedral_angle() const { return dihedral_; }
  int n_surfaces() const { return n_surfaces_; }
  // That this share of the nodes does not exceed, in h; after print().
  double deviation(double share) const {
    return deviation_.at(
        std::min(deviation_.size() - 1, std::size_t(share * double(deviation_.size()))));
  }

 private:
  std::string name_;
  std::vector<double> ratio_, deviation_;
  double dihedral_ = 180;
  int n_surfaces_ = 0;
};

// Parts of the surface that no edge joins.
int n_surfaces(const Mesh& mesh) {
  std::vector<std::int32_t> root(mesh.X.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const Surface surface = boundary_surface(mesh);
  for (const auto& [a, b, c] : surface.triangle) {
    root[find(b)] = find(a);
    root[find(c)] = find(a);
  }
  return int(std::ranges::count_if(surface.node, [&](std::int32_t i) { return root[i] == i; }));
}

// What no cut may change: the numbers of elements and of all nodes but partners, mass, soundness,
// and that no surface has a handle.
void expect_sound(const Body& body, const Mesh& before, const Ledger& ledger) {
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(euler_characteristic(body.mesh), 2 * n_surfaces(body.mesh));
  EXPECT_EQ(body.mesh.n_elements(), before.n_elements());
  EXPECT_EQ(body.mesh.n_nodes(), before.n_nodes() + ledger.total.n_duplicated);
  EXPECT_NEAR(total_mass(body.mesh) / total_mass(before), 1, 1e-12);
}

// Nodes of boxes slide in their faces, those of balls along the facets of a coarse sphere.
void expect_volume(const Mesh& mesh, const Mesh& before, bool is_box, double tolerance) {
  const double change = std::abs(total_volume(mesh) / total_volume(before) - 1);
  EXPECT_LT(change, is_box ? tolerance : 0.04);
}

void expect_at_rest(const Body& body) {
  for (std::size_t i = 0; i < body.x.size(); ++i)  // rounding of weights, over some twenty edits
    EXPECT_LT((body.x[i] - body.mesh.X[i]).norm(), 1e-14) << i;
}

constexpr double by_rounding = 1e-12;
// A plane that crosses another one moves nodes along its uneven lips, which changes volumes.
constexpr double along_lips = 5e-3;

// Runs `stroke` on n_random_bodies bodies, whose relative change of volume is below `tolerance`.
template <class Stroke>
Figures run(const std::string& name, int n_expected, double tolerance, const Stroke& stroke) {
  Figures figures(name);
  std::mt19937 random(7);
  for (int k = 0; k < n_random_bodies; ++k) {
    SCOPED_TRACE(name + " " + std::to_string(k));
    Body body(mesh_of(k));
    const Mesh before = body.mesh;
    const double h = mean_edge_length(before);
    const PlaneCuts cuts = stroke(body, random_plane(random), h);
    EXPECT_EQ(n_pieces(body.mesh), n_expected);
    expect_sound(body, before, cuts.ledger);
    expect_volume(body.mesh, before, k % 5 != 4, tolerance);
    if (!cuts.plane.empty()) expect_at_rest(body);
    figures.add_deviations(body.mesh, cuts, h);
    figures.add(body.mesh, n_surfaces(body.mesh), least_step_of(body.mesh) / least_step_of(before));
  }
  figures.print();
  return figures;
}

constexpr double floor_of_step = CutTetOptions{}.least_step_ratio;

// What docs/cutting.md and docs/cutting-measured.md say of tetrahedra.
void expect_good(const Figures& figures) {
  EXPECT_GE(figures.least_ratio(), floor_of_step);
  EXPECT_GT(figures.least_dihedral_angle(), 7);
  EXPECT_LT(figures.deviation(0.95), 0.35);
  EXPECT_LT(figures.deviation(1), 1.14);
}

TEST(RandomCuts, in_one_sweep_part_the_body) {
  const Figures f = run("one sweep", 2, by_rounding, [](Body& body, const Plane& p, double) {
    return part_along(body, {p}, 1);
  });
  EXPECT_EQ(f.n_surfaces(), 2 * n_random_bodies);
  expect_good(f);
}

TEST(RandomCuts, in_small_steps_part_the_body) {
  const Figures f = run("small steps", 2, by_rounding, [](Body& body, const Plane& p, double h) {
    return part_along(body, {p}, small_steps(3, h));
  });
  EXPECT_EQ(f.n_surfaces(), 2 * n_random_bodies);
  expect_good(f);
}

TEST(RandomCuts, that_stop_inside_leave_one_piece) {
  const Figures f = run("half way", 1, by_rounding, [](Body& body, const Plane& p, double h) {
    const Vec3 u = p.normal.unitOrthogonal(), way = p.normal.cross(u);
    const Vec3 begin = p.centre - 1.2 * way;
    const Blade blade = straight_blade(begin - 0.25 * u, begin + 0.25 * u, 1.2 * way);
    return PlaneCuts{{p}, cut(body, blade, p.normal, small_steps(1.2, h))};
  });
  // The blade is 2.4 h wide, and nodes that hold its ends don't move: now and then, in 5 of 50, it
  // opens no facet with an edge on the outer surface, and the wound is closed.
  EXPECT_LE(f.n_surfaces(), 1.2 * n_random_bodies);
  expect_good(f);
}

TEST(RandomCuts, that_cross_make_four_pieces) {
  const Figures f = run("crossing", 4, along_lips, [](Body& body, const Plane& p, double h) {
    const auto [centre, normal] = near_middle(p);
    return part_along(body, {{centre, normal}, {centre, normal.unitOrthogonal()}},
                      small_steps(3, h));
  });
  EXPECT_EQ(f.n_surfaces(), 4 * n_random_bodies);
  expect_good(f);
}

TEST(RandomCuts, that_cross_three_times_make_eight_pieces) {
  const Figures f = run("triple crossing", 8, along_lips, [](Body& body, const Plane& p, double h) {
    const auto [centre, normal] = near_middle(p);
    const Vec3 second = normal.unitOrthogonal(), third = normal.cross(second);
    return part_along(body, {{centre, normal}, {centre, second}, {centre, third}},
                      small_steps(3, h));
  });
  EXPECT_EQ(f.n_surfaces(), 8 * n_random_bodies);
  expect_good(f);
}

// A smooth map that moves by a tenth of an edge from frame to frame.
Vec3 swayed(const Vec3& X, double t) {
  const Vec3 d = X - Vec3(0.5, 0.5, 0.5);
  const double phase = 9 * t - double(int(9 * t));
  const double sway = 0.02 * (phase < 0.5 ? 4 * phase - 1 : 3 - 4 * phase);
  return X + Vec3(0.25 * d.z() * d.z() + 0.15 * d.x() * d.y() + sway * (1 + d.y()),
                  0.2 * d.x() * d.z() * (1 + t) + sway, 0.3 * d.y() * d.y() * d.x() - 0.1 * d.x());
}

TEST(RandomCuts, of_a_body_that_is_deformed_and_moves_stay_sound) {
  const Figures f = run("moving body", 2, by_rounding, [](Body& body, const Plane& p, double h) {
    TetCutter cutter{CutTetOptions{}};
    const Blade blade = plane_blade(p.centre, p.normal, 1.5);
    return PlaneCuts{{}, cut(body, blade, p.normal, small_steps(3, h), cutter, swayed)};
  });
  EXPECT_EQ(f.n_surfaces(), 2 * n_random_bodies);
  EXPECT_GE(f.least_ratio(), floor_of_step);
  EXPECT_GT(f.least_dihedral_angle(), 7);
  EXPECT_LT(f.deviation(1), 1.14);
}

}  // namespace
}  // namespace trocar
