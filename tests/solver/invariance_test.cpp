// The same bits for any number of ranks and threads. Ranks are bodies of their own in this process,
// and the halo is copied from the owners.
#include <gtest/gtest.h>

#include "base/threads.h"
#include "solver_body.h"

using namespace trocar;

// Half hexahedra, half tetrahedra on the same nodes, three materials that alternate: every list
// occurs, and elements of different lists meet at most nodes.
static Mesh mixed_mesh() {
  const Vec3 high(.06, .03, .03);
  const Mesh hex = make_box(Vec3(0, 0, 0), high, {8, 4, 4}, BoxElements::hex8);
  const Mesh tet = make_box(Vec3(0, 0, 0), high, {8, 4, 4}, BoxElements::tet4_kuhn);
  Mesh mesh;
  mesh.X = hex.X;
  mesh.region_name = {"a", "b", "c"};
  for (std::int32_t cell = 0; cell < hex.n_elements(); ++cell)
    if (cell % 8 < 4)
      add_element(mesh, ElementType::hex8, hex.corners(cell), cell % 3);
    else
      for (int k = 0; k < 6; ++k)
        add_element(mesh, ElementType::tet4, tet.corners(6 * cell + k), (cell + k) % 3);
  return mesh;
}

static BodyOptions options(const Mesh& mesh) {
  BodyOptions options{.materials = {material_of(MaterialModel::neo_hookean, 1000, 9000),
                                    material_of(MaterialModel::st_venant_kirchhoff, 1500, 5000),
                                    material_of(MaterialModel::linear, 800, 4000)},
                      .solver = {.mass_damping = 2, .gravity = Vec3(0, 1, -9.81)}};
  options.materials[0].prony = {{.3, .01}, {.2, 1}};
  options.fixed.assign(mesh.X.size(), 0);
  for (std::size_t i = 0; i < mesh.X.size(); ++i)
    if (mesh.X[i].x() == 0) options.fixed[i] = 7;
  return options;
}

struct Result {
  std::vector<double> u, v;  // global
  double stable_step = 1e300, least_J = 1e300;
  std::int32_t stable_element = -1;
  std::vector<double> strain;  // sorted
};

static void exchange(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner) {
  for (Body& body : ranks)
    for (std::int32_t k = body.part.n_owned; k < body.part.n_local(); ++k) {
      const std::int32_t global = body.part.node_global[k];
      const Body& other = ranks[owner[global]];
      const std::int32_t there = other.part.node_local[global];
      for (int j = 0; j < 3; ++j) {
        body.state.u[3 * k + j] = other.state.u[3 * there + j];
        body.state.v[3 * k + j] = other.state.v[3 * there + j];
      }
    }
}

static Result collect(const std::vector<Body>& ranks, std::size_t n_nodes) {
  Result result{.u = std::vector<double>(3 * n_nodes), .v = std::vector<double>(3 * n_nodes)};
  for (const Body& body : ranks) {
    for (std::int32_t k = 0; k < 3 * body.part.n_owned; ++k) {
      const std::int32_t global = 3 * body.part.node_global[k / 3] + k % 3;
      result.u[global] = body.state.u[k];
      result.v[global] = body.state.v[k];
    }
    const Watch w = watch(body.model, body.part, body.state);
    if (w.stable_step < result.stable_step) result.stable_element = w.stable_element;
    result.stable_step = std::min(result.stable_step, w.stable_step);
    result.least_J = std::min(result.least_J, w.least_J);
    EnergyTerms terms;
    energy_terms(body.model, body.part, body.state, terms);
    result.strain.insert(result.strain.end(), terms.strain.begin(), terms.strain.end());
  }
  std::sort(result.strain.begin(), result.strain.end());
  return result;
}

static Result run(const Mesh& mesh, int n_ranks, int n_threads) {
  const int before = thread_count();
  set_thread_count(n_threads);
  const std::vector<std::int32_t> owner = partition_nodes(mesh, n_ranks);
  std::vector<Body> ranks;
  for (int rank = 0; rank < n_ranks; ++rank)
    ranks.push_back(make_body(mesh, options(mesh), owner, rank));
  for (int k = 0; k < 200; ++k) {
    for (Body& body : ranks) step(body, 2e-4);
    exchange(ranks, owner);
  }
  Result result = collect(ranks, mesh.X.size());
  set_thread_count(before);
  return result;
}

static void expect_same(const Result& a, const Result& b) {
  EXPECT_EQ(a.u, b.u);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.stable_step, b.stable_step);
  EXPECT_EQ(a.stable_element, b.stable_element);
  EXPECT_EQ(a.least_J, b.least_J);
  EXPECT_EQ(a.strain, b.strain);  // each element once, whoever counts it
}

TEST(Invariance, any_number_of_ranks_gives_the_same_bits_after_200_steps) {
  const Mesh mesh = mixed_mesh();
  const Result alone = run(mesh, 1, 1);
  EXPECT_GT(largest(alone.u), 1e-3);  // it has really moved
  EXPECT_EQ(alone.strain.size(), mesh.element_type.size());
  for (const int n_ranks : {2, 3, 5}) expect_same(run(mesh, n_ranks, 1), alone);
}

TEST(Invariance, any_number_of_threads_gives_the_same_bits_after_200_steps) {
  const Mesh mesh = mixed_mesh();
  const Result alone = run(mesh, 1, 1);
  for (const int n_threads : {2, 3}) expect_same(run(mesh, 1, n_threads), alone);
  expect_same(run(mesh, 2, 2), alone);
}
