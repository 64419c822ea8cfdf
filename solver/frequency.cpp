#include "solver/frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/digest.h"
#include "base/reproducible_dot.h"
#include "solver/mass_clusters.h"

namespace trocar {

namespace {

using Vector = std::vector<double>;

// A direction, what K makes of it and what M makes of it, all (n_owned * 3).
struct Direction {
  Vector x, Kx, Mx;
};

struct Search {
  const Model& model;
  const Part& part;
  const State& state;
  const ForceOfDisplacement& forces;
  const FrequencyOptions& options;
  const Communicator& communicator;
  std::int64_t n = 0;  // components on all ranks
  Vector force_at_rest, u, force, room;

  std::size_t size() const { return 3 * static_cast<std::size_t>(model.n_owned); }
  bool is_fixed(std::size_t k) const { return (model.fixed[k / 3] >> (k % 3) & 1) != 0; }
  // The same bits on any ranks.
  double dot(const Vector& a, const Vector& b) const {
    return reproducible_dot(a, b, n, communicator);
  }
};

void add_scaled(Vector& a, double c, const Vector& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += c * b[k];
}

// d += c b; K follows by linearity where it is known.
void add_scaled(Direction& d, double c, const Direction& b) {
  add_scaled(d.x, c, b.x);
  add_scaled(d.Mx, c, b.Mx);
  if (!d.Kx.empty()) add_scaled(d.Kx, c, b.Kx);
}

void scale(Direction& d, double c) {
  for (Vector* v : {&d.x, &d.Kx, &d.Mx})
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
// is left of it.
bool orthonormalise(const Search& s, const std::vector<const Direction*>& basis, Direction& d) {
  for (int pass = 0; pass < 2; ++pass)  // once more for what rounding left
    for (const Direction* b : basis) add_scaled(d, -s.dot(b->x, d.Mx), *b);
  const double norm2 = s.dot(d.x, d.Mx);
  if (!(norm2 > 0) || !std::isfinite(norm2)) return false;
  scale(d, 1 / std::sqrt(norm2));
  return true;
}

// Within +-1 by the global number alone, so that every mode of vibration has a share.
double noise(const Search& s, std::size_t k) {
  const auto global = static_cast<std::uint64_t>(s.part.node_global[k / 3]);
  return static_cast<double>(mix64(3 * global + k % 3 + 1) >> 11) * 0x1p-52 - 1;
}

Direction start_direction(const Search& s, const Vector& mode) {
  Direction d{.x = mode};
  if (mode.size() != s.size()) {
    d.x.assign(s.size(), 0.0);
    for (std::size_t k = 0; k < s.size(); ++k)
      if (!s.is_fixed(k)) d.x[k] = noise(s, k);
  }
  multiply_by_mass(s.model, d.x, d.Mx);
  return d;
}

// The largest Ritz value of the directions; x becomes its vector, p the part of it that is new.
double rayleigh_ritz(const Search& s, Direction& x, Direction& r, std::optional<Direction>& p) {
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
  Direction fresh = std::move(r);
  scale(fresh, c[1]);
  if (n == 3) add_scaled(fresh, c[2], *p);
  scale(x, c[0]);
  add_scaled(x, 1, fresh);
  p = std::move(fresh);
  return solver.eigenvalues()[n - 1];
}

// M^-1 K x - omega^2 x
Direction residual(Search& s, const Direction& x, double omega2) {
  Direction r{.x = x.Kx};
  add_cluster_force(s.model, {}, r.x, s.room);
  for (std::size_t k = 0; k < s.size(); ++k)
    r.x[k] = s.is_fixed(k) ? 0 : r.x[k] / inertia_of(s.model)[k / 3] - omega2 * x.x[k];
  multiply_by_mass(s.model, r.x, r.Mx);
  return r;
}

}  // namespace

HighestFrequency find_highest_frequency(const Model& model, const Part& part, const State& state,
                                        const ForceOfDisplacement& forces,
                                        const FrequencyOptions& options,
                                        const Communicator& communicator, Vector& mode) {
  const auto n_owned = static_cast<std::uint64_t>(model.n_owned);
  Search s{.model = model,
           .part = part,
           .state = state,
           .forces = forces,
           .options = options,
           .communicator = communicator,
           .n = 3 * static_cast<std::int64_t>(communicator.all_sum(n_owned)),
           .u = state.u};
  forces(s.u, s.force_at_rest);
  Direction x = start_direction(s, mode);
  std::optional<Direction> p;  // not "empty": a rank without nodes has empty directions
  HighestFrequency found;
  if (!orthonormalise(s, {}, x)) return found;
  apply_stiffness(s, x);
  double omega2 = s.dot(x.x, x.Kx);
  for (;; ++found.n_iterations) {
    Direction r = residual(s, x, omega2);
    found.residual = std::sqrt(s.dot(r.x, r.Mx)) / std::abs(omega2);
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
