#include <gtest/gtest.h>

#include "base_scene_options.h"

namespace trocar {
namespace {

const std::string text =
    "name = 'x'\n[tissue]\nmesh = 'a'\n[[instrument]]\n[[instrument]]\nradius = 1\n";

TEST(Override, wins_over_the_file) {
  EXPECT_EQ(read_scene(text, {"name='y'"}).value.name, "y");
  EXPECT_EQ(read_scene(text, {"instrument[1].radius='3 mm'"}).value.instrument[1].radius, 0.003);
}

TEST(Override, takes_what_is_not_toml_as_text) {
  EXPECT_EQ(read_scene(text, {"name=it's me"}).value.name, "it's me");
  EXPECT_EQ(read_scene(text, {"name="}).value.name, "");
  EXPECT_EQ(read_scene(text, {"name=a=b"}).value.name, "a=b");
  EXPECT_EQ(read_scene(text, {"name=1\nduration=3"}).value.name, "1\nduration=3");
  EXPECT_EQ(read_scene(text, {"tissue.material.density=1060 kg/m^3"}).value.tissue.material.density,
            1060);
}

TEST(Override, can_add_keys_and_tables_that_the_file_lacks) {
  const Scene scene =
      read_scene(text, {"camera.size=[3, 4]", "instrument[0].path=[{time=1}]"}).value;
  ASSERT_TRUE(scene.camera.has_value());
  EXPECT_EQ(scene.camera->size, (std::array<int, 2>{3, 4}));
  EXPECT_EQ(scene.instrument[0].path.size(), 1u);
}

TEST(Override, can_replace_one_component) {
  EXPECT_EQ(read_scene("gravity = [1, 2, 3]\n" + text, {"gravity[1]=5"}).value.gravity,
            Vec3(1, 5, 3));
}

TEST(Override, that_comes_later_wins) {
  EXPECT_EQ(read_scene(text, {"name=a", "name=b"}).value.name, "b");
}

TEST(Override, mends_a_missing_key) {
  EXPECT_EQ(read_scene("", {"tissue.mesh=a"}).value.tissue.mesh, "a");
}

TEST(Override, is_the_place_of_its_key) {
  const SourceMap where = read_scene(text, {"name=y"}).where;
  EXPECT_EQ(where.find("name").file, "--set name=y");
  EXPECT_THROW(where.fail("name", "is bad"), InputError);
}

// The line of the file shows what is no longer so.
TEST(Override, of_a_component_is_the_place_of_the_list) {
  const SourceMap where =
      read_scene("gravity = [1, 2, 3]\n" + text, {"gravity[1]=5", "gravity[0]=4", "name=y"}).where;
  EXPECT_EQ(where.find("gravity").file, "--set gravity[0]=4");
  EXPECT_EQ(where.message("gravity", "is bad"), "--set gravity[0]=4: gravity: is bad");
  // Of the tables of a list each has its own place.
  const SourceMap of_path =
      read_scene("instrument = [{ path = [{ time = 1 }] }]\n[tissue]\nmesh = 'a'\n",
                 {"instrument[0].path[0].time=2"})
          .where;
  EXPECT_EQ(of_path.find("instrument[0].path").line, 1);
}

TEST(OverrideErrors, name_the_override) {
  const std::pair<const char*, const char*> errors[] = {
      {"name", "--set name: needs the form key.path=value"},
      {"nam=3", "--set nam=3: unknown key \"nam\"; the nearest allowed key is \"name\"; allowed: "},
      {"tissue.mash=3",
       "--set tissue.mash=3: unknown key \"mash\"; the nearest allowed key is "
       "\"mesh\"; allowed: mesh, material"},
      {"duration=3 kg", "--set duration=3 kg: duration: \"3 kg\" is a mass, but a time is needed"},
      {"duration=-1", "--set duration=-1: duration: -1 s is out of range; allowed: > 0 s"},
      {"duration=nan", "--set duration=nan: duration: nan is not a finite number"},
      {"tissue.mesh.x=1", "--set tissue.mesh.x=1: there is no key below a value: \"x\""},
      {"instrument.radius=1", "--set instrument.radius=1: \"radius\" stands behind a list"},
      {"instrument[2].radius=1", "--set instrument[2].radius=1: there is no [2]: the list has 2"},
      {"instrument[x].radius=1", "--set instrument[x].radius=1: an index is written"},
      {"instrument[1]radius=1", "--set instrument[1]radius=1: a path is written a.b[1].c"},
      {"instrument[99999999999999999999]=1",
       "--set instrument[99999999999999999999]=1: an index is written"},
      {"name[0]=1", "--set name[0]=1: there is no [0]: the file has no list in this place"},
      {"tissue..mesh=1", "--set tissue..mesh=1: a key is missing in the path"},
      {"=1", "--set =1: a key is missing in the path"},
      {"name=\xff", "--set name=\xff: a byte that is not UTF-8"},
      {"camera={sice=1}", "--set camera={sice=1}: camera.sice: unknown key"},
  };
  for (const auto& [override_text, message] : errors)
    EXPECT_EQ(scene_error(text, {override_text}).find(message), 0u)
        << override_text << " gives " << scene_error(text, {override_text});
}

TEST(OverrideErrors, of_a_table_that_is_a_value_in_the_file) {
  expect_part(scene_error("camera = 3\n" + text, {"camera.size=[1, 2]"}),
              "--set camera.size=[1, 2]: the file has no table above \"size\"");
}

TEST(OverrideErrors, of_deep_nesting_come_at_once) {
  const std::string deep(1'000'000, '[');
  expect_part(scene_error(text, {"duration=" + deep}),
              "does not begin with a number; a time is needed");
  EXPECT_TRUE(read_scene(text, {"name=" + deep}).value.name == deep);  // not TOML, so text
}

}  // namespace
}  // namespace trocar
