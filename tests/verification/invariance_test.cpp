// V31: the state after many steps does not depend on ranks and threads. tests/invariance asks the
// same of whole scenes under mpirun, with contact and cuts.
#include "solver_ranks.h"
#include "verification_figure.h"

using namespace trocar;

TEST(V31Invariance, the_state_after_a_thousand_steps_is_the_same_to_the_last_bit) {
  struct Machine {
    int n_ranks, n_threads;
  };
  for (const Precision precision : precisions) {
    const SolverOptions solver{.precision = precision,
                               .tet4 = Formulation::tet4_nodal_pressure,
                               .hex8 = Formulation::hex8_enhanced};
    const RanksResult alone = run_on_ranks(mixed_mesh(), solver, 1000, 1, 1);
    EXPECT_GT(largest(alone.u), 5e-4);
    EXPECT_LT(largest(alone.u), 1e-1);
    for (const Machine& m : {Machine{2, 1}, Machine{5, 1}, Machine{1, 2}, Machine{3, 2}}) {
      const RanksResult other = run_on_ranks(mixed_mesh(), solver, 1000, m.n_ranks, m.n_threads);
      check_figure({"V31 Parallel invariance",
                    "greatest difference of u [m] and v [m/s], " + std::to_string(m.n_ranks) +
                        " ranks x " + std::to_string(m.n_threads) + " threads",
                    std::string("hex8-enhanced and tet4-nodal-pressure, ") + name_of(precision),
                    larger_or_nan(largest_difference(other.u, alone.u),
                                  largest_difference(other.v, alone.v)),
                    0, 0, "one rank, one thread"});
    }
  }
}
