// A body on one rank with all that is needed to step it: what the built-in problems are made of.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/mesh.h"
#include "solver/rank_body.h"
#include "solver/step.h"

namespace trocar {

struct StudyBody : RankBody {
  Mesh mesh;
  std::vector<double> mass;  // (n_nodes) [kg]
  double h = 0;              // edge of a cell [m]
};

// `fixed` tells the supported components of the node at X; empty: none.
StudyBody make_study_body(Mesh mesh, double h, const Material& material,
                          const std::function<FixedMask(const Vec3& X)>& fixed,
                          const SolverOptions& options);

// Step that the body's highest frequency allows in its present deformation, less the margin of the
// search; the least element's bound if the search does not end. [s]
double stable_step(StudyBody& body);

// Steps over `length` seconds with equal steps of at most `factor` * stable_step, as a frame of the
// engine does, and calls `after_step(dt)` after each. False if the body is broken. The frame must
// be short beside the motion: unlike the engine this does not repeat a frame that stiffened.
bool advance_frame(StudyBody& body, double length, double factor,
                   const std::function<void(double dt)>& after_step);

// Number of the node nearest to X.
std::int32_t nearest_node(const Mesh& mesh, const Vec3& X);

}  // namespace trocar
