// What a stroke remembers between advances: where the blade has crossed element edges, and what has
// been opened so far. Element numbers survive edits, so everything is kept by element; node numbers
// only where copies are followed. In a body that has or had hexahedra, elements are those of
// HexTets::mesh (cut_hex.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace trocar {

inline constexpr std::array<std::array<int, 2>, 6> tet_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// The blade crossed local edge `edge` (tet_edges) of tetrahedron `element`.
struct CutHit {
  std::int32_t element = 0;
  std::int32_t edge = 0;
  bool is_first_plus = false;  // the edge's first corner lies on the + side
  Vec3 X = Vec3::Zero();       // crossing point, reference configuration [m]
  Vec3 N = Vec3::Zero();       // unit normal of the swept surface, pulled back to the reference

  std::pair<std::int32_t, std::int32_t> key() const { return {element, edge}; }
};

// Of a swept surface, reference configuration.
struct SurfacePoint {
  Vec3 X = Vec3::Zero();  // [m]
  Vec3 N = Vec3::Zero();  // unit, towards +
};

// A value of an element; vectors of them are ascending by element.
template <class T>
struct OfElement {
  std::int32_t element = 0;
  T value{};
};

// What a stroke knows of the elements that its blade has met, or several strokes together.
struct CutKnown {
  std::vector<CutHit> hit;                      // ascending (element, edge)
  std::vector<OfElement<std::int8_t>> side;     // +1 or -1: sides given at earlier advances
  std::vector<OfElement<std::uint8_t>> opened;  // bit f: facet f was opened by this stroke
  // nodes of opened facets that lie on the swept surface, ascending
  std::vector<std::int32_t> surface_node;
  // nodes that this stroke gave a copy, and the copies, ascending
  std::vector<std::int32_t> parted_node;
};

// What strokes leave to others. What they know of elements around the ends of their slits: one
// that comes there goes on with it (cut_go_on.h). And where they have parted (cut_in_slit.h).
struct CutLeft : CutKnown {
  std::vector<SurfacePoint> parted;  // crossings of elements that they have opened, ascending
  std::vector<SurfacePoint> at_end;  // those of them around the ends of the slits, ascending
  std::vector<Vec3> rim;             // as in CutStroke, ascending
};

// A point of the blade's edge at the end of a frame, and where in the tissue its band has ended.
struct BladePoint {
  std::int32_t element = -1;  // that held it, or beside it; -1: far outside the body
  bool is_inside = false;
  Vec3 X = Vec3::Zero();         // the element's point there or next to it, reference position [m]
  Vec3 beyond = Vec3::Zero();    // from that point to the end of the band [m]
  Vec3 x = Vec3::Zero();         // of the edge [m]
  Vec3 farthest = Vec3::Zero();  // from there to the end of its way on, if it goes back now [m]
  Vec3 ahead = Vec3::Zero();     // unit: where its way on leads
};

struct CutStroke : CutKnown {
  std::vector<CutHit> earlier_hit;  // of earlier strokes that parted nothing there
  CutLeft left;                     // of strokes that have ended
  CutKnown beside;  // of other blades that are in a stroke, around what they have parted in it
  std::vector<std::int32_t> taken;  // elements of those that it goes on with, ascending
  // its bound (step_bound) before the blade touched it first [m]
  std::vector<OfElement<double>> step;
  // of parts of elements that cuts split: the mean edge of the whole one [m]
  std::vector<OfElement<double>> whole_edge;
  std::vector<std::int32_t> made_node;   // that this stroke put on crossed edges, ascending
  std::vector<std::int32_t> fresh;       // elements crossed since the last edit, ascending
  std::vector<std::int32_t> in_slit;     // elements that it crossed in an older slit, ascending
  std::vector<std::int32_t> whole;       // hexahedra that it went through and can't cut, ascending
  std::vector<std::int32_t> unfinished;  // elements to look at again at the next edit, ascending
  std::vector<BladePoint> edge;          // where the blade's edge is in the tissue
  std::vector<std::int32_t> at_edge;     // elements that hold it, ascending
  // where the swept surface ends inside the tissue: the edge at the begin, the ways of its ends;
  // reference positions [m]
  std::vector<Vec3> rim;
  bool is_amid = false;  // it went on into tissue and stopped there: if it is out now, it drew back
  double mean_edge = 0;  // around the last hits [m]; 0: not known yet
  double swept = 0;  // as the tissue sees it, since the last edit; in the air before it, too [m]
};

// Its own, what is left of others, and what is known of those beside it.
std::array<CutKnown*, 3> all_known(CutStroke& stroke);

// Whether the blade has left the tissue all along its edge, and not by the way it came: but for
// what lies at the rim, all that it crossed is parted then.
bool has_come_out(const CutStroke& stroke);

// Whether it has left, and cut what it swept from surface to surface.
bool has_gone_through(const CutStroke& stroke);

// Whether it has left the tissue by the way it came.
bool has_drawn_back(const CutStroke& stroke);

// Whether a place of the tissue (reference position) is too far from where the swept surface ends
// in there to be joined for that: by more than `width` mean edges, within which elements may hold
// the rim.
bool is_clear_of_rim(const CutStroke& stroke, const Vec3& X, double width = 1);

// Whether the edge, or some of it, is not on its way back.
bool goes_on(const CutStroke& stroke);

// The entry of `element`, nullptr if there is none.
template <class T>
const T* find_element(const std::vector<OfElement<T>>& values, std::int32_t element);
// The entries of many elements, ascending.
template <class T>
std::vector<const T*> find_elements(const std::vector<OfElement<T>>& values,
                                    std::span<const std::int32_t> element);
// Adds or overwrites entries; both ascending.
template <class T>
void merge_elements(std::vector<OfElement<T>>& values, const std::vector<OfElement<T>>& changes);

// Ascending (element, edge), the first of those with the same.
void sort_hits(std::vector<CutHit>& hits);

// The crossings of an element's edges; of many, ascending.
std::span<const CutHit> hits_of(const CutStroke& stroke, std::int32_t element);
std::vector<std::span<const CutHit>> hits_of(const CutStroke& stroke,
                                             std::span<const std::int32_t> element);

}  // namespace trocar

#include "cutting/cut_stroke_inl.h"
