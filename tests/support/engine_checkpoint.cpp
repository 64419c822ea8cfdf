#include "engine_checkpoint.h"

#include "engine_recording.h"

namespace trocar {

std::shared_ptr<std::vector<FrameRow>> rows_of(int n) {
  auto rows = std::make_shared<std::vector<FrameRow>>(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) (*rows)[k].tools = {{.position = Vec3(7, 8, k)}};
  return rows;
}

Checkpoint example_checkpoint() {
  Checkpoint c{.version = "trocar test", .scene = "name = \"x\"\n", .frame = 17, .digest = 99};
  c.mesh = std::make_shared<const Mesh>(make_rectangle(0.02, 0.01, 3, 2));
  c.fixed = {1, 2, 3, 4, 5, 6};
  for (int i = 0; i < 18; ++i) {
    c.u.push_back(0.1 * i);
    c.v.push_back(-0.3 * i);
  }
  c.step = 5;
  c.holds = {{.node = 2, .tool = 1, .offset = Vec3(1, 2, 3)}};
  c.cuts.resize(1);
  c.cuts[0].stroke.hit = {{.element = 3, .edge = 2, .is_first_plus = true, .X = Vec3(4, 5, 6)}};
  c.cuts[0].stroke.step = {{.element = 7, .value = 0.25}};
  c.cuts[0].is_engaged = true;
  c.cuts[0].strokes = {{.tool = "scalpel", .n_edits = 4}};
  c.rows = rows_of(2);
  c.tally.events = {"0.1 s: something"};
  c.outputs = {{.file = "r.trocar", .last_frame = 16}};
  c.outputs[0].pending = {example_edit(*c.mesh, 1)};
  return c;
}

}  // namespace trocar
