// Blocks that are cut, as scenes, and what they are computed with.
#pragma once

#include <string>

namespace trocar {

struct BodyKind {
  std::string elements, material, solver;  // more lines of the tables
};

// 20 x 20 x 30 mm in cells of 5 mm.
std::string short_block(const std::string& elements, const std::string& more);

// 40 x 32 x 32 mm in cells of 4 mm, hanging.
std::string hanging_block(const BodyKind& kind);

}  // namespace trocar
