// "instrument[1].radius=3 mm" on the command line: replaces that value in the tree of the file,
// before it is read.
#include <algorithm>
#include <charconv>

#include "base/options_node.h"
#include "base/quoted.h"

namespace trocar {

namespace {

// One step of a path: a key, or an index into a list.
struct Step {
  std::string key{};
  std::size_t index = 0;
  bool is_index = false;
};

struct Override {
  std::string text;  // as given
  int source = 0;
  std::vector<Step> path;
  OptionNode value;
};

[[noreturn]] void fail(const Override& override_, const std::string& sentence) {
  throw InputError({"--set " + override_.text, 0, 0}, sentence);
}

// Takes "[12]" off the front of `path`.
Step take_index(std::string_view& path, const Override& override_) {
  Step step{.is_index = true};
  const char* end = path.data() + path.size();
  const auto result = std::from_chars(path.data() + 1, end, step.index);
  if (result.ec != std::errc() || result.ptr == end || *result.ptr != ']')
    fail(override_, "an index is written [0], [1], …, found " + in_quotes(path));
  path.remove_prefix(static_cast<std::size_t>(result.ptr + 1 - path.data()));
  return step;
}

std::vector<Step> parse_path(std::string_view path, const Override& override_) {
  std::vector<Step> steps;
  while (true) {
    const std::size_t end = std::min(path.find_first_of(".["), path.size());
    if (end == 0) fail(override_, "a key is missing in the path");
    steps.push_back({.key = std::string(path.substr(0, end))});
    path.remove_prefix(end);
    while (path.starts_with('[')) steps.push_back(take_index(path, override_));
    if (path.empty()) return steps;
    if (path[0] != '.') fail(override_, "a path is written a.b[1].c, found " + in_quotes(path));
    path.remove_prefix(1);
  }
}

// TOML if it is a TOML value, else the text itself.
OptionNode parse_value(const std::string& text, const Override& override_) {
  try {
    check_characters(text);
  } catch (const SyntaxTrouble& trouble) {
    fail(override_, trouble.sentence);
  }
  try {
    OptionNode root = parse_toml("v = " + text);
    if (root.below.size() == 1 && root.below[0].key == "v") return std::move(root.below[0]);
  } catch (const SyntaxTrouble&) {
    // Not TOML: a plain word or a quantity, "1000 kg/m^3".
  }
  OptionNode node;
  node.kind = NodeKind::text;
  node.text = text;
  return node;
}

void set_source(OptionNode& node, int source) {
  node.source = source;
  node.line = node.column = node.key_line = node.key_column = 0;
  for (OptionNode& below : node.below) set_source(below, source);
}

OptionNode& list_element(OptionNode& list, const Step& step, const Override& override_) {
  const std::string none = "there is no [" + std::to_string(step.index) + "]: ";
  if (list.kind != NodeKind::list) fail(override_, none + "the file has no list in this place");
  if (step.index >= list.below.size())
    fail(override_,
         none + "the list has " + std::to_string(list.below.size()) + ", counted from 0");
  return list.below[step.index];
}

OptionNode& find_or_add(OptionNode& table, const std::string& key, int source) {
  OptionNode* found = find_below(table, key);
  if (found != nullptr) return *found;
  OptionNode& added = table.below.emplace_back();
  added.key = key;
  set_source(added, source);
  return added;
}

const OptionEntry& find_entry(const std::vector<OptionEntry>* entries, const Step& step,
                              const Override& override_) {
  if (entries == nullptr) fail(override_, "there is no key below a value: " + in_quotes(step.key));
  for (const OptionEntry& entry : *entries)
    if (entry.key == step.key) return entry;
  fail(override_,
       "unknown key " + in_quotes(step.key) + "; " + allowed_keys_text(step.key, *entries));
}

void apply(OptionNode& root, const OptionTable& table, const Override& override_) {
  OptionNode* node = &root;
  const std::vector<OptionEntry>* entries = &table.entries();
  bool is_whole_list = false;
  for (const Step& step : override_.path) {
    if (step.is_index) {
      node = &list_element(*node, step, override_);
      is_whole_list = false;
      continue;
    }
    if (is_whole_list)
      fail(override_, in_quotes(step.key) + " stands behind a list: which one, [0], [1], …?");
    const OptionEntry& entry = find_entry(entries, step, override_);
    if (node->kind != NodeKind::table)
      fail(override_, "the file has no table above " + in_quotes(step.key));
    node = &find_or_add(*node, step.key, override_.source);
    entries = entry.is_table ? &entry.below : nullptr;
    is_whole_list = entry.is_list;
  }
  OptionNode value = override_.value;
  value.key = node->key;
  value.index = node->index;
  *node = std::move(value);
}

}  // namespace

void apply_overrides(OptionNode& root, const OptionTable& table, const OptionDocument& document) {
  for (std::size_t i = 0; i < document.overrides.size(); ++i) {
    const std::string& text = document.overrides[i];
    Override override_{.text = text, .source = static_cast<int>(i) + 1, .path = {}, .value = {}};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) fail(override_, "needs the form key.path=value");
    override_.path = parse_path(std::string_view(text).substr(0, equals), override_);
    override_.value = parse_value(text.substr(equals + 1), override_);
    set_source(override_.value, override_.source);
    apply(root, table, override_);
  }
}

}  // namespace trocar
