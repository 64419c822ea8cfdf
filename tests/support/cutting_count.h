// How many random cuts to try.
#pragma once

#include <cstdlib>

namespace trocar {

// What TROCAR_CUTS says, or else `otherwise`.
inline int n_cuts_or(int otherwise) {
  const char* wish = std::getenv("TROCAR_CUTS");
  return wish != nullptr ? std::atoi(wish) : otherwise;
}

}  // namespace trocar
