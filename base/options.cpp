// Reading options from a file: text -> tree -> overrides -> struct.
#include "base/options.h"

#include <algorithm>

#include "base/check.h"
#include "base/options_node.h"
#include "base/whole_file.h"

namespace trocar {

// Default texts of an entry, or of those of a table, as the object that holds it initialises them.
static void set_default_texts(OptionEntry& entry, const void* defaults) {
  if (!entry.is_table) {
    entry.default_text = entry.value_text(defaults);
    return;
  }
  // A list or an optional table that is absent keeps the defaults of its own type.
  const std::vector<const void*> objects = entry.objects_below(defaults);
  if (entry.is_list || objects.empty()) return;
  for (OptionEntry& below : entry.below) set_default_texts(below, objects[0]);
}

void OptionTable::add(OptionEntry entry, const void* defaults) {
  CHECK(is_bare_key(entry.key) && entry.key.find('-') == std::string::npos);
  for (const OptionEntry& other : entries_) CHECK_OP(other.key, !=, entry.key);
  entries_.push_back(std::move(entry));
  set_default_texts(entries_.back(), defaults);
}

void link_nodes(OptionNode& node, OptionDocument& document) {
  node.document = &document;
  for (OptionNode& below : node.below) {
    below.above = &node;
    link_nodes(below, document);
  }
}

static OptionNode parse_document(const OptionDocument& document) {
  try {
    return parse_toml(document.text);
  } catch (const SyntaxTrouble& trouble) {
    throw InputError({document.name, trouble.line, trouble.column},
                     trouble.sentence + excerpt(document.text, trouble.line, trouble.column));
  }
}

static void read_document(const OptionTable& table, OptionDocument& document, void* object,
                          SourceMap& where) {
  OptionNode root = parse_document(document);
  apply_overrides(root, table, document);
  link_nodes(root, document);
  read_table(root, table.entries(), object);
  where = {.places = std::move(document.places),
           .file = std::move(document.name),
           .text = std::move(document.text)};
}

void read_options_text(const OptionTable& table, const std::string& text, const std::string& name,
                       const std::vector<std::string>& overrides, void* object, SourceMap& where) {
  OptionErrors errors(where);
  OptionDocument document{
      .name = name, .text = text, .overrides = overrides, .places = {}, .errors = &errors};
  read_document(table, document, object, where);
  errors.throw_if_any();
}

void read_options(const OptionTable& table, const std::string& file,
                  const std::vector<std::string>& overrides, void* object, SourceMap& where,
                  OptionErrors& errors) {
  OptionDocument document{.name = file,
                          .text = read_whole_file(file, max_options_bytes),
                          .overrides = overrides,
                          .places = {},
                          .errors = &errors};
  read_document(table, document, object, where);
}

}  // namespace trocar
