#include "cutting_count.h"

#include <cstdlib>

#include "mesh/quality.h"

namespace trocar {

std::int32_t n_pieces(const Mesh& mesh) {
  std::vector<std::int32_t> piece;
  return mesh_pieces(mesh, piece);
}

int n_cuts_or(int otherwise) {
  const char* wish = std::getenv("TROCAR_CUTS");
  return wish != nullptr ? std::atoi(wish) : otherwise;
}

}  // namespace trocar
