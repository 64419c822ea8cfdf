// Just enough XML for the tags of VTU files: names and attributes, front to back. No entities, no
// nesting: whoever reads the tags knows what may stand where.
#pragma once

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

}  // namespace trocar
