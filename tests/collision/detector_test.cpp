#include "collision/detector.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "collision/narrow_phase.h"
#include "collision_random.h"
#include "collision_tool.h"
#include "error_of.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

std::vector<Contact> detect(ContactDetector& detector, const std::vector<Vec3>& x,
                            const std::vector<Pose>& pose, double margin) {
  std::vector<Contact> contacts;
  const std::vector<double> margins(pose.size(), margin);
  detector.detect(x, pose, margins, contacts);
  return contacts;
}

std::vector<Contact> detect(const Mesh& mesh, const ToolShape& tool, const Pose& pose,
                            double margin = 1e-3) {
  ContactDetector detector({tool});
  detector.set_surface(boundary_surface(mesh));
  return detect(detector, mesh.X, {pose}, margin);
}

ToolShape sphere_tool() {
  return {.pieces = {{.points = {Vec3::Zero()}, .radius = tool_radius}}};
}
Pose at(const Vec3& x) {
  return {.translation = x};
}

ConvexPiece box_piece(const Vec3& half) {
  ConvexPiece piece;
  for (const int i : {-1, 1})
    for (const int j : {-1, 1})
      for (const int k : {-1, 1}) piece.points.push_back(half.cwiseProduct(Vec3(i, j, k)));
  return piece;
}

std::vector<ToolShape> mixed_tools() {
  return {sphere_tool(),
          {.pieces = {{.points = {Vec3(0, 0, 0), Vec3(0, 0, 0.05)}, .radius = 2e-3},
                      {.points = {Vec3::Zero()}, .radius = 3e-3}}},
          {.pieces = {box_piece(Vec3(2e-3, 4e-3, 8e-3)), box_piece(Vec3(0.2e-3, 3e-3, 1e-2))}}};
}

void expect_same_bits(const std::vector<Contact>& a, const std::vector<Contact>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].tool, b[k].tool);
    EXPECT_EQ(a[k].piece, b[k].piece);
    EXPECT_EQ(a[k].triangle, b[k].triangle);
    EXPECT_EQ(a[k].node, b[k].node);
    EXPECT_EQ(a[k].weight, b[k].weight);
    EXPECT_EQ(a[k].point, b[k].point);
    EXPECT_EQ(a[k].normal, b[k].normal);
    EXPECT_EQ(a[k].gap, b[k].gap);
  }
}

// The rule of the header by plain loops: winding by solid angles, the way out by trying all.
class PlainDetector {
 public:
  PlainDetector(const Mesh& mesh, const Surface& surface) {
    for (const auto& node : surface.triangle)
      triangle_.push_back({mesh.X[node[0]], mesh.X[node[1]], mesh.X[node[2]]});
  }

  std::vector<std::int32_t> touching(const ConvexPiece& piece, const Pose& pose, double margin) {
    const PieceCore core = make_core(piece);
    std::vector<std::int32_t> result;
    for (std::size_t t = 0; t < triangle_.size(); ++t) {
      Triangle local;
      for (std::size_t a = 0; a < 3; ++a) local[a] = pose.apply_inverse(triangle_[t][a]);
      const auto found = touch(core, local, margin);
      if (!found || (found->depth > 0 && !is_way_out(pose.apply(found->core), t))) continue;
      result.push_back(static_cast<std::int32_t>(t));
    }
    return result;
  }

 private:
  bool is_way_out(const Vec3& p, std::size_t t) const {
    double angle = 0, nearest = std::numeric_limits<double>::max();
    Vec3 out = Vec3::Zero();
    for (const Triangle& x : triangle_) {
      const Vec3 a = x[0] - p, b = x[1] - p, c = x[2] - p;
      angle += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                 b.dot(c) * a.norm() + c.dot(a) * b.norm());
      const Vec3 d = closest_point_triangle(p, x).point - p, n = *unit_normal(x);
      if (d.dot(n) <= 0 || d.norm() >= nearest) continue;
      nearest = d.norm();
      out = n;
    }
    return angle > M_PI && out.dot(*unit_normal(triangle_[t])) > 0;
  }

  std::vector<Triangle> triangle_;
};

TEST(ContactDetector, finds_the_same_pairs_as_plain_loops_over_all_triangles) {
  const Mesh mesh = make_ball(Vec3::Zero(), 0.02, 6, BoxElements::tet4_kuhn);
  const Surface surface = boundary_surface(mesh);
  PlainDetector plain(mesh, surface);
  const std::vector<ToolShape> tools = mixed_tools();
  ContactDetector detector(tools);
  detector.set_surface(surface);
  Random random(1);
  std::size_t n_contacts = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<Pose> pose;
    for (std::size_t k = 0; k < tools.size(); ++k)
      pose.push_back({random.rotation(), random.between(0.014, 0.027) * random.direction()});
    const std::vector<Contact> contacts = detect(detector, mesh.X, pose, 1e-3);
    std::size_t next = 0;
    for (std::size_t k = 0; k < tools.size(); ++k)
      for (std::size_t j = 0; j < tools[k].pieces.size(); ++j)
        for (const std::int32_t t : plain.touching(tools[k].pieces[j], pose[k], 1e-3)) {
          ASSERT_LT(next, contacts.size());
          EXPECT_EQ(contacts[next].tool, static_cast<std::int32_t>(k));
          EXPECT_EQ(contacts[next].piece, static_cast<std::int32_t>(j));
          EXPECT_EQ(contacts[next].triangle, t);
          ++next;
        }
    EXPECT_EQ(next, contacts.size());
    n_contacts += next;
  }
  EXPECT_GT(n_contacts, 1000u);
}

TEST(ContactDetector, point_normal_and_weights_give_the_gap_in_any_pose) {
  const Mesh mesh = make_ball(Vec3(0.3, 0.2, 0.1), 0.02, 6, BoxElements::tet4_kuhn);
  Random random(2);
  for (int k = 0; k < 20; ++k) {
    const Pose pose{random.rotation(), Vec3(0.3, 0.2, 0.1) + 0.022 * random.direction()};
    for (const ToolShape& tool : mixed_tools())
      for (const Contact& c : detect(mesh, tool, pose)) {
        Vec3 q = Vec3::Zero();
        for (std::size_t a = 0; a < 3; ++a) q += c.weight[a] * mesh.X[c.node[a]];
        const Vec3 n = pose.rotation * c.normal;
        EXPECT_NEAR(c.gap, n.dot(q - pose.apply(c.point)), 1e-11);  // Bullet's 1e-12, twice
      }
  }
}

TEST(ContactDetector, gives_the_same_bits_after_any_history_and_with_a_rebuilt_tree) {
  const Mesh mesh = make_ball(Vec3::Zero(), 0.02, 6, BoxElements::tet4_kuhn);
  const Surface surface = boundary_surface(mesh);
  Random random(3);
  std::vector<std::vector<Pose>> poses;
  std::vector<std::vector<Vec3>> positions;
  for (int k = 0; k < 6; ++k) {
    poses.emplace_back();
    for (int tool = 0; tool < 3; ++tool)
      poses.back().push_back({random.rotation(), 0.021 * random.direction()});
    positions.push_back(mesh.X);
    for (Vec3& x : positions.back()) x += random.in_box(1e-3);
  }
  ContactDetector old(mixed_tools());
  old.set_surface(surface);
  for (const int k : {3, 1, 5, 0, 2, 4, 4, 0, 5, 1, 3, 2}) {
    const auto i = static_cast<std::size_t>(k);
    ContactDetector fresh(mixed_tools());
    fresh.set_surface(surface);
    expect_same_bits(detect(old, positions[i], poses[i], 1e-3),
                     detect(fresh, positions[i], poses[i], 1e-3));
  }
}

// A sphere of 5 mm sinks 10 mm into a flat face with triangles of 6 mm.
TEST(ContactDetector, keeps_pushing_inwards_while_a_sphere_sinks_and_slides) {
  const Mesh mesh =
      make_box(Vec3(0, 0, -0.036), Vec3(0.06, 0.06, 0), {10, 10, 6}, BoxElements::tet4_kuhn);
  ContactDetector detector({sphere_tool()});
  detector.set_surface(boundary_surface(mesh));
  for (int k = 0; k <= 400; ++k) {
    const double s = k / 400.0;
    const Vec3 centre(0.022 + 0.015 * s, 0.023 + 0.011 * s, 5e-3 - 10e-3 * s);
    const auto contacts = detect(detector, mesh.X, {at(centre)}, 1e-3);
    double deepest = 1;
    for (const Contact& c : contacts) {
      EXPECT_LE(c.normal.z(), 1e-12);
      for (const std::int32_t i : c.node) EXPECT_EQ(mesh.X[i].z(), 0);
      if (c.normal.z() < -0.999999) deepest = std::min(deepest, c.gap);
    }
    EXPECT_NEAR(deepest, centre.z() - tool_radius, 1e-14) << centre.transpose();
  }
}

TEST(ContactDetector, leaves_the_far_side_of_a_thin_lobe_alone) {
  // 2 mm thick; the sphere is pressed 4.5 mm into the upper side, beyond the lower one.
  const Mesh lobe =
      make_box(Vec3(0, 0, -2e-3), Vec3(0.06, 0.06, 0), {20, 20, 1}, BoxElements::tet4_kuhn);
  for (const double z : {4e-3, 2e-3, 0.5e-3, -0.5e-3, -0.9e-3}) {
    const auto contacts = detect(lobe, sphere_tool(), at(Vec3(0.031, 0.032, z)));
    EXPECT_FALSE(contacts.empty());
    for (const Contact& c : contacts)
      for (const std::int32_t i : c.node) EXPECT_EQ(lobe.X[i].z(), 0);
  }
  // Beyond the middle the lower side is nearer, and the tool has come through.
  const auto through = detect(lobe, sphere_tool(), at(Vec3(0.031, 0.032, -3e-3)));
  EXPECT_FALSE(through.empty());
  for (const Contact& c : through) EXPECT_GE(c.normal.z(), 0);
}

TEST(ContactDetector, spreads_the_two_lips_of_a_closed_cut) {
  // Two boxes that meet at y = 0 with nodes of their own, and a blade of 0.4 mm between them.
  Mesh mesh = make_box(Vec3(0, -0.03, 0), Vec3(0.03, 0, 0.03), {5, 5, 5}, BoxElements::hex8);
  const Mesh other = make_box(Vec3(0, 0, 0), Vec3(0.03, 0.03, 0.03), {5, 5, 5}, BoxElements::hex8);
  const std::int32_t n = mesh.n_nodes();
  mesh.X.insert(mesh.X.end(), other.X.begin(), other.X.end());
  for (std::int32_t e = 0; e < other.n_elements(); ++e) {
    std::vector<std::int32_t> corners(other.corners(e).begin(), other.corners(e).end());
    for (std::int32_t& i : corners) i += n;
    add_element(mesh, ElementType::hex8, corners);
  }
  const ToolShape blade{.pieces = {box_piece(Vec3(5e-3, 0.2e-3, 5e-3))}};
  for (const double y : {0.0, 0.05e-3, 0.15e-3}) {
    int n_left = 0, n_right = 0;
    for (const Contact& c : detect(mesh, blade, at(Vec3(0.0151, y, 0.0152)), 0.3e-3)) {
      if (std::abs(c.normal.y()) < 0.7) continue;  // the blade's narrow sides
      const bool is_left = c.node[0] < n;          // tissue in y < 0
      // Left tissue goes to -y, down to the blade's lower side, and the right one to +y.
      EXPECT_NEAR(c.normal.y(), is_left ? -1 : 1, 1e-6);
      EXPECT_NEAR(c.gap, is_left ? y - 0.2e-3 : -y - 0.2e-3, 2e-9);
      ++(is_left ? n_left : n_right);
    }
    EXPECT_GT(n_left, 0);
    EXPECT_GT(n_right, 0);
  }
}

TEST(ContactDetector, touches_a_plane_mesh_at_its_boundary_edges) {
  const Mesh mesh = make_rectangle(0.07, 0.04, 10, 8);
  const auto contacts = detect(mesh, sphere_tool(), at(Vec3(0.036, 0.044, 0)));
  ASSERT_FALSE(contacts.empty());
  double least = 1;
  for (const Contact& c : contacts) {
    EXPECT_EQ(c.node[1], c.node[2]);
    EXPECT_EQ(c.weight[2], 0);
    EXPECT_LT(c.normal.y(), 0);
    EXPECT_EQ(c.normal.z(), 0);
    least = std::min(least, c.gap);
  }
  EXPECT_NEAR(least, 0.044 - 0.04 - tool_radius, 1e-14);
  // Inside the mesh and 8 mm below the edge: still pushed back to it, and no other edge.
  const auto inside = detect(mesh, sphere_tool(), at(Vec3(0.036, 0.032, 0)));
  EXPECT_FALSE(inside.empty());
  for (const Contact& c : inside) {
    EXPECT_LT(c.normal.y(), 0);
    EXPECT_EQ(mesh.X[c.node[0]].y(), 0.04);
  }
  EXPECT_TRUE(
      detect(mesh, sphere_tool(), at(Vec3(0.036, 0.044, 0.02))).empty());  // above the plane
}

TEST(ContactDetector, finds_nothing_on_an_empty_surface_or_far_away) {
  ContactDetector detector({sphere_tool()});
  EXPECT_TRUE(detect(detector, {}, {at(Vec3::Zero())}, 1e-3).empty());
  const Mesh mesh = make_ball(Vec3::Zero(), 0.02, 4, BoxElements::tet4_kuhn);
  EXPECT_TRUE(detect(mesh, sphere_tool(), at(Vec3(0.03, 0, 0))).empty());
}

TEST(ContactDetector, refuses_impossible_pieces_with_a_sentence) {
  const auto error = [](const ConvexPiece& piece) {
    return error_of([&] { ContactDetector({{.pieces = {{.points = {Vec3::Zero()}}, piece}}}); });
  };
  EXPECT_NE(error({}).find("piece 1 of instrument 0 has no points"), std::string::npos);
  EXPECT_NE(error({.points = {Vec3::Zero()}, .radius = -1}).find("radius"), std::string::npos);
  EXPECT_NE(error({.points = {Vec3(NAN, 0, 0)}}).find("not finite"), std::string::npos);
}

TEST(ContactDetector, reports_its_time_on_twenty_thousand_triangles) {
  const Mesh mesh = make_ball(Vec3::Zero(), 0.05, 41, BoxElements::tet4_kuhn);
  const Surface surface = boundary_surface(mesh);
  const ToolShape probe{.pieces = {{.points = {Vec3(0, 0, 0.01), Vec3(0, 0, 0.3)}, .radius = 3e-3},
                                   {.points = {Vec3(0, 0, 0.005)}, .radius = tool_radius}}};
  const ToolShape blade{.pieces = {{.points = {Vec3(0, 0, 0.03), Vec3(0, 0, 0.3)}, .radius = 3e-3},
                                   box_piece(Vec3(3e-3, 0.2e-3, 1e-2))}};
  ContactDetector detector({probe, blade});
  detector.set_surface(surface);
  const std::vector<Pose> pose = {{rotation_from_z(Vec3(1, 1, 3)), Vec3(0, 0, 0.049)},
                                  {rotation_from_z(Vec3(3, 1, 1)), Vec3(0.05, 0, 0)}};
  std::size_t n_contacts = detect(detector, mesh.X, pose, 1e-3).size();
  double best = 1;
  for (int k = 0; k < 20; ++k) {
    const auto start = std::chrono::steady_clock::now();
    n_contacts = detect(detector, mesh.X, pose, 1e-3).size();
    best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  // No assertion on wall-clock time: machines are loaded.
  std::printf("%zu triangles, 4 pieces, %zu contacts: %.3f ms\n", surface.triangle.size(),
              n_contacts, 1e3 * best);
  EXPECT_GT(n_contacts, 0u);
}

}  // namespace
}  // namespace trocar
