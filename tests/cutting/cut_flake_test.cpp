// Pieces at the end of a neck that stays with the other side.
#include "cutting/cut_flake.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"
#include "mesh/mesh_file.h"
#include "real_file.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr double blade_height = 0.4;
constexpr int bar_end = 5, neck = 2;

// Adds cells `from` to `to` of a bar.
void add_cells(int from, int to, Mesh& mesh) {
  const Mesh part =
      make_box({double(from), 0, 0}, {double(to), 1, 1}, {to - from, 1, 1}, BoxElements::tet4_kuhn);
  const std::int32_t first = mesh.n_nodes();
  mesh.X.insert(mesh.X.end(), part.X.begin(), part.X.end());
  for (std::int32_t e = 0; e < part.n_elements(); ++e) {
    std::vector<std::int32_t> node(part.corners(e).begin(), part.corners(e).end());
    for (std::int32_t& i : node) i += first;
    add_element(mesh, ElementType::tet4, node);
  }
}

int cell_of(const Mesh& mesh, std::int32_t e) {
  double x = 0;
  for (const std::int32_t i : mesh.corners(e)) x += mesh.X[i].x() / 4;
  return int(x);
}

// A row of cells that a blade has gone through at `blade_height`: all are on the + side but for the
// cell of the neck.
struct CrossedBar {
  Mesh mesh;
  CutStroke stroke;
  std::vector<std::int32_t> piece;  // before the neck

  // Marks the edges that a surface crosses.
  void cross(const std::function<double(const Vec3&)>& phi) {
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      for (std::int32_t k = 0; k < 6; ++k) {
        const double a = phi(mesh.X[mesh.corners(e)[tet_edges[k][0]]]),
                     b = phi(mesh.X[mesh.corners(e)[tet_edges[k][1]]]);
        if (a * b < 0) stroke.hit.push_back({e, k, a > 0});
      }
    std::ranges::sort(stroke.hit, {}, &CutHit::key);
  }
  bool has_flake() const {
    return find_flake(mesh, index_of(mesh), stroke, piece, 1, stroke.side).is_one;
  }
};

CrossedBar crossed_bar(Mesh mesh) {
  CrossedBar bar{std::move(mesh), {}, {}};
  for (std::int32_t e = 0; e < bar.mesh.n_elements(); ++e) {
    const int cell = cell_of(bar.mesh, e);
    bar.stroke.side.push_back({e, static_cast<std::int8_t>(cell == neck ? -1 : 1)});
    if (cell < neck) bar.piece.push_back(e);
  }
  bar.cross([](const Vec3& X) { return X.z() - blade_height; });
  return bar;
}

Mesh whole_bar() {
  Mesh mesh;
  mesh.region_name = {""};
  add_cells(0, bar_end, mesh);
  return mesh;
}

TEST(IsFlake, a_piece_that_the_blade_left_joined_across_a_neck) {
  EXPECT_TRUE(crossed_bar(whole_bar()).has_flake());
}

TEST(IsFlake, no_piece_that_the_blade_parted_from_the_rest) {
  CrossedBar bar = crossed_bar(whole_bar());
  bar.cross([](const Vec3& X) { return neck + 0.5 - X.x(); });
  EXPECT_FALSE(bar.has_flake());
}

TEST(IsFlake, no_piece_beside_which_none_has_its_side) {
  CrossedBar bar = crossed_bar(whole_bar());
  for (OfElement<std::int8_t>& s : bar.stroke.side)
    if (cell_of(bar.mesh, s.element) > neck) s.value = -1;
  EXPECT_FALSE(bar.has_flake());
}

// The piece and the neck have nodes of their own where they meet.
TEST(IsFlake, across_facets_that_this_stroke_opened_but_no_older_one) {
  Mesh mesh;
  mesh.region_name = {""};
  add_cells(0, neck, mesh);
  add_cells(neck, bar_end, mesh);
  CrossedBar bar = crossed_bar(std::move(mesh));
  EXPECT_FALSE(bar.has_flake());
  for (std::int32_t e = 0; e < bar.mesh.n_elements(); ++e)
    for (int f = 0; f < 4; ++f)
      if (std::ranges::all_of(tet_facets[std::size_t(f)], [&](int c) {
            return bar.mesh.X[bar.mesh.corners(e)[std::size_t(c)]].x() == neck;
          }))
        bar.stroke.opened.push_back({e, static_cast<std::uint8_t>(1 << f)});
  EXPECT_TRUE(bar.has_flake());
}

// A block whose top sinks in the middle to `depth` above the blade: one end came off apart from the
// other although the blade left them joined.
Mesh cut_sunk_block(double depth, int n_steps) {
  Mesh mesh = make_box({0, 0, 0}, {5, 2, 2}, {5, 2, 2}, BoxElements::tet4_kuhn);
  for (Vec3& X : mesh.X)
    if (X.z() == 2) X.z() = 1.2 + (X.x() < 2 || X.x() > 3 ? 1 : depth);
  Body body(std::move(mesh));
  const Blade blade = straight_blade({-1, -1, 1.2}, {-1, 3, 1.2}, {7, 0, 0});
  TetCutter cutter{CutTetOptions{.split_step_ratio = 0}};
  cut(body, blade, Vec3::UnitZ(), n_steps, cutter);
  EXPECT_EQ(fault(body), "");
  return std::move(body.mesh);
}

TEST(Flakes, stay_with_the_other_side_but_not_what_the_blade_parted) {
  EXPECT_EQ(n_pieces(cut_sunk_block(0.1, 12)), 2);
  EXPECT_EQ(n_pieces(cut_sunk_block(-0.1, 12)), 3);
}

// Both ends and the middle lie above a blade that passes in one advance: no neck is parted before.
TEST(Flakes, keep_their_necks_where_a_blade_passes_at_once) {
  const Mesh mesh = cut_sunk_block(0.1, 1);
  ASSERT_EQ(n_pieces(mesh), 2);
  const std::vector<std::int32_t> piece = element_pieces(mesh);
  std::array<double, 2> V{};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    V[std::size_t(piece[e])] += element_volume(mesh, e, mesh.X);
  constexpr double above = 2 * (1 + 0.55 + 0.1 + 0.55 + 1);  // the blade
  EXPECT_NEAR(std::min(V[0], V[1]), above, 0.1 * above);
}

// Planes at 3 and 1 degrees to the axis leave wedges that taper to nothing: some 5 h^3 of these
// came off.
TEST(Flakes, of_a_slender_body_stay_with_the_other_side) {
  const std::string file = real_file("sofa_cylinder_pdms.vtk");
  if (file.empty()) GTEST_SKIP() << "the cylinder is not beside the checkout";
  const Mesh cylinder = read_mesh(file, 1);
  const auto n_pieces_after = [&](const Vec3& centre, const Vec3& normal, const Vec3& along) {
    Body body(cylinder);
    const Vec3 n = normal.normalized(), way = n.cross(along).normalized(), edge = way.cross(n);
    constexpr double reach = 0.1;
    const Vec3 begin = centre - reach * way;
    cut(body, straight_blade(begin - reach * edge, begin + reach * edge, 2 * reach * way, 50), n,
        200);
    EXPECT_EQ(fault(body), "");
    return n_pieces(body.mesh);
  };
  EXPECT_EQ(n_pieces_after(Vec3(-0.0002, 0, 0.0646), Vec3(0.943, -0.328, 0.05),
                           Vec3(-0.148, -0.549, -0.823)),
            2);
  EXPECT_EQ(n_pieces_after(Vec3(0.0019, -0.0015, 0.1242), Vec3(0.493, -0.870, 0.018),
                           Vec3(0.559, 0.301, -0.772)),
            2);
}

// Between two planes that cross in a coarse plate. What hangs together around the blade is parted
// from its side for a while where tissue ahead of it is not parted yet.
TEST(Flakes, are_not_decided_on_before_the_blade_has_left) {
  for (const int k : {59, 94}) {
    const BoxElements elements = k % 2 == 0 ? BoxElements::tet4_kuhn : BoxElements::tet4_five;
    Body body(
        irregular(make_box({-1, -1, 0}, {1, 1, 0.4}, {5, 5, 1}, elements), 0.08, unsigned(k)));
    const double angle = 0.26 * k, tilt = 0.5 + 0.05 * (k % 10);
    TetCutter cutter{CutTetOptions{.split_step_ratio = 0}};
    for (const Vec3& normal : crossing_normals(angle, tilt))
      cut(body, plane_blade(Vec3(0, 0, 0.2), normal, 3), normal, 30, cutter);
    EXPECT_EQ(fault(body), "");
    EXPECT_EQ(n_pieces(body.mesh), 4) << k;
  }
}

}  // namespace
}  // namespace trocar
