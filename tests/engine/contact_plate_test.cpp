// Flat instruments that cover all of a body's face press it alike everywhere, and slide on it:
// force and direction have closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "box_file.h"
#include "engine/event_log.h"
#include "engine_started.h"
#include "larger_or_nan.h"
#include "mesh/generate.h"
#include "mesh_write.h"

namespace trocar {
namespace {

constexpr double E = 5000, nu = 0.3, side = 0.04, stretch = 0.9;

// A box of 160 x 160 x 10 mm with the middle of its lower face at the origin.
void write_plate(const std::string& file) {
  write_box(file, Vec3(-0.08, -0.08, 0), Vec3(0.08, 0.08, 0.01));
}

// Cauchy stress of the neo-Hookean law along the first of the stretches a, b, c. [Pa]
double stress(double a, double b, double c) {
  const double mu = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu)), J = a * b * c;
  const double I1 = a * a + b * b + c * c;
  return mu * std::pow(J, -5.0 / 3) * (a * a - I1 / 3) + K * (J - 1);
}

// Of a cube of tissue, or of a plate of tissue in plane strain, that may go aside freely: its
// stretch aside.
double stretch_aside(bool is_plane) {
  double low = 1, high = 1.5;
  for (int k = 0; k < 60; ++k) {
    const double aside = 0.5 * (low + high);
    (stress(aside, stretch, is_plane ? 1 : aside) < 0 ? low : high) = aside;
  }
  return low;
}

// And what presses it. [N]
double closed_form(bool is_plane, double thickness) {
  const double aside = stretch_aside(is_plane), other = is_plane ? 1 : aside;
  return -stress(stretch, aside, other) * side * aside * thickness * other;
}

// Presses along -z, in the plane along -y, for 0.2 s, rests until 0.4 s and slides along x.
struct Slide {
  std::string body, supports;
  bool is_plane = false;
  bool is_mesh = true;  // else a shaft that lies on the tissue
  std::string solver = "";
};

std::unique_ptr<Started> make_slide(const Slide& slide, double friction) {
  const TestFolder folder;
  write_plate(folder.file("plate.obj"));
  const double lift = slide.is_mesh ? 0 : 0.003;
  const auto at = [&](double x, double height) {
    const std::string across = std::to_string(height + lift);
    const std::string place = std::to_string(x) + (slide.is_plane ? ", " : ", 0, ") + across;
    return "position = [" + place + (slide.is_plane ? ", 0]" : "]") +
           (slide.is_plane && slide.is_mesh ? ", direction = [0, -1, 0]"
            : slide.is_mesh                 ? ""
                                            : ", direction = [-1, 0, 0], forward = [0, 0, 1]");
  };
  const double from = slide.is_mesh ? 0 : -0.06;
  return built("[time]\nduration = 10\nframe_rate = 60\n" + slide.body +
               "[tissue.material]\nyoung_modulus = 5000\npoisson_ratio = "
               "0.3\n[solver]\nmass_damping = 60\n" +
               slide.solver + slide.supports + "[contact]\nfriction = " + std::to_string(friction) +
               "\n[[instrument]]\nkind = \"probe\"\nradius = 0.005\nlength = 0.2\n" +
               (slide.is_mesh ? "mesh = \"" + folder.file("plate.obj") + "\"\n" : "") +
               "path = [{ time = 0, " + at(from, side + 0.002) + " }, { time = 0.2, " +
               at(from, stretch * side) + " }, { time = 0.4, " + at(from, stretch * side) +
               " }, { time = 1, " + at(from + 0.03, stretch * side) + " }]\n");
}

const std::string rollers =
    "[[support]]\nregion = \"x-\"\nfix = \"x\"\n[[support]]\nregion = \"y-\"\nfix = \"y\"\n";

const std::string on_foot = "[[support]]\nregion = \"z-\"\nfix = \"z\"\n";
// The same of a mesh whose faces have no names.
const std::string sides_of_cube = R"([[region]]
name = "left"
low = [-1, -1, -1]
high = [-0.01999, 1, 1]
[[region]]
name = "front"
low = [-1, -1, -1]
high = [1, -0.01999, 1]
[[region]]
name = "foot"
low = [-1, -1, -1]
high = [1, 1, 1e-5]
[[support]]
region = "left"
fix = "x"
[[support]]
region = "front"
fix = "y"
[[support]]
region = "foot"
fix = "z"
)";

Slide on_cube(const std::string& elements, const std::string& supports) {
  return {.body = "[tissue.shape]\nkind = \"box\"\nelements = \"" + elements +
                  "\"\nlow = [-0.02, -0.02, 0]\nhigh = [0.02, 0.02, 0.04]\ncells = [4, 4, 4]\n",
          .supports = supports};
}

Slide on_plane(const std::string& supports, bool is_mesh) {
  return {.body =
              "[tissue]\nthickness = 0.04\n[tissue.shape]\nkind = \"rectangle\"\n"
              "high = [0.04, 0.04, 0]\ncells = [9, 9, 1]\n",
          .supports = supports,
          .is_plane = true,
          .is_mesh = is_mesh};
}

// While only edges touched in the plane, each with one of its ends, tissue without friction was
// two thirds of the way inside the plate, with a quarter of the force.
TEST(ContactOfAPlate, that_tissue_may_slide_on_is_pressed_as_the_closed_form_says) {
  for (const Slide& slide :
       {on_cube("hex8", rollers + on_foot), on_cube("tet4-kuhn", rollers + on_foot),
        on_plane(rollers, true), on_plane(rollers, false)}) {
    const auto body = make_slide(slide, 0);
    for (int frame = 0; frame < 22; ++frame) run_frame(*body->s, body->outputs);
    const double force = body->s->log.rows.back().tools[0].force[slide.is_plane ? 1 : 2],
                 exact = closed_form(slide.is_plane, side);
    std::printf("pressed with %.5f N, closed form %.5f N\n", force, exact);
    // Contacts are solved to 1e-3 of the deepest point.
    EXPECT_NEAR(force, exact, 1e-3 * exact);
  }
}

// The tip is at x = y = 0, and the body's middle goes aside from there.
TEST(ContactOfAPlate, turns_about_its_tip_by_the_way_of_the_body_s_middle_times_the_force) {
  const auto body = make_slide(on_cube("hex8", rollers + on_foot +
                                                   "[[output]]\nkind = \"metrics\"\nfile = "
                                                   "\"m.csv\"\n"),
                               0);
  for (int frame = 0; frame < 22; ++frame) run_frame(*body->s, body->outputs);
  const ToolRow& plate = body->s->log.rows.back().tools[0];
  const double force = closed_form(false, side), arm = side * (stretch_aside(false) - 1) / 2;
  EXPECT_GT(arm, 5e-4);
  EXPECT_NEAR(plate.torque.x(), arm * force, 3e-3 * arm * force);
  EXPECT_NEAR(plate.torque.y(), -arm * force, 3e-3 * arm * force);
  EXPECT_NEAR(plate.torque.z(), 0, 1e-3 * arm * force);
}

// While each node's push was found as if the others of its cluster stayed, a plate pressed one of
// these cubes with 1.1 times the force, and the tissue hovered off it.
TEST(ContactOfAPlate, presses_as_the_closed_form_says_whatever_masses_are_scaled_to) {
  for (const std::string step : {"4 ms", "8 ms"})
    for (const std::string elements : {"hex8", "tet4-kuhn"}) {
      Slide slide = on_cube(elements, rollers + on_foot);
      slide.solver = "mass_scaling_step = \"" + step + "\"\n";
      const auto body = make_slide(slide, 0);
      ASSERT_TRUE(body->s->added_mass) << elements;
      for (int frame = 0; frame < 60; ++frame) run_frame(*body->s, body->outputs);
      const double force = body->s->log.rows.back().tools[0].force.z(),
                   exact = closed_form(false, side);
      std::printf("scaled to %s: %.5f N, closed form %.5f N\n", step.c_str(), force, exact);
      EXPECT_NEAR(force, exact, 1e-3 * exact) << elements;
    }
}

// A cube whose uppermost layer is a tenth as thick as the others. With local steps under the plate
// it pressed with 0.84 of the force.
TEST(ContactOfAPlate, presses_small_elements_as_without_their_local_steps) {
  Mesh mesh = make_box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, side), {4, 4, 5}, BoxElements::hex8);
  const double thick = side / 4.1;
  for (Vec3& X : mesh.X) X.z() = X.z() > 0.99 * side ? side : X.z() / (side / 5) * thick;
  const TestFolder folder;
  write_mesh(mesh, folder.file("layer.msh"));
  const Slide slide{.body = "[tissue]\nmesh = \"" + folder.file("layer.msh") + "\"\n",
                    .supports = sides_of_cube,
                    .solver = "multirate = true\n"};
  const auto body = make_slide(slide, 0);
  Simulation& s = *body->s;
  ASSERT_TRUE(s.multirate);
  EXPECT_LT(s.look.of_small, 0.5);
  for (int frame = 0; frame < 22; ++frame) run_frame(s, body->outputs);
  EXPECT_EQ(s.log.n_roll_backs, 0);
  EXPECT_TRUE(is_told(s, "small elements take no local steps"));
  const double force = s.log.rows.back().tools[0].force.z(), exact = closed_form(false, side);
  std::printf("with small elements %.5f N, closed form %.5f N\n", force, exact);
  EXPECT_NEAR(force, exact, 1e-3 * exact);
}

// What of a plate lies "straight below" the bulging sides that end at it dragged the body along
// with up to a fifth of the force.
TEST(ContactOfAPlate, that_slides_without_friction_drags_nothing_along) {
  const std::string foot = "[[support]]\nregion = \"z-\"\n",
                    plane_foot = "[[support]]\nregion = \"y-\"\n";
  for (const Slide& slide : {on_cube("hex8", foot), on_cube("tet4-kuhn", foot),
                             on_plane(plane_foot, true), on_plane(plane_foot, false)}) {
    const auto body = make_slide(slide, 0);
    double most = 0;
    for (int frame = 0; frame < 60; ++frame) {
      run_frame(*body->s, body->outputs);
      most = larger_or_nan(most, std::abs(body->s->log.rows.back().tools[0].force.x()));
    }
    const double force = body->s->log.rows.back().tools[0].force[slide.is_plane ? 1 : 2];
    std::printf("pressed with %.4f N, dragged with %.1e N at most\n", force, most);
    EXPECT_LT(most, 1e-5 * force);
  }
}

TEST(ContactOfAPlate, that_slides_drags_as_coulombs_law_says) {
  for (const char* elements : {"hex8", "tet4-kuhn"}) {
    const auto cube = make_slide(on_cube(elements, "[[support]]\nregion = \"z-\"\n"), 0.2);
    for (int frame = 0; frame < 55; ++frame) run_frame(*cube->s, cube->outputs);
    const Vec3& force = cube->s->log.rows.back().tools[0].force;
    std::printf("pressed with %.4f N, dragged with %.4f N\n", force.z(), -force.x());
    EXPECT_NEAR(-force.x(), 0.2 * force.z(), 2e-4 * force.z()) << elements;
  }
}

}  // namespace
}  // namespace trocar
