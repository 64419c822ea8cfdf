// What cuts are made of, for archives: in checkpoints, and on its way between ranks.
#pragma once

#include "cutting/cut_figures.h"
#include "cutting/cut_stroke.h"
#include "cutting/cut_tet.h"
#include "engine/archive.h"
#include "engine/locate.h"

namespace trocar {

template <class Archive>
void visit(Archive& a, MeshEdit& edit) {
  visit_bytes(a, edit, edit_to_bytes, edit_from_bytes);
}
template <class Archive>
void visit(Archive& a, CutHit& h) {
  a(h.element, h.edge, h.is_first_plus, h.X, h.N);
}
template <class Archive>
void visit(Archive& a, CutterEdit& edit) {
  visit(a, static_cast<MeshEdit&>(edit));
  visit(a, edit.tets);
  a(edit.along);
}
template <class Archive, class T>
void visit(Archive& a, OfElement<T>& entry) {
  a(entry.element, entry.value);
}
template <class Archive>
void visit(Archive& a, BladePoint& p) {
  a(p.element, p.is_inside, p.X, p.beyond, p.x, p.farthest, p.ahead);
}
template <class Archive>
void visit(Archive& a, SurfacePoint& p) {
  a(p.X, p.N);
}
template <class Archive>
void visit(Archive& a, CutKnown& k) {
  a(k.hit, k.side, k.opened, k.surface_node, k.parted_node);
}
template <class Archive>
void visit(Archive& a, CutLeft& l) {
  visit(a, static_cast<CutKnown&>(l));
  a(l.parted, l.at_end, l.rim);
}
template <class Archive>
void visit(Archive& a, CutStroke& s) {
  visit(a, static_cast<CutKnown&>(s));
  a(s.earlier_hit, s.left, s.beside, s.taken, s.step, s.whole_edge, s.made_node, s.fresh, s.in_slit,
    s.whole, s.unfinished, s.edge, s.at_edge, s.rim, s.is_amid, s.mean_edge, s.swept);
}
template <class Archive>
void visit(Archive& a, CutRefusal& r) {
  a(r.X, r.reason, r.area);
}
template <class Archive>
void visit(Archive& a, CutFigures& f) {
  a(f.goes_through, f.is_in_slit, f.n_opened_facets, f.n_moved, f.n_duplicated, f.n_refused,
    f.least_quality, f.largest_deviation, f.deviation_sum, f.n_on_cut, f.n_beside, f.n_turned,
    f.n_chips, f.n_pulled_back, f.n_inverted, f.n_converted, f.n_kept_hexahedra, f.n_inserted,
    f.refusals, f.mean_edge);
}
template <class Archive>
void visit(Archive& a, Location& l) {
  a(l.element, l.weight);
}
template <class Archive>
void visit(Archive& a, SegmentPiece& p) {
  a(p.middle, p.length);
}

}  // namespace trocar
