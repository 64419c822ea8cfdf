// Random cuts with a fixed seed; TROCAR_CUTS sets another number per mesh.
#include <chrono>
#include <cmath>
#include <cstdio>

#include "cutting_count.h"
#include "cutting_plane.h"

namespace trocar {
namespace {

const int n_random_cuts = n_cuts_or(300);

// Uniform in [a, b) without std::uniform_real_distribution, which differs between libraries.
class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double operator()(double a, double b) { return a + (b - a) * (generator_() / 4294967296.0); }

 private:
  std::mt19937 generator_;
};

double height(const Mesh& mesh) {
  double h = 0;
  for (const Vec3& X : mesh.X) h = std::max(h, X.y());
  return h;
}

struct Sample {
  double floor = plane_step_ratio;  // under the step after / before
  int n_refused = 0;
  std::int64_t n_opened = 0, n_left = 0;  // facets; places left joined
  std::vector<double> altitude, step, milliseconds;

  static double at(std::vector<double>& values, double fraction) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
  }
  void print(const char* kind, int configuration) {
    std::printf(
        "%s, configuration %d: %zu cut, %d refused, %lld edges opened, %lld places left; least "
        "altitude after / before: worst "
        "%.3f, 5 %% %.3f, median %.3f; stable step: worst %.3f, median %.3f; ms: median %.3f, "
        "95 %% %.3f\n",
        kind, configuration, altitude.size(), n_refused, static_cast<long long>(n_opened),
        static_cast<long long>(n_left), at(altitude, 0), at(altitude, 0.05), at(altitude, 0.5),
        at(step, 0), at(step, 0.5), at(milliseconds, 0.5), at(milliseconds, 0.95));
  }
};

// Bound of the stable step over the wave speed: omega^2 <= c^2 sum_a 1 / h_a^2 of an element with
// the altitudes h_a. Not that of the module itself.
double bound_from_altitudes(const Mesh& mesh) {
  double least = 1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      const Vec3 edge = mesh.X[mesh.corners(e)[(a + 1) % 3]] - mesh.X[mesh.corners(e)[a]];
      const double h = 2 * element_volume(mesh, e, mesh.X) / edge.norm();
      sum += 1 / (h * h);
    }
    least = std::min(least, 1 / std::sqrt(sum));
  }
  return least;
}

// What holds for each cut, and the mesh after it; n_closed is the number of ends that stay closed,
// -1 if it is not known; is_held: of the nodes, none if empty.
Mesh cut_and_check(const Mesh& mesh, const std::vector<Vec3>& path, int n_closed, Sample& sample,
                   std::vector<std::uint8_t> is_held = {}) {
  is_held.resize(mesh.X.size());
  const auto start = std::chrono::steady_clock::now();
  const CutPlaneOptions options{.least_step = sample.floor * bound_from_altitudes(mesh)};
  const PlaneCut result = cut_plane(mesh, path, -1, {is_held}, options);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  sample.milliseconds.push_back(time.count());
  EXPECT_EQ(result.figures.refusals.size(), static_cast<std::size_t>(result.figures.n_refused));
  sample.n_left += result.figures.n_refused;
  sample.n_opened += result.figures.n_opened_facets;
  for (const NodeMove& move : result.edit.moves) EXPECT_EQ(is_held[move.node], 0);
  if (result.edit.is_empty()) {
    EXPECT_GT(result.figures.n_refused, 0);
    ++sample.n_refused;
    return mesh;
  }
  const Mesh after = applied(result.edit, mesh);
  EXPECT_TRUE(validate(after).empty());
  EXPECT_TRUE(has_closed_boundary(after));
  EXPECT_EQ(after.n_elements(), mesh.n_elements());
  if (n_closed >= 0) {
    EXPECT_EQ(after.n_nodes() - mesh.n_nodes(), result.figures.n_opened_facets + 1 - n_closed);
  }
  bool are_on_boundary = false;
  const int n_before = n_marked_sides(mesh, are_on_boundary);
  EXPECT_EQ(n_marked_sides(after, are_on_boundary), n_before + 2 * result.figures.n_opened_facets);
  EXPECT_NEAR(total_mass(after) / total_mass(mesh), 1, 1e-12);
  EXPECT_NEAR(total_volume(after) / total_volume(mesh), 1, 1e-12);
  sample.altitude.push_back(least_altitude(after) / least_altitude(mesh));
  sample.step.push_back(bound_from_altitudes(after) / bound_from_altitudes(mesh));
  EXPECT_GE(sample.step.back(), sample.floor * (1 - 1e-12));
  return after;
}

// Tips at least 10 mm from the bounding box, so that cuts do not graze the boundary.
TEST(CutPlaneRandom, inner_cuts_are_valid_and_keep_half_the_least_altitude) {
  for (int c = 1; c <= 4; ++c) {
    const Mesh mesh = paper_mesh(c);
    const double margin = 10 * mm, top = height(mesh) - margin;
    Random random(12345);
    Sample sample;
    for (int k = 0; k < n_random_cuts; ++k) {
      std::vector<Vec3> path;
      do {
        const double x0 = random(margin, 60 * mm), y0 = random(margin, top);
        const double x1 = random(margin, 60 * mm), y1 = random(margin, top);
        path = {{x0, y0, 0}, {x1, y1, 0}};
      } while ((path[1] - path[0]).norm() < 12 * mm);
      cut_and_check(mesh, path, 2, sample);
    }
    sample.print("inner cuts", c);
    EXPECT_EQ(sample.n_refused, 0);
    // The stable step may fall to half, and to 0.87 in the median on right triangles. On
    // equilateral ones the paper's rule sets the cut points 0.6 edges apart, which bounds the least
    // altitude near 0.67 and the step near 0.74.
    EXPECT_GE(Sample::at(sample.altitude, 0), 0.5);
    EXPECT_GE(Sample::at(sample.altitude, 0.5), c <= 2 ? 0.87 : 0.65);
    EXPECT_GE(Sample::at(sample.step, 0), 0.5);
    EXPECT_GE(Sample::at(sample.step, 0.5), c <= 2 ? 0.87 : 0.70);
  }
}

TEST(CutPlaneRandom, through_cuts_give_two_pieces) {
  for (int c = 1; c <= 4; ++c) {
    const Mesh mesh = paper_mesh(c);
    Random random(777);
    Sample sample;
    for (int k = 0; k < n_random_cuts; ++k) {
      const std::vector<Vec3> path = {{random(12 * mm, 58 * mm), -1 * mm, 0},
                                      {random(12 * mm, 58 * mm), height(mesh) + mm, 0}};
      cut_and_check(mesh, path, 0, sample);
      EXPECT_EQ(n_pieces(applied(cut(mesh, path).edit, mesh)), 2);
    }
    sample.print("through cuts", c);
    EXPECT_EQ(sample.n_refused, 0);
  }
}

// Anything anywhere, also polylines that cross themselves: grazing cuts, slices thinner than an
// edge and crossings of one path with itself may be refused, but nothing invalid ever comes out.
// The bound only notices when refusals become common.
TEST(CutPlaneRandom, cuts_anywhere_are_valid_or_refused) {
  for (int c = 1; c <= 4; ++c) {
    const Mesh mesh = paper_mesh(c);
    Random random(4242);
    Sample sample;
    for (int k = 0; k < n_random_cuts; ++k) {
      std::vector<Vec3> path;
      const int n_points = 2 + k % 3;
      for (int p = 0; p < n_points; ++p)
        path.emplace_back(random(-10 * mm, 80 * mm), random(-10 * mm, 60 * mm), 0);
      const PlaneCut result = cut(mesh, path);
      if (result.edit.is_empty() && result.figures.n_refused == 0) continue;
      cut_and_check(mesh, path, -1, sample);
    }
    sample.print("cuts anywhere", c);
    EXPECT_LE(sample.n_refused, n_random_cuts / 8);
  }
}

// Lips of earlier cuts bend a little at each node.
TEST(CutPlaneRandom, cuts_across_earlier_ones_leave_their_lips_where_they_are) {
  for (const int c : {1, 2, 5, 6}) {
    Random random(17);
    Sample sample;
    for (int k = 0; k < n_random_cuts / 3; ++k) {
      Mesh mesh = paper_mesh(c);
      const double top = height(mesh);
      for (int n = 0; n < 3; ++n) {
        const Vec3 middle(random(15 * mm, 40 * mm), random(0.25 * top, 0.75 * top), 0);
        const double angle = random(0, 3.14159);
        const Vec3 way = 100 * mm * Vec3(std::cos(angle), std::sin(angle), 0);
        const std::vector<Vec3> path = {middle - way, n == 1 ? middle : Vec3(middle + way)};
        mesh = cut_and_check(mesh, path, -1, sample);
      }
    }
    sample.print("cuts across earlier ones", c);
    EXPECT_LE(sample.n_refused, n_random_cuts / 20);
  }
}

// Whatever floor the user wants; what that costs is places that stay joined.
TEST(CutPlaneRandom, steps_keep_any_floor) {
  for (const double floor : {0.0, 0.35, 0.5, 0.75, 0.9}) {
    const Mesh mesh = paper_mesh(4);
    Random random(31);
    Sample sample{.floor = floor};
    for (int k = 0; k < n_random_cuts / 3; ++k) {
      const Vec3 start(random(-10 * mm, 80 * mm), random(-10 * mm, 60 * mm), 0);
      cut_and_check(mesh, {start, {random(20 * mm, 50 * mm), random(10 * mm, 30 * mm), 0}}, -1,
                    sample);
    }
    std::printf("floor %.2f: ", floor);
    sample.print("cuts from anywhere to the middle", 4);
    EXPECT_GT(sample.n_opened, floor < 0.8 ? 5 * n_random_cuts / 3 : 0);
  }
}

// Across the body, with the nodes of a disc held that the path meets: what is free is cut.
TEST(CutPlaneRandom, cuts_through_held_discs_move_no_held_node_and_open_the_rest) {
  for (int c = 1; c <= 4; ++c) {
    const Mesh mesh = paper_mesh(c);
    Random random(99);
    Sample sample;
    for (int k = 0; k < n_random_cuts / 3; ++k) {
      const std::vector<Vec3> path = {{random(12 * mm, 58 * mm), -1 * mm, 0},
                                      {random(12 * mm, 58 * mm), height(mesh) + mm, 0}};
      const Vec3 centre = path[0] + random(0, 1) * (path[1] - path[0]);
      const double radius = random(3 * mm, 12 * mm);
      std::vector<std::uint8_t> is_held(mesh.X.size(), 0);
      for (std::size_t i = 0; i < mesh.X.size(); ++i)
        is_held[i] = (mesh.X[i] - centre).norm() < radius ? 1 : 0;
      cut_and_check(mesh, path, -1, sample, is_held);
    }
    sample.print("cuts through held discs", c);
    EXPECT_EQ(sample.n_refused, 0);
    EXPECT_GE(Sample::at(sample.altitude, 0), 0.2);
  }
}

}  // namespace
}  // namespace trocar
