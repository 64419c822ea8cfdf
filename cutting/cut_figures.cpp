#include "cutting/cut_figures.h"

#include <array>

namespace trocar {

const char* reason_of(const CutRefusal& refusal) {
  constexpr std::array<const char*, CutRefusal::n_reasons> text = {
      "the outer surface would no longer be a closed surface",
      "a piece too small for the mesh, or left joined by the blade, stays with the other side",
      "tissue on the blade's way from surface to surface stays joined",
      "a hexahedron there can't become tetrahedra: it is bent too much, or tetrahedra beside it "
      "have the other diagonal",
      "the stable step of elements there would fall below the floor",
      "nodes there are held",
      "too few nodes are there for valid elements",
      "a slice thinner than some third of an element stays with nodes of a support or a grasp, "
      "which can't go to the blade: finer elements there, or a path farther from them",
      "a slice thinner than some third of an element stays with nodes of the outer surface or of "
      "an older cut, which can't go to the blade: finer elements there, or another path",
      "tissue there is pressed together so far that an element would be inverted",
      "the blade has gone all around, and what is inside hangs by a neck of few elements: a deeper "
      "way, or one that ends beside the point where it comes together"};
  return text[refusal.reason];
}

}  // namespace trocar
