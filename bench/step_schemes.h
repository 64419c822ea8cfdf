// Schemes of one and the same step, made of the solver's kernels: the same arithmetic in the same
// order of sums, so the same displacements; what differs is what lies in memory between elements
// and nodes, and when nodes move. Bytes beside those that all of them move once (constants and
// corners of elements; displacement, velocity, mass of nodes), in double; half of what is of forces
// in single precision. A write to memory reads the line first, so it counts twice.
//   one pass          the program's step: sums and forces stay in the cache
//   forces, motion    compute_force, then integrate: forces out and in (72 a node), displacement
//                     in again (24)
//   elements, nodes   all elements, then all nodes: sums out, in, and out as zeros (128 a node),
//                     displacement in again (24), by component also out (48)
//   slots by element  each element stores its corner forces behind those of the one before, a node
//                     collects its own: 32 out and in, and 4 for where it is, 100 a corner: 800 a
//                     hexahedron, 400 a tetrahedron; displacement as "elements, nodes", no sums
//   slots by node     the same, but corner forces are spread so that a node's lie side by side
// The kernels add to sums of four numbers a node, and can't store. So each task of theirs adds to a
// buffer of zeros in the first cache, from where slots are stored.
#pragma once

#include <functional>
#include <vector>

#include "base/aligned_vector.h"
#include "solver_body.h"

namespace trocar {

struct StepScheme {
  const char* name;
  std::function<void()> prepare;  // after another scheme's step
  std::function<void(double dt)> step;
};

// What the schemes other than the program's have beside a body.
struct SchemeData {
  std::vector<std::int32_t> node;     // (n_owned) 0, 1, …
  std::vector<std::int32_t> met_end;  // (strides) behind the nodes that the run met up to it
  // Displacements by component, where the model's fields lie so. [m]
  AlignedVector<double> u_x;
  // Corners count through [list][block][corner][lane]; those of a node ascend by element.
  std::vector<std::int64_t> first_corner;  // of each list
  std::vector<std::int32_t> node_offset;   // (n_owned + 1) into node_corner
  std::vector<std::int32_t> node_corner;   // and some zeros
  // Where each corner is in node_corner; what is padding, behind the corners.
  std::vector<std::int32_t> place;
};

SchemeData make_scheme_data(const Body& body);

// They keep pointers to both. The first one is the program's.
std::vector<StepScheme> step_schemes(Body& body, SchemeData& data);

}  // namespace trocar
