// Two blades at once, on one line and across each other, and one after the other.
#include "cutting/cut_follow.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "cutting_cube.h"

namespace trocar::cutting_test {
namespace {

const Vec3 normal = Vec3::UnitX();

// Through the cube's middle, half of its height deep: a slit, not a cut through.
BladeSweep sweep_at(double x, int k) {
  const auto edge = [&](int n) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 8; ++i) points.emplace_back(x, -0.1 + 1.2 * n / 30, 0.5 + 0.1 * i);
    return points;
  };
  return {.before = edge(k), .after = edge(k + 1), .normal = normal};
}

int facets_opened_by(BoxElements elements, double x, int n_blades) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, elements));
  std::vector<TetCutter> cutters;
  for (int c = 0; c < n_blades; ++c) cutters.emplace_back(CutTetOptions{}).prepare(body.mesh);
  Ledger ledger;
  for (int k = 0; k < 30; ++k)
    for (TetCutter& cutter : cutters) {
      const Mesh before = body.mesh;
      const CutterEdit edit = advance(cutter, body, sweep_at(x, k), k == 29, ledger);
      for (TetCutter& other : cutters)
        if (&other != &cutter) other.follow(before, edit);
    }
  EXPECT_EQ(fault(body), "");
  return ledger.total.n_opened_facets;
}

TEST(CutFollow, second_blade_on_the_same_line_opens_no_slit_of_its_own) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double x : {0.47, 0.5, 0.52, 0.55}) {
      const int alone = facets_opened_by(elements, x, 1);
      EXPECT_GT(alone, 40) << x;
      EXPECT_LE(facets_opened_by(elements, x, 2), 1.3 * alone) << x;
    }
}

struct Plane {
  Vec3 centre, normal;
};

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Vec3(gauss(random), gauss(random), gauss(random)).normalized();
}

// Two cutters' blades, whose edges are across the line in which their planes cross, along that line
// in 30 frames.
class TwoBlades {
 public:
  TwoBlades(Body body, const std::array<Plane, 2>& planes) : body_(std::move(body)) {
    const Vec3 line = planes[0].normal.cross(planes[1].normal).normalized();
    for (const Plane& plane : planes) {
      const Vec3 along = line.cross(plane.normal), from = plane.centre - 1.2 * line;
      blades_.push_back(
          {straight_blade(from - 1.2 * along, from + 1.2 * along, 2.4 * line, 12), plane.normal});
      cutters_.emplace_back(CutTetOptions{}).prepare(body_.mesh);
    }
  }
  void advance_both() {
    for (int k = 0; k < n_frames; ++k)
      for (std::size_t which = 0; which < 2; ++which) advance_one(which, k);
  }
  void cut_in_turn(bool by_one_cutter) {
    for (std::size_t which = 0; which < 2; ++which) {
      TetCutter& cutter = cutters_[by_one_cutter ? 0 : which];
      cutter.start_stroke();
      for (int k = 0; k < n_frames; ++k) advance_one(which, k, by_one_cutter ? 0 : which);
    }
  }
  const Body& body() const { return body_; }

 private:
  static constexpr int n_frames = 30;
  struct MovingBlade {
    Blade edge;
    Vec3 normal;
  };
  Body body_;
  std::vector<MovingBlade> blades_;
  std::vector<TetCutter> cutters_;
  Ledger ledger_;

  void advance_one(std::size_t which, int k) { advance_one(which, k, which); }
  void advance_one(std::size_t which, int k, std::size_t by) {
    const auto& [edge, normal_of_blade] = blades_[which];
    BladeSweep sweep{edge(1.0 * k / n_frames), edge(1.0 * (k + 1) / n_frames), normal_of_blade};
    for (bool is_parted = false; !is_parted; sweep.before = sweep.after) {
      CutFigures figures;
      KnownPositions positions(body_.mesh, body_.x);
      const CutterEdit edit =
          cutters_[by].advance(body_.mesh, positions, CutConstraints{body_.is_held, body_.border},
                               sweep, k + 1 == n_frames, figures);
      cutters_[1 - by].follow(body_.mesh, edit);
      apply(edit, figures, body_, ledger_);
      is_parted = edit.inserted.empty();
    }
    if (k + 1 == n_frames) cutters_[1 - by].take_over(cutters_[by].left());
  }
};

// Planes at 60 degrees or more: neither blade parts what the other one crosses.
TEST(CutFollow, two_blades_at_once_whose_planes_cross_part_the_body_in_four) {
  std::mt19937_64 random(3);
  constexpr int n = 30;
  int n_right = 0;
  for (int k = 0; k < n; ++k) {
    std::array<Plane, 2> planes;
    do {
      const Vec3 centre = Vec3::Constant(0.5) + 0.1 * random_direction(random);
      for (Plane& plane : planes) plane = {centre, random_direction(random)};
    } while (std::abs(planes[0].normal.dot(planes[1].normal)) > 0.5);
    TwoBlades blades(cube(), planes);
    blades.advance_both();
    EXPECT_EQ(fault(blades.body()), "");
    n_right += n_pieces(blades.body().mesh) == 4 ? 1 : 0;
  }
  std::printf("%d of %d in four pieces\n", n_right, n);
  EXPECT_GE(n_right, n - 2);
}

// By one cutter, or by one for each stroke: bounds are over those from before any cut.
TEST(CutFollow, floors_do_not_sink_from_blade_to_blade) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 8; ++k) {
    std::array<Plane, 2> planes;
    for (Plane& plane : planes)
      plane = {Vec3::Constant(0.5) + 0.1 * random_direction(random), random_direction(random)};
    const Body body = cube();
    for (const bool by_one_cutter : {true, false}) {
      TwoBlades blades(body, planes);
      blades.cut_in_turn(by_one_cutter);
      EXPECT_GE(least_step_of(blades.body().mesh), 0.7499 * least_step_of(body.mesh))
          << k << by_one_cutter;
    }
  }
}

}  // namespace
}  // namespace trocar::cutting_test
