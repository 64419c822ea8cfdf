#include "engine_split.h"

#include "engine/simulation.h"
#include "known_positions.h"

namespace trocar {

PlateSplit split_plate(Simulation& s, bool parts, const ApplyEdit& apply) {
  PlateSplit done;
  BladeSweep sweep;
  sweep.normal = Vec3::UnitZ();
  for (int k = 0; k <= 10; ++k) {
    const double y = 0.026 - 0.006 * k;
    sweep.before.emplace_back(-0.045, y, 0.0021);
    sweep.after.emplace_back(0.045, y, 0.0023);
  }
  TetCutter cutter{CutTetOptions{.split_step_ratio = s.scene.cutting.split_step_ratio}};
  cutter.start_stroke();
  for (bool is_parted = false; !is_parted; sweep.before = sweep.after) {
    GlobalState global = gather_state(s);
    KnownPositions positions(s.mesh, global.x);
    const std::vector<std::uint8_t> is_held = held_nodes(s.holds, s.fixed);
    CutFigures figures;
    const MeshEdit edit =
        cutter.advance(s.mesh, positions, {is_held, s.loads.border}, sweep, true, figures);
    is_parted = edit.inserted.empty() || !parts;
    if (done.split.is_empty()) done.split = edit;
    done.n_inserted += figures.n_inserted;
    if (edit.is_empty()) continue;
    if (apply)
      apply(global, edit, done.record);
    else
      apply_cut(s, edit, global, done.record);
  }
  return done;
}

}  // namespace trocar
