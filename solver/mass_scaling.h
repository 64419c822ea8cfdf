// Selective mass scaling (Olovsson, Simonsson and Unosson 2005): elements whose own stable step
// lies below a wanted one get inertia that resists their deformation, not their motion as a whole.
//
// Olovsson adds beta m_e/n (I - 1 1^T/n) to the mass of an element, beta = (wanted / own step)^2
// - 1. It leaves translations alone and divides the element's omega^2 by 1 + beta, but the sum over
// elements needs a solver in each step. Here the corner masses d = beta m_e/n are added up at nodes
// and joined over clusters of scaled elements that touch,
//   M = diag(m + d) - sum_c d d^T / s_c,  s_c = sum d of the cluster, in x, y and z alike.
// Total variance is not below the sum of those within elements: no frequency is above Olovsson's,
// and M has an inverse in closed form (mass_clusters.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/partition.h"
#include "solver/model.h"

namespace trocar {

struct MassScaling {
  double wanted_step = 0;               // [s]
  std::vector<RestingElement> element;  // scaled ones, ascending
  std::vector<std::int32_t> offset;     // (n_clusters + 1) into node and added
  std::vector<std::int32_t> node;       // of clusters, ascending; clusters by their lowest node
  std::vector<double> added;            // d of these nodes [kg]

  std::int32_t n_clusters() const { return static_cast<std::int32_t>(offset.size()) - 1; }
};

// Looks at the whole mesh, undeformed; the same on every rank without communication.
MassScaling find_mass_scaling(const Mesh& mesh, std::span<const Material> materials,
                              const SolverOptions& options, double wanted_step);
// After an edit, to what find_mass_scaling says of the edited mesh, in time of what is scaled.
// edited: elements, those that it added among them; ascending.
void edit_mass_scaling(const Mesh& mesh, std::span<const Material> materials,
                       const SolverOptions& options, std::span<const std::int32_t> edited,
                       MassScaling& scaling);
bool are_clusters_whole(const MassScaling& scaling, std::span<const std::int32_t> node_owner);
// Gives each cluster to the owner of its lowest node, so that no rank needs another's forces.
void keep_clusters_whole(const MassScaling& scaling, std::span<std::int32_t> node_owner);
// Into a model whose part has whole clusters: inertia, clusters, and the scaled elements' steps.
void scale_mass(const MassScaling& scaling, const Part& part, Model& model);
// Inertia and clusters out of it; steps stay.
void unscale_mass(Model& model);

}  // namespace trocar
