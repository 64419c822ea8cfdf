// Reading: what a good file gives, and for each kind of error what the message says and where it
// points.
#include "base/options.h"

#include <gtest/gtest.h>

#include "base_scene_options.h"
#include "error_of.h"

namespace trocar {
namespace {

const std::string minimal = "[tissue]\nmesh = 'a.msh'\n";

TEST(ReadOptions, fills_the_struct_and_leaves_defaults) {
  const Scene scene = read_scene(R"(name = "incision"
is_fast = true
duration = "4 s"
gravity = ["0 mm/s^2", 1, -9.81]
[tissue]
mesh = "liver.msh"
material = { young_modulus = "5 kPa", law = "linear" }
[camera]
size = [1280, 720]
view_angle = "90 deg"
[[instrument]]
radius = 3e-3
path = [{ time = 1 }, { time = "20 ms", position = "1 2 3 mm" }]
[[instrument]]
n_sides = 12
)")
                          .value;
  EXPECT_EQ(scene.name, "incision");
  EXPECT_TRUE(scene.is_fast);
  EXPECT_EQ(scene.duration, 4);
  EXPECT_EQ(scene.gravity, Vec3(0, 1, -9.81));
  EXPECT_EQ(scene.tissue.mesh, "liver.msh");
  EXPECT_EQ(scene.tissue.material.young_modulus, 5000);
  EXPECT_EQ(scene.tissue.material.law, Law::linear);
  EXPECT_EQ(scene.tissue.material.density, 1000);
  ASSERT_TRUE(scene.camera.has_value());
  EXPECT_EQ(scene.camera->size, (std::array<int, 2>{1280, 720}));
  EXPECT_DOUBLE_EQ(scene.camera->view_angle, 1.5707963267948966);
  ASSERT_EQ(scene.instrument.size(), 2u);
  ASSERT_EQ(scene.instrument[0].path.size(), 2u);
  EXPECT_EQ(scene.instrument[0].path[1].time, 0.02);
  EXPECT_EQ(scene.instrument[0].path[1].position, Vec3(1e-3, 2e-3, 3e-3));
  EXPECT_EQ(scene.instrument[1].n_sides, 12);
  EXPECT_EQ(scene.instrument[1].radius, 0.002);
}

TEST(ReadOptions, leaves_an_absent_optional_table_empty) {
  EXPECT_FALSE(read_scene(minimal).value.camera.has_value());
  EXPECT_TRUE(read_scene(minimal + "[camera]\n").value.camera.has_value());
}

TEST(ReadOptions, takes_a_vector_as_one_text_with_one_unit) {
  for (const char* text : {"'1 -2 3 mm/s^2'", "'[1, -2, 3] mm/s^2'", "'(1,-2,3) mm/s^2'",
                           "'1 -2 3mm/s^2'", "'1mm/s^2 -2mm/s^2 3mm/s^2'"}) {
    const Scene scene = read_scene(std::string("gravity = ") + text + "\n" + minimal).value;
    EXPECT_EQ(scene.gravity, Vec3(1e-3, -2e-3, 3e-3)) << text;
  }
}

// One bad line in front of a good file, and how its message has to begin.
struct BadLine {
  const char* line;
  const char* message;
};

class ReadOptionsError : public testing::TestWithParam<BadLine> {};

TEST_P(ReadOptionsError, has_place_key_finding_and_what_is_allowed) {
  const std::string error = scene_error(GetParam().line + std::string("\n") + minimal);
  EXPECT_EQ(error.substr(0, std::string(GetParam().message).size()), GetParam().message) << error;
}

const BadLine bad_lines[] = {
    {"name = 3", "s.toml:1:8: name: needs a text in quotes, found the integer 3\n"},
    {"name = 2020-01-01", "s.toml:1:8: name: needs a text in quotes, found a date or time\n"},
    {"name = 'a' # ok\nname = 'b'", "s.toml:2:8: not TOML: "},
    {"is_fast = 'yes'", "s.toml:1:11: is_fast: needs true or false, found the text \"yes\"\n"},
    {"duration = true",
     "s.toml:1:12: duration: needs a number in s or a text with a unit, found true\n"},
    {"duration = []",
     "s.toml:1:12: duration: needs a number in s or a text with a unit, found a "
     "list of 0 values\n"},
    {"duration = 0", "s.toml:1:12: duration: 0 s is out of range; allowed: > 0 s\n"},
    {"duration = '-5 ms'", "s.toml:1:12: duration: -0.005 s is out of range; allowed: > 0 s\n"},
    {"duration = 1e300",
     "s.toml:1:12: duration: 1e+300 s is out of range; allowed: 0 and magnitudes from 1e-24 to "
     "1e+24\n"},
    {"duration = '1e-300 s'",
     "s.toml:1:12: duration: 1e-300 s is out of range; allowed: 0 and magnitudes from 1e-24 to "
     "1e+24\n"},
    {"duration = nan", "s.toml:1:12: duration: nan is not a finite number\n"},
    {"duration = -inf", "s.toml:1:12: duration: -inf is not a finite number\n"},
    {"duration = '3 mm'",
     "s.toml:1:12: duration: \"3 mm\" is a length, but a time is needed; "
     "units that fit: s, ms, us, min, h\n"},
    {"duratoin = 3",
     "s.toml:1:1: duratoin: unknown key; the nearest allowed key is \"duration\"; "
     "allowed: name, is_fast, duration, gravity, tissue, camera, instrument\n"},
    {"gravity = [1, 2]",
     "s.toml:1:11: gravity: needs a list of 3 numbers, found a list of 2 values\n"},
    {"gravity = [1, 'two', 3]", "s.toml:1:15: gravity[1]: \"two\" does not begin with a number"},
    {"gravity = '1 2 m/s^2'",
     "s.toml:1:11: gravity: needs 3 numbers and a unit, found the text \"1 2 m/s^2\""},
    {"gravity = '1 2'", "s.toml:1:11: gravity: needs 3 numbers and a unit, found the text"},
    {"instrument = 3",
     "s.toml:1:14: instrument: needs a list of tables ([[instrument]]), found the integer 3\n"},
    {"instrument = [3]", "s.toml:1:15: instrument[0]: needs a table, found the integer 3\n"},
    {"camera = 'x'", "s.toml:1:10: camera: needs a table, found the text \"x\"\n"},
    {"camera.size = [0, 5]", "s.toml:1:16: camera.size[0]: 0 is out of range; allowed: >= 1\n"},
    {"camera.size = [1, 5.0]",
     "s.toml:1:19: camera.size[1]: needs an integer, found the number 5\n"},
    {"camera.size = [1, 3000000000]",
     "s.toml:1:19: camera.size[1]: 3000000000 is out of range; allowed: -2147483648 to "
     "2147483647\n"},
    {"tissue = { material = { law = 'liner' } }\n#",
     "s.toml:3:1: not TOML: "},  // tissue is defined twice
    {"[[instrument]]\npath = [{}]",
     "s.toml:2:9: instrument[0].path[0]: the required key \"time\" is missing (number [s], >= 0 s: "
     "When.)\n"},
    {"name = \"\\u0000\"", "s.toml:1:8: name: a text can't hold a NUL character\n"},
    {"name = 'open", "s.toml:1:8: a text without its closing quote\n"},
    {"= 3", "s.toml:1:1: not TOML: "},
};

INSTANTIATE_TEST_SUITE_P(, ReadOptionsError, testing::ValuesIn(bad_lines));

TEST(ReadOptionsErrors, of_a_choice_name_the_nearest_and_all_allowed) {
  expect_part(scene_error(minimal + "material.law = 'neo-hokean'"),
              "s.toml:3:16: tissue.material.law: \"neo-hokean\" is not one of the choices; the "
              "nearest is \"neo-hookean\"; allowed: \"neo-hookean\", \"linear\"\n");
}

TEST(ReadOptionsErrors, of_an_unknown_table_point_at_its_name) {
  expect_part(scene_error(minimal + "[tissue.materiel]\ndensity = 3"),
              "s.toml:3:9: tissue.materiel: unknown key; the nearest allowed key is \"material\"");
}

TEST(ReadOptionsErrors, of_a_missing_key_point_at_its_table) {
  expect_part(scene_error("name = 'x'\n[tissue]\n"),
              "s.toml:2:1: tissue: the required key \"mesh\" is missing (text: Mesh file.)");
  expect_part(scene_error("name = 'x'\n"),
              "s.toml:1:1: the required key \"tissue\" is missing (table: The tissue.)");
}

TEST(ReadOptionsErrors, show_the_line_with_a_caret_below_the_place) {
  EXPECT_EQ(scene_error("name = 'ä' # ö\nis_fast = 1 # why?\n" + minimal),
            "s.toml:2:11: is_fast: needs true or false, found the integer 1\n"
            "    is_fast = 1 # why?\n"
            "              ^");
}

TEST(ReadOptionsErrors, put_the_caret_by_characters_not_bytes) {
  EXPECT_EQ(scene_error("camera = { 'äöü' = 1, size = 2 }\n" + minimal)
                .substr(0, 150)
                .find("s.toml:1:12: camera.\"äöü\": unknown key"),
            0u);
  expect_part(scene_error("camera = { 'äöü' = 1, size = 2 }\n" + minimal),
              "s.toml:1:30: camera.size: needs a list of 2 integers, found the integer 2\n"
              "    camera = { 'äöü' = 1, size = 2 }\n"
              "                                 ^");
}

TEST(ReadOptionsErrors, are_all_reported_in_the_order_of_the_file) {
  const std::string error =
      scene_error("duration = -1\nnam = 3\ngravity = ['x', 1, 'y']\n[tissue]\n");
  std::size_t at = 0;
  for (const char* place : {"s.toml:1:12: ", "\ns.toml:2:1: ", "\ns.toml:3:12: gravity[0]",
                            "\ns.toml:3:20: gravity[2]", "\ns.toml:4:1: "}) {
    const std::size_t found = error.find(place, at);
    ASSERT_NE(found, std::string::npos) << place << " in " << error;
    at = found;
  }
}

TEST(ReadOptionsErrors, of_a_choice_of_another_type_name_the_choices) {
  EXPECT_EQ(scene_error("[tissue]\nmesh = 'a'\nmaterial = { law = 3 }\n"),
            "s.toml:3:20: tissue.material.law: needs one of \"neo-hookean\", \"linear\", found the "
            "integer 3\n    material = { law = 3 }\n                       ^");
}

TEST(ReadOptionsErrors, beyond_a_hundred_are_counted) {
  std::string text;
  for (int i = 0; i < 130; ++i) text += "key" + std::to_string(i) + " = 1\n";
  const std::string error = scene_error(text + minimal);
  expect_part(error, "\n… and 30 more errors");
}

TEST(ReadOptionsErrors, of_a_very_long_line_show_the_part_around_the_place) {
  const std::string blanks(5000, ' ');
  const std::string error = scene_error("is_fast = " + blanks + "1 " + blanks + "\n" + minimal);
  EXPECT_LT(error.size(), 400u);
  const std::size_t caret_line = error.rfind('\n');
  const std::size_t source_line = error.rfind('\n', caret_line - 1);
  // The character … has 3 bytes and 1 column.
  EXPECT_EQ(error[source_line + (error.size() - 1 - caret_line) + 2], '1') << error;
}

TEST(SourceMap, finds_keys_tables_and_elements) {
  const SourceMap where = read_scene(
                              "name = 'x'\n[tissue]\nmesh = 'a'\n[[instrument]]\n"
                              "path = [{ time = 1 },\n { time = 2 }]\n")
                              .where;
  const auto expect_place = [&](const char* key, int line, int column) {
    const SourcePlace place = where.find(key);
    EXPECT_EQ(place.file, "s.toml");
    EXPECT_EQ(place.line, line) << key;
    EXPECT_EQ(place.column, column) << key;
  };
  expect_place("name", 1, 8);
  expect_place("tissue", 2, 1);
  expect_place("tissue.mesh", 3, 8);
  expect_place("instrument[0]", 4, 1);
  expect_place("instrument[0].path[1].time", 6, 11);
  expect_place("instrument[0].path[1].position", 6, 2);  // absent: the table above it
  expect_place("tissue.material.density", 2, 1);
  expect_place("camera.size", 1, 1);
}

TEST(SourceMap, fails_with_place_key_and_line) {
  const SourceMap where = read_scene(minimal).where;
  EXPECT_EQ(error_of([&] { where.fail("tissue.mesh", "no such file"); }),
            "s.toml:2:8: tissue.mesh: no such file\n"
            "    mesh = 'a.msh'\n"
            "           ^");
}

TEST(SourceMap, shows_the_nearest_table_of_a_key_that_is_not_in_the_file) {
  const SourceMap where = read_scene(minimal).where;
  EXPECT_EQ(where.message("tissue.material", "is needed"),
            "s.toml:1:1: tissue.material: is needed\n    [tissue]\n    ^");
  EXPECT_EQ(where.message("camera.size", "is needed"), "s.toml:1:1: camera.size: is needed");
}

TEST(OptionErrors, are_thrown_together_in_the_order_of_the_file) {
  const SourceMap where =
      read_scene("name = 'x'\n" + minimal + "[camera]\nsize = [1, 2]\n", {"is_fast=true"}).where;
  OptionErrors errors(where);
  EXPECT_NO_THROW(errors.throw_if_any());
  for (const char* key : {"is_fast", "camera.size", "name", "tissue.mesh"}) errors.add(key, "bad");
  const std::string text = error_of([&] { errors.throw_if_any(); });
  std::size_t at = 0;
  for (const char* place : {"s.toml:1:8: name: bad\n", "s.toml:3:8: tissue.mesh: bad\n",
                            "s.toml:5:8: camera.size: bad\n", "--set is_fast=true: is_fast: bad"}) {
    const std::size_t found = text.find(place, at);
    ASSERT_NE(found, std::string::npos) << place << " in " << text;
    at = found;
  }
}

TEST(OptionErrors, tell_one_error_of_a_key_and_none_of_a_table_that_can_not_be_read) {
  const SourceMap where =
      read_scene(minimal + "[[instrument]]\nn_sides = 3\n[[instrument]]\nn_sides = 4\n").where;
  OptionErrors errors(where);
  errors.add({.line = 4, .key_path = "instrument[0].radius", .message = "it can't be read"});
  errors.add("tissue.mesh", "is bad");
  errors.add("tissue.mesh", "is bad because of that");
  errors.add("instrument[0].n_sides", "may follow from the radius");
  errors.add("instrument[1].n_sides", "is bad, too");
  const std::string text = error_of([&] { errors.throw_if_any(); });
  for (const char* part :
       {"tissue.mesh: is bad\n", "it can't be read\n", "instrument[1].n_sides: is bad, too\n"})
    expect_part(text, part);
  EXPECT_EQ(text.find("because of that"), std::string::npos) << text;
  EXPECT_EQ(text.find("may follow"), std::string::npos) << text;
}

TEST(OptionErrors, stand_at_the_first_of_some_keys_that_is_given) {
  const SourceMap where = read_scene(minimal).where;
  OptionErrors errors(where);
  errors.add_at_first({"tissue.material", "tissue.mesh"}, "one of them is bad");
  errors.add_at_first({"camera.size", "camera"}, "none is given");
  const std::string text = error_of([&] { errors.throw_if_any(); });
  expect_part(text, "tissue.mesh: one of them is bad");
  expect_part(text, "camera: none is given");
}

TEST(OptionDeclaration, refuses_a_key_that_is_declared_twice_or_needs_quotes) {
  Options<Camera> options("A view.");
  options.integers("size", &Camera::size, any, "Pixels.");
  EXPECT_DEATH(options.integers("size", &Camera::size, any, "Pixels."), "CHECK failed");
  EXPECT_DEATH(options.integers("si ze", &Camera::size, any, "Pixels."), "CHECK failed");
}

}  // namespace
}  // namespace trocar
