// Hourglass energies of one-point hexahedra against the integrals that they stand for.
#include "solver/hourglass.h"

#include <gtest/gtest.h>

#include "solver_body.h"

using namespace trocar;

// A sheared and stretched box: a parallelepiped.
static Mesh parallelepiped() {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {1, 1, 1}, BoxElements::hex8);
  Mat3 A;
  A << .011, .003, -.001, .001, .008, .002, -.002, .001, .014;
  for (Vec3& X : mesh.X) X = A * X;
  return mesh;
}

// Gradients of the trilinear displacement at the 2 x 2 x 2 Gauss points, by shape functions.
static std::vector<Mat3> gradients(const Body& body) {
  std::vector<Mat3> H;
  const double g = 1 / std::sqrt(3.0);
  const int xi[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                        {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  for (const auto& point : xi) {
    const double x = g * point[0], y = g * point[1], z = g * point[2];
    Mat3 dX = Mat3::Zero(), du = Mat3::Zero();
    for (int a = 0; a < 8; ++a) {
      const double X = xi[a][0], Y = xi[a][1], Z = xi[a][2];
      const Vec3 dN = Vec3(X * (1 + y * Y) * (1 + z * Z), Y * (1 + x * X) * (1 + z * Z),
                           Z * (1 + x * X) * (1 + y * Y)) /
                      8;
      const std::int32_t node = body.mesh.corners(0)[a];
      dX += body.mesh.X[node] * dN.transpose();
      du += Vec3::Map(&body.state.u[3 * node]) * dN.transpose();
    }
    H.emplace_back(du * dX.inverse());
  }
  return H;
}

static double hourglass_energy(Body& body) {
  EnergyTerms terms;
  energy_terms(body.model, body.part, body.state, terms);
  return sum(terms.hourglass);
}

TEST(HourglassEnhanced, is_the_neo_hookean_energy_of_the_gradients_variation) {
  Body body = make_body(parallelepiped(),
                        {.materials = {material_of(MaterialModel::neo_hookean, 1000, 9000)},
                         .solver = with(Formulation::hex8_enhanced)});
  for (std::uint64_t seed = 1; seed < 10; ++seed) {
    shake(body.state.u, 2e-3, seed);
    Mat3 mean = Mat3::Zero();
    double square = 0;
    for (const Mat3& H : gradients(body)) {
      mean += H / 8;
      square += H.squaredNorm() / 8;
    }
    const double V = element_volume(body.mesh, 0, body.mesh.X);
    const double W = 1000. / 2 * V * (square - mean.squaredNorm());
    EXPECT_NEAR(hourglass_energy(body) / W, 1, 1e-12);
  }
}

TEST(HourglassEnhanced, stays_the_same_when_the_body_turns) {
  for (const Formulation formulation : {Formulation::hex8_one_point, Formulation::hex8_enhanced}) {
    Body body = make_body(irregular_elements()[2], {.solver = with(formulation)});
    shake(body.state.u, 1e-3, 5);
    const double W = hourglass_energy(body);
    const Mat3 R = Eigen::AngleAxisd(2.5, Vec3(2, -1, 2) / 3).toRotationMatrix();
    for (std::size_t i = 0; i < body.mesh.X.size(); ++i) {
      const Vec3 X = body.mesh.X[i];
      Vec3::Map(&body.state.u[3 * i]) = R * (X + Vec3::Map(&body.state.u[3 * i])) - X;
    }
    EXPECT_NEAR(hourglass_energy(body) / W, 1, 1e-12);  // u is now ten times as large
  }
}

TEST(HourglassStiffness, of_a_cube_is_an_eighth_of_its_constant_times_the_gradients) {
  // Mode xi eta with amplitude 1 at the corners of a cube of edge h: q = 8, sum_a |B_a|^2 = 3/(2
  // h^2).
  const double h = .01, c_mu = .2, mu = 1000;
  Body body = make_body(make_box(Vec3(0, 0, 0), Vec3(h, h, h), {1, 1, 1}, BoxElements::hex8),
                        {.materials = {material_of(MaterialModel::neo_hookean, mu, 9000)},
                         .solver = {.hourglass = c_mu}});
  displace(body, [&](const Vec3& X) {
    return Vec3(1e-4 * (X.x() > h / 2 ? 1 : -1) * (X.y() > h / 2 ? 1 : -1), 0, 0);
  });
  const double k = c_mu * mu * h * h * h * 1.5 / (h * h) / 8;
  EXPECT_NEAR(hourglass_energy(body) / (k / 2 * 64 * 1e-8), 1, 1e-12);
}
