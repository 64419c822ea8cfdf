// V30: a body that is cut through moves on as one that was born in two pieces.
#include "cutting/cut_duplicate.h"
#include "cutting_tet.h"
#include "larger_or_nan.h"
#include "solver/relax.h"
#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

constexpr const char* cut_problem = "V30 Cut = pre-cut";

struct CutBody {
  Mesh mesh;
  std::vector<double> u, v;  // (n_nodes * 3)
};

static Momenta momenta_of(const CutBody& body) {
  const std::vector<double> density = {soft_tissue.density};
  const std::vector<double> mass = lumped_mass(body.mesh, density, 1);
  Momenta m;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const Vec3 p = mass[i] * Vec3::Map(&body.v[3 * i]);
    m.linear += p;
    m.angular += (body.mesh.X[i] + Vec3::Map(&body.u[3 * i])).cross(p);
  }
  return m;
}

// A block in large random motion, bent smoothly and shaken.
static CutBody moving_block() {
  CutBody body{.mesh =
                   make_box(Vec3::Zero(), Vec3(.04, .03, .03), {8, 6, 6}, BoxElements::tet4_kuhn)};
  for (const Vec3& X : body.mesh.X) {
    const Vec3 u(.3 * X.x(), 20 * X.x() * X.x(), -.2 * X.z() + 5 * X.x() * X.y());
    body.u.insert(body.u.end(), {u.x(), u.y(), u.z()});
  }
  body.v.assign(body.u.size(), 0.);
  shake(body.u, 2e-4, 1);
  shake(body.v, .1, 2);
  return body;
}

// Opens the faces in the plane x = .02, on which nodes lie.
static CutBody opened_in_the_middle(CutBody body) {
  const auto is_middle = [&](std::int32_t i) { return std::abs(body.mesh.X[i].x() - .02) < 1e-9; };
  std::vector<std::array<std::int32_t, 2>> opened;
  std::vector<std::int32_t> nodes;
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e)
    for (int f = 0; f < 4; ++f) {
      const std::array<int, 4> facet = facet_corners(ElementType::tet4, f);
      if (std::all_of(facet.begin(), facet.begin() + 3,
                      [&](int c) { return is_middle(body.mesh.corners(e)[c]); }))
        opened.push_back({e, f});
    }
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    if (is_middle(i)) nodes.push_back(i);
  const Duplication duplication = duplicate_nodes(
      body.mesh, opened, nodes, node_elements(body.mesh), facet_neighbours(body.mesh));
  const MeshEdit edit{.duplicate_parent = duplication.duplicate_parent,
                      .corners = duplication.corners};
  apply_edit(edit, body.mesh, 3, body.u);
  apply_edit(edit, body.mesh, 3, body.v);
  apply_edit(edit, body.mesh);
  return body;
}

static const Vec3 oblique = Vec3(1, .3, .2).normalized();

// In one stroke along a plane through the middle. The blade meets the body at rest: a plane there
// is one in the reference too.
static CutBody cut_through(CutBody body, const Vec3& normal) {
  cutting_test::Body tissue_body(body.mesh);
  TetCutter cutter{CutTetOptions{}};
  cutter.start_stroke();
  const cutting_test::Blade blade = cutting_test::plane_blade({.02, .015, .015}, normal, .08);
  const int n = 10;
  for (int k = 0; k < n; ++k) {
    const Mesh before = tissue_body.mesh;
    cutting_test::Ledger ledger;
    const BladeSweep sweep{blade(double(k) / n), blade(double(k + 1) / n), normal};
    const MeshEdit edit = cutting_test::advance(cutter, tissue_body, sweep, k + 1 == n, ledger);
    if (edit.is_empty()) continue;
    apply_edit(edit, before, 3, body.u);
    apply_edit(edit, before, 3, body.v);
  }
  body.mesh = tissue_body.mesh;
  return body;
}

// Piece `wanted` as a mesh of its own, with the numbers that its nodes had.
static Mesh piece_of(const Mesh& mesh, std::int32_t wanted, std::vector<std::int32_t>& node) {
  const std::vector<std::int32_t> piece = element_pieces(mesh);
  std::vector<std::int32_t> number(mesh.X.size(), -1);
  Mesh part;
  part.region_name = mesh.region_name;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (piece[e] != wanted) continue;
    std::vector<std::int32_t> corner;
    for (const std::int32_t i : mesh.corners(e)) {
      if (number[i] < 0) {
        number[i] = part.n_nodes();
        part.X.push_back(mesh.X[i]);
        node.push_back(i);
      }
      corner.push_back(number[i]);
    }
    add_element(part, ElementType::tet4, corner);
    part.density_factor.back() = mesh.density_factor[e];
  }
  return part;
}

static Body settled_in(const Mesh& mesh, const std::vector<double>& u) {
  Body body = make_body(mesh, {.materials = {soft_tissue}});
  body.state.u = u;
  return body;
}

// The greatest difference of forces over the greatest force.
static double difference_of_forces(const CutBody& cut) {
  Body whole = settled_in(cut.mesh, cut.u);
  const std::vector<double> expected = force(whole);
  double most = 0;
  std::size_t n_nodes = 0;
  for (const std::int32_t k : {0, 1}) {
    std::vector<std::int32_t> node;
    const Mesh mesh = piece_of(cut.mesh, k, node);
    std::vector<double> u;
    for (const std::int32_t i : node) u.insert(u.end(), &cut.u[3 * i], &cut.u[3 * i] + 3);
    Body born = settled_in(mesh, u);
    const std::vector<double>& f = force(born);
    for (std::size_t i = 0; i < node.size(); ++i)
      for (std::size_t j = 0; j < 3; ++j)
        most = larger_or_nan(most, std::abs(f[3 * i + j] - expected[3 * node[i] + j]));
    n_nodes += node.size();
  }
  EXPECT_EQ(n_nodes, cut.mesh.X.size());  // no node belongs to both
  return most / largest(expected);
}

static void check_forces(const std::string& cut_name, const CutBody& cut) {
  EXPECT_EQ(n_pieces(cut.mesh), 2);
  check_figure({cut_problem, "difference of forces, " + cut_name, "tet4 8 x 6 x 6",
                difference_of_forces(cut), 0, 1e-14, "two meshes, relative"});
}

TEST(V30Cut, forces_are_those_of_a_body_born_in_two_pieces) {
  check_forces("opened between elements", opened_in_the_middle(moving_block()));
  check_forces("oblique stroke", cut_through(moving_block(), oblique));
  check_forces("stroke along a plane of nodes", cut_through(moving_block(), Vec3::UnitX()));
}

TEST(V30Cut, a_cut_that_moves_no_nodes_keeps_linear_and_angular_momentum) {
  const CutBody block = moving_block(), cut = opened_in_the_middle(block);
  EXPECT_EQ(cut.mesh.n_nodes(), block.mesh.n_nodes() + 49);  // 7 x 7 partners
  const Momenta before = momenta_of(block), after = momenta_of(cut);
  // Partners share the mass and take the velocity. Some hundred roundings.
  check_figure({cut_problem, "change of linear momentum", "tet4 8 x 6 x 6",
                (after.linear - before.linear).norm() / before.linear.norm(), 0, 1e-13,
                "conservation, relative"});
  check_figure({cut_problem, "change of angular momentum", "tet4 8 x 6 x 6",
                (after.angular - before.angular).norm() / before.angular.norm(), 0, 1e-13,
                "conservation, relative"});
}

TEST(V30Cut, both_halves_relax_to_zero_strain) {
  const CutBody cut = cut_through(moving_block(), oblique);
  Body body = settled_in(cut.mesh, cut.u);
  const double before = stored_energy(body);
  settle(body, {.ramp_iterations = 0, .tolerance = 1e-6});
  // The residual is 1e-9 of the greatest, so the energy 1e-18; softer modes hold more of it.
  check_figure({cut_problem, "energy left after relaxation", "tet4 8 x 6 x 6",
                stored_energy(body) / before, 0, 1e-12, "relative"});
}
