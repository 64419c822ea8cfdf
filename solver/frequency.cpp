#include "solver/frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "base/digest.h"
#include "base/reproducible_dot.h"
#include "solver/block_ranges.h"
#include "solver/mass_clusters.h"

namespace trocar {

namespace {

using Vector = std::vector<double>;

double larger_or_bad(double a, double b) {
  return a > b || std::isnan(a) ? a : b;
}

constexpr std::int64_t piece = 512;  // components
constexpr int least_iterations = 2;

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
  double most_inertia = 0;         // of a node on all ranks
  std::span<const double> force_at_rest;
  // Displacements that forces are asked of (n_local * 3); or of the owned nodes M x of a direction:
  // they are never wanted at once.
  Vector u;
  Vector room;

  std::size_t size() const { return 3 * static_cast<std::size_t>(model.n_owned); }
  std::span<double> Mx() { return std::span(u).first(size()); }
  // Products are no larger than `most`. The same bits on any ranks and threads.
  double dot(std::span<const double> a, std::span<const double> b, double most) const {
    return reproducible_dot(a, b, n, most, communicator);
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
  // Calls body(begin, end) for pieces of the components that stay in the first cache; returns the
  // size of the largest component of what the body writes on all ranks, NaN if one is not finite.
  template <class Body>
  double for_pieces(const Vector& written, const Body& body) const {
    double most = 0;
    std::mutex mutex;
    const auto pieces = [&](std::int64_t begin, std::int64_t end) {
      double mine = 0;
      for (std::int64_t next; begin < end; begin = next) {
        next = std::min(end, begin + piece);
        body(static_cast<std::size_t>(begin), static_cast<std::size_t>(next));
        const auto n_written = static_cast<std::size_t>(next - begin);
        mine = larger_or_bad(mine, largest_size({written.data() + begin, n_written}));
      }
      const std::scoped_lock lock(mutex);
      most = larger_or_bad(most, mine);
    };
    parallel_for_nodes(static_cast<std::int64_t>(size()), pieces);
    return communicator.all_max(most);
  }
  // Calls body(k) for all components; returns as for_pieces.
  template <class Body>
  double for_components(const Vector& written, const Body& body) const {
    return for_pieces(written, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) body(k);
    });
  }
  // Calls body(k, inertia, one over it) likewise.
  template <class Body>
  double for_inertias(const Vector& written, const Body& body) const {
    const std::vector<double>& of_node = inertia_of(model);
    return for_pieces(written, [&](std::size_t begin, std::size_t end) {
      std::array<double, piece + 4> m, by_m;  // from the first component of the first node on
      const std::size_t first = begin / 3 * 3;
      for (std::size_t node = begin / 3, at = 0; 3 * node < end; ++node, at += 3) {
        std::fill_n(&m[at], 3, of_node[node]);
        std::fill_n(&by_m[at], 3, 1 / of_node[node]);
      }
      for (std::size_t k = begin; k < end; ++k) body(k, m[k - first], by_m[k - first]);
    });
  }
  void hold_supports(Vector& x) const {
    for (const std::size_t k : fixed) x[k] = 0;
  }
};

std::vector<std::size_t> fixed_components(const Model& model) {
  std::vector<std::size_t> fixed;
  for (std::size_t k = 0; k < 3 * model.fixed.size(); ++k)
    if ((model.fixed[k / 3] >> (k % 3) & 1) != 0) fixed.push_back(k);
  return fixed;
}

// A direction as the iteration finds it, before it is made of length one.
struct Direction {
  Vector x;
  double largest = 0;  // component's size on all ranks
  double length = 0;   // in M; 0 if there is nothing to divide
};

// `largest` is that of x before supports took their part; s.Mx(): its products with inertias.
void measure(Search& s, double largest, Direction& d) {
  s.hold_supports(d.x);
  subtract_cluster_means(s.model, d.x, s.Mx());  // adds as much to M x as it has, at most
  const double square = s.dot(d.x, s.Mx(), 2 * s.most_inertia * largest * largest);
  d.largest = largest;
  d.length = square > 0 && std::isfinite(square) ? std::sqrt(square) : 0;
}

// Within +-1 by the global number alone, so that every mode of vibration has a share.
void begin_with_noise(Search& s, Direction& d) {
  const std::span<double> Mx = s.Mx();
  const double largest = s.for_inertias(d.x, [&](std::size_t k, double m, double) {
    const auto global = static_cast<std::uint64_t>(s.part.node_global[k / 3]);
    const auto bits = mix64(3 * global + k % 3 + 1) >> 11;
    d.x[k] = static_cast<double>(bits) * 0x1p-52 - 1;
    Mx[k] = m * d.x[k];
  });
  measure(s, largest, d);
}

// x = d / |d|, and d.x = Kx = -(f(u + h x) - f(u)) / h with h so that the largest displacement is
// the amplitude. Returns its largest component's size.
double apply_stiffness(Search& s, Direction& d, Vector& x) {
  const double by_length = 1 / d.length, h = s.options.amplitude * d.length / d.largest;
  s.for_components([&](std::size_t k) {
    x[k] = by_length * d.x[k];
    s.u[k] = s.state.u[k] + h * x[k];
  });
  s.forces(s.u, d.x);
  const double by_h = -1 / h;
  const double largest =
      s.for_components(d.x, [&](std::size_t k) { d.x[k] = by_h * (d.x[k] - s.force_at_rest[k]); });
  s.hold_supports(d.x);
  return largest;
}

// d = M^-1 Kx - (a x + b last), where d.x is Kx.
void go_on(Search& s, double a, const Vector& x, double b, const Vector& last, Direction& d) {
  add_cluster_force(s.model, {}, d.x, s.room);
  const std::span<double> Mx = s.Mx();
  const double largest = s.for_inertias(d.x, [&](std::size_t k, double m, double by_m) {
    d.x[k] = by_m * d.x[k] - (a * x[k] + b * last[k]);
    Mx[k] = m * d.x[k];
  });
  measure(s, largest, d);
}

// Of the tridiagonal matrix of M^-1 K in the directions so far.
struct Tridiagonal {
  Vector diagonal, beside;
  Eigen::VectorXd values;  // ascending; of all directions but the last one until they are taken
};

// The largest eigenvalue, and how far its vector is from being one of M^-1 K, where `next` couples
// the last direction to the next one. The vector's last component follows from the eigenvalues with
// and without the last direction: |v_m|^2 = prod_(i < m) (w - w'_i) / (w - w_i).
void take_ritz_value(Tridiagonal& T, double next, HighestFrequency& found) {
  const auto n = static_cast<Eigen::Index>(T.diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::VectorXd::Map(T.diagonal.data(), n),
                                Eigen::VectorXd::Map(T.beside.data(), n - 1),
                                Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const double omega2 = values[n - 1];
  double square = 1;
  for (Eigen::Index i = 0; i < n - 1; ++i)
    if (const double of_all = omega2 - values[i]; of_all > 0)
      square *= std::max(0.0, omega2 - T.values[i]) / of_all;
  T.values = values;
  found.omega = omega2 > 0 ? std::sqrt(omega2) : 0;
  found.residual = next * std::sqrt(square) / std::abs(omega2);
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
           .u = state.u};
  s.most_inertia = communicator.all_max(largest_size(inertia_of(model)));
  Vector at_rest;
  if (options.force.empty()) forces(s.u, at_rest);
  s.force_at_rest = options.force.empty() ? at_rest : options.force;
  Vector x(s.size()), last(s.size(), 0.0);
  Direction next{.x = Vector(s.size())};
  Tridiagonal T;
  HighestFrequency found;
  begin_with_noise(s, next);
  if (next.length == 0) return found;
  while (!found.is_converged && found.n_iterations < options.most_iterations) {
    const double by_length = 1 / next.length, largest = by_length * next.largest;
    const double largest_K = apply_stiffness(s, next, x);
    ++found.n_iterations;
    T.diagonal.push_back(s.dot(x, next.x, largest * largest_K));
    if (!std::isfinite(T.diagonal.back())) return found;
    go_on(s, T.diagonal.back(), x, T.beside.empty() ? 0 : T.beside.back(), last, next);
    take_ritz_value(T, next.length, found);
    found.is_converged =
        next.length == 0 ||
        (found.n_iterations >= least_iterations && found.residual <= options.tolerance) ||
        is_below_interest(found, options);
    T.beside.push_back(next.length);
    last.swap(x);
  }
  return found;
}

}  // namespace trocar
