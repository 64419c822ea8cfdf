// What a cut did, for the cut ledger of the summary.
#pragma once

#include <cstdint>

namespace trocar {

struct CutFigures {
  std::int32_t n_opened_facets = 0;
  std::int32_t n_moved = 0;
  std::int32_t n_duplicated = 0;
  std::int32_t n_refused =
      0;  // places where no valid change was found; the tissue stays joined there
  double least_quality = 1;  // mean ratio of the touched elements after the cut
  double largest_deviation =
      0;                      // of a cut node from the swept surface [m], reference configuration
  double mean_deviation = 0;  // [m]
  double mean_edge = 0;       // mean edge length around the cut [m]
};

}  // namespace trocar
