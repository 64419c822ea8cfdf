// Help on options, as aligned text and as Markdown; both say the same.
#include <algorithm>
#include <array>
#include <utility>

#include "base/options.h"
#include "base/quoted.h"

namespace trocar {

namespace {

using Row = std::array<std::string, 4>;  // key, type and range, default, doc

std::string default_of(const OptionEntry& entry) {
  if (entry.need == Need::required) return "required";
  return entry.default_text.empty() ? "-" : entry.default_text;
}

std::vector<Row> value_rows(const std::vector<OptionEntry>& entries) {
  std::vector<Row> rows;
  for (const OptionEntry& entry : entries) {
    if (entry.is_table) continue;
    const std::string range = entry.range_text.empty() ? "" : ", " + entry.range_text;
    rows.push_back({entry.key, entry.type_text + range, default_of(entry), entry.doc});
  }
  return rows;
}

std::string table_doc(const OptionEntry& entry) {
  const bool is_required = entry.need == Need::required;
  return entry.doc + " (" + entry.type_text + (is_required ? ", required)" : ")");
}

std::string path_below(const std::string& path, const OptionEntry& entry) {
  return path.empty() ? entry.key : path + "." + entry.key;
}

std::string header(const std::string& path, const OptionEntry& entry) {
  const std::string inside = path_below(path, entry);
  return entry.is_list ? "[[" + inside + "]]" : "[" + inside + "]";
}

void append_aligned(const std::vector<Row>& rows, const std::string& indent, std::string& text) {
  std::array<std::size_t, 4> widths{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < 4; ++i) widths[i] = std::max(widths[i], n_characters(row[i]));
  for (const Row& row : rows) {
    text.append(indent);
    for (std::size_t i = 0; i < 3; ++i)
      text.append(row[i]).append(widths[i] - n_characters(row[i]) + 2, ' ');
    text.append(row[3]).append("\n");
  }
}

bool is_same(const std::vector<OptionEntry>& a, const std::vector<OptionEntry>& b) {
  return value_rows(a) == value_rows(b) &&
         std::ranges::equal(a, b, [](const OptionEntry& one, const OptionEntry& other) {
           return one.key == other.key && is_same(one.below, other.below);
         });
}

// Tables on the way down the help. One as long as this that comes again points to the first.
class ShownTables {
 public:
  // Header of the one before it with the same keys, else "".
  std::string shown_as(const std::string& head, const OptionEntry& entry) {
    constexpr std::size_t is_long = 6;
    if (entry.below.size() < is_long) return "";
    for (const auto& [earlier, below] : shown_)
      if (is_same(*below, entry.below)) return earlier;
    shown_.emplace_back(head, &entry.below);
    return "";
  }

 private:
  std::vector<std::pair<std::string, const std::vector<OptionEntry>*>> shown_;
};

void append_help(const std::vector<OptionEntry>& entries, const std::string& path,
                 const std::string& indent, ShownTables& shown, std::string& text) {
  append_aligned(value_rows(entries), indent, text);
  for (const OptionEntry& entry : entries) {
    if (!entry.is_table) continue;
    const std::string head = header(path, entry), as = shown.shown_as(head, entry);
    text.append("\n").append(indent).append(head).append("  ");
    text.append(table_doc(entry)).append("\n");
    if (as.empty())
      append_help(entry.below, path_below(path, entry), indent + "  ", shown, text);
    else
      text.append(indent).append("  The keys of ").append(as).append(".\n");
  }
}

// A cell of a Markdown table can't hold a bare |.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped.append(c == '|' ? "\\|" : std::string(1, c));
  return escaped;
}

void append_markdown(const std::vector<OptionEntry>& entries, const std::string& path,
                     ShownTables& shown, std::string& text) {
  const std::vector<Row> rows = value_rows(entries);
  if (!rows.empty()) text.append("\n| key | type | default | meaning |\n|---|---|---|---|\n");
  for (const Row& row : rows) {
    text.append("| `").append(row[0]).append("` | ").append(cell(row[1])).append(" | ");
    text.append(cell(row[2])).append(" | ").append(cell(row[3])).append(" |\n");
  }
  for (const OptionEntry& entry : entries) {
    if (!entry.is_table) continue;
    const std::string head = header(path, entry), as = shown.shown_as(head, entry);
    text.append("\n## `").append(head).append("`\n\n");
    text.append(table_doc(entry)).append("\n");
    if (as.empty())
      append_markdown(entry.below, path_below(path, entry), shown, text);
    else
      text.append("\nThe keys of `").append(as).append("`.\n");
  }
}

}  // namespace

std::string help_options(const OptionTable& table) {
  std::string text = table.doc();
  text.append("\n\n");
  ShownTables shown;
  append_help(table.entries(), "", "  ", shown, text);
  return text;
}

std::string markdown_options(const OptionTable& table) {
  std::string text = table.doc();
  text.append("\n");
  ShownTables shown;
  append_markdown(table.entries(), "", shown, text);
  return text;
}

}  // namespace trocar
