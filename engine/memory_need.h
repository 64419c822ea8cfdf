// What memory a body will take, before it is asked for: a machine that runs out of it ends programs
// without a word, or after minutes.
#pragma once

#include <cstdint>

#include "base/communicator.h"
#include "engine/scene.h"
#include "mesh/mesh.h"

namespace trocar {

struct BodySize {
  std::int64_t n_nodes = 0, n_hexahedra = 0;
  std::int64_t n_others = 0;  // tetrahedra, triangles
};

// Of a generated body; of a mesh.
BodySize size_of(const SceneShape& shape);
BodySize size_of(const Mesh& mesh);

// Of the rank that has most, while the body is built and watched. Of measured runs
// (docs/performance.md, "What limits it"), within a fifth; instruments and pictures not counted.
struct MemoryNeed {
  double of_whole = 0;  // mesh and surface, which every rank holds [bytes]
  double of_part = 0;   // model, state, searches [bytes]
};
MemoryNeed memory_need(const BodySize& size, const SceneSolver& solver, int n_ranks);

// What the host that has least can still give each of its ranks. Collective. [bytes]
double memory_for_a_rank(const Communicator& communicator);
// Throws SharedMachineError if that would not do.
void check_memory(const BodySize& size, const SceneSolver& solver, int n_ranks, double left);

}  // namespace trocar
