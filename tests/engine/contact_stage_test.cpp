#include "engine/contact_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesh/generate.h"

namespace trocar {
namespace {

// A slab of tissue with its upper side at z = 0.
Mesh slab_mesh() {
  return make_box(Vec3(-0.05, -0.05, -0.02), Vec3(0.05, 0.05, 0), {10, 10, 2},
                  BoxElements::tet4_kuhn);
}

Tool resting_tool(InstrumentKind kind, const InstrumentKey& key) {
  SceneInstrument s{.kind = kind, .name = "tool", .path = {key}};
  if (kind == InstrumentKind::grasper)
    s.path.push_back({.time = key.time + 1,
                      .position = key.position,
                      .direction = key.direction,
                      .forward = key.forward,
                      .action = GraspAction::close});
  return make_tool(s, {}, 1e-3);
}

bool is_shaft(const Contact& contact) {
  return contact.piece < first_working_piece;
}

struct SlabUnderTool {
  Mesh mesh = slab_mesh();
  std::vector<Tool> tools;
  Holds holds;
  SurfaceView view;
  ContactStage stage;

  explicit SlabUnderTool(Tool tool)
      : tools{std::move(tool)}, stage{.detector = ContactDetector({tools[0].shape})} {
    holds.is_open.assign(1, 1);
    view.x = mesh.X;
    stage.detector.set_surface(boundary_surface(mesh));
  }
  const std::vector<Contact>& detect(double reach_extra = 1e-3) {
    detect_contacts(stage, tools, holds, view, {.t0 = 0, .t1 = 0.033}, reach_extra);
    return stage.contacts;
  }
};

TEST(ContactStage, sees_a_probe_on_the_tissue_and_none_above_it) {
  SlabUnderTool on(resting_tool(InstrumentKind::probe, {.position = Vec3(0.003, 0.002, -0.0005)}));
  EXPECT_FALSE(on.detect().empty());
  SlabUnderTool above(
      resting_tool(InstrumentKind::probe, {.position = Vec3(0.003, 0.002, 0.0101)}));
  EXPECT_TRUE(above.detect(0.01).empty());
  EXPECT_FALSE(above.detect(0.0102).empty());  // tissue may come up as far as that
}

TEST(ContactStage, looks_as_far_as_the_tool_travels_in_the_frame) {
  SlabUnderTool c(resting_tool(InstrumentKind::probe, {.position = Vec3(0.003, 0.002, 0.005)}));
  EXPECT_TRUE(c.detect().empty());
  SceneInstrument falling{.name = "p",
                          .path = {{.time = 0, .position = Vec3(0.003, 0.002, 0.005)},
                                   {.time = 0.033, .position = Vec3(0.003, 0.002, -0.005)}}};
  c.tools[0] = make_tool(falling, {}, 1e-3);
  EXPECT_FALSE(c.detect().empty());
}

// The end of a shaft of 150 mm that turns about its tip, 140 mm beside the middle of the slab.
TEST(ContactStage, looks_as_far_as_the_end_of_the_shaft_travels) {
  SceneInstrument turning{.name = "p", .length = 0.15};
  const Vec3 tip(-0.14, 0.002, 0.01);
  turning.path = {{.time = 0, .position = tip, .direction = Vec3(-1, 0, 0)},
                  {.time = 0.033, .position = tip, .direction = Vec3(-1, 0, 0.1)}};
  for (InstrumentKey& key : turning.path) key.forward = Vec3(0, 1, 0);
  SlabUnderTool c(make_tool(turning, {}, 1e-3));
  EXPECT_FALSE(c.detect().empty());
  turning.path.pop_back();
  c.tools[0] = make_tool(turning, {}, 1e-3);
  EXPECT_TRUE(c.detect().empty());
}

// Contacts of the slab as it lies, looked at anew.
std::vector<Contact> touching(SlabUnderTool& c) {
  std::vector<Contact> found;
  for (Contact contact : c.detect()) {
    ContactDetector::Corners corners;
    const Pose pose = c.tools[0].path.at(0);
    for (std::size_t a = 0; a < 3; ++a) {
      corners.x[a] = c.mesh.X[contact.node[a]];
      corners.local[a] = pose.apply_inverse(corners.x[a]);
    }
    if (c.stage.detector.update(corners, pose, 1e-3, contact)) found.push_back(contact);
  }
  return found;
}

// Upright on its tip, a blade would touch with its edge: it cuts there instead.
TEST(ContactStage, a_blade_does_not_touch_with_its_edge) {
  SlabUnderTool c(resting_tool(InstrumentKind::scalpel, {.position = Vec3(0.003, 0.002, 0.0003)}));
  ASSERT_FALSE(c.detect().empty());
  EXPECT_TRUE(touching(c).empty());
}

// Lying flat: y of the blade's frame is the tissue's normal.
TEST(ContactStage, a_blade_touches_with_its_flat_sides) {
  SlabUnderTool c(resting_tool(InstrumentKind::scalpel, {.position = Vec3(0.003, 0.002, 0.0004),
                                                         .direction = Vec3(0, 1, 0),
                                                         .forward = Vec3(1, 0, 0)}));
  const std::vector<Contact> contacts = touching(c);
  const auto n_blade = std::count_if(contacts.begin(), contacts.end(), [](const Contact& contact) {
    return contact.piece >= first_working_piece;
  });
  EXPECT_GT(n_blade, 0);
  for (const Contact& contact : contacts)
    if (!is_shaft(contact)) {
      EXPECT_GE(std::abs(contact.normal.y()), 0.9);
    }
}

TEST(ContactStage, a_probe_keeps_contacts_with_any_normal) {
  SlabUnderTool c(resting_tool(InstrumentKind::probe, {.position = Vec3(0.003, 0.002, -0.0005),
                                                       .direction = Vec3(0, 0, -1)}));
  const std::vector<Contact>& contacts = c.detect();
  EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                          [](const Contact& k) { return std::abs(k.normal.y()) < 0.7; }));
}

// A grasper lying on the slab: shaft and jaws both touch.
SlabUnderTool lying_grasper() {
  return SlabUnderTool(resting_tool(InstrumentKind::grasper, {.position = Vec3(0.003, -0.03, 0.001),
                                                              .direction = Vec3(0, -1, -0.01),
                                                              .forward = Vec3(1, 0, 0)}));
}

std::set<std::int32_t> pieces_of(const std::vector<Contact>& contacts) {
  std::set<std::int32_t> pieces;
  for (const Contact& contact : contacts) pieces.insert(contact.piece);
  return pieces;
}

TEST(ContactStage, closed_jaws_touch_in_place_of_open_ones) {
  SlabUnderTool c = lying_grasper();
  EXPECT_EQ(pieces_of(c.detect()), (std::set<std::int32_t>{0, 1, 2}));
  c.holds.is_open[0] = 0;
  EXPECT_EQ(pieces_of(c.detect()), (std::set<std::int32_t>{0, 3}));
}

// As deep as their axis lies.
TEST(ContactStage, tissue_between_closed_jaws_does_not_touch_them) {
  SlabUnderTool c = lying_grasper();
  c.holds.is_open[0] = 0;
  ASSERT_EQ(pieces_of(c.detect()).count(3), 1U);
  SceneInstrument lower{.kind = InstrumentKind::grasper, .name = "tool"};
  lower.path = {{.position = Vec3(0.003, -0.03, 0), .direction = Vec3(0, -1, 0)}};
  c.tools[0] = make_tool(lower, {}, 1e-3);
  EXPECT_EQ(pieces_of(c.detect(0)).count(3), 0U);
}

TEST(ContactStage, a_shaft_does_not_touch_what_its_closed_jaws_hold) {
  SlabUnderTool c = lying_grasper();
  c.holds.is_open[0] = 0;
  const std::vector<Contact> before = c.detect();
  ASSERT_FALSE(before.empty());
  const std::int32_t held = before[0].node[1];
  const auto touches_held = [&](const Contact& k) {
    return std::count(k.node.begin(), k.node.end(), held) > 0;
  };
  c.holds.holds = {{.node = held, .tool = 0}};
  const std::vector<Contact> after = c.detect();
  EXPECT_TRUE(std::none_of(after.begin(), after.end(), touches_held));
  EXPECT_EQ(static_cast<std::ptrdiff_t>(before.size() - after.size()),
            std::count_if(before.begin(), before.end(), touches_held));
  c.holds.holds = {{.node = held, .tool = 1}};  // held by another
  EXPECT_EQ(c.detect().size(), before.size());
}

TEST(MoveTools, gives_the_velocity_of_the_path_over_the_last_substep) {
  SceneInstrument s{.name = "p",
                    .path = {{.time = 0, .direction = Vec3(0, 0, -1)},
                             {.time = 1,
                              .position = Vec3(0.1, 0, 0.05),
                              .direction = Vec3(0.6, 0, -1),
                              .forward = Vec3(1, 0, 0.5)}}};
  const std::vector<Tool> tools = {make_tool(s, {}, 1e-3)};
  std::vector<ToolMotion> motion(1);
  const double t = 0.4, dt = 1e-5;
  move_tools(tools, t, dt, motion);
  const Pose now = tools[0].path.at(t), before = tools[0].path.at(t - dt);
  EXPECT_EQ(motion[0].pose.translation, now.translation);
  EXPECT_EQ(motion[0].velocity, Vec3((now.translation - before.translation) / dt));
  // The twist moves any point of the tool as the two poses do, up to O(dt) of the turn: |omega|^2
  // dt |r| < 1e-6.
  const Vec3 local(0.01, 0.02, 0.1);
  const Vec3 expected = (now.apply(local) - before.apply(local)) / dt;
  const Vec3 r = now.apply(local) - now.translation;
  EXPECT_LT((motion[0].velocity + motion[0].angular_velocity.cross(r) - expected).norm(), 1e-6);
  EXPECT_GT(motion[0].angular_velocity.norm(), 0.1);
}

TEST(MoveTools, gives_no_velocity_to_a_resting_tool) {
  const std::vector<Tool> tools = {resting_tool(
      InstrumentKind::probe, {.position = Vec3(1, 2, 3), .direction = Vec3(0.3, 0.4, -1)})};
  std::vector<ToolMotion> motion(1);
  move_tools(tools, 0.4, 1e-5, motion);
  EXPECT_EQ(motion[0].velocity, Vec3::Zero());
  EXPECT_LT(motion[0].angular_velocity.norm(), 1e-10);  // roundings of 1e-16 over 1e-5 s
}

TEST(ContactReactions, are_the_mean_over_the_substeps_by_tool) {
  SlabUnderTool c(resting_tool(InstrumentKind::probe, {.position = Vec3::Zero()}));
  c.stage.set.items.resize(3);
  for (std::size_t k = 0; k < 3; ++k) {
    c.stage.set.items[k].contact.tool = k == 2 ? 1 : 0;
    c.stage.set.items[k].reaction_sum = Vec3(2, 8 * static_cast<double>(k), 1);
    c.stage.set.items[k].torque_sum = Vec3(0, 0, 4);
  }
  std::vector<ToolLoad> load(2);
  sum_contact_reactions(c.stage, 4, load);
  EXPECT_EQ(load[0].force[0].value(), 0);  // another rank reports them
  c.stage.set.is_counted_here = true;
  sum_contact_reactions(c.stage, 4, load);
  EXPECT_EQ(load[0].force[0].value(), 2 * 2 / 4.0);
  EXPECT_EQ(load[0].force[1].value(), 8 / 4.0);
  EXPECT_EQ(load[0].torque[2].value(), 2 * 4 / 4.0);
  EXPECT_EQ(load[1].force[0].value(), 2 / 4.0);
  EXPECT_EQ(load[1].force[1].value(), 16 / 4.0);
  EXPECT_EQ(load[1].force[2].value(), 0.25);
  EXPECT_EQ(load[1].torque[2].value(), 1);
}

TEST(PrepareFrameContacts, starts_each_frame_without_reactions_and_moves_nothing_that_is_held) {
  SlabUnderTool c(resting_tool(InstrumentKind::probe, {.position = Vec3(0.003, 0.002, -0.0005)}));
  ASSERT_FALSE(c.detect().empty());
  const std::vector<std::int32_t> owner(c.mesh.X.size(), 0);
  const std::vector<double> mass(c.mesh.X.size(), 1e-3);
  std::vector<std::uint8_t> fixed(c.mesh.X.size(), 0);
  const Contact& first = c.stage.contacts[0];
  fixed[first.node[0]] = 7;
  fixed[first.node[1]] = 3;  // free to move along z
  c.holds.holds = {{.node = first.node[2], .tool = 0}};
  const Part part = make_part(c.mesh, owner, 0);
  prepare_frame_contacts(c.stage, {.part = part, .node_owner = owner, .mass = mass, .fixed = fixed},
                         c.holds);
  const ContactSet& set = c.stage.set;
  ASSERT_EQ(set.items.size(), c.stage.contacts.size());
  const std::array<Vec3, 3> expected = {Vec3::Zero(), Vec3(0, 0, 1e3), Vec3::Zero()};
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_EQ(set.inverse_mass[set.items[0].place[a]], expected[a]);
  for (const ContactSet::Item& item : set.items) EXPECT_EQ(item.reaction_sum, Vec3(Vec3::Zero()));
  EXPECT_EQ(c.stage.set.local.size(), set.node.size());
}

TEST(SharePositions, puts_the_displacements_of_both_ends_of_the_step_on_the_nodes) {
  SlabUnderTool c(resting_tool(InstrumentKind::probe, {.position = Vec3(0.003, 0.002, -0.0005)}));
  ASSERT_FALSE(c.detect().empty());
  const std::vector<std::int32_t> owner(c.mesh.X.size(), 0);
  const std::vector<double> mass(c.mesh.X.size(), 1e-3);
  const std::vector<std::uint8_t> fixed(c.mesh.X.size(), 0);
  const Part part = make_part(c.mesh, owner, 0);
  prepare_frame_contacts(c.stage, {.part = part, .node_owner = owner, .mass = mass, .fixed = fixed},
                         c.holds);
  std::vector<double> u(3 * c.mesh.X.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = 1e-4 * static_cast<double>(i);
    c.stage.u_next[i] = -2 * u[i];
  }
  Communicator alone;
  share_positions(c.stage, c.mesh.X, u, alone);
  for (std::size_t k = 0; k < c.stage.set.node.size(); ++k) {
    const auto i = static_cast<std::size_t>(c.stage.set.node[k]);
    EXPECT_EQ(c.stage.set.x_start[k], Vec3(c.mesh.X[i] + Vec3::Map(&u[3 * i])));
    EXPECT_EQ(c.stage.set.x_end[k], Vec3(c.mesh.X[i] - 2 * Vec3::Map(&u[3 * i])));
  }
}

}  // namespace
}  // namespace trocar
