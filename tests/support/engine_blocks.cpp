#include "engine_blocks.h"

namespace trocar {

std::string short_block(const std::string& elements, const std::string& more) {
  return "[time]\nduration = \"1 s\"\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\n"
         "low = [-0.01, -0.01, 0]\nhigh = [0.01, 0.01, 0.03]\ncells = [4, 4, 6]\nelements = \"" +
         elements + "\"\n[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\n" +
         "density = 1000\n" + more;
}

std::string hanging_block(const BodyKind& kind) {
  return "[time]\nduration = \"1 s\"\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\n"
         "low = [-0.02, -0.016, 0]\nhigh = [0.02, 0.016, 0.032]\ncells = [10, 8, 8]\n"
         "elements = \"" +
         kind.elements +
         "\"\n[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\ndensity = 1000\n" +
         kind.material + "[solver]\n" + kind.solver +
         "[[support]]\nregion = \"z+\"\nfix = \"xyz\"\n";
}

}  // namespace trocar
