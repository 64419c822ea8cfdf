#include "engine/cut_record.h"

#include <algorithm>

#include "engine/apply_cut.h"
#include "engine/event_log.h"

namespace trocar {

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
