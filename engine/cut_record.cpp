#include "engine/cut_record.h"

#include <algorithm>

#include "engine/apply_cut.h"
#include "engine/event_log.h"

namespace trocar {

// Of a step of a stroke without an edit only what its blade met counts.
static void add(const CutFigures& of, bool has_edit, CutFigures& sum) {
  sum.goes_through = of.goes_through;
  sum.is_in_slit = of.is_in_slit;
  sum.n_refused += of.n_refused;
  sum.n_beside += of.n_beside;
  sum.refusals.insert(sum.refusals.end(), of.refusals.begin(), of.refusals.end());
  if (!has_edit) return;
  const double n_old = sum.n_moved, n_new = of.n_moved;
  if (n_old + n_new > 0)
    sum.mean_deviation = (sum.mean_deviation * n_old + of.mean_deviation * n_new) / (n_old + n_new);
  sum.n_moved += of.n_moved;
  sum.n_duplicated += of.n_duplicated;
  sum.n_opened_facets += of.n_opened_facets;
  sum.n_turned += of.n_turned;
  sum.n_chips += of.n_chips;
  sum.n_pulled_back += of.n_pulled_back;
  sum.n_inserted += of.n_inserted;
  sum.n_converted += of.n_converted;
  sum.n_kept_hexahedra += of.n_kept_hexahedra;
  sum.largest_deviation = std::max(sum.largest_deviation, of.largest_deviation);
  sum.mean_edge = of.mean_edge;
}

void note_edit(Simulation& s, const MeshEdit& edit, const CutFigures& figures, CutRecord& record) {
  add(figures, !edit.is_empty(), record.figures);
  if (edit.is_empty()) return;
  ++record.n_edits;
  const std::int32_t n_before = s.mesh.n_elements(), n_pieces_before = s.n_pieces;
  apply_cut(s, edit, s.cut_state, record);
  if (s.n_pieces > n_pieces_before)
    note_event(s, record.end,
               record.tool + " frees a piece: the body is in " + std::to_string(s.n_pieces));
  const std::int64_t difference = s.mesh.n_elements() - n_before;
  record.n_elements_added += std::max<std::int64_t>(difference, 0);
  record.n_elements_dissolved += std::max<std::int64_t>(-difference, 0);
}

}  // namespace trocar
