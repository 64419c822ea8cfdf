#include "cutting/cut_figures.h"

#include <algorithm>
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

void add(const CutFigures& of, bool has_edit, CutFigures& sum) {
  sum.goes_through = of.goes_through;
  sum.is_in_slit = of.is_in_slit;
  sum.n_refused += of.n_refused;
  sum.n_beside += of.n_beside;
  sum.refusals.insert(sum.refusals.end(), of.refusals.begin(), of.refusals.end());
  if (!has_edit) return;
  sum.n_moved += of.n_moved;
  sum.n_duplicated += of.n_duplicated;
  sum.n_opened_facets += of.n_opened_facets;
  sum.least_quality = std::min(sum.least_quality, of.least_quality);
  sum.n_turned += of.n_turned;
  sum.n_chips += of.n_chips;
  sum.n_pulled_back += of.n_pulled_back;
  sum.n_inserted += of.n_inserted;
  sum.n_inverted += of.n_inverted;
  sum.n_converted += of.n_converted;
  sum.n_kept_hexahedra += of.n_kept_hexahedra;
  sum.largest_deviation = std::max(sum.largest_deviation, of.largest_deviation);
  sum.deviation_sum += of.deviation_sum;
  sum.n_on_cut += of.n_on_cut;
  sum.mean_edge = of.mean_edge;
}

}  // namespace trocar
