// Reads a table by its entries: known keys into the object, everything else into the list of
// errors.
#include <algorithm>

#include "base/options_node.h"
#include "base/quoted.h"

namespace trocar {

namespace {

void report_unknown_key(const OptionNode& node, const std::vector<OptionEntry>& entries) {
  OptionErrors& errors = *node.document->errors;
  if (errors.is_full()) return errors.add({});
  OptionNode at_key = node;
  at_key.line = node.key_line;
  at_key.column = node.key_column;
  try {
    refuse(at_key, "unknown key; " + allowed_keys_text(node.key, entries));
  } catch (const OptionRefusal& refusal) {
    errors.add(refusal.error());
  }
}

void report_missing_key(const OptionNode& table, const OptionEntry& entry) {
  try {
    const std::string range = entry.range_text.empty() ? "" : ", " + entry.range_text;
    refuse(table, "the required key " + in_quotes(entry.key) + " is missing (" + entry.type_text +
                      range + ": " + entry.doc + ")");
  } catch (const OptionRefusal& refusal) {
    OptionError error = refusal.error();
    error.key_path += (error.key_path.empty() ? "" : ".") + entry.key;
    table.document->errors->add(std::move(error));
  }
}

void read_list(const OptionNode& node, const OptionEntry& entry, void* object) {
  if (node.kind != NodeKind::list)
    refuse(node, "needs a list of tables ([[" + entry.key + "]]), found " + description(node));
  const std::vector<void*> objects = entry.make_below(object, node.below.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    read_table(node.below[i], entry.below, objects[i]);
}

void read_entry(const OptionNode& node, const OptionEntry& entry, void* object) {
  try {
    node.document->places[key_path(node)] = place_of(node);
    if (entry.is_list) return read_list(node, entry, object);
    if (!entry.is_table) return entry.read(node, object);
    read_table(node, entry.below, entry.make_below(object, 1)[0]);
  } catch (const OptionRefusal& refusal) {
    node.document->errors->add(refusal.error());
  }
}

bool is_known(const OptionNode& node, const std::vector<OptionEntry>& entries) {
  return std::any_of(entries.begin(), entries.end(),
                     [&](const OptionEntry& entry) { return entry.key == node.key; });
}

}  // namespace

void read_table(const OptionNode& node, const std::vector<OptionEntry>& entries, void* object) {
  try {
    if (node.kind != NodeKind::table) refuse(node, "needs a table, found " + description(node));
  } catch (const OptionRefusal& refusal) {
    return node.document->errors->add(refusal.error());
  }
  node.document->places[key_path(node)] = place_of(node);
  for (const OptionEntry& entry : entries) {
    const OptionNode* below = find_below(node, entry.key);
    if (below != nullptr) read_entry(*below, entry, object);
    if (below == nullptr && entry.need == Need::required) report_missing_key(node, entry);
  }
  for (const OptionNode& below : node.below)
    if (!is_known(below, entries)) report_unknown_key(below, entries);
}

const OptionNode* find_below(const OptionNode& table, std::string_view key) {
  for (const OptionNode& node : table.below)
    if (node.key == key) return &node;
  return nullptr;
}

OptionNode* find_below(OptionNode& table, std::string_view key) {
  for (OptionNode& node : table.below)
    if (node.key == key) return &node;
  return nullptr;
}

std::string allowed_keys_text(std::string_view key, const std::vector<OptionEntry>& entries) {
  if (entries.empty()) return "no key is allowed here";
  std::vector<std::string> keys;
  for (const OptionEntry& entry : entries) keys.push_back(entry.key);
  const std::string nearest = nearest_name(key, keys);
  std::string text =
      nearest.empty() ? "" : "the nearest allowed key is " + in_quotes(nearest) + "; ";
  text.append("allowed: ");
  for (const std::string& allowed : keys)
    text.append(&allowed == &keys[0] ? "" : ", ").append(allowed);
  return text;
}

}  // namespace trocar
