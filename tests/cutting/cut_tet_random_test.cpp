// Random cuts, five meshes by turns. TROCAR_CUTS sets their number per test.
#include <gtest/gtest.h>

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

class Figures {
 public:
  explicit Figures(std::string name) : name_(std::move(name)) {}
  void add(double ratio, const Ledger& ledger, double h, bool is_right) {
    ratio_.push_back(ratio);
    deviation_ = larger_or_nan(deviation_, ledger.total.largest_deviation / h);
    deviation_sum_ += ledger.deviation_sum / h;
    n_duplicated_ += ledger.total.n_duplicated;
    n_refused_ += ledger.total.n_refused;
    n_right_ += is_right ? 1 : 0;
  }
  void print() {
    std::sort(ratio_.begin(), ratio_.end());
    const std::size_t n = ratio_.size();
    std::printf(
        "%s: %d of %zu with the right number of pieces, %d facets refused; least step bound after "
        "/ "
        "before: min %.3f, 5 %% %.3f, median %.3f; deviation over h: largest %.3f, mean %.4f\n",
        name_.c_str(), n_right_, n, n_refused_, ratio_[0], ratio_[n / 20], ratio_[n / 2],
        deviation_, deviation_sum_ / std::max(1, n_duplicated_));
  }
  int n_right() const { return n_right_; }
  double least_ratio() const { return *std::min_element(ratio_.begin(), ratio_.end()); }
  double deviation() const { return deviation_; }

 private:
  std::string name_;
  std::vector<double> ratio_;
  double deviation_ = 0, deviation_sum_ = 0;
  int n_duplicated_ = 0, n_refused_ = 0, n_right_ = 0;
};

// Runs `stroke` on n_random_bodies bodies; every one must stay sound and keep its mass.
template <class Stroke>
Figures run(const std::string& name, int n_pieces_expected, const Stroke& stroke) {
  Figures figures(name);
  std::mt19937 random(7);
  for (int k = 0; k < n_random_bodies; ++k) {
    Body body(mesh_of(k));
    const double h = mean_edge_length(body.mesh), step = least_step_of(body.mesh);
    const double mass_before = total_mass(body.mesh);
    const Ledger ledger = stroke(body, random_plane(random), h);
    EXPECT_EQ(fault(body), "") << name << " " << k;
    EXPECT_NEAR(total_mass(body.mesh) / mass_before, 1, 1e-12) << name << " " << k;
    const bool is_right = n_pieces(body.mesh) == n_pieces_expected;
    EXPECT_TRUE(is_right || ledger.total.n_refused > 0) << name << " " << k << " is silent";
    figures.add(least_step_of(body.mesh) / step, ledger, h, is_right);
  }
  figures.print();
  return figures;
}

constexpr double floor_of_step = CutTetOptions{}.least_step_ratio;

TEST(RandomCuts, in_one_sweep_part_the_body) {
  const Figures f = run("one sweep", 2, [](Body& body, const Plane& p, double) {
    return cut(body, plane_blade(p.centre, p.normal, 1.5), p.normal, 1);
  });
  EXPECT_EQ(f.n_right(), n_random_bodies);
  EXPECT_GE(f.least_ratio(), floor_of_step);
  EXPECT_LT(f.deviation(), 1);  // an edge
}

TEST(RandomCuts, in_small_steps_part_the_body) {
  const Figures f = run("small steps", 2, [](Body& body, const Plane& p, double h) {
    return cut(body, plane_blade(p.centre, p.normal, 1.5), p.normal, int(3 / (0.35 * h)));
  });
  EXPECT_EQ(f.n_right(), n_random_bodies);
  EXPECT_GE(f.least_ratio(), floor_of_step);
  EXPECT_LT(f.deviation(), 1);
}

TEST(RandomCuts, that_stop_inside_leave_one_piece) {
  const Figures f = run("half way", 1, [](Body& body, const Plane& p, double h) {
    const Vec3 u = p.normal.unitOrthogonal(), way = p.normal.cross(u);
    const Vec3 begin = p.centre - 1.2 * way;
    return cut(body, straight_blade(begin - 0.25 * u, begin + 0.25 * u, 1.2 * way), p.normal,
               int(1.2 / (0.35 * h)));
  });
  EXPECT_EQ(f.n_right(), n_random_bodies);
  EXPECT_GE(f.least_ratio(), floor_of_step);
}

TEST(RandomCuts, that_cross_make_four_pieces) {
  const Figures f = run("crossing", 4, [](Body& body, Plane p, double h) {
    p.centre = Vec3(0.5, 0.5, 0.5) + 0.3 * (p.centre - Vec3(0.5, 0.5, 0.5));
    const Vec3 second = p.normal.unitOrthogonal();
    TetCutter cutter{CutTetOptions{}};
    const int n = int(3 / (0.35 * h));
    cut(body, plane_blade(p.centre, p.normal, 1.5), p.normal, n, cutter);
    return cut(body, plane_blade(p.centre, second, 1.5), second, n, cutter);
  });
  EXPECT_EQ(f.n_right(), n_random_bodies);
  EXPECT_GE(f.least_ratio(), floor_of_step);
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
  const Figures f = run("moving body", 2, [](Body& body, const Plane& p, double h) {
    TetCutter cutter{CutTetOptions{}};
    return cut(body, plane_blade(p.centre, p.normal, 1.5), p.normal, int(3 / (0.35 * h)), cutter,
               swayed);
  });
  EXPECT_EQ(f.n_right(), n_random_bodies);
  EXPECT_GE(f.least_ratio(), floor_of_step);
}

}  // namespace
}  // namespace trocar
