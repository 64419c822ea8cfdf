// Plates and wedges one element thick, cut along themselves: only nodes on edges can part them.
#include "cutting/cut_thin.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"
#include "mesh/mesh_file.h"
#include "real_file.h"

namespace trocar::cutting_test {
namespace {

const double split_ratio = CutTetOptions{}.split_step_ratio;

Mesh plate(BoxElements elements) {
  return make_box(Vec3(-1, -1, 0), Vec3(1, 1, 0.2), {10, 10, 1}, elements);
}

struct Cut {
  Body body;
  int n_inserted = 0;
};

// Lists are searched by halves.
void expect_ascending(const CutStroke& stroke) {
  const auto ascends = [](const auto& values) {
    return std::ranges::adjacent_find(values, [](const auto& a, const auto& b) {
             return a.element >= b.element;
           }) == values.end();
  };
  EXPECT_TRUE(ascends(stroke.side));
  EXPECT_TRUE(ascends(stroke.opened));
  EXPECT_TRUE(ascends(stroke.step));
  EXPECT_TRUE(ascends(stroke.whole_edge));
  EXPECT_TRUE(std::ranges::is_sorted(stroke.hit, {}, &CutHit::key));
}

// One frame, and the cut itself where nodes are put on edges first. The other cutter takes it up.
void step(TetCutter& cutter, BladeSweep sweep, bool is_last, Cut& result, Ledger& ledger,
          TetCutter* other = nullptr) {
  for (bool is_parted = false; !is_parted; sweep.before = sweep.after) {
    const Mesh before = result.body.mesh;
    const CutterEdit edit = advance(cutter, result.body, sweep, is_last, ledger);
    if (other != nullptr && !edit.is_empty()) other->follow(before, edit);
    is_parted = edit.inserted.empty();
    result.n_inserted += static_cast<int>(edit.inserted.size());
    expect_ascending(cutter.stroke());
  }
}

// A plane through `centre`, in n_steps frames.
void add_plane(TetCutter& cutter, const Vec3& centre, const Vec3& normal, int n_steps, Cut& result,
               TetCutter* other = nullptr) {
  const Blade blade = plane_blade(centre, normal, 3);
  Ledger ledger;
  cutter.start_stroke();
  for (int k = 0; k < n_steps; ++k)
    step(cutter, {blade(double(k) / n_steps), blade(double(k + 1) / n_steps), normal},
         k + 1 == n_steps, result, ledger, other);
}

Cut cut_along(Mesh mesh, const Vec3& centre, const Vec3& normal, double ratio, int n_steps = 20) {
  Cut result{.body = Body(std::move(mesh))};
  TetCutter cutter{CutTetOptions{.split_step_ratio = ratio}};
  add_plane(cutter, centre, normal, n_steps, result);
  return result;
}

TEST(ThinSlices, part_a_plate_in_its_plane_in_two) {
  const Mesh whole = plate(BoxElements::tet4_five);
  const Cut cut = cut_along(whole, Vec3(0, 0, 0.09), Vec3::UnitZ(), split_ratio);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_EQ(n_pieces(cut.body.mesh), 2);
  EXPECT_GT(cut.n_inserted, 0);
  EXPECT_NEAR(total_mass(cut.body.mesh), total_mass(whole), 1e-12 * total_mass(whole));
  EXPECT_NEAR(total_volume(cut.body.mesh), total_volume(whole), 1e-12 * total_volume(whole));
  EXPECT_GE(least_step_of(cut.body.mesh), split_ratio * least_step_of(whole));
}

TEST(ThinSlices, part_a_plate_askew_in_two) {
  const Mesh whole = plate(BoxElements::tet4_five);
  const Cut cut = cut_along(whole, Vec3(0, 0, 0.1), Vec3(0.03, 0.05, 1).normalized(), split_ratio);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_EQ(n_pieces(cut.body.mesh), 2);
  EXPECT_GT(cut.n_inserted, 0);
  EXPECT_NEAR(total_mass(cut.body.mesh), total_mass(whole), 1e-12 * total_mass(whole));
  EXPECT_GE(least_step_of(cut.body.mesh), split_ratio * least_step_of(whole));
}

TEST(ThinSlices, leave_a_bent_plate_sound) {
  Mesh mesh = plate(BoxElements::tet4_five);
  for (Vec3& X : mesh.X) X.z() += 0.1 * X.x() * X.x();
  const Cut cut = cut_along(mesh, Vec3(0, 0, 0.15), Vec3::UnitZ(), split_ratio);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_NEAR(total_mass(cut.body.mesh), total_mass(mesh), 1e-12 * total_mass(mesh));
}

TEST(ThinSlices, stay_as_they_are_where_the_floor_allows_no_part) {
  const Mesh whole = plate(BoxElements::tet4_five);
  const Cut cut = cut_along(whole, Vec3(0, 0, 0.1), Vec3::UnitZ(), 0.9);
  EXPECT_EQ(cut.n_inserted, 0);
  EXPECT_EQ(cut.body.mesh.n_elements(), whole.n_elements());
  EXPECT_EQ(fault(cut.body), "");
}

// Four thinner elements at a corner, whose parts no place of a node keeps above the floor.
TEST(ThinSlices, are_split_beside_elements_that_the_floor_keeps_whole) {
  Mesh mesh = plate(BoxElements::tet4_five);
  for (Vec3& X : mesh.X)
    if (X.x() > 0.9 && X.y() > 0.9 && X.z() > 0.1) X.z() = 0.1;
  const double ratio = 0.55;
  const Cut cut = cut_along(mesh, Vec3(0, 0, 0.09), Vec3::UnitZ(), ratio);
  EXPECT_GT(cut.n_inserted, 100);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_GE(least_step_of(cut.body.mesh), ratio * least_step_of(mesh));
}

TEST(ThinSlices, are_not_split_in_a_thick_body) {
  const Mesh cube = make_box(Vec3::Zero(), Vec3::Ones(), {6, 6, 6}, BoxElements::tet4_kuhn);
  for (const double z : {0.3, 0.5, 0.8, 0.9, 0.95}) {
    const Vec3 normal = Vec3(0.1, 0.2, 1).normalized();
    const Cut cut = cut_along(cube, Vec3(0.5, 0.5, z), normal, split_ratio);
    EXPECT_EQ(cut.n_inserted, 0) << z;
    EXPECT_EQ(cut.body.mesh.n_elements(), cube.n_elements());
    EXPECT_EQ(fault(cut.body), "");
  }
}

// Three planes leave a wedge at an edge of a cube, of which nearly all nodes lie on the outer
// surface: on faces that meet there, though.
TEST(ThinSlices, are_not_split_at_the_edge_of_a_thick_body) {
  Cut cut{.body = Body(make_box(Vec3::Zero(), Vec3::Ones(), {6, 6, 6}, BoxElements::tet4_kuhn))};
  TetCutter cutter{CutTetOptions{}};
  for (const Vec3& normal : {Vec3(-0.2680, 0.3014, 0.9151), Vec3(-0.5776, 0.7099, -0.4030),
                             Vec3(-0.7711, -0.6366, -0.0161)})
    add_plane(cutter, Vec3(0.52, 0.53, 0.51), normal.normalized(), 60, cut);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_EQ(n_pieces(cut.body.mesh), 8);
  EXPECT_EQ(cut.n_inserted, 0);
}

// What lies above, or below, both of two planes that cross inside a plate is a prism that tapers to
// nothing. Sides given to its elements before the second stroke was through would part it in bits.
TEST(ThinSlices, between_two_planes_that_cross_in_a_plate_come_off_whole) {
  for (int k = 0; k < 42; ++k) {
    const double angle = 0.26 * k, tilt = 0.40 + 0.006 * k;
    Cut cut{.body =
                Body(irregular(plate(k % 2 == 0 ? BoxElements::tet4_kuhn : BoxElements::tet4_five),
                               0.03, unsigned(k)))};
    TetCutter cutter{CutTetOptions{.split_step_ratio = split_ratio}};
    for (const Vec3& normal : crossing_normals(angle, tilt))
      add_plane(cutter, Vec3(0, 0, 0.1), normal, 80, cut);
    EXPECT_EQ(fault(cut.body), "");
    EXPECT_EQ(n_pieces(cut.body.mesh), 4) << k;
  }
}

// Where the second plane crosses the first one's lips, edges lead from the outer surface to these.
TEST(ThinSlices, between_two_planes_that_cross_in_a_flap_come_off_whole) {
  const std::string file = real_file("sofaenv_tissue_flap.msh");
  if (file.empty()) GTEST_SKIP() << "the flap is not beside the checkout";
  Cut cut{.body = Body(read_mesh(file, 10))};
  TetCutter cutter{CutTetOptions{.split_step_ratio = split_ratio}};
  for (const Vec3& normal : {Vec3(1, 1, 0).normalized(), Vec3(1, -1, 0).normalized()})
    add_plane(cutter, Vec3(0, 0.09, 0), normal, 80, cut);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_EQ(n_pieces(cut.body.mesh), 4);
}

// Else a crumb among the parts would not count as a chip.
TEST(ThinSlices, leave_the_mean_edge_what_it_was) {
  Cut cut{.body = Body(plate(BoxElements::tet4_five))};
  const CutTetOptions options{.split_step_ratio = split_ratio};
  TetCutter along{options}, across{options};
  add_plane(across, Vec3(0.1, 0, 0.1), Vec3::UnitX(), 20, cut);
  const double whole = across.stroke().mean_edge;
  add_plane(along, Vec3(0, 0, 0.1), Vec3::UnitZ(), 20, cut, &across);
  for (TetCutter* cutter : {&along, &across}) {
    add_plane(*cutter, Vec3(-0.3, 0, 0.1), Vec3::UnitX(), 20, cut);
    EXPECT_NEAR(cutter->stroke().mean_edge, whole, 0.1 * whole);
  }
}

// Nodes of elements that another stroke has under way: it must go on with their parts.
TEST(ThinSlices, of_one_blade_are_followed_by_another) {
  Cut cut{.body = Body(plate(BoxElements::tet4_five))};
  const CutTetOptions options{.split_step_ratio = split_ratio};
  TetCutter first{options}, second{options};
  const Vec3 centre(0, 0, 0.1);
  const Blade across = plane_blade(centre, Vec3::UnitX(), 3);
  Ledger ledger;
  second.start_stroke();
  const int n = 20;
  const auto step_across = [&](int k) {
    step(second, {across(double(k) / n), across(double(k + 1) / n), Vec3::UnitX()}, k + 1 == n, cut,
         ledger, &first);
  };
  for (int k = 0; k < n / 2; ++k) step_across(k);
  add_plane(first, centre, Vec3::UnitZ(), n, cut, &second);
  for (int k = n / 2; k < n; ++k) step_across(k);
  EXPECT_EQ(fault(cut.body), "");
  EXPECT_GE(n_pieces(cut.body.mesh), 4);
}

}  // namespace
}  // namespace trocar::cutting_test
