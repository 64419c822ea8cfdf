#include "engine_started.h"

#include "base/log.h"
#include "base/threads.h"
#include "known_positions.h"

namespace trocar {

Started::Started() = default;
Started::~Started() = default;

std::unique_ptr<Started> built(const std::string& text, const std::vector<std::string>& overrides) {
  start_log(0, true);
  set_thread_count(1);
  auto started = std::make_unique<Started>();
  started->outputs.folder = started->folder.path();
  started->loaded = load_scene(write_text(started->folder.file("s.toml"), text), overrides);
  started->s = build(started->loaded, started->alone);
  return started;
}

std::unique_ptr<Started> block_of(const std::string& elements, int n) {
  const std::string cells = std::to_string(n);
  return built(R"([time]
duration = "1 s"
[tissue.shape]
kind = "box"
cells = [4, 4, 4]
[tissue.material]
young_modulus = "3 kPa"
poisson_ratio = 0.45
)",
               {"tissue.shape.elements='" + elements + "'",
                "tissue.shape.cells=[" + cells + "," + cells + "," + cells + "]"});
}

MeshEdit cut_across(const Simulation& s, const GlobalState& global, CutFigures& figures) {
  BladeSweep sweep;
  sweep.normal = Vec3(-0.3, 0, 1).normalized();
  for (int k = 0; k <= 10; ++k) {
    const double y = -0.02 + 0.004 * k;
    sweep.before.emplace_back(-0.03, y, 0.006);
    sweep.after.emplace_back(0.03, y, 0.024);
  }
  TetCutter cutter{CutTetOptions{}};
  KnownPositions positions(s.mesh, global.x);
  return cutter.advance(s.mesh, positions, {held_nodes(s.holds, s.fixed)}, sweep, true, figures);
}

}  // namespace trocar
