// What a cut did, for the cut ledger of the summary.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace trocar {

// Where tissue stays joined though the blade went through.
struct CutRefusal {
  enum Reason : std::int32_t {  // as checkpoints have them: new ones go to the end
    pinched,                    // a facet: the outer surface would be no 2-manifold
    chip,        // elements below a quarter of a mean edge cubed stay with the other side
    missed,      // an element, facet or edge on the blade's path that holds both sides together
    bent,        // a hexahedron, or a facet at one, that can't become tetrahedra
    slow,        // plane cuts: elements there would have a stable step below the floor …
    held,        // … would need nodes that must not be displaced …
    no_room,     // … or too few nodes are there for valid ones
    slice_held,  // a stretch thinner than the mesh can show stays with held nodes …
    slice,       // … or with others of the outer surface or of a lip, which slide in that alone
    crushed,     // plane cuts: an element there would be inverted in the deformed body
    neck,        // of few elements, all around which the blade has gone
    n_reasons
  };
  Vec3 X = Vec3::Zero();  // its centre, that of the stretch, or where the blade crossed the first
                          // element of a slice, reference configuration [m]
  Reason reason = pinched;
  double area = 0;  // of the outer surface along a slice; else 0 [m^2]
};

// As the ledger says it.
const char* reason_of(const CutRefusal& refusal);

struct CutFigures {
  bool goes_through = false;  // at a stroke's end: the blade has swept from surface to surface
  bool is_in_slit = false;    // at a stroke's end: it has met nothing but an older slit
  std::int32_t n_opened_facets = 0;
  std::int32_t n_moved = 0;
  std::int32_t n_duplicated = 0;
  // places where no valid change was found; the tissue stays joined there
  std::int32_t n_refused = 0;
  double least_quality = 1;  // mean ratio of the touched elements after the cut
  // of cut nodes from the swept surface, reference configuration [m]
  double largest_deviation = 0, deviation_sum = 0;
  std::int32_t n_on_cut = 0;  // nodes of deviation_sum
  // parted nodes that the floor under the stable step, a support or a sharp edge keeps more than
  // 0.1 mean edges from the swept surface
  std::int32_t n_beside = 0;
  // Rungs of the ladder: elements whose side was turned so that the outer surface stays a
  // 2-manifold, chips that stay with the other side, nodes that went less far than
  // their move wanted so that elements stay valid, and elements that this move had inverted.
  std::int32_t n_turned = 0, n_chips = 0, n_pulled_back = 0, n_inverted = 0;
  std::int32_t n_converted = 0;       // hexahedra that became six tetrahedra each
  std::int32_t n_kept_hexahedra = 0;  // that were reshaped or opened at a facet and stay hexahedra
  std::int32_t n_inserted = 0;        // nodes put on crossed edges of tissue too thin for its own
  std::vector<CutRefusal> refusals;   // (n_refused)
  double mean_edge = 0;               // mean edge length around the cut [m]

  double mean_deviation() const { return n_on_cut > 0 ? deviation_sum / n_on_cut : 0; }  // [m]
};

// Those of a stroke's next step to the sum of the ones before; without an edit only what the blade
// met counts.
void add(const CutFigures& of, bool has_edit, CutFigures& sum);

}  // namespace trocar
