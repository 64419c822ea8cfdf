// When new parts pay after a cut that turned hexahedra into tetrahedra: what it costs to choose
// them and to move over, what the old ones cost in every step, and after how many steps and frames
// the one makes up for the other. Markdown to stdout. mpirun -np RANKS bench_rebalance [hexahedra,
// about (default 8000)] [steps a frame (default 40)]
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/communicator.h"
#include "bench/machine.h"
#include "bench/usage.h"
#include "mesh/edit.h"
#include "mesh/hex_split.h"
#include "solver/rank_body.h"
#include "solver_body.h"

using namespace trocar;

namespace {

// The last hexahedra become tetrahedra, in the last part.
Mesh with_tets(const Mesh& hexahedra, int n_split) {
  MeshEdit edit;
  for (std::int32_t e = hexahedra.n_elements() - n_split; e < hexahedra.n_elements(); ++e)
    edit.splits.push_back({.element = e, .corner = hex_tet_nodes(hexahedra, e)});
  Mesh mesh = hexahedra;
  apply_edit(edit, mesh);
  return mesh;
}

// Without what its steps need.
RankBody make_rank(const Mesh& mesh, std::span<const std::int32_t> owner, int rank) {
  RankBody body;
  const std::vector<Material> materials(1);
  const std::vector<FixedMask> fixed(mesh.X.size(), 0);
  const std::vector<double> mass = mass_of(mesh, {});
  body.part = make_part(mesh, owner, rank);
  body.halo = make_halo(mesh, owner, body.part);
  body.model = build_model(mesh, body.part, materials, fixed, mass, {});
  body.scratch = make_scratch(body.model);
  return body;
}

// Of a step with these parts and with those, in turn.
std::array<double, 2> step_seconds(std::array<RankBody*, 2> bodies, Communicator& ranks) {
  for (RankBody* body : bodies) {
    body->state = make_state(body->model);
    shake(body->state.u, 1e-5, 1);
    body->neighbours = make_neighbours(body->halo, body->model, ranks);
  }
  constexpr int n = 5, n_rounds = 500;
  std::array<double, 2> best = {1e300, 1e300};
  for (int round = 0; round < n_rounds; ++round)
    for (std::size_t k = 0; k < 2; ++k) {
      RankBody& body = *bodies[k];
      const double seconds = best_of_ranks(ranks, 1, [&] {
        for (int step = 0; step < n; ++step) {
          start_exchange(body.neighbours, body.state);
          find_force(body.model, body.neighbours, body.state, body.scratch);
          integrate(body.model, body.scratch, {}, 1e-9, body.state);
        }
      });
      best[k] = std::min(best[k], seconds / n);
    }
  return best;
}

// Displacements and velocities to all, of which each takes its own.
double move_seconds(const RankBody& before, const RankBody& after, Communicator& ranks) {
  const State state = make_state(before.model);
  State moved = make_state(after.model);
  return best_of_ranks(ranks, 20, [&] {
    for (std::vector<double>* field : {&moved.u, &moved.v}) {
      const std::vector<double> all = all_gather_field(before.part, 3, state.u, ranks);
      for (std::size_t i = 0; i < after.part.node_global.size(); ++i)
        for (std::size_t j = 0; j < 3; ++j)
          (*field)[3 * i + j] = all[3 * static_cast<std::size_t>(after.part.node_global[i]) + j];
    }
  });
}

void report(const Mesh& hexahedra, int n_split, int steps_of_frame, Communicator& ranks) {
  const std::vector<std::int32_t> old_owner = partition_nodes(hexahedra, ranks);
  const Mesh mesh = with_tets(hexahedra, n_split);
  std::vector<std::int32_t> owner;
  const double choose = best_of_ranks(ranks, 20, [&] { owner = partition_nodes(mesh, ranks); });
  RankBody before = make_rank(mesh, old_owner, ranks.rank()), after;
  const double build =
      best_of_ranks(ranks, 20, [&] { after = make_rank(mesh, owner, ranks.rank()); });
  const double move = move_seconds(before, after, ranks);
  const auto [slow, quick] = step_seconds({&before, &after}, ranks);
  const double gain = slow - quick, all = choose + move + build;
  const auto steps = [&](double cost) { return gain > 0 ? cost / gain : INFINITY; };
  if (!ranks.is_root()) return;
  std::printf("| %.3f | %.3f | %.1f | %.1f | %.2f | %.2f | %.2f | %.0f, %.1f | %.0f, %.1f |\n",
              imbalance(mesh, old_owner, ranks.size()), imbalance(mesh, owner, ranks.size()),
              1e6 * slow, 1e6 * quick, 1e3 * choose, 1e3 * move, 1e3 * build, steps(choose),
              steps(choose) / steps_of_frame, steps(all), steps(all) / steps_of_frame);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage =
      "[mpirun -np RANKS] bench_rebalance [hexahedra (8000)] [steps of a frame (40)]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  MpiSession session(&argc, &argv);
  Communicator& ranks = session.world();
  const int n_elements = argc > 1 ? std::atoi(argv[1]) : 8000;
  const int steps_of_frame = argc > 2 ? std::atoi(argv[2]) : 40;
  if (n_elements < 8 || steps_of_frame < 1 || ranks.size() < 2)
    return ranks.is_root() ? print_usage(usage, stderr) : 2;
  const int n = static_cast<int>(std::lround(std::cbrt(n_elements)));
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {n, n, n}, BoxElements::hex8);
  if (ranks.is_root())
    std::printf(
        "| imbalance | after | step [us] | after | choose [ms] | move [ms] | build [ms] | choosing "
        "pays after steps, frames | all of it |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double share : {.02, .04, .08, .16, .32})
    report(mesh, static_cast<int>(share * mesh.n_elements()), steps_of_frame, ranks);
}
