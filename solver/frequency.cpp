#include "solver/frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/digest.h"
#include "base/exact_sum.h"
#include "solver/mass_clusters.h"

namespace trocar {

namespace {

using Vector = std::vector<double>;

// A direction and what K makes of it, both (n_owned * 3).
struct Direction {
  Vector x, Kx;
};

struct Search {
  const Model& model;
  const Part& part;
  const State& state;
  const ForceOfDisplacement& forces;
  const FrequencyOptions& options;
  const Communicator& communicator;
  Vector force_at_rest, u, force, room;

  std::size_t size() const { return 3 * static_cast<std::size_t>(model.n_owned); }
  bool is_fixed(std::size_t k) const { return (model.fixed[k / 3] >> (k % 3) & 1) != 0; }

  // a·b or a·M b over all ranks, the same bits however they are spread.
  template <class Term>
  double sum(const Term& term) const {
    ExactSum total;
    for (std::size_t k = 0; k < size(); k += 3) total.add(term(k) + term(k + 1) + term(k + 2));
    total.all_sum(communicator);
    return total.value();
  }
  double dot(const Vector& a, const Vector& b) const {
    return sum([&](std::size_t k) { return a[k] * b[k]; });
  }
  double mass_dot(const Vector& a, const Vector& b) {
    multiply_by_mass(model, a, room);
    return dot(room, b);
  }
};

void add_scaled(Vector& a, double c, const Vector& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += c * b[k];
}

void scale(Direction& d, double c) {
  for (Vector* v : {&d.x, &d.Kx})
    for (double& value : *v) value *= c;
}

// K x = -(f(u + h x) - f(u)) / h with h so that the largest displacement is the amplitude.
void apply_stiffness(Search& s, Direction& d) {
  double largest = 0;
  for (const double value : d.x) largest = std::max(largest, std::abs(value));
  largest = s.communicator.all_max(largest);
  const double h = s.options.amplitude / largest;
  s.u = s.state.u;
  for (std::size_t k = 0; k < s.size(); ++k) s.u[k] += h * d.x[k];
  s.forces(s.u, s.force);
  d.Kx.resize(s.size());
  for (std::size_t k = 0; k < s.size(); ++k)
    d.Kx[k] = s.is_fixed(k) ? 0 : -(s.force[k] - s.force_at_rest[k]) / h;
}

// Removes from d its part along the unit directions of `basis` and makes it one; false if nothing
// is left of it. K follows by linearity where it is known.
bool orthonormalise(Search& s, const std::vector<const Direction*>& basis, Direction& d) {
  for (int pass = 0; pass < 2; ++pass)  // once more for what rounding left
    for (const Direction* b : basis) {
      const double c = s.mass_dot(b->x, d.x);
      add_scaled(d.x, -c, b->x);
      if (!d.Kx.empty()) add_scaled(d.Kx, -c, b->Kx);
    }
  const double norm2 = s.mass_dot(d.x, d.x);
  if (!(norm2 > 0) || !std::isfinite(norm2)) return false;
  scale(d, 1 / std::sqrt(norm2));
  return true;
}

Direction start_direction(const Search& s, const Vector& mode) {
  Direction d{.x = mode};
  if (mode.size() == s.size()) return d;
  d.x.assign(s.size(), 0.0);
  for (std::int64_t i = 0; i < s.model.n_owned; ++i) add_noise(s.model, s.part, i, 1, d.x);
  return d;
}

// The largest Ritz value of the directions; x becomes its vector, p the part of it that is new.
double rayleigh_ritz(const Search& s, Direction& x, const Direction& r,
                     std::optional<Direction>& p) {
  const std::vector<const Direction*> basis =
      p ? std::vector<const Direction*>{&x, &r, &*p} : std::vector<const Direction*>{&x, &r};
  const auto n = static_cast<Eigen::Index>(basis.size());
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      A(i, j) = A(j, i) =
          s.dot(basis[static_cast<std::size_t>(i)]->x, basis[static_cast<std::size_t>(j)]->Kx);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  const Eigen::VectorXd c = solver.eigenvectors().col(n - 1);
  Direction fresh{Vector(s.size(), 0.0), Vector(s.size(), 0.0)};
  for (Eigen::Index i = 1; i < n; ++i) {
    add_scaled(fresh.x, c[i], basis[static_cast<std::size_t>(i)]->x);
    add_scaled(fresh.Kx, c[i], basis[static_cast<std::size_t>(i)]->Kx);
  }
  scale(x, c[0]);
  add_scaled(x.x, 1, fresh.x);
  add_scaled(x.Kx, 1, fresh.Kx);
  p = std::move(fresh);
  return solver.eigenvalues()[n - 1];
}

// M^-1 K x - omega^2 x
Direction residual(Search& s, const Direction& x, double omega2) {
  Direction r{x.Kx};
  add_cluster_force(s.model, {}, r.x, s.room);
  for (std::size_t k = 0; k < s.size(); ++k)
    r.x[k] = s.is_fixed(k) ? 0 : r.x[k] / s.model.inertia[k / 3] - omega2 * x.x[k];
  return r;
}

}  // namespace

void add_noise(const Model& model, const Part& part, std::int64_t i, double size, Vector& mode) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto global = static_cast<std::uint64_t>(part.node_global[i]);
    const std::uint64_t bits = mix64(3 * global + k + 1) >> 11;
    if ((model.fixed[i] >> k & 1) == 0)
      mode[3 * static_cast<std::size_t>(i) + k] += size * (static_cast<double>(bits) * 0x1p-52 - 1);
  }
}

HighestFrequency find_highest_frequency(const Model& model, const Part& part, const State& state,
                                        const ForceOfDisplacement& forces,
                                        const FrequencyOptions& options,
                                        const Communicator& communicator, Vector& mode) {
  Search s{model, part, state, forces, options, communicator, {}, state.u, {}, {}};
  forces(s.u, s.force_at_rest);
  Direction x = start_direction(s, mode);
  std::optional<Direction> p;  // not "empty": a rank without nodes has empty directions
  HighestFrequency found;
  if (!orthonormalise(s, {}, x)) return found;
  apply_stiffness(s, x);
  double omega2 = s.dot(x.x, x.Kx);
  for (;; ++found.n_iterations) {
    Direction r = residual(s, x, omega2);
    found.residual = std::sqrt(s.mass_dot(r.x, r.x)) / std::abs(omega2);
    found.is_converged =
        found.n_iterations >= options.least_iterations && found.residual <= options.tolerance;
    if (found.is_converged || found.n_iterations == options.most_iterations) break;
    if (!orthonormalise(s, {&x}, r)) break;
    apply_stiffness(s, r);
    if (p && !orthonormalise(s, {&x, &r}, *p)) p.reset();
    omega2 = rayleigh_ritz(s, x, r, p);
  }
  found.omega = omega2 > 0 ? std::sqrt(omega2) : 0;
  mode = std::move(x.x);
  return found;
}

}  // namespace trocar
