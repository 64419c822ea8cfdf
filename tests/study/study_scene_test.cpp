#include "study/study_scene.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_of.h"
#include "largest.h"
#include "mesh/generate.h"
#include "mesh_write.h"
#include "replaced.h"
#include "study/study_sweep.h"
#include "study/study_text.h"
#include "test_files.h"

namespace trocar {
namespace {

const char* const hanging_box =
    "name = \"hanging box\"\n"
    "[time]\nduration = \"0.1 s\"\nframe_rate = \"50 Hz\"\n"
    "[tissue.material]\nyoung_modulus = \"3 kPa\"\npoisson_ratio = 0.45\n"
    "[solver]\ngravity = [0, 0, \"-9.81 m/s^2\"]\n"
    "[[support]]\nregion = \"z+\"\nfix = \"xyz\"\n"
    "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n";

const char* const shape =
    "[tissue.shape]\nkind = \"box\"\nelements = \"hex8\"\ncells = [4, 4, 8]\n"
    "low = [0, 0, 0]\nhigh = [\"50 mm\", \"50 mm\", \"100 mm\"]\n";

TEST(StudyScene, errors_fall_with_the_cells_and_are_small_beside_the_motion) {
  const TestFolder folder;
  Communicator alone;
  const Problem problem = problem_of_scene(
      {.scene_file = folder.file("scene.toml", std::string(hanging_box) + shape)}, alone);
  EXPECT_EQ(problem.sizes, (std::vector<int>{2, 4, 8}));
  const Study study = sweep(problem, {.elements = {"hex8"}, .repeats = 1});
  ASSERT_EQ(study.runs.size(), 6u);
  // Free fall of .1 s is 49 mm; the elastic box stays behind that.
  EXPECT_GT(study.problem.length, .01);
  EXPECT_LT(study.problem.length, .05);
  EXPECT_LT(study.runs[2].error, study.runs[0].error);
  EXPECT_LT(study.runs[2].error, .2);
  EXPECT_EQ(study.runs[0].outcome.n_elements, 1 * 1 * 2);
  EXPECT_EQ(study.runs[4].outcome.n_elements, 4 * 4 * 8);
}

TEST(StudyScene, measures_the_error_that_sleep_brings_on_one_mesh) {
  const TestFolder folder;
  Communicator alone;
  const Problem problem =
      problem_of_scene({.scene_file = folder.file("scene.toml", std::string(hanging_box) + shape),
                        .overrides = {"time.duration='2 s'", "solver.mass_damping='30 1/s'"},
                        .sleeps = {"0", "0.2 mm"},
                        .sizes = {4}},
                       alone);
  EXPECT_EQ(problem.sleeps, (std::vector<double>{0, 0.2e-3}));
  const Study study =
      sweep(problem, {.elements = {"hex8"}, .precisions = {"double"}, .repeats = 1});
  ASSERT_EQ(study.runs.size(), 2u);
  EXPECT_TRUE(study.runs[0].is_reference);
  double most = 0;
  for (std::size_t k = 0; k < study.runs[0].outcome.samples.size(); ++k)
    most = std::max(most,
                    (study.runs[0].outcome.samples[k] - study.runs[1].outcome.samples[k]).norm());
  EXPECT_GT(most, 0);  // it slept
  EXPECT_LT(most, 0.2e-3);
  EXPECT_NE(method_text(study.runs[1]).find("sleep 0.2 mm"), std::string::npos);
  ASSERT_EQ(study.notes.size(), 2u);  // the first: one size alone has no reference
  EXPECT_NE(study.notes[1].find("at most " + length_text(most) + " from the same run without"),
            std::string::npos)
      << study.notes[1];
}

TEST(StudyScene, tetrahedra_and_hexahedra_of_one_scene_come_to_the_same_place) {
  const TestFolder folder;
  Communicator alone;
  const Problem problem = problem_of_scene(
      {.scene_file = folder.file("scene.toml", std::string(hanging_box) + shape), .sizes = {8}},
      alone);
  ASSERT_EQ(problem.methods.size(), solid_methods().size());
  const Outcome hexes = problem.solve({.method = method_named("hex8"), .n = 8});
  const Outcome tets = problem.solve({.method = method_named("tet4"), .n = 8});
  EXPECT_EQ(tets.n_elements, 6 * hexes.n_elements);
  const double difference = largest_difference(hexes.samples, tets.samples);
  EXPECT_GT(difference, 0);
  EXPECT_LT(difference, .15 * largest(hexes.samples));  // plain tetrahedra are too stiff
}

TEST(StudyScene, starts_where_the_scene_starts) {
  const TestFolder folder;
  Communicator alone;
  const auto most_moved = [&](const char* start) {
    const Problem problem =
        problem_of_scene({.scene_file = folder.file("scene.toml", std::string(hanging_box) + shape),
                          .overrides = {std::string("start.state='") + start + "'"},
                          .sizes = {4}},
                         alone);
    const Outcome outcome = problem.solve({.method = method_named("hex8"), .n = 4});
    const auto n_points = outcome.samples.size() / 5;  // sample times
    double most = 0;
    for (std::size_t k = n_points; k < outcome.samples.size(); ++k)
      most = std::max(most, (outcome.samples[k] - outcome.samples[k % n_points]).norm());
    return most;
  };
  EXPECT_LT(most_moved("equilibrium"), 1e-5);
  EXPECT_GT(most_moved("undeformed"), 1e-2);
}

TEST(StudyScene, in_a_plane_computes_the_scene_s_own_stress_or_strain) {
  const TestFolder folder;
  Communicator alone;
  const std::string plane =
      "[tissue.shape]\nkind = \"rectangle\"\ncells = [8, 16, 1]\nhigh = [\"50 mm\", \"100 mm\", "
      "0]\n";
  const std::string held =
      replaced(replaced(hanging_box, "0, 0, \"-9.81 m/s^2\"", "0, -9.81, 0"), "\"z+\"", "\"y+\"");
  const std::string scene = folder.file("scene.toml", held + plane);
  for (const char* name : {"plane-stress", "plane-strain"}) {
    const Problem problem = problem_of_scene(
        {.scene_file = scene, .overrides = {std::string("solver.triangle='") + name + "'"}}, alone);
    EXPECT_EQ(problem.growth, 3);  // cells and steps
    ASSERT_EQ(problem.methods.size(), 1u);
    EXPECT_EQ(problem.methods[0].formulation == Formulation::tri3_plane_stress,
              std::string(name) == "plane-stress");
  }
}

TEST(StudyScene, mesh_files_take_the_place_of_cells) {
  const TestFolder folder;
  Communicator alone;
  std::vector<std::string> meshes;
  for (const int n : {2, 1}) {  // sorted before they are run
    meshes.push_back(folder.file("box" + std::to_string(n) + ".msh"));
    write_mesh(make_box(Vec3::Zero(), Vec3(.05, .05, .1), {n, n, 2 * n}, BoxElements::tet4_kuhn),
               meshes.back());
  }
  const std::string text = std::string(hanging_box) + "[tissue]\nmesh = \"box1.msh\"\n";
  const Problem problem =
      problem_of_scene({.scene_file = folder.file("scene.toml", text), .meshes = meshes}, alone);
  const Study study = sweep(problem, {.elements = {"tet4"}, .precisions = {"double"}});
  ASSERT_EQ(study.runs.size(), 2u);
  ASSERT_EQ(problem.edges.size(), 2u);
  // Each cell became eight; edges within cells count more where there are fewer of the outer ones.
  EXPECT_NEAR(problem.edges[0] / problem.edges[1], 2, 0.1);
  EXPECT_EQ(study.runs[0].size, "box1");
  EXPECT_TRUE(study.runs[1].is_reference);
  EXPECT_EQ(study.runs[1].outcome.n_elements, 6 * 16);
  EXPECT_THROW(sweep(problem, {.elements = {"hex8"}}), InputError);
}

// The scene's text with a body of this kind that nothing holds.
std::string scene_of_shape(const std::string& keys) {
  const std::string text = hanging_box;
  return text.substr(0, text.find("[[support]]")) + "[tissue.shape]\n" + keys;
}

TEST(StudyScene, every_shape_has_sizes_of_its_own) {
  const TestFolder folder;
  Communicator alone;
  const auto sizes = [&](const std::string& keys) {
    return problem_of_scene({.scene_file = folder.file("scene.toml", scene_of_shape(keys))}, alone)
        .sizes;
  };
  const std::string ball = "kind = \"ball\"\nradius = 0.05\n";
  EXPECT_EQ(sizes(ball + "cells = [6, 6, 6]\n"), (std::vector<int>{2, 3, 6}));
  EXPECT_EQ(sizes(ball + "cells = [4, 10, 10]\n"), (std::vector<int>{2, 4}));
  // The ten cells of a shape without `cells`; the coarsest has to make a mesh.
  for (const char* kind : {"box", "ball", "cylinder", "rectangle"})
    EXPECT_EQ(sizes("kind = \"" + std::string(kind) + "\"\n"), (std::vector<int>{2, 5, 10}))
        << kind;
  EXPECT_EQ(sizes("kind = \"triangular-rectangle\"\n"), (std::vector<int>{3, 5, 10}));
}

TEST(StudyScene, sizes_that_the_shape_can_not_have_are_refused) {
  const TestFolder folder;
  Communicator alone;
  const std::pair<const char*, int> least_of_kind[] = {
      {"box", 1}, {"ball", 2}, {"cylinder", 2}, {"rectangle", 2}, {"triangular-rectangle", 3}};
  for (const auto& [kind, least] : least_of_kind) {
    const std::string scene =
        folder.file("scene.toml", scene_of_shape("kind = \"" + std::string(kind) + "\"\n"));
    const auto make = [&, least = least](int n) {
      problem_of_scene({.scene_file = scene, .sizes = {n, least + 1}}, alone);
    };
    EXPECT_NO_THROW(make(least)) << kind;
    const std::string error = error_of([&, least = least] { make(least - 1); });
    EXPECT_TRUE(error.starts_with("n = " + std::to_string(least - 1) + " is below " +
                                  std::to_string(least)))
        << kind << ": " << error;
  }
}

// As it is refused where the scene itself asks for both.
TEST(StudyScene, with_local_steps_leaves_out_what_they_exclude) {
  const TestFolder folder;
  Communicator alone;
  const std::string text =
      replaced(std::string(hanging_box), "[solver]\n", "[solver]\nmultirate = true\n") + shape;
  const Problem problem = problem_of_scene({.scene_file = folder.file("scene.toml", text)}, alone);
  EXPECT_FALSE(problem.methods.empty());
  for (const Method& method : problem.methods)
    EXPECT_NE(method.formulation, Formulation::tet4_nodal_pressure);
}

TEST(StudyScene, sizes_for_a_mesh_file_and_meshes_for_a_generated_body_are_refused) {
  const TestFolder folder;
  Communicator alone;
  const std::string scene = folder.file("scene.toml", std::string(hanging_box) + shape);
  EXPECT_THROW(problem_of_scene({.scene_file = scene, .meshes = {"a.msh"}}, alone), InputError);
  const std::string of_file = std::string(hanging_box) + "[tissue]\nmesh = \"box.msh\"\n";
  EXPECT_THROW(
      problem_of_scene({.scene_file = folder.file("m.toml", of_file), .sizes = {4}}, alone),
      InputError);
}

}  // namespace
}  // namespace trocar
