#include "engine_recording.h"

#include <gtest/gtest.h>

namespace trocar {

bool is_equal(const RecordedFrame& a, const RecordedFrame& b) {
  return a.frame == b.frame && a.step == b.step && a.time == b.time && a.digest == b.digest &&
         a.u == b.u && a.tool_forces == b.tool_forces;
}

MeshEdit example_edit(const Mesh& mesh, std::int32_t node) {
  MeshEdit edit;
  std::int32_t element = 0, corner = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (std::size_t a = 0; a < mesh.corners(e).size(); ++a)
      if (mesh.corners(e)[a] == node) {
        element = e;
        corner = static_cast<std::int32_t>(a);
      }
  NodeMove move{.node = node, .X = mesh.X[node] + Vec3(1e-4, 2e-4, 0), .host = element};
  move.weight[corner] = 1;
  edit.moves = {move};
  edit.duplicate_parent = {node};
  edit.corners = {{.element = element, .corner = corner, .node = mesh.n_nodes()}};
  edit.cut_facets = {{.element = element, .mask = 3}};
  edit.density = {{.element = element, .factor = 1.01}};
  return edit;
}

RecordedFrame example_frame(std::int64_t number, std::size_t n_nodes, std::size_t n_tools) {
  RecordedFrame frame{.frame = number,
                      .step = 37 * number,
                      .time = static_cast<double>(number) / 30,
                      .digest = 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(number + 1)};
  for (std::size_t i = 0; i < 3 * n_nodes; ++i) {
    const double wave = std::sin(0.1 * static_cast<double>(i) + static_cast<double>(number));
    frame.u.push_back(i % 3 == 2 ? 0 : 1e-3 * wave);  // the mesh is a plane one
  }
  for (std::size_t i = 0; i < 3 * n_tools; ++i)
    frame.tool_forces.push_back(0.1 * static_cast<double>(i + 1) / static_cast<double>(number + 3));
  return frame;
}

ExampleRun example_run(int n_frames) {
  ExampleRun run;
  run.head = {.version = "trocar test",
              .scene = "name = \"a test\"\n",
              .mesh = make_rectangle(0.07, 0.04, 4, 3)};
  run.head.tool_meshes.resize(2);
  run.head.tool_meshes[1] = make_box_surface(Vec3(0, 0, 0), Vec3(1e-3, 2e-3, 3e-3));
  Mesh mesh = run.head.mesh;
  for (int k = 0; k < n_frames; ++k) {
    std::vector<MeshEdit> edits;
    const int n_edits = k == 5 ? 2 : (k % 3 == 2 ? 1 : 0);
    for (int n = 0; n < n_edits; ++n) {
      edits.push_back(example_edit(mesh, (k + n) % 12));
      apply_edit(edits.back(), mesh);
    }
    run.frames.push_back(example_frame(2 * k, mesh.X.size(), 2));
    run.edits.push_back(std::move(edits));
    run.meshes.push_back(mesh);
  }
  return run;
}

void write_run(const ExampleRun& run, const std::string& file, bool with_finish) {
  RecordingWriter writer(file, run.head);
  for (std::size_t k = 0; k < run.frames.size(); ++k) writer.add(run.edits[k], run.frames[k]);
  if (with_finish) writer.finish();
}

bool is_equal(const RecordingHead& a, const RecordingHead& b) {
  if (a.version != b.version || a.scene != b.scene || a.mesh != b.mesh) return false;
  if (a.tool_meshes.size() != b.tool_meshes.size()) return false;
  for (std::size_t k = 0; k < a.tool_meshes.size(); ++k)
    if (a.tool_meshes[k].X != b.tool_meshes[k].X ||
        a.tool_meshes[k].triangle != b.tool_meshes[k].triangle)
      return false;
  return true;
}

}  // namespace trocar
