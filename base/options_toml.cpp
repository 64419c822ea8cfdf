// TOML text to the tree of options_node.h. The only file that sees toml++.
#include <toml++/toml.h>

#include "base/options_node.h"
#include "base/quoted.h"

namespace trocar {

namespace {

OptionNode value_node(const toml::node& from) {
  OptionNode node;
  if (const auto* text = from.as_string()) {
    node.kind = NodeKind::text;
    node.text = text->get();
  } else if (const auto* integer = from.as_integer()) {
    node.kind = NodeKind::integer;
    node.integer = integer->get();
    node.number = static_cast<double>(integer->get());
  } else if (const auto* number = from.as_floating_point()) {
    node.kind = NodeKind::number;
    node.number = number->get();
  } else if (const auto* boolean = from.as_boolean()) {
    node.kind = NodeKind::boolean;
    node.integer = boolean->get() ? 1 : 0;
  } else {
    node.kind = NodeKind::date;
  }
  return node;
}

OptionNode any_node(const toml::node& from);

OptionNode table_node(const toml::table& from) {
  OptionNode node;
  node.kind = NodeKind::table;
  node.below.reserve(from.size());
  for (const auto& [key, value] : from) {
    OptionNode& below = node.below.emplace_back(any_node(value));
    below.key = key.str();
    below.key_line = static_cast<int>(key.source().begin.line);
    below.key_column = static_cast<int>(key.source().begin.column);
  }
  return node;
}

OptionNode list_node(const toml::array& from) {
  OptionNode node;
  node.kind = NodeKind::list;
  node.below.reserve(from.size());
  for (const toml::node& value : from) {
    OptionNode& below = node.below.emplace_back(any_node(value));
    below.index = node.below.size() - 1;
    below.key_line = below.line;
    below.key_column = below.column;
  }
  return node;
}

OptionNode any_node(const toml::node& from) {
  const auto* table = from.as_table();
  const auto* list = from.as_array();
  OptionNode node = table != nullptr  ? table_node(*table)
                    : list != nullptr ? list_node(*list)
                                      : value_node(from);
  node.line = static_cast<int>(from.source().begin.line);
  node.column = static_cast<int>(from.source().begin.column);
  return node;
}

}  // namespace

OptionNode parse_toml(std::string_view text) {
  scan_toml(text);
  try {
    OptionNode root = any_node(toml::parse(text));
    root.line = root.column = 1;
    return root;
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    // The parser quotes the text that it stumbled over, however long.
    std::string sentence(error.description().substr(0, 300));
    throw SyntaxTrouble{static_cast<int>(at.line), static_cast<int>(at.column),
                        "not TOML: " + sentence};
  }
}

}  // namespace trocar
