#include "engine/mesh_fit.h"

#include <gtest/gtest.h>

#include "engine_scene.h"
#include "engine_started.h"

namespace trocar {
namespace {

// The error that building a body of 1 cell refuses it with, 100 mm wide.
std::string error_with(const std::string& lines, const std::string& kind = "box") {
  return error_of([&] {
    built("[time]\nduration = 1\n[tissue.shape]\nkind = \"" + kind + "\"\ncells = [2, 2, 2]\n" +
          lines);
  });
}

void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_TRUE(contains(text, part)) << "looked for: " << part << "\nfound: " << text;
}

TEST(MeshFit, tells_all_names_that_the_body_does_not_have) {
  const std::string text = error_with(R"([[support]]
region = "z"
[[load]]
region = "tip"
pressure = 1
[[tissue.region_material]]
region = "x-"
material = {}
[[region]]
name = "x+"
low = [0, 0, 0]
high = [1, 1, 1]
[[region]]
name = "far"
low = [5, 5, 5]
high = [6, 6, 6]
[[support]]
region = "far"
[[tissue.region_material]]
region = "far"
material = {}
[[marker]]
name = "m"
position = [0, 0, 2]
)");
  expect_parts(text,
               {"s.toml:7:10: support[0].region: the body has no region \"z\"; the nearest is "
                "\"z-\"; there are \"x-\", \"x+\"",
                "s.toml:9:10: load[0].region: the body has no region \"tip\"; there are",
                "s.toml:12:10: tissue.region_material[0].region: the body has no region of "
                "elements \"x-\"; there are \"far\"",
                "s.toml:15:8: region[0].name: the body has a region \"x+\" already",
                "s.toml:20:7: region[1].low: region \"far\" holds no node of the mesh, which "
                "reaches from (0, 0, 0) to (0.1, 0.1, 0.1) m",
                "s.toml:29:12: marker[0].position: "});
  EXPECT_FALSE(contains(text, "support[1]")) << text;
  EXPECT_FALSE(contains(text, "region_material[1]")) << text;  // its box is told
}

// Gmsh lists names of which nothing is left in the file.
TEST(MeshFit, tells_regions_of_the_file_that_hold_nothing) {
  const TestFolder folder;
  folder.file("m.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 1 \"liver\"\n"
              "3 9 \"tumour\"\n2 10 \"nothing\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n"
              "2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n"
              "$EndElements\n");
  const std::string text = error_of([&] {
    built("[time]\nduration = 1\n[tissue]\nmesh = \"" + folder.file("m.msh") +
          "\"\n[[support]]\nregion = \"nothing\"\n[[load]]\nregion = \"liver\"\n"
          "force = [1, 0, 0]\n[[tissue.region_material]]\nregion = \"tumour\"\nmaterial = {}\n");
  });
  expect_parts(text, {"support[0].region: the body has no region \"nothing\": its file names it, "
                      "and puts nothing of the body there; there "});
  EXPECT_FALSE(contains(text, "load[0]")) << text;
  EXPECT_FALSE(contains(text, "tumour")) << text;  // told as without effect
}

TEST(MeshFit, tells_all_that_a_plane_body_can_not_do) {
  const std::string text = error_with(
      "[tissue]\ntranslate = [0, 0, 1]\n[contact]\ntissue = true\n" + instrument_text("scissors"),
      "rectangle");
  expect_parts(text, {"s.toml:7:13: tissue.translate: a plane body stays at z = 0",
                      "s.toml:9:10: contact.tissue: this body is plane",
                      "s.toml:11:8: instrument[0].kind: scissors cut volumes only"});
}

TEST(MeshFit, refuses_blades_of_more_than_100000_edges) {
  expect_parts(error_with(instrument_text("scalpel") + "blade_length = 1e5\n"),
               {"instrument[0].blade_length: the blade is longer than 100,000 edges of the mesh"});
}

TEST(MeshFit, of_the_body_as_a_whole_is_told_with_all_that_is_wrong) {
  expect_parts(error_with("[solver]\ngravity = [0, 0, -9.81]\n[start]\nstate = "
                          "\"equilibrium\"\n[[region]]\nname = \"corner\"\nlow = [0, 0, 0]\nhigh = "
                          "[0.01, 0.01, 0.01]\n[[load]]\nregion = \"corner\"\npressure = 1\n"),
               {"start.state: there is no equilibrium", "load[0].region: no face of the surface"});
}

}  // namespace
}  // namespace trocar
