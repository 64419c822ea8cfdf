#include <gtest/gtest.h>

#include <algorithm>

#include "engine_scene.h"

namespace trocar {
namespace {

std::vector<std::string> config_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(TROCAR_SOURCE_DIR "/configs"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

std::string echo(const Scene& scene) {
  return echo_options(scene_options(), &scene);
}

// Of a text alone: the files that it names need not be there.
Scene read_scene_text(const std::string& text) {
  Scene scene;
  SourceMap where;
  read_options_text(scene_options(), text, "s.toml", {}, &scene, where);
  return scene;
}

TEST(SceneOptions, the_echo_of_every_shipped_scene_reads_back_to_the_same_echo) {
  ASSERT_FALSE(config_files().empty());
  for (const std::string& file : config_files()) {
    const std::string text = echo(load_scene(file, {}).scene);
    EXPECT_EQ(echo(read_scene_text(text)), text) << file;
  }
}

TEST(SceneOptions, the_echo_of_the_least_scene_reads_back_too) {
  const std::string text = echo(load_scene_text(scene_text()));
  EXPECT_EQ(echo(read_scene_text(text)), text);
}

// A scene whose every value differs from its default, written by hand in units.
const char* const full_scene = R"(
name = "full"
[time]
duration = "2 min"
frame_rate = "60 Hz"
pace = "real-time"
overrun = "stop"
[tissue]
mesh = "a.msh"
scale = "1 mm"
longest_side = "15 cm"
centred = true
translate = ["1 mm", "2 mm", "3 mm"]
thickness = "4 mm"
[tissue.material]
model = "linear"
young_modulus = "3.5 kPa"
poisson_ratio = 0.3
density = "1.1 g/cm^3"
[tissue.look]
colour = [0.1, 0.2, 0.3]
cut_colour = [0.4, 0.5, 0.6]
wetness = 0.9
texture_size = "5 mm"
has_edges = true
[solver]
gravity = [0, 0, "-9.81 m/s^2"]
mass_damping = "5 1/s"
hourglass = 0.2
step_factor = 0.8
hexahedron = "full"
tetrahedron = "nodal-pressure"
triangle = "plane-stress"
precision = "single"
[contact]
release_speed = "0.3 m/s"
friction = 0.3
[cutting]
advance = 0.7
least_step_ratio = 0.4
split_step_ratio = 0.3
resistance = "20 N/m"
mode = "paper"
spring = 2
particle = 0.3
[[region]]
name = "r"
low = [0, 0, 0]
high = ["1 cm", "2 cm", "3 cm"]
[[support]]
region = "r"
fix = "xyz"
path = [ { time = "100 ms", displacement = [0, 0, 0] }, { time = "200 ms", displacement = ["1 mm", 0, 0] } ]
[[instrument]]
kind = "grasper"
name = "g"
radius = "4 mm"
length = "20 cm"
blade_length = "1 cm"
grip_radius = "7 mm"
grip_force = "2 N"
mesh = "g.stl"
scale = "1 mm"
[[instrument.path]]
time = "0.5 s"
position = [0, "1 cm", 0]
direction = [0, 1, 0]
forward = [0, 0, 1]
action = "close"
[[camera]]
name = "c"
eye = ["10 cm", 0, 0]
target = [0, "1 cm", 0]
up = [0, 1, 0]
field_of_view = "90 deg"
endoscope_mask = true
[[output]]
kind = "contact-sheet"
file = "s.png"
camera = "c"
size = [640, 480]
every = "0.5 s"
)";

TEST(SceneOptions, every_key_reaches_its_member_in_si) {
  const Scene s = read_scene_text(full_scene);
  EXPECT_EQ(s.name, "full");
  EXPECT_EQ(s.time.duration, 120);
  EXPECT_EQ(s.time.frame_rate, 60);
  EXPECT_EQ(s.time.pace, Pace::real_time);
  EXPECT_EQ(s.time.overrun, Overrun::stop);
  EXPECT_EQ(s.tissue.mesh, "a.msh");
  EXPECT_DOUBLE_EQ(s.tissue.scale, 1e-3);
  EXPECT_DOUBLE_EQ(s.tissue.longest_side, 0.15);
  EXPECT_TRUE(s.tissue.is_centred);
  EXPECT_LT((s.tissue.translate - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-18);
  EXPECT_FALSE(s.tissue.shape.has_value());
  EXPECT_DOUBLE_EQ(s.tissue.thickness, 4e-3);
  EXPECT_EQ(s.tissue.material.model, MaterialModel::linear);
  EXPECT_DOUBLE_EQ(s.tissue.material.young_modulus, 3500);
  EXPECT_EQ(s.tissue.material.poisson_ratio, 0.3);
  EXPECT_DOUBLE_EQ(s.tissue.material.density, 1100);
  EXPECT_EQ(s.tissue.look.colour, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(s.tissue.look.cut_colour, Vec3(0.4, 0.5, 0.6));
  EXPECT_EQ(s.tissue.look.wetness, 0.9);
  EXPECT_DOUBLE_EQ(s.tissue.look.texture_size, 5e-3);
  EXPECT_TRUE(s.tissue.look.has_edges);
  EXPECT_EQ(s.solver.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(s.solver.mass_damping, 5);
  EXPECT_EQ(s.solver.hourglass, 0.2);
  EXPECT_EQ(s.solver.step_factor, 0.8);
  EXPECT_EQ(s.solver.hexahedron, Formulation::hex8_full);
  EXPECT_EQ(s.solver.tetrahedron, Formulation::tet4_nodal_pressure);
  EXPECT_EQ(s.solver.triangle, Formulation::tri3_plane_stress);
  EXPECT_EQ(s.solver.precision, Precision::in_single);
  EXPECT_EQ(s.contact.release_speed, 0.3);
  EXPECT_EQ(s.contact.friction, 0.3);
}

TEST(SceneOptions, every_key_of_the_operation_reaches_its_member_in_si) {
  const Scene s = read_scene_text(full_scene);
  EXPECT_EQ(s.cutting.advance, 0.7);
  EXPECT_EQ(s.cutting.least_step_ratio, 0.4);
  EXPECT_EQ(s.cutting.split_step_ratio, 0.3);
  EXPECT_EQ(s.cutting.resistance, 20);
  EXPECT_EQ(s.cutting.mode, CutMode::paper);
  EXPECT_EQ(s.cutting.spring, 2);
  EXPECT_EQ(s.cutting.particle, 0.3);
  EXPECT_EQ(s.regions.at(0).name, "r");
  EXPECT_LT((s.regions[0].high - Vec3(0.01, 0.02, 0.03)).norm(), 1e-17);
  EXPECT_EQ(s.supports.at(0).region, "r");
  EXPECT_DOUBLE_EQ(s.supports[0].path.at(0).time, 0.1);
  EXPECT_DOUBLE_EQ(s.supports[0].path[1].displacement.x(), 1e-3);
  const SceneInstrument& i = s.instruments.at(0);
  EXPECT_EQ(i.kind, InstrumentKind::grasper);
  EXPECT_EQ(i.name, "g");
  EXPECT_DOUBLE_EQ(i.radius, 4e-3);
  EXPECT_DOUBLE_EQ(i.length, 0.2);
  EXPECT_DOUBLE_EQ(i.blade_length, 0.01);
  EXPECT_DOUBLE_EQ(i.grip_radius, 7e-3);
  EXPECT_DOUBLE_EQ(i.grip_force, 2);
  EXPECT_EQ(i.mesh, "g.stl");
  EXPECT_DOUBLE_EQ(i.scale, 1e-3);
  EXPECT_EQ(i.path.at(0).time, 0.5);
  EXPECT_DOUBLE_EQ(i.path[0].position.y(), 0.01);
  EXPECT_EQ(i.path[0].direction, Vec3(0, 1, 0));
  EXPECT_EQ(i.path[0].forward, Vec3(0, 0, 1));
  EXPECT_EQ(i.path[0].action, GraspAction::close);
  const SceneCamera& c = s.cameras.at(0);
  EXPECT_EQ(c.name, "c");
  EXPECT_DOUBLE_EQ(c.eye.x(), 0.1);
  EXPECT_DOUBLE_EQ(c.target.y(), 0.01);
  EXPECT_EQ(c.up, Vec3(0, 1, 0));
  EXPECT_DOUBLE_EQ(c.field_of_view, 1.5707963267948966);  // pi / 2
  EXPECT_TRUE(c.has_endoscope_mask);
  const SceneOutput& o = s.outputs.at(0);
  EXPECT_EQ(o.kind, OutputKind::contact_sheet);
  EXPECT_EQ(o.file, "s.png");
  EXPECT_EQ(o.camera, "c");
  EXPECT_EQ(o.size, (std::array<int, 2>{640, 480}));
  EXPECT_EQ(o.every, 0.5);
}

TEST(SceneOptions, every_key_of_a_shape_reaches_its_member_in_si) {
  const Scene s =
      load_scene_text(scene_text("elements = \"tet4-kuhn\"\nlow = [\"-1 cm\", 0, 0]\nhigh = [1, 2, "
                                 "3]\ncentre = [4, 5, 6]\nradius = \"1 cm\"\n"
                                 "height = \"2 cm\"\ncells = [7, 8, 9]\n"));
  EXPECT_EQ(s.tissue.shape->kind, ShapeKind::box);
  EXPECT_EQ(s.tissue.shape->elements, BoxElements::tet4_kuhn);
  EXPECT_DOUBLE_EQ(s.tissue.shape->low.x(), -0.01);
  EXPECT_EQ(s.tissue.shape->high, Vec3(1, 2, 3));
  EXPECT_EQ(s.tissue.shape->centre, Vec3(4, 5, 6));
  EXPECT_DOUBLE_EQ(s.tissue.shape->radius, 0.01);
  EXPECT_DOUBLE_EQ(s.tissue.shape->height, 0.02);
  EXPECT_EQ(s.tissue.shape->cells, (std::array<int, 3>{7, 8, 9}));
}

TEST(SceneOptions, the_echo_of_a_full_scene_reads_back_to_the_same_echo) {
  const std::string text = echo(read_scene_text(full_scene));
  EXPECT_EQ(echo(read_scene_text(text)), text);
}

TEST(SceneOptions, unknown_keys_and_impossible_values_are_refused) {
  EXPECT_TRUE(contains(scene_error(scene_text("[solver]\ngravty = [0, 0, 0]\n")), "gravity"));
  EXPECT_NE(scene_error(scene_text("[tissue.material]\npoisson_ratio = 0.5\n")), "");
  EXPECT_NE(scene_error(scene_text("[tissue.material]\nyoung_modulus = \"3 kg\"\n")), "");
  EXPECT_NE(scene_error(scene_text("[solver]\nstep_factor = 0\n")), "");
  EXPECT_NE(scene_error(scene_text("[contact]\nrelease_speed = -1\n")), "");
  EXPECT_NE(scene_error(scene_text("cells = [0, 1, 1]\n")), "");
  // A colour has no unit.
  EXPECT_TRUE(contains(scene_error(scene_text("[tissue.look]\ncolour = \"red\"\n")),
                       "colour: needs a list of 3 numbers, found the text \"red\""));
}

}  // namespace
}  // namespace trocar
