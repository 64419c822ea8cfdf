// Just enough XML for VTU files and pictures. Tags: names and attributes, front to back. No
// entities, no nesting: whoever reads the tags knows what may stand where.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/file_reader.h"

namespace trocar {

struct XmlTag {
  std::string_view name;
  bool is_end = false;      // </name>
  bool is_empty = false;    // <name/>
  std::string_view before;  // the text between the previous tag and this one
  std::string_view text;    // from < to >
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
};

// Moves behind the next tag that is neither a comment nor a declaration; false if there is none.
// Throws InputError for a tag that is cut off or malformed.
bool next_tag(FileReader& in, XmlTag& tag);
// "" if the tag doesn't have it.
std::string_view attribute(const XmlTag& tag, std::string_view name);

// Text as it may stand in an attribute or between tags: entities for what XML keeps for itself,
// blanks for control characters, which it does not allow.
std::string escaped_xml(std::string_view text);

}  // namespace trocar
