// The effective options as TOML: what a run really used, readable by the same program.
#include <utility>

#include "base/options.h"

namespace trocar {

static void echo_table(const std::vector<OptionEntry>& entries, const void* object,
                       const std::string& path, std::string& text);

static void echo_values(const std::vector<OptionEntry>& entries, const void* object,
                        std::string& text) {
  for (const OptionEntry& entry : entries) {
    const bool is_empty_list = entry.is_list && entry.objects_below(object).empty();
    const std::string value = !entry.is_table ? entry.value_text(object)
                              : is_empty_list ? "[]"
                                              : "";
    if (!value.empty()) text.append(entry.key).append(" = ").append(value).append("\n");
  }
}

static void echo_tables(const OptionEntry& entry, const void* object, const std::string& path,
                        std::string& text) {
  const std::string path_below = path.empty() ? entry.key : path + "." + entry.key;
  for (const void* below : entry.objects_below(object)) {
    text.append(entry.is_list ? "\n[[" : "\n[").append(path_below);
    text.append(entry.is_list ? "]]\n" : "]\n");
    echo_table(entry.below, below, path_below, text);
  }
}

// Values before tables: in TOML a value behind a header belongs to that header's table.
static void echo_table(const std::vector<OptionEntry>& entries, const void* object,
                       const std::string& path, std::string& text) {
  echo_values(entries, object, text);
  for (const OptionEntry& entry : entries)
    if (entry.is_table) echo_tables(entry, object, path, text);
}

std::string echo_options(const OptionTable& table, const void* object) {
  std::string text;
  echo_table(table.entries(), object, "", text);
  return text;
}

static void add_flat(const std::vector<OptionEntry>& entries, const void* object,
                     const std::string& path, std::vector<OptionText>& all) {
  for (const OptionEntry& entry : entries)
    if (std::string value = entry.is_table ? "" : entry.value_text(object); !value.empty())
      all.push_back({path + entry.key, std::move(value)});
  for (const OptionEntry& entry : entries) {
    if (!entry.is_table) continue;
    const std::vector<const void*> below = entry.objects_below(object);
    for (std::size_t k = 0; k < below.size(); ++k) {
      const std::string key = path + entry.key;
      add_flat(entry.below, below[k], (entry.is_list ? item_path(key, k) : key) + ".", all);
    }
  }
}

std::vector<OptionText> flat_options(const OptionTable& table, const void* object) {
  std::vector<OptionText> all;
  add_flat(table.entries(), object, "", all);
  return all;
}

}  // namespace trocar
