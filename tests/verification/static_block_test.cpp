// V11, V12, V13: blocks that are stretched, squeezed and indented, against an implicit mixed solver
// of high order (numerics 2).
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static const std::string mixed_solver = "implicit Q3/P2 mixed solver";
static const Material tissue = {MaterialModel::neo_hookean, 3000, .49, 1000};

// A quarter of the cube of edge .1 about the z axis, mirror planes x = 0 and y = 0, top moved by
// `lift`. n: cells over half an edge.
static Body bonded_cube(const Variant& variant, int n, double lift) {
  Body body = make_box_body(
      variant,
      {.size = {.05, .05, .1}, .n = {n, n, 2 * n}, .material = tissue, .fixed = [](const Vec3& X) {
         if (X.z() < 1e-9 || X.z() > .1 - 1e-9) return FixedMask{3};
         return static_cast<FixedMask>((X.x() < 1e-9 ? 1 : 0) | (X.y() < 1e-9 ? 2 : 0));
       }});
  std::vector<PrescribedNode> ends;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i) {
    const double z = body.mesh.X[i].z();
    if (z < 1e-9) ends.push_back({.node = i});
    if (z > .1 - 1e-9) ends.push_back({.node = i, .u_next = Vec3(0, 0, lift)});
  }
  settle(body, {.prescribed = ends});
  return body;
}

static double top_reaction(const Body& body) {
  return 4 * reaction_of(body, [](const Vec3& X) { return X.z() > .1 - 1e-9; }).z();
}

static void check_cube(const Variant& variant, int n, double lift, double force, double bulge,
                       double tolerance) {
  const Body body = bonded_cube(variant, n, lift);
  const std::string mesh = mesh_name(variant, {n, n, 2 * n});
  const std::string end = lift > 0 ? " at +20 %" : " at -20 %";
  check_figure({"V11 Bonded cube", "force" + end + " [N]", mesh, top_reaction(body), force,
                tolerance, mixed_solver});
  check_figure({"V11 Bonded cube", "bulge of the face" + end + " [m]", mesh,
                displacement_at(body, {.05, 0, .05}).x(), bulge, tolerance, mixed_solver});
}

TEST(V11BondedCube, force_and_bulge_are_those_of_the_mixed_solver) {
  // numerics V11: one-point hexahedra +.8 % and +2.9 % at n = 4, +.3 % and +1.8 % at n = 8.
  check_cube(hex_one_point, 4, .02, 6.084, -.005372, .012);
  check_cube(hex_one_point, 4, -.02, -9.0, .00749, .035);
  check_cube(hex_one_point, 8, .02, 6.084, -.005372, .006);
  check_cube(hex_one_point, 8, -.02, -9.0, .00749, .023);
}
