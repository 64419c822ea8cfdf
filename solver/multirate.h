// Local time steps: where a few small elements would make all elements take small steps, the forces
// of a step dt are taken from p substeps of their surroundings alone (local leapfrog: Diaz, Grote,
// SIAM J. Sci. Comput. 31, 2009; stabilised: Grote, Michel, Sauter, Math. Comp. 90, 2021). With
// P = 1 at fine nodes (all nodes of small elements), 0 elsewhere, and a_k = M^-1 F(u + P z_k),
//   z_0 = 0,  z_1 = dt^2 / (w d) a_0,  z_k+1 = (1 + b_k) z_k - b_k z_k-1 + 2/w c_k dt^2 a_k,
//   F~ = 2 M z_p / dt^2
// takes the place of F(u) in the step; away from elements that touch fine nodes the two are equal.
// w = 2 T_p'(d) / T_p(d), b_k = T_k-1 / T_k+1 and c_k = T_k / T_k+1 of the Chebyshev polynomials at
// d > 1. At d = 1, z is p steps of central differences: unstable where a fine frequency meets its
// coarse neighbours in resonance. With d as in the paper (1 + 0.05 / p^2), steps are stable, but
// their cosines cos(omega~ dt) = T_p(d - (omega dt)^2 / w) / T_p(d) go back and forth between about
// -1 and 1: some mode meets the third-order resonance at -1/2 that finite strains feed
// (docs/stability.md). T_p(d) = 9/4 keeps all of them above -4/9, where the highest coarse mode is
// at 0.85 of its limit, and costs a fifth of the fine nodes' limit.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mesh/node_corners.h"
#include "mesh/partition.h"
#include "solver/material.h"
#include "solver/model.h"
#include "solver/rank_body.h"
#include "solver/step.h"

namespace trocar {

// z_k+1 = (1 + back[k]) z_k - back[k] z_k-1 + gain[k] dt^2 a_k; back[0] = 0.
struct LocalSteps {
  std::vector<double> back, gain;  // (p)
  double limit = 2;                // of dt omega, omega the highest frequency of all
};
// p: a power of two.
LocalSteps local_steps(int p);

// Local steps that save less than this factor of element-steps are not worth it.
inline constexpr double least_local_gain = 1.2;

// Which elements are computed p times a step.
struct MultiRatePlan {
  int n_substeps = 1;                 // p, a power of two; 1: nothing is worth it
  std::vector<std::int32_t> element;  // all that touch fine nodes, ascending
  std::vector<std::uint8_t> is_fine;  // (n_nodes)
  double gain = 1;                    // element-steps without over with it
};
// resting: of all elements of the mesh.
MultiRatePlan plan_multirate(const Mesh& mesh, const NodeCorners& corners,
                             std::span<const RestingElement> resting);

// The elements of a plan as a body of their own; a rank without such nodes has an empty one.
struct MultiRate : RankBody {
  LocalSteps steps;
  double share = 0;                     // of all elements
  bool is_judged = false;               // whether a search has shown that it saves work
  std::vector<std::int32_t> whole;      // (n_local) local number in the whole body
  std::vector<std::int32_t> of_whole;   // (n_owned of the whole body) local number here or -1
  std::vector<std::uint8_t> is_fine;    // (n_owned)
  std::vector<FixedMask> moves;         // (n_owned) fine, and not supported or held in this step
  std::vector<double> start_force;      // (n_owned * 3) of these elements at u [N]
  std::vector<double> z, z_before;      // (n_owned * 3) [m]
  std::vector<FixedMask> coarse_fixed;  // (n_owned of the whole body) fixed, and fine nodes
};
struct MultiRateBody {
  const Mesh& mesh;
  std::span<const Material> materials;
  std::span<const std::int32_t> node_owner;
  const Part& part;
  const Model& model;
};
std::unique_ptr<MultiRate> make_multirate(const MultiRatePlan& plan, const MultiRateBody& body,
                                          Communicator& communicator);

// scratch.force from F(u) to F~ of a step dt. What is held stays where it is meanwhile, and its
// force is what the others' substeps exert on it: the sum of all is that of F(u). Collective among
// neighbours.
struct MultiRateStep {
  const Model& model;
  const State& state;
  std::span<const PrescribedNode> prescribed;
  double dt = 0;
};
void refine_force(const MultiRateStep& step, MultiRate& multirate, Scratch& scratch);

}  // namespace trocar
