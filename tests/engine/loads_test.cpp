// Forces and pressures: closed forms, what they do to momentum and energy, and what cuts leave of
// them. That ranks and threads don't matter is tested in tests/invariance.
#include "engine/loads.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/equilibrium.h"
#include "engine/frame_force.h"
#include "engine_motion.h"
#include "engine_scene.h"
#include "engine_split.h"
#include "engine_started.h"
#include "scene_parts.h"
#include "solver_body.h"

namespace trocar {
namespace {

const std::string at_rest = "[start]\nstate = \"equilibrium\"\ntolerance = 1e-8\n";

std::string loaded_box(const std::string& elements, const std::string& material) {
  return "[time]\nduration = 1\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\n"
         "high = [0.02, 0.02, 0.05]\ncells = [2, 3, 5]\nelements = \"" +
         elements + "\"\n[tissue.material]\ndensity = 1000\n" + material;
}

const std::string linear = "model = \"linear\"\nyoung_modulus = 6000\npoisson_ratio = 0\n";
const std::string soft = "young_modulus = 6000\npoisson_ratio = 0.4\n";
const std::string foot_of_plate = "[[support]]\nregion = \"x+\"\n";
const std::string foot = "[[support]]\nregion = \"z-\"\n";

// Faces that the first load acts on.
std::vector<LoadFace> loaded_faces(const Simulation& s) {
  return find_loaded_areas(s.scene.loads, s.mesh, s.surface).of_load[0];
}

Vec3 total(const Loads& loads) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : loads.force) sum += force;
  return sum;
}

TEST(Loads, stretch_a_bar_by_the_closed_form) {
  for (const std::string elements : {"hex8", "tet4-kuhn", "tet4-five"}) {
    const auto bar = built(at_rest + loaded_box(elements, linear) + foot + metrics_table +
                           "[[load]]\nregion = \"z+\"\nforce = [0, 0, \"0.02 N\"]\n");
    start_in_equilibrium(bar->loaded, *bar->s);
    const double strain = 0.02 / (6000 * 4e-4);
    for (std::size_t i = 0; i < bar->s->mesh.X.size(); ++i) {
      const Vec3 u = Vec3::Map(&bar->s->state.u[3 * i]);
      EXPECT_LT((u - Vec3(0, 0, strain * bar->s->mesh.X[i].z())).norm(), 1e-6 * strain * 0.05);
    }
    run_frame(*bar->s, bar->outputs);
    EXPECT_LT((bar->s->log.rows.back().support_forces[0] - Vec3(0, 0, 0.02)).norm(), 1e-6 * 0.02);
  }
}

// W = … + K/2 (J - 1)^2: J = 1 - p/K, whatever the size of the deformation.
TEST(Loads, pressure_on_all_sides_shrinks_a_free_body_by_the_closed_form) {
  const double K = 6000 / (3 * (1 - 2 * 0.4)), p = 0.3 * K;
  const std::string pressure = "pressure = " + std::to_string(p) + "\n";
  std::string sides;
  for (const std::string side : {"x-", "x+", "y-", "y+", "z-", "z+"})
    sides += "[[load]]\nregion = \"" + side + "\"\n" + pressure;
  const std::string ball =
      "[time]\nduration = 1\n[tissue.shape]\nkind = \"ball\"\nradius = 0.02\ncells = [6, 6, 6]\n"
      "elements = \"tet4-kuhn\"\n[tissue.material]\n" +
      soft;
  for (const std::string& text :
       {loaded_box("hex8", soft) + sides, loaded_box("tet4-five", soft) + sides,
        ball + "[[load]]\nregion = \"surface\"\n" + pressure}) {
    const auto body = built(at_rest + text);
    start_in_equilibrium(body->loaded, *body->s);
    EXPECT_NEAR(body->s->watch.least_J, 0.7, 1e-5) << text;
    double volume = 0, before = 0;
    for (std::int32_t e = 0; e < body->s->mesh.n_elements(); ++e) {
      before += element_volume(body->s->mesh, e, body->s->mesh.X);
      volume += element_volume(body->s->mesh, e, gather_state(*body->s).x);
    }
    EXPECT_NEAR(volume, 0.7 * before, 1e-5 * before) << text;
  }
}

// Whose faces are no parallelograms, and twisted: equal parts of them at the corners turn the body.
TEST(Loads, of_pressure_on_all_sides_do_not_turn_a_body_of_any_hexahedra) {
  std::string sides;
  for (const std::string side : {"x-", "x+", "y-", "y+", "z-", "z+"})
    sides += "[[load]]\nregion = \"" + side + "\"\npressure = 500\n";
  const auto body = built(loaded_box("hex8", soft) + sides);
  Simulation& s = *body->s;
  std::vector<double> shift(3 * s.mesh.X.size(), 0.0);
  shake(shift, 1e-3, 3);
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i) s.mesh.X[i] += Vec3::Map(&shift[3 * i]);
  find_loads(s.scene.loads, s.mesh, s.part, 1, 0, s.state.u, s.loads);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t k = 0; k < s.loads.node.size(); ++k) {
    force += s.loads.force[k];
    moment += s.mesh.X[s.loads.node[k]].cross(s.loads.force[k]);
  }
  EXPECT_LT(force.norm(), 1e-12 * 500 * 0.02 * 0.05);
  EXPECT_LT(moment.norm(), 1e-12 * 500 * 0.02 * 0.05 * 0.05);
}

TEST(Loads, of_a_force_on_a_face_that_is_not_convex_are_all_of_it) {
  const auto body = built(loaded_box("hex8", soft) + foot +
                          "[[load]]\nregion = \"z+\"\nforce = [0.1, 0.2, 0.3]\n");
  Simulation& s = *body->s;
  for (Vec3& X : s.mesh.X)
    if ((X - Vec3(0.02, 0.02, 0.05)).norm() < 1e-9)
      X -= Vec3(0.008, 0.0055, 0);  // of a cell of 10 x 6.7 mm
  localise_loads(s.scene.loads, s.mesh, find_loaded_areas(s.scene.loads, s.mesh, s.surface), s.part,
                 s.loads);
  find_loads(s.scene.loads, s.mesh, s.part, 1, 0, s.state.u, s.loads);
  EXPECT_LT((total(s.loads) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
}

TEST(Loads, that_come_and_go_within_a_frame_change) {
  const auto body = built(loaded_box("hex8", soft) + foot +
                          "[[load]]\nregion = \"z+\"\nforce = [0.1, 0, 0]\npath = [{time = 0.01, "
                          "factor = 0}, {time = 0.1, factor = 1}, {time = 0.19, factor = 0}]\n");
  EXPECT_TRUE(do_loads_change(body->s->loads, 0, 0.2));
  EXPECT_FALSE(do_loads_change(body->s->loads, 0.2, 0.4));
}

TEST(Loads, change_the_momentum_of_a_free_body_and_their_work_its_energy) {
  const auto body = built(loaded_box("hex8", soft) + metrics_table +
                              "[[load]]\nregion = \"x-\"\nforce = [0.01, 0.002, 0]\n"
                              "[[load]]\nregion = \"z+\"\npressure = \"100 Pa\"\n"
                              "path = [{ time = 0.02, factor = 0 }, { time = 0.1, factor = 1 }]\n",
                          {"solver.step_factor=0.1"});
  for (int frame = 0; frame < 2; ++frame) run_frame(*body->s, body->outputs);
  const Vec3 before = momentum(*body->s);
  const double dt = body->s->log.rows.back().dt;
  run_frame(*body->s, body->outputs);
  ASSERT_EQ(body->s->log.rows.back().dt, dt);
  const Vec3 gained = (momentum(*body->s) - before) / 0.01;
  EXPECT_NEAR(gained.x(), 0.01, 1e-3 * 0.01);  // and what the pressed face turns
  EXPECT_LT(gained.z(), -1e-4);
  while (body->s->frame < 20) run_frame(*body->s, body->outputs);
  const FrameRow& row = body->s->log.rows.back();
  EXPECT_GT(row.works.loads, 1e-5);
  EXPECT_LT(std::abs(row.energy_error), 1e-4 * row.works.loads);
}

TEST(Loads, of_an_edge_in_the_plane_push_along_its_normal) {
  const auto sheet = built(
      "[time]\nduration = 1\n[tissue]\nthickness = 0.005\n[tissue.shape]\n"
      "kind = \"rectangle\"\nhigh = [0.04, 0.02, 0]\ncells = [9, 5, 1]\n"
      "[[load]]\nregion = \"x+\"\npressure = 200\n[[load]]\nregion = \"y-\"\npressure = 50\n");
  run_frame(*sheet->s, sheet->outputs);
  Simulation& s = *sheet->s;
  const std::vector<double> rest(s.state.u.size(), 0.0);
  find_loads(s.scene.loads, s.mesh, s.part, 0.005, 0, rest, s.loads);
  EXPECT_LT((total(s.loads) - Vec3(-200 * 0.02, 50 * 0.04, 0) * 0.005).norm(), 1e-12);
}

// Uniaxial: s = p along x and 0 across, s_i = mu J^(-5/3) (l_i^2 - I1/3) + K (J - 1).
struct Uniaxial {
  double along, across;
};
Uniaxial uniaxial(double mu, double K, double p) {
  const auto stress = [&](double l, double I1, double J) {
    return mu * std::pow(J, -5. / 3) * (l * l - I1 / 3) + K * (J - 1);
  };
  const auto across_of = [&](double along) {  // no stress across
    double low = 0.2, high = 2;
    for (int k = 0; k < 200; ++k) {
      const double l = (low + high) / 2, I1 = along * along + 2 * l * l;
      (stress(l, I1, along * l * l) > 0 ? high : low) = l;
    }
    return low;
  };
  double low = 0.5, high = 2;
  for (int k = 0; k < 200; ++k) {
    const double along = (low + high) / 2, l = across_of(along);
    (stress(along, along * along + 2 * l * l, along * l * l) > p ? high : low) = along;
  }
  return {low, across_of(low)};
}

// A sheet thins as it is drawn out: what pulls at its edge gets less.
TEST(Loads, of_an_edge_in_plane_stress_push_on_the_present_thickness) {
  const double E = 3000, nu = 0.3;
  for (const double tension : {500., -400.}) {
    const Uniaxial exact = uniaxial(E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu)), tension);
    for (const auto& [precision, residual] : {std::pair{"double", 1e-6}, {"single", 4e-5}}) {
      const auto sheet = built(
          "[time]\nduration = 1\n[tissue]\nthickness = 0.002\n[tissue.shape]\n"
          "kind = \"rectangle\"\nhigh = [0.04, 0.02, 0]\ncells = [9, 5, 1]\n"
          "[tissue.material]\nyoung_modulus = 3000\npoisson_ratio = 0.3\n[solver]\n"
          "triangle = \"plane-stress\"\n[[support]]\nregion = \"x-\"\nfix = \"x\"\n"
          "[[support]]\nregion = \"y-\"\nfix = \"y\"\n[[load]]\nregion = \"x+\"\npressure = " +
              std::to_string(-tension) + "\n" + at_rest,
          {"solver.precision='" + std::string(precision) + "'",
           "start.tolerance=" + std::to_string(residual)});
      Simulation& s = *sheet->s;
      start_in_equilibrium(sheet->loaded, s);
      for (std::size_t i = 0; i < s.mesh.X.size(); ++i) {
        const Vec3& X = s.mesh.X[i];
        const Vec3 u((exact.along - 1) * X.x(), (exact.across - 1) * X.y(), 0);
        EXPECT_LT((Vec3::Map(&s.state.u[3 * i]) - u).norm(), 20 * residual * 0.04);
      }
      find_loads_at(s, 0);
      const Vec3 force(tension * exact.across * 0.02 * exact.across * 0.002, 0, 0);
      EXPECT_LT((total(s.loads) - force).norm(), 20 * residual * force.norm());
    }
  }
}

TEST(Loads, of_a_region_without_faces_are_spread_over_its_nodes) {
  const auto bar = built(loaded_box("hex8", soft) + foot +
                         "[[region]]\nname = \"corner\"\nlow = [-1, -1, 0.049]\n"
                         "high = [0.001, 0.001, 1]\n[[load]]\nregion = \"corner\"\n"
                         "force = [0.001, 0, 0]\n");
  run_frame(*bar->s, bar->outputs);
  ASSERT_EQ(bar->s->loads.node.size(), 1u);
  EXPECT_EQ(bar->s->loads.force[0], Vec3(0.001, 0, 0));
}

// The cut opens the loaded side x-: its force stays what it was, and nothing presses on the wound.
TEST(Loads, stay_on_their_side_after_a_cut) {
  const auto bar = built(loaded_box("tet4-kuhn", soft) + foot +
                         "[[load]]\nregion = \"x-\"\nforce = [0, \"0.1 N\", 0]\n"
                         "[[load]]\nregion = \"x-\"\npressure = \"10 Pa\"\n");
  Simulation& s = *bar->s;
  const std::size_t n_faces = loaded_faces(s).size(), n_nodes = s.loads.node.size();
  GlobalState global = gather_state(s);
  CutFigures figures;
  CutRecord record;
  apply_cut(s, cut_across(s, global, figures), global, record);
  EXPECT_EQ(loaded_faces(s).size(), n_faces);
  EXPECT_GT(s.loads.node.size(), n_nodes);
  find_loads(s.scene.loads, s.mesh, s.part, 1, 0, s.state.u, s.loads);
  EXPECT_LT((total(s.loads) - Vec3(10 * 0.02 * 0.05, 0.1, 0)).norm(), 1e-9);
}

// The side y+ is parted along its middle, the box's border goes through what is split: faces there
// get smaller, the loads stay what they were, and nothing presses on the wound.
TEST(Loads, stay_what_they_are_where_a_cut_puts_nodes_on_edges) {
  const std::string box =
      "[[region]]\nname = \"end\"\nlow = [\"-31 mm\", -1, -1]\nhigh = [\"-8 mm\", 1, 1]\n";
  for (const std::string region : {"y+", "end"}) {
    const auto plate = built(plate_of("tet4-five") + foot_of_plate + box + "[[load]]\nregion = \"" +
                             region + "\"\nforce = [0, \"0.1 N\", 0]\n[[load]]\nregion = \"" +
                             region + "\"\npressure = \"10 Pa\"\n" + plate_blade);
    Simulation& s = *plate->s;
    const auto area = [&] {
      double sum = 0;
      for (const LoadFace& face : loaded_faces(s)) {
        const auto X = [&](std::size_t k) { return s.mesh.X[face[k]]; };
        sum += 0.5 * (X(1) - X(0)).cross(X(2) - X(0)).norm();
      }
      return sum;
    };
    const auto loads = [&] {
      find_loads(s.scene.loads, s.mesh, s.part, 1, 0, s.state.u, s.loads);
      return total(s.loads);
    };
    const std::size_t n_before = loaded_faces(s).size();
    const double area_before = area();
    const Vec3 before = loads();
    ASSERT_GT(split_plate(s).n_inserted, 300);
    EXPECT_EQ(s.n_pieces, 2) << region;
    EXPECT_GT(loaded_faces(s).size(), n_before) << region;
    EXPECT_NEAR(area(), area_before, 1e-12 * area_before) << region;
    EXPECT_LT((loads() - before).norm(), 1e-12) << region;
  }
}

TEST(Loads, that_change_end_sleep) {
  const auto bar = built(at_rest + loaded_box("hex8", soft) + foot +
                             "[solver]\nsleep = \"0.1 mm\"\nmass_damping = 20\n"
                             "[[load]]\nregion = \"z+\"\nforce = [0, 0, -0.05]\n"
                             "path = [{ time = 0.75, factor = 1 }, { time = 0.8, factor = 3 }]\n",
                         {"time.frame_rate=50"});
  start_in_equilibrium(bar->loaded, *bar->s);
  while (bar->s->frame < 37) run_frame(*bar->s, bar->outputs);
  EXPECT_GT(bar->s->sleep->share, 0.9);
  run_frame(*bar->s, bar->outputs);
  EXPECT_EQ(bar->s->sleep->share, 0);
}

TEST(Loads, are_refused_with_their_place) {
  const auto error = [](const std::string& load) {
    return scene_error("[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\n[[load]]\n" + load);
  };
  EXPECT_NE(error("region = \"z+\"\n").find("load[0]: a load needs a force or a pressure"),
            std::string::npos);
  EXPECT_NE(error("region = \"z+\"\npressure = 1\npath = [{ time = 1, factor = 0 }, { time = 1, "
                  "factor = 1 }]\n")
                .find("load[0].path[1].time: the times of a path must ascend"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              built(loaded_box("hex8", soft) + "[[load]]\nregion = \"top\"\npressure = 1\n");
            }).find("load[0].region: the body has no region \"top\"; there are \"x-\""),
            std::string::npos);
  EXPECT_NE(error_of([] {
              built(loaded_box("hex8", soft) +
                    "[[region]]\nname = \"in\"\nlow = [0.005, 0.005, 0.005]\n"
                    "high = [0.015, 0.015, 0.045]\n[[load]]\nregion = \"in\"\npressure = 1\n");
            }).find("load[0].region: no face of the surface lies in region \"in\""),
            std::string::npos);
}

// Of these faces, in the reference.
double loaded_area(const Simulation& s) {
  double area = 0;
  for (const LoadFace& face : loaded_faces(s)) {
    const auto X = [&](int k) { return s.mesh.X[std::size_t(face[std::size_t(k)])]; };
    area += 0.5 * (X(1) - X(0)).cross(X(2) - X(0)).norm();
    if (face[3] >= 0) area += 0.5 * (X(2) - X(0)).cross(X(3) - X(0)).norm();
  }
  return area;
}

// Down beside the middle, where the loaded half of the top ends: by 0.3, 0.42 and 0.6 cells.
TEST(Loads, act_on_the_same_area_after_a_cut_beside_its_edge) {
  for (const std::string elements : {"hex8", "tet4-kuhn"})
    for (const std::string x : {"-1 mm", "1.4 mm", "2 mm"}) {
      const auto key = [&](const std::string& time, const std::string& y) {
        return "{ time = " + time + ", position = [\"" + x + "\", \"" + y +
               "\", \"2 mm\"], forward = [0, 1, 0] }";
      };
      const auto body = built(
          "[time]\nduration = 1\nframe_rate = 50\n[tissue.shape]\nkind = \"box\"\nelements = \"" +
          elements +
          "\"\nlow = [\"-20 mm\", \"-10 mm\", \"-10 mm\"]\n"
          "high = [\"20 mm\", \"10 mm\", \"10 mm\"]\ncells = [12, 6, 6]\n"
          "[tissue.material]\nyoung_modulus = 60000\n[solver]\nmass_damping = 40\n"
          "[[region]]\nname = \"left\"\nlow = [-1, -1, \"9.99 mm\"]\nhigh = [\"0.01 mm\", 1, 1]\n"
          "[[support]]\nregion = \"z-\"\n[[load]]\nregion = \"left\"\npressure = 200\n"
          "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.03\npath = [" +
          key("0", "-14 mm") + ", " + key("0.5", "14 mm") + ", " + key("0.6", "24 mm") + "]\n");
      Simulation& s = *body->s;
      const double before = loaded_area(s);
      EXPECT_NEAR(before, 20e-3 * 20e-3, 1e-15);
      for (int frame = 0; frame < 35; ++frame) run_frame(s, body->outputs);
      EXPECT_GT(s.cuts[0].strokes.at(0).figures.n_opened_facets, 20);
      EXPECT_NEAR(loaded_area(s), before, 1e-12 * before) << elements << " " << x;
    }
}

}  // namespace
}  // namespace trocar
