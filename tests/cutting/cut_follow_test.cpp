// Two blades at once, on one line and across each other, and one after the other.
#include "cutting/cut_follow.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "cutting_cube.h"
#include "known_positions.h"

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

struct BladePlane {
  Vec3 centre, normal;
};

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return Vec3(gauss(random), gauss(random), gauss(random)).normalized();
}

struct MovingBlade {
  Blade edge;
  Vec3 normal;
};

// Two cutters' blades, in 30 frames.
class TwoBlades {
 public:
  TwoBlades(Body body, const std::array<MovingBlade, 2>& blades)
      : body_(std::move(body)), blades_(blades) {
    for (int k = 0; k < 2; ++k) cutters_.emplace_back(CutTetOptions{}).prepare(body_.mesh);
  }
  // Their edges are across the line in which the planes cross, and go along that line.
  TwoBlades(Body body, const std::array<BladePlane, 2>& planes)
      : TwoBlades(std::move(body), across(planes)) {}

  // The second one begins `lag` frames later.
  void advance_both(int lag = 0) {
    for (int k = 0; k < n_frames + lag; ++k) {
      if (k < n_frames) advance_one(0, k);
      if (k >= lag) advance_one(1, k - lag);
    }
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
  Body body_;
  std::array<MovingBlade, 2> blades_;
  std::vector<TetCutter> cutters_;
  Ledger ledger_;

  static std::array<MovingBlade, 2> across(const std::array<BladePlane, 2>& planes) {
    const Vec3 line = planes[0].normal.cross(planes[1].normal).normalized();
    std::array<MovingBlade, 2> blades;
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 &N = planes[k].normal, along = line.cross(N), from = planes[k].centre - 1.2 * line;
      blades[k] = {straight_blade(from - 1.2 * along, from + 1.2 * along, 2.4 * line, 12), N};
    }
    return blades;
  }
  void advance_one(std::size_t which, int k) { advance_one(which, k, which); }
  void advance_one(std::size_t which, int k, std::size_t by) {
    const auto& [edge, normal_of_blade] = blades_[which];
    BladeSweep sweep{edge(1.0 * k / n_frames), edge(1.0 * (k + 1) / n_frames), normal_of_blade};
    for (bool is_parted = false; !is_parted; sweep.before = sweep.after) {
      CutFigures figures;
      KnownPositions positions(body_.mesh, body_.x);
      const CutterEdit edit = cutters_[by].advance(
          body_.mesh, positions, {body_.is_held, body_.border}, sweep, k + 1 == n_frames, figures);
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
    std::array<BladePlane, 2> planes;
    do {
      const Vec3 centre = Vec3::Constant(0.5) + 0.1 * random_direction(random);
      for (BladePlane& plane : planes) plane = {centre, random_direction(random)};
    } while (std::abs(planes[0].normal.dot(planes[1].normal)) > 0.5);
    TwoBlades blades(cube(), planes);
    blades.advance_both();
    EXPECT_EQ(fault(blades.body()), "");
    n_right += n_pieces(blades.body().mesh) == 4 ? 1 : 0;
  }
  std::printf("%d of %d in four pieces\n", n_right, n);
  EXPECT_GE(n_right, n - 2);
}

// From two sides, the second one `aside` of the first one's plane, until they overlap by so many
// mean edges.
std::array<MovingBlade, 2> meeting_blades(double x, double overlap, double aside, double h) {
  const Vec3 way = (0.6 + overlap * h / 2) * Vec3::UnitY(), up = 1.4 * Vec3::UnitZ();
  const Vec3 first(x, -0.1, -0.2), second(x + aside * h, 1.1, -0.2);
  return {{{straight_blade(first, first + up, way, 14), normal},
           {straight_blade(second, second + up, -way, 14), -normal}}};
}

int n_parted_by_meeting(BoxElements elements, double overlap, int lag, double aside) {
  int n = 0;
  for (const double x : {0.37, 0.44, 0.52, 0.6}) {
    Body body(make_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, elements));
    const double h = mean_edge_length(body.mesh), step = least_step_of(body.mesh);
    TwoBlades blades(std::move(body), meeting_blades(x, overlap, aside, h));
    blades.advance_both(lag);
    EXPECT_EQ(fault(blades.body()), "");
    if (elements != BoxElements::hex8) {
      EXPECT_GE(least_step_of(blades.body().mesh), 0.7499 * step);
    }
    n += n_pieces(blades.body().mesh) == 2 ? 1 : 0;
  }
  return n;
}

TEST(CutFollow, two_blades_that_meet_part_the_body) {
  for (const double overlap : {1.0, 2.0, 4.0})
    for (const int lag : {0, 5, 12})
      for (const double aside : {0.0, 0.2}) {
        int n = 0;
        for (const BoxElements elements :
             {BoxElements::hex8, BoxElements::tet4_kuhn, BoxElements::tet4_five})
          n += n_parted_by_meeting(elements, overlap, lag, aside);
        std::printf("overlap %.0f, lag %d, aside %.1f: %d of 12 parted\n", overlap, lag, aside, n);
        EXPECT_GE(n, overlap < 2 ? 9 : 11) << overlap << ' ' << lag << ' ' << aside;
      }
}

// By one cutter, or by one for each stroke: bounds are over those from before any cut.
TEST(CutFollow, floors_do_not_sink_from_blade_to_blade) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 8; ++k) {
    std::array<BladePlane, 2> planes;
    for (BladePlane& plane : planes)
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
