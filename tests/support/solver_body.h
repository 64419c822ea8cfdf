// A body on one rank, ready to be stepped, and the small things that tests of solver/ do with it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "base/digest.h"
#include "base/threads.h"
#include "largest.h"
#include "mesh/generate.h"
#include "mesh/mesh.h"
#include "mesh/partition.h"
#include "mesh_fixtures.h"
#include "solver/element_setup.h"
#include "solver/frequency.h"
#include "solver/model.h"
#include "solver/neighbours.h"
#include "solver/simd.h"
#include "solver/step.h"
#include "solver/watch.h"

namespace trocar {

// Its special members are compiled once.
struct Body {
  Body();
  Body(const Body& other);
  Body(Body&& other) noexcept;
  Body& operator=(const Body& other);
  Body& operator=(Body&& other) noexcept;
  ~Body();

  Mesh mesh;
  std::vector<Material> materials;
  std::vector<double> mass;
  Part part;
  Model model;
  State state;
  Scratch scratch;
};

struct BodyOptions {
  std::vector<Material> materials = {Material{}};
  SolverOptions solver;
  std::vector<FixedMask> fixed;  // empty: free
};

std::vector<double> mass_of(const Mesh& mesh, const BodyOptions& options);

Body make_body(Mesh mesh, BodyOptions options = {}, const std::vector<std::int32_t>& owner = {},
               int rank = 0);

// The same with nodal fields node by node, if they lie component by component (node_layout.h).
void put_node_by_node(Body& body);

Watch look(Body& body);

// Of the present deformation.
HighestFrequency search_frequency(Body& body, const FrequencyOptions& options = {});

// u = field(X) at all local nodes.
template <class Field>
void displace(Body& body, const Field& field) {
  for (std::int32_t i = 0; i < body.model.n_local; ++i) {
    const Vec3 u = field(body.mesh.X[body.part.node_global[i]]);
    for (int j = 0; j < 3; ++j) body.state.u[3 * i + j] = u[j];
  }
}

// Repeatable numbers in [-1, 1] (splitmix64).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    return static_cast<double>(mix64(state_ += 0x9e3779b97f4a7c15) >> 11) * 0x1p-52 - 1;
  }

 private:
  std::uint64_t state_;
};

void shake(std::vector<double>& values, double amount, std::uint64_t seed);

// External minus internal force of the present displacement.
const std::vector<double>& force(Body& body);

// Of a body with history, deformed twice: forces and history of a second call at the same time are
// those of the first, to the last bit.
void expect_second_call_changes_nothing(Body body);

double sum(const std::vector<double>& values);

// Strain plus hourglass energy of the present displacement.
double stored_energy(Body& body);

void step(Body& body, double dt);
// A step in which nothing waits or adds forces, in one pass over the nodes.
void step_freely(const Model& model, Neighbours& neighbours, double dt, State& state,
                 Scratch& scratch);
void step_freely(Body& body, double dt);
// A step; the energy at its beginning, with the kinetic part 1/2 m v- · v+ that central differences
// conserve (numerics 1.1; that of one velocity alone swings with the step).
double step_and_measure(Body& body, const std::function<void()>& step);
double step_and_measure(Body& body, double dt);

double least_element_step(const Body& body);

// One irregular element of each type, about 1 cm wide.
std::vector<Mesh> irregular_elements();

// One irregular element, or two tetrahedra where elements share more than forces.
Mesh irregular_patch(Formulation formulation);

std::vector<Formulation> all_formulations();
inline constexpr Precision precisions[] = {Precision::in_double, Precision::in_single};

// Options that compute the formulation's shape with it.
SolverOptions with(Formulation formulation, SolverOptions options = {});
// Whether elements of the formulation can be of the material.
bool is_possible(Formulation formulation, MaterialModel model);

const std::vector<MaterialModel>& all_models();

// The models' parameters from the shear and bulk moduli at small strain, in the ratios of numerics
// V4; only those of the model count.
Material material_of(MaterialModel model, double mu, double K, double density = 1000);

}  // namespace trocar
