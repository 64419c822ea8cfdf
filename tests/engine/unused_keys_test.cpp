#include "engine/unused_keys.h"

#include <gtest/gtest.h>

#include "engine_scene.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

Mesh body_of(const std::string& kind) {
  if (kind == "plane") return make_rectangle(1, 1, 2, 2);
  return make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1},
                  kind == "hex8" ? BoxElements::hex8 : BoxElements::tet4_kuhn);
}

// The keys that are named, of a scene with `more`.
std::vector<std::string> named(const std::string& more, const std::string& body) {
  std::vector<std::string> keys;
  for (const std::string& sentence : unused_keys(load_scene_text(scene_text(more)), body_of(body)))
    keys.push_back(sentence.substr(0, sentence.find(' ')));
  return keys;
}

using Keys = std::vector<std::string>;

TEST(UnusedKeys, of_a_scene_without_them_are_none) {
  for (const std::string body : {"plane", "hex8", "tet4"})
    EXPECT_EQ(named("", body), Keys()) << body;
}

TEST(UnusedKeys, of_deadlines_are_named_where_there_are_none) {
  const auto keys = [](const std::string& pace) {
    return unused_keys(load_scene_text("[time]\nduration = 1\noverrun = \"shift\"\n" + pace +
                                       "[tissue.shape]\nkind = \"box\"\n"),
                       body_of("hex8"));
  };
  EXPECT_EQ(keys(""), Keys{"time.overrun has no effect: only pace = \"real-time\" has deadlines; "
                           "leave it out"});
  EXPECT_EQ(keys("pace = \"real-time\"\n"), Keys());
}

TEST(UnusedKeys, of_elements_that_the_body_lacks_are_named) {
  const std::string triangle = "[solver]\ntriangle = \"plane-stress\"\n",
                    tetrahedron = "[solver]\ntetrahedron = \"nodal-pressure\"\n",
                    hourglass = "[solver]\nhourglass = 0.3\n",
                    full = hourglass + "hexahedron = \"full\"\n";
  EXPECT_EQ(named(triangle, "hex8"), Keys{"solver.triangle"});
  EXPECT_EQ(named(triangle, "plane"), Keys());
  EXPECT_EQ(named(tetrahedron, "hex8"), Keys{"solver.tetrahedron"});
  EXPECT_EQ(named(tetrahedron, "tet4"), Keys());
  EXPECT_EQ(named(hourglass, "hex8"), Keys());
  EXPECT_EQ(named(full, "hex8"), Keys{"solver.hourglass"});
  EXPECT_EQ(named(full, "tet4"), (Keys{"solver.hexahedron", "solver.hourglass"}));
}

// A cut makes tetrahedra of hexahedra.
TEST(UnusedKeys, of_tetrahedra_serve_where_hexahedra_are_cut) {
  EXPECT_EQ(
      named(instrument_text("scalpel") + "[solver]\ntetrahedron = \"nodal-pressure\"\n", "hex8"),
      Keys());
}

TEST(UnusedKeys, of_plane_bodies_and_plane_cuts_are_named_on_others) {
  const std::string cut = instrument_text("scalpel");
  const std::string spring = "[cutting]\nspring = 2\n", advance = "[cutting]\nadvance = 1\n";
  EXPECT_EQ(named(cut + spring, "tet4"), Keys{"cutting.spring"});
  EXPECT_EQ(named(cut + spring, "plane"), Keys());
  EXPECT_EQ(named(cut + advance, "plane"), Keys{"cutting.advance"});
  EXPECT_EQ(named(cut + advance, "tet4"), Keys());
  EXPECT_EQ(named(spring, "plane"), Keys{"cutting.spring"});
}

TEST(UnusedKeys, of_fibres_in_a_mesh_without_a_model_that_has_some_are_named) {
  Mesh mesh = body_of("tet4");
  mesh.fibre.assign(mesh.element_type.size(), Vec3::UnitX());
  const Scene plain = load_scene_text(scene_text("")),
              fibred = load_scene_text(scene_text(
                  "[tissue.material]\nmodel = \"transversely-isotropic\"\neta = 1000\n"));
  ASSERT_EQ(unused_keys(plain, mesh).size(), 1U);
  EXPECT_EQ(unused_keys(plain, mesh)[0],
            "the mesh's cell data \"fibre\" has no effect: no material has fibres; leave it out");
  EXPECT_TRUE(unused_keys(fibred, mesh).empty());
}

TEST(UnusedKeys, of_fibres_without_a_model_that_has_some_are_named) {
  const std::string fibre = "[tissue.material]\nfibre = [0, 1, 0]\n";
  EXPECT_EQ(named(fibre, "hex8"), Keys{"tissue.material.fibre"});
  EXPECT_EQ(named(fibre + "model = \"transversely-isotropic\"\neta = 100\n", "hex8"), Keys());
}

TEST(UnusedKeys, of_pictures_are_named_where_none_is_made) {
  const std::string look = "camera = \"endoscope\"\nsize = [64, 48]\n";
  const auto output = [&](const std::string& kind, const std::string& file) {
    return camera_text + "[[output]]\nkind = \"" + kind + "\"\nfile = \"" + file + "\"\n" + look;
  };
  EXPECT_EQ(named(output("metrics", "m.csv"), "hex8"),
            (Keys{"output[0].camera", "output[0].size"}));
  EXPECT_EQ(named(output("recording", "r"), "hex8"), (Keys{"output[0].camera", "output[0].size"}));
  EXPECT_EQ(named(output("video", "v.mp4"), "hex8"), Keys());
}

TEST(UnusedKeys, of_other_kinds_of_shapes_and_instruments_are_named) {
  const std::string time = "[time]\nduration = 1\n[tissue.shape]\nradius = 0.2\nkind = ";
  const auto keys = [&](const std::string& text) {
    return unused_keys(load_scene_text(text), body_of("hex8")).size();
  };
  EXPECT_EQ(keys(time + "\"box\"\n"), 1u);
  EXPECT_EQ(keys(time + "\"ball\"\n"), 0u);
  EXPECT_EQ(named(instrument_text("probe") + "grip_radius = 0.01\n", "hex8"),
            Keys{"instrument[0].grip_radius"});
}

}  // namespace
}  // namespace trocar
