// Scenes that users begin with: those of configs/ and the recipes of docs/howto.md are read and
// built, as by `trocar check`.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "engine_started.h"

namespace trocar {
namespace {

const std::string source_folder = TROCAR_SOURCE_DIR;

TEST(WrittenScenes, of_the_configurations_can_all_be_built) {
  int n_scenes = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(source_folder + "/configs")) {
    if (entry.path().extension() != ".toml") continue;
    Communicator alone;
    EXPECT_EQ(error_of([&] { build(load_scene(entry.path().string(), {}), alone); }), "");
    ++n_scenes;
  }
  EXPECT_GE(n_scenes, 15);
}

// A table's header and the lines below it; the first one has the keys above all headers.
struct SceneTable {
  std::string header;
  std::vector<std::string> lines;
};

std::vector<SceneTable> tables_of(const std::string& text) {
  std::vector<SceneTable> tables(1);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("["))
      tables.push_back({line.substr(0, line.rfind(']', line.find('#')) + 1), {}});
    else
      tables.back().lines.push_back(line);
  return tables;
}

std::string key_of(const std::string& line) {
  return line.substr(0, line.find_first_of(" ="));
}

// The recipe's keys take the place of the scene's.
void add_table(const SceneTable& recipe, std::vector<SceneTable>& scene) {
  const auto same = std::find_if(scene.begin(), scene.end(), [&](const SceneTable& table) {
    return table.header == recipe.header && !table.header.starts_with("[[");
  });
  if (same == scene.end()) return scene.push_back(recipe);
  for (const std::string& line : recipe.lines)
    std::erase_if(same->lines, [&](const std::string& old) { return key_of(old) == key_of(line); });
  same->lines.insert(same->lines.end(), recipe.lines.begin(), recipe.lines.end());
}

bool has_key(const std::vector<SceneTable>& tables, const std::string& header,
             const std::string& key) {
  return std::any_of(tables.begin(), tables.end(), [&](const SceneTable& table) {
    return table.header == header &&
           std::any_of(table.lines.begin(), table.lines.end(),
                       [&](const std::string& line) { return key_of(line) == key; });
  });
}

// A recipe with a body of its own also has its supports and gravity.
std::string scene_with(const std::string& recipe, const std::string& base) {
  const std::vector<SceneTable> more = tables_of(recipe);
  std::vector<SceneTable> scene = tables_of(base);
  const std::set<std::string> of_body = {"[tissue.shape]", "[[support]]", "[solver]"};
  if (has_key(more, "[tissue]", "mesh") || has_key(more, "[tissue.shape]", "kind"))
    std::erase_if(scene, [&](const SceneTable& table) { return of_body.contains(table.header); });
  for (const SceneTable& table : more) add_table(table, scene);
  std::string text;
  for (const SceneTable& table : scene) {
    text += table.header + "\n";
    for (const std::string& line : table.lines) text += line + "\n";
  }
  return text;
}

// The page's blocks of TOML, in their order.
std::vector<std::string> recipes_of(const std::string& page) {
  const std::string begin = "\n```toml\n", end = "\n```";
  std::vector<std::string> blocks;
  for (std::size_t at = 0; (at = page.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    blocks.push_back(page.substr(at, page.find(end, at) - at));
  }
  return blocks;
}

// The first one is the base of the others; a mesh is the liver, whatever it is called.
TEST(WrittenScenes, of_the_recipes_can_all_be_built) {
  const std::vector<std::string> recipes = recipes_of(read_text(source_folder + "/docs/howto.md"));
  ASSERT_GE(recipes.size(), 7U);
  EXPECT_EQ(error_of([&] { built(recipes[0]); }), "");
  for (std::size_t k = 1; k < recipes.size(); ++k) {
    const std::string& recipe = recipes[k];
    std::vector<std::string> overrides;
    if (has_key(tables_of(recipe), "[tissue]", "mesh"))
      overrides.push_back("tissue.mesh='" + source_folder + "/configs/meshes/liver.msh'");
    EXPECT_EQ(error_of([&] { built(scene_with(recipe, recipes[0]), overrides); }), "") << recipe;
  }
}

}  // namespace
}  // namespace trocar
