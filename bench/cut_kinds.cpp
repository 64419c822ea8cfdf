// Random strokes: planes and cylinders through a body, at once or in steps of half an edge.
#include <cmath>

#include "base/box.h"
#include "cut_case.h"

namespace trocar::cut_bench {

namespace {

using Random = std::mt19937_64;

struct Extent {
  Vec3 centre = Vec3::Zero(), half = Vec3::Zero();
  double radius = 0;  // of the ball around the box
};

struct Frame {
  Vec3 origin, normal, along, way;  // the edge lies along `along` and moves by `way`
};

}  // namespace

static Extent extent_of(const Mesh& mesh) {
  const Box box = bounding_box(mesh.X);
  return {box.middle(), box.size() / 2, box.size().norm() / 2};
}

static double uniform(Random& random, double low, double high) {
  return low + (high - low) * (double(random() >> 11) * 0x1p-53);
}

static Vec3 in_cube(Random& random) {
  const double x = uniform(random, -1, 1), y = uniform(random, -1, 1);
  return {x, y, uniform(random, -1, 1)};
}

static Vec3 direction(Random& random) {
  Vec3 n;
  do n = in_cube(random);
  while (n.norm() > 1 || n.norm() < 0.1);
  return n.normalized();
}

// A plane through a point of the middle part of the body's box, turned anyhow.
static Frame random_frame(const Extent& extent, double part, Random& random) {
  Frame frame;
  frame.normal = direction(random);
  Vec3 other;
  do other = direction(random);
  while (std::abs(other.dot(frame.normal)) > 0.9);
  frame.along = (other - frame.normal * frame.normal.dot(other)).normalized();
  frame.way = frame.normal.cross(frame.along);
  frame.origin = extent.centre + part * extent.half.cwiseProduct(in_cube(random));
  return frame;
}

static std::function<double(const Vec3&)> plane_distance(const Frame& f) {
  return [f](const Vec3& X) { return f.normal.dot(X - f.origin); };
}

// Across the whole body; n_steps 0: half an edge a step.
static Stroke full_plane(const Frame& f, const Extent& extent, double h, int n_steps) {
  const double r = 1.05 * extent.radius + (f.origin - extent.centre).norm();
  const Vec3 begin = f.origin - r * f.way;
  const int n_points = std::max(8, int(2 * r / (2 * h)));
  return {cutting_test::straight_blade(begin - r * f.along, begin + r * f.along, 2 * r * f.way,
                                       n_points),
          f.normal, n_steps > 0 ? n_steps : int(2 * r / (0.5 * h)), plane_distance(f)};
}

static std::vector<Stroke> through(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  return {full_plane(random_frame(extent, 0.5, random), extent, mean_edge_length(mesh), 1)};
}

static std::vector<Stroke> progressive(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  return {full_plane(random_frame(extent, 0.5, random), extent, mean_edge_length(mesh), 0)};
}

static std::vector<Stroke> crossing(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  const Frame f = random_frame(extent, 0.15, random);
  const double h = mean_edge_length(mesh);
  return {full_plane(f, extent, h, 0),
          full_plane({f.origin, f.along, f.way, f.normal}, extent, h, 0),
          full_plane({f.origin, f.way, f.normal, f.along}, extent, h, 0)};
}

// An edge a third of the body long enters and stops in the middle.
static std::vector<Stroke> partial(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  const Frame f = random_frame(extent, 0.3, random);
  const double r = extent.radius, h = mean_edge_length(mesh), w = 0.33 * extent.half.minCoeff();
  const Vec3 begin = f.origin - 1.2 * r * f.way;
  return {{cutting_test::straight_blade(begin - w * f.along, begin + w * f.along, 1.2 * r * f.way,
                                        std::max(4, int(w / h))),
           f.normal, int(1.2 * r / (0.5 * h)), plane_distance(f)}};
}

// Around an axis beside the body, six edges or more away from the cut; the blade turns.
static std::vector<Stroke> curved(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  const double h = mean_edge_length(mesh), reach = 1.05 * extent.radius;
  Frame f = random_frame(extent, 0.4, random);
  const double R = std::max(6 * h, extent.radius * uniform(random, 0.8, 1.6));
  const Vec3 axis = f.origin - R * f.normal;
  const double half_angle = std::min(3.0, 2 * std::asin(std::min(0.99, 0.75 * reach / R)));
  const auto blade = [=](double t) {
    const double angle = half_angle * (2 * t - 1);
    const Vec3 middle = axis + R * (std::cos(angle) * f.normal + std::sin(angle) * f.way);
    std::vector<Vec3> edge;
    const int n = std::max(8, int(reach / h));
    for (int k = 0; k <= n; ++k) edge.push_back(middle + 1.6 * reach * (2.0 * k / n - 1) * f.along);
    return edge;
  };
  const auto phi = [=](const Vec3& X) {
    const Vec3 d = X - axis;
    return (d - f.along * f.along.dot(d)).norm() - R;
  };
  return {{blade, f.normal, int(2 * half_angle * R / (0.5 * h)), phi}};
}

// Half of them askew by up to three degrees.
static std::vector<Stroke> parallel(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  const double h = mean_edge_length(mesh), askew = uniform(random, 0, 1) < 0.5 ? 0 : 0.05;
  Frame f;
  f.normal = Vec3(askew * uniform(random, -1, 1), askew * uniform(random, -1, 1), 1).normalized();
  f.along = (Vec3::UnitY() - f.normal * f.normal.y()).normalized();
  f.way = f.normal.cross(f.along);
  f.origin = extent.centre + uniform(random, -1, 1) * h * Vec3::UnitZ();
  return {full_plane(f, extent, h, 0)};
}

// Of a plate from z = 0 to 1 in its middle: askew by up to some two degrees.
static std::vector<Stroke> in_plane(const Mesh& mesh, Random& random) {
  const Extent extent = extent_of(mesh);
  Frame f;
  f.normal = Vec3(uniform(random, -0.03, 0.03), uniform(random, -0.03, 0.03), 1).normalized();
  f.along = (Vec3::UnitY() - f.normal * f.normal.y()).normalized();
  f.way = f.normal.cross(f.along);
  f.origin = Vec3(extent.centre.x(), extent.centre.y(), uniform(random, 0.1, 0.9));
  return {full_plane(f, extent, mean_edge_length(mesh), 0)};
}

// Sheared, stretched and bent; F stays within some 40 % of the identity.
cutting_test::Deformation random_bend(std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  Mat3 A = Mat3::Identity();
  for (int k = 0; k < 9; ++k) A(k / 3, k % 3) += 0.1 * u(random);
  const Vec3 wave = 3 * Vec3(u(random), u(random), u(random));
  const Vec3 way = 0.04 * Vec3(u(random), u(random), u(random));
  return [=](const Vec3& X) { return Vec3(A * X + way * std::sin(wave.dot(X))); };
}

std::vector<Kind> kinds() {
  return {{"through", true, through},
          {"partial", false, partial},
          {"curved", true, curved},
          {"crossing", true, crossing},
          {"progressive", true, progressive}};
}

std::vector<Kind> layered_kinds() {
  std::vector<Kind> all = kinds();
  all.push_back({"parallel", true, parallel});
  return all;
}

std::vector<Kind> plate_kinds() {
  return {{"in_plane", true, in_plane}};
}

}  // namespace trocar::cut_bench
