// What lies between the TOML parser and the options: the parsed file as a plain tree whose nodes
// know their place and key path, and the errors found so far.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/options.h"

namespace trocar {

enum class NodeKind { table, list, text, number, integer, boolean, date };

struct OptionDocument;

struct OptionNode {
  NodeKind kind = NodeKind::table;
  int line = 1;  // of the value, of a table's header; from 1
  int column = 1;
  int key_line = 1;
  int key_column = 1;
  int source = 0;         // 0: the file, i: override i - 1
  std::string key;        // in the table above; "" in a list
  std::size_t index = 0;  // in the list above
  std::string text;
  double number = 0;         // also of an integer
  std::int64_t integer = 0;  // also of a boolean
  std::vector<OptionNode> below;
  // Set by link_nodes, when the tree has got its final addresses.
  const OptionNode* above = nullptr;
  OptionDocument* document = nullptr;
};

struct OptionDocument {
  std::string name;
  std::string text;
  std::vector<std::string> overrides;
  std::map<std::string, SourcePlace> places;
  OptionErrors* errors = nullptr;
};

// An error of one value, on its way to the table that collects it.
class OptionRefusal : public InputError {
 public:
  explicit OptionRefusal(OptionError error) : InputError(error.message), error_(std::move(error)) {}
  const OptionError& error() const { return error_; }

 private:
  OptionError error_;
};

// Text that is not TOML. line 0: no place.
struct SyntaxTrouble {
  int line = 0;
  int column = 0;
  std::string sentence;
};

// Throws SyntaxTrouble for bytes that are not UTF-8 and for NUL.
void check_characters(std::string_view text);
// The same, and for what no parser should be given: nesting without end, values without number,
// texts without end.
void scan_toml(std::string_view text);
// The tree of a text; scans it first. Throws SyntaxTrouble.
OptionNode parse_toml(std::string_view text);

// Replaces, in the tree of the document's file, what the document's overrides name. Throws
// InputError.
void apply_overrides(OptionNode& root, const OptionTable& table, const OptionDocument& document);
void link_nodes(OptionNode& node, OptionDocument& document);

OptionNode* find_below(OptionNode& table, std::string_view key);
const OptionNode* find_below(const OptionNode& table, std::string_view key);

// "tissue.material.density", "instrument[1].path[0]"
std::string key_path(const OptionNode& node);
SourcePlace place_of(const OptionNode& node);
// "the text "abc"", "a list of 3 values"
std::string description(const OptionNode& node);
// The source line and a caret below the column, each after a line break; "" where there is no such
// line.
std::string excerpt(std::string_view text, int line, int column);
// Whether TOML takes it without quotes.
bool is_bare_key(std::string_view key);

// Throws OptionRefusal: place, key, sentence, source line.
[[noreturn]] void refuse(const OptionNode& node, const std::string& sentence);
// Reads a table into the object; errors go to the document.
void read_table(const OptionNode& node, const std::vector<OptionEntry>& entries, void* object);
// What to write instead of an unknown key: "the nearest allowed key is …; allowed: …".
std::string allowed_keys_text(std::string_view key, const std::vector<OptionEntry>& entries);

}  // namespace trocar
