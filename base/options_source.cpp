// Places: of nodes, of key paths, and the source line that a message shows.
#include <algorithm>

#include "base/check.h"
#include "base/options_node.h"
#include "base/quoted.h"

namespace trocar {

namespace {

// Line `line` (from 1) without its end.
std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

// Takes `n` characters off the front and returns them.
std::string_view take_characters(std::string_view& text, int n) {
  const std::string_view taken = first_characters(text, static_cast<std::size_t>(n));
  text.remove_prefix(taken.size());
  return taken;
}

// The override of the value or, of a list in the file, the last one of its components; 0: none.
int source_of(const OptionNode& node) {
  int source = node.source;
  if (node.kind != NodeKind::list) return source;
  for (const OptionNode& below : node.below)
    if (below.kind != NodeKind::table) source = std::max(source, source_of(below));
  return source;
}

}  // namespace

bool is_bare_key(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
}

std::string excerpt(std::string_view text, int line, int column) {
  constexpr int width = 90;
  std::string_view rest = line_of(text, line);
  if (line < 1 || column < 1 || rest.empty()) return "";
  const int n_skipped = column > width ? column - width / 2 : 0;
  take_characters(rest, n_skipped);
  std::string shown = n_skipped > 0 ? "…" : "";
  shown += take_characters(rest, width);
  if (!rest.empty()) shown += "…";
  // Tabs and control characters as blanks, so that the caret stands below its character.
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  const int n_blanks = column - 1 - n_skipped + (n_skipped > 0 ? 1 : 0);
  return "\n    " + shown + "\n    " + std::string(static_cast<std::size_t>(n_blanks), ' ') + "^";
}

std::string key_path(const OptionNode& node) {
  if (node.above == nullptr) return "";
  std::string path = key_path(*node.above);
  if (node.above->kind == NodeKind::list) {
    path.append("[").append(std::to_string(node.index)).append("]");
    return path;
  }
  if (!path.empty()) path.append(".");
  return path.append(is_bare_key(node.key) && node.key.size() <= 64 ? node.key
                                                                    : in_quotes(node.key));
}

SourcePlace place_of(const OptionNode& node) {
  const OptionDocument& document = *node.document;
  const int source = source_of(node);
  if (source == 0) return {document.name, node.line, node.column};
  return {"--set " + document.overrides[source - 1], 0, 0};
}

void refuse(const OptionNode& node, const std::string& sentence) {
  const std::string path = key_path(node);
  std::string message =
      InputError(place_of(node), path.empty() ? sentence : path + ": " + sentence).what();
  const bool is_root = node.above == nullptr;
  const int source = source_of(node);
  if (source == 0 && !is_root) message += excerpt(node.document->text, node.line, node.column);
  throw OptionRefusal({source, node.line, node.column, path, message});
}

}  // namespace trocar
