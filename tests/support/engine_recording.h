// A small recording with cuts: its parts, the file, and what a reader must give back.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "engine/recording.h"
#include "mesh/edit.h"
#include "mesh/generate.h"

namespace trocar {

bool is_equal(const RecordedFrame& a, const RecordedFrame& b);

// Moves a node, duplicates it, and hands one of its elements to the duplicate.
MeshEdit example_edit(const Mesh& mesh, std::int32_t node);

// All that goes into a recording, and the mesh that belongs to each frame.
struct ExampleRun {
  RecordingHead head;
  std::vector<RecordedFrame> frames;
  std::vector<std::vector<MeshEdit>> edits;  // (frames.size())
  std::vector<Mesh> meshes;                  // (frames.size())
};

// Numbers without pattern, so that a swapped or shifted one shows.
RecordedFrame example_frame(std::int64_t number, std::size_t n_nodes, std::size_t n_tools);

// Every third frame from 2 on comes with an edit, the fifth with two.
ExampleRun example_run(int n_frames);

void write_run(const ExampleRun& run, const std::string& file, bool with_finish = true);

bool is_equal(const RecordingHead& a, const RecordingHead& b);

}  // namespace trocar
