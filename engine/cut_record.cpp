#include "engine/cut_record.h"

#include <algorithm>

#include "engine/apply_cut.h"
#include "engine/frame_report.h"

namespace trocar {

static void add_figures(const CutFigures& figures, bool has_edit, CutRecord& record) {
  record.goes_through = figures.goes_through;
  record.is_in_slit = figures.is_in_slit;
  record.n_refused += figures.n_refused;
  record.n_beside += figures.n_beside;
  record.refusals.insert(record.refusals.end(), figures.refusals.begin(), figures.refusals.end());
  if (!has_edit) return;
  const auto n_old = static_cast<double>(record.n_moved),
             n_new = static_cast<double>(figures.n_moved);
  if (n_old + n_new > 0)
    record.mean_deviation =
        (record.mean_deviation * n_old + figures.mean_deviation * n_new) / (n_old + n_new);
  ++record.n_edits;
  record.n_moved += figures.n_moved;
  record.n_duplicated += figures.n_duplicated;
  record.n_opened_facets += figures.n_opened_facets;
  record.n_turned += figures.n_turned;
  record.n_chips += figures.n_chips;
  record.n_pulled_back += figures.n_pulled_back;
  record.n_inserted += figures.n_inserted;
  record.n_converted += figures.n_converted;
  record.n_kept_hexahedra += figures.n_kept_hexahedra;
  record.largest_deviation = std::max(record.largest_deviation, figures.largest_deviation);
  record.mean_edge = figures.mean_edge;
}

void note_edit(Simulation& s, const MeshEdit& edit, const CutFigures& figures, CutRecord& record) {
  add_figures(figures, !edit.is_empty(), record);
  if (edit.is_empty()) return;
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
