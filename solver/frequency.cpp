#include "solver/frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/digest.h"
#include "base/reproducible_dot.h"
#include "solver/block_ranges.h"
#include "solver/mass_clusters.h"

namespace trocar {

namespace {

using Vector = std::vector<double>;

// Vectors are (n_owned * 3).
struct Search {
  const Model& model;
  const Part& part;
  const State& state;
  const ForceOfDisplacement& forces;
  const FrequencyOptions& options;
  const Communicator& communicator;
  std::int64_t n = 0;              // components on all ranks
  std::vector<std::size_t> fixed;  // components that supports hold
  Vector inertia;                  // of each component
  Vector force_at_rest, u, force, room;

  std::size_t size() const { return 3 * static_cast<std::size_t>(model.n_owned); }
  // The same bits on any ranks and threads.
  double dot(const Vector& a, const Vector& b) const {
    return reproducible_dot(a, b, n, communicator);
  }
  // Calls body(k) for all components.
  template <class Body>
  void for_components(const Body& body) const {
    parallel_for_nodes(static_cast<std::int64_t>(size()),
                       [&](std::int64_t begin, std::int64_t end) {
                         for (std::int64_t k = begin; k < end; ++k)
                           body(static_cast<std::size_t>(k));
                       });
  }
};

std::vector<std::size_t> fixed_components(const Model& model) {
  std::vector<std::size_t> fixed;
  for (std::size_t k = 0; k < 3 * model.fixed.size(); ++k)
    if ((model.fixed[k / 3] >> (k % 3) & 1) != 0) fixed.push_back(k);
  return fixed;
}

Vector inertia_of_components(const Model& model) {
  Vector inertia;
  for (const double of_node : inertia_of(model)) inertia.insert(inertia.end(), 3, of_node);
  return inertia;
}

double largest_of(const Vector& x) {
  double largest = 0;
  std::mutex mutex;
  parallel_for_nodes(std::ssize(x), [&](std::int64_t begin, std::int64_t end) {
    double mine = 0;
    for (std::int64_t k = begin; k < end; ++k) mine = std::max(mine, std::abs(x[k]));
    const std::scoped_lock lock(mutex);
    largest = std::max(largest, mine);
  });
  return largest;
}

// K x = -(f(u + h x) - f(u)) / h with h so that the largest displacement is the amplitude.
void apply_stiffness(Search& s, const Vector& x, Vector& Kx) {
  const double h = s.options.amplitude / s.communicator.all_max(largest_of(x));
  s.for_components([&](std::size_t k) { s.u[k] = s.state.u[k] + h * x[k]; });
  s.forces(s.u, s.force);
  s.for_components([&](std::size_t k) { Kx[k] = -(s.force[k] - s.force_at_rest[k]) / h; });
  for (const std::size_t k : s.fixed) Kx[k] = 0;
}

// next = M^-1 next - (a x + b last)
void take_away(Search& s, double a, const Vector& x, double b, const Vector& last, Vector& next) {
  add_cluster_force(s.model, {}, next, s.room);
  s.for_components(
      [&](std::size_t k) { next[k] = next[k] / s.inertia[k] - (a * x[k] + b * last[k]); });
  for (const std::size_t k : s.fixed) next[k] = 0;
}

// Within +-1 by the global number alone, so that every mode of vibration has a share.
Vector noise(const Search& s) {
  Vector x(s.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    const auto global = static_cast<std::uint64_t>(s.part.node_global[k / 3]);
    const auto bits = mix64(3 * global + k % 3 + 1) >> 11;
    x[k] = static_cast<double>(bits) * 0x1p-52 - 1;
  }
  for (const std::size_t k : s.fixed) x[k] = 0;
  return x;
}

// A vector and its length in M; makes it of length one. False if there is nothing to divide.
bool normalise(const Search& s, Vector& x, Vector& Mx, double& length) {
  s.for_components([&](std::size_t k) { Mx[k] = s.inertia[k] * x[k]; });
  subtract_cluster_means(s.model, x, Mx);
  const double square = s.dot(x, Mx);
  length = square > 0 ? std::sqrt(square) : 0;
  if (!(square > 0) || !std::isfinite(square)) return false;
  s.for_components([&](std::size_t k) { x[k] /= length; });
  return true;
}

// The largest eigenvalue of the tridiagonal matrix of M^-1 K in the directions so far, and how far
// its vector is from being one of M^-1 K, where `next` couples the last direction to the next one.
void take_ritz_value(const Vector& diagonal, const Vector& beside, double next,
                     HighestFrequency& found) {
  const auto n = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::VectorXd::Map(diagonal.data(), n),
                                Eigen::VectorXd::Map(beside.data(), n - 1));
  const double omega2 = solver.eigenvalues()[n - 1];
  found.omega = omega2 > 0 ? std::sqrt(omega2) : 0;
  found.residual = next * std::abs(solver.eigenvectors()(n - 1, n - 1)) / std::abs(omega2);
}

// No mode can be much above what a few directions of all modes have found where the residual is
// small beside the distance: each direction more has a faster one's share grow several times.
bool is_below_interest(const HighestFrequency& found, const FrequencyOptions& options) {
  constexpr int least_directions = 5;
  constexpr double residuals = 4;
  return found.n_iterations >= least_directions &&
         found.omega * found.omega * (1 + residuals * found.residual) <
             options.of_interest * options.of_interest;
}

}  // namespace

double search_amplitude(const Model& model, double edge) {
  return (model.options.precision == Precision::in_single ? 1e-3 : 1e-6) * edge;
}

HighestFrequency find_highest_frequency(const Model& model, const Part& part, const State& state,
                                        const ForceOfDisplacement& forces,
                                        const FrequencyOptions& options,
                                        const Communicator& communicator) {
  const auto n_owned = static_cast<std::uint64_t>(model.n_owned);
  Search s{.model = model,
           .part = part,
           .state = state,
           .forces = forces,
           .options = options,
           .communicator = communicator,
           .n = 3 * static_cast<std::int64_t>(communicator.all_sum(n_owned)),
           .fixed = fixed_components(model),
           .inertia = inertia_of_components(model),
           .u = state.u};
  s.force_at_rest.assign(options.force.begin(), options.force.end());
  if (s.force_at_rest.empty()) forces(s.u, s.force_at_rest);
  Vector x = noise(s), last(s.size(), 0.0), next(s.size()), Mx(s.size());
  Vector diagonal, beside;  // of the tridiagonal matrix
  HighestFrequency found;
  double length = 0;
  if (!normalise(s, x, Mx, length)) return found;
  while (!found.is_converged && found.n_iterations < options.most_iterations) {
    apply_stiffness(s, x, next);
    ++found.n_iterations;
    diagonal.push_back(s.dot(x, next));
    take_away(s, diagonal.back(), x, beside.empty() ? 0 : beside.back(), last, next);
    const bool goes_on = normalise(s, next, Mx, length);
    take_ritz_value(diagonal, beside, length, found);
    found.is_converged =
        !goes_on ||
        (found.n_iterations >= options.least_iterations && found.residual <= options.tolerance) ||
        is_below_interest(found, options);
    beside.push_back(length);
    last.swap(x);
    x.swap(next);
  }
  return found;
}

}  // namespace trocar
