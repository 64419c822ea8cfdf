#include <gtest/gtest.h>

#include <sstream>

#include "base_scene_options.h"

namespace trocar {
namespace {

TEST(Help, shows_key_type_unit_range_default_and_doc) {
  const std::string help = help_options(scene_options());
  expect_part(help, "A scene.\n\n  name ");
  expect_part(help, "number [Pa], > 0 Pa");
  expect_part(help, "one of \"neo-hookean\", \"linear\"");
  expect_part(help, "  [[instrument]]  The tools. (list of tables)\n");
  expect_part(help, "    [tissue.material]  Its material. (table)\n");
  expect_part(help, "[camera]  The endoscope. (table, may be absent)\n");
  expect_part(help, "mesh  text  required  Mesh file.\n");
}

TEST(Help, has_the_defaults_of_the_outermost_struct) {
  // Material's own default density is 0; Tissue initialises it to 1000.
  const std::string help = help_options(scene_options());
  const std::size_t row = help.find("density ");
  ASSERT_NE(row, std::string::npos);
  expect_part(help.substr(row, help.find('\n', row) - row), " 1000.0 ");
  expect_part(markdown_options(scene_options()), "| 1000.0 | Mass per volume. |");
}

TEST(Help, aligns_the_columns_of_a_table) {
  std::istringstream help(help_options(instrument_options()));
  std::string line;
  std::vector<std::size_t> columns;
  while (std::getline(help, line))
    for (const char* doc : {"Radius of the tip.", "Sides of the shaft."})
      if (line.find(doc) != std::string::npos) columns.push_back(line.find(doc));
  ASSERT_EQ(columns.size(), 2u);
  EXPECT_EQ(columns[0], columns[1]);
}

TEST(Markdown, has_a_heading_and_a_table_for_each_table) {
  const std::string text = markdown_options(scene_options());
  for (const char* heading : {"## `[tissue]`", "## `[tissue.material]`", "## `[camera]`",
                              "## `[[instrument]]`", "## `[[instrument.path]]`"})
    expect_part(text, heading);
}

TEST(Markdown, has_the_same_number_of_cells_in_every_row) {
  std::istringstream text(markdown_options(scene_options()));
  std::string line;
  int n_rows = 0;
  while (std::getline(text, line)) {
    if (line.empty() || line[0] != '|') continue;
    int n_bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i)
      if (line[i] == '|' && (i == 0 || line[i - 1] != '\\')) ++n_bars;
    EXPECT_EQ(n_bars, 5) << line;
    ++n_rows;
  }
  // 5 tables and the top, each with two header rows, and their 15 values.
  EXPECT_EQ(n_rows, 6 * 2 + 15);
}

struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero(), turn = Vec3::Zero();
  double scale = 1, density = 1000;
  bool is_open = false;
};
struct Boxes {
  Box first, second{.density = 2000}, third;
};

Options<Box> box_options(const std::string& doc) {
  Options<Box> box(doc);
  box.vector("low", &Box::low, dim::length, any, "One corner.");
  box.vector("high", &Box::high, dim::length, any, "The other.");
  box.vector("turn", &Box::turn, dim::none, any, "Its axis.");
  box.number("scale", &Box::scale, dim::none, positive, "Its size.");
  box.number("density", &Box::density, dim::density, positive, "Mass per volume.");
  box.boolean("is_open", &Box::is_open, "Whether it has a lid.");
  return box;
}

TEST(Help, points_to_a_long_table_that_it_has_shown) {
  Options<Boxes> boxes("Boxes.");
  boxes.table("first", &Boxes::first, box_options("One."));
  boxes.table("second", &Boxes::second, box_options("Another, of another default."));
  boxes.table("third", &Boxes::third, box_options("One more."));
  const std::string help = help_options(boxes), markdown = markdown_options(boxes);
  expect_part(help, "\n  [third]  One more. (table)\n    The keys of [first].\n");
  expect_part(markdown, "## `[third]`\n\nOne more. (table)\n\nThe keys of `[first]`.\n");
  const auto count = [](const std::string& text, const std::string& part) {
    int n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  EXPECT_EQ(count(help, "Whether it has a lid."), 2) << help;
  EXPECT_EQ(count(markdown, "Whether it has a lid."), 2) << markdown;
}

}  // namespace
}  // namespace trocar
