// Scanning the tags of an XML file.
#include "mesh/xml_tag.h"

#include "base/quoted.h"

namespace trocar {

static constexpr std::string_view spaces = " \t\r\n";

static std::string_view without_spaces(std::string_view text) {
  const std::size_t first = text.find_first_not_of(spaces);
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

// name = "value" pairs up to the end of `text`.
static void read_attributes(const FileReader& in, std::string_view text, XmlTag& tag) {
  for (text = without_spaces(text); !text.empty(); text = without_spaces(text)) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos)
      in.fail("an attribute should be name=\"value\", not " + in_quotes(text));
    const std::string_view name = text.substr(0, text.find_first_of(" \t\r\n="));
    text = without_spaces(text.substr(equals + 1));
    const std::size_t end = text.empty() ? std::string_view::npos : text.find(text[0], 1);
    if (end == std::string_view::npos || (text[0] != '"' && text[0] != '\''))
      in.fail("the value of attribute " + in_quotes(name) + " should stand in quotes");
    tag.attributes.emplace_back(name, text.substr(1, end - 1));
    text.remove_prefix(end + 1);
  }
}

// Where the tag at the beginning of `rest` ends: behind its > outside of quotes.
static std::size_t find_tag_end(std::string_view rest) {
  if (rest.starts_with("<!--")) {
    const std::size_t end = rest.find("-->");
    return end == std::string_view::npos ? end : end + 3;
  }
  char quote = '\0';
  for (std::size_t k = 1; k < rest.size(); ++k) {
    if (quote != '\0') {
      if (rest[k] == quote) quote = '\0';
    } else if (rest[k] == '"' || rest[k] == '\'') {
      quote = rest[k];
    } else if (rest[k] == '>') {
      return k + 1;
    }
  }
  return std::string_view::npos;
}

bool next_tag(FileReader& in, XmlTag& tag) {
  while (true) {
    const std::size_t begin = in.rest().find('<');
    if (begin == std::string_view::npos) return false;
    tag.before = in.take(begin, "the text of a tag");
    const std::size_t size = find_tag_end(in.rest());
    if (size == std::string_view::npos) in.fail("the file ends within a tag: it is cut off");
    tag.text = in.take(size, "a tag");
    if (tag.text[1] != '?' && tag.text[1] != '!') break;
  }
  std::string_view inside = tag.text.substr(1, tag.text.size() - 2);
  tag.is_end = inside.starts_with('/');
  tag.is_empty = !tag.is_end && inside.ends_with('/');
  if (tag.is_end) inside.remove_prefix(1);
  if (tag.is_empty) inside.remove_suffix(1);
  tag.name = inside.substr(0, inside.find_first_of(spaces));
  tag.attributes.clear();
  read_attributes(in, inside.substr(tag.name.size()), tag);
  return true;
}

std::string_view attribute(const XmlTag& tag, std::string_view name) {
  for (const auto& [key, value] : tag.attributes)
    if (key == name) return value;
  return {};
}

std::string escaped_xml(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return safe;
}

}  // namespace trocar
