#include "solver/multirate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "mesh/sub_mesh.h"
#include "solver/block_ranges.h"

namespace trocar {

namespace {

constexpr double least_cosine = 4. / 9;  // 1 / T_p(d)
constexpr int most_substeps = 64;

// T_0 ... T_n at x, and the derivative of T_n.
struct Chebyshev {
  std::vector<double> T;
  double derivative = 0;
};

Chebyshev chebyshev(int n, double x) {
  Chebyshev c{.T = {1, x}};
  double dT = 0, next_dT = 1;  // of T_k-1, T_k
  for (int k = 1; k < n; ++k) {
    const double T_k = c.T[k];
    c.T.push_back(2 * x * T_k - c.T[k - 1]);
    const double after = 2 * T_k + 2 * x * next_dT - dT;
    dT = next_dT;
    next_dT = after;
  }
  c.derivative = next_dT;
  return c;
}

// d of T_p(d) = 1 / least_cosine, by T_p/2(d) = sqrt((T_p(d) + 1) / 2).
double chebyshev_argument(int p) {
  double T = 1 / least_cosine;
  for (; p > 1; p /= 2) T = std::sqrt((T + 1) / 2);
  return T;
}

double least_step(std::span<const RestingElement> resting) {
  double least = std::numeric_limits<double>::max();
  for (const RestingElement& element : resting) least = std::min(least, element.step);
  return least;
}

std::size_t count_below(double step, std::span<const RestingElement> resting) {
  std::size_t n = 0;
  for (const RestingElement& element : resting) n += element.step < step ? 1 : 0;
  return n;
}

std::vector<std::int32_t> nodes_below(double step, const Mesh& mesh,
                                      std::span<const RestingElement> resting) {
  std::vector<std::int32_t> elements;
  for (const RestingElement& element : resting)
    if (element.step < step) elements.push_back(element.number);
  return nodes_of(mesh, elements);
}

// What the elements' own force needs: no loads, and masses that nobody asks for.
void build_body(const MultiRateBody& body, const Mesh& own, MultiRate& m,
                Communicator& communicator) {
  SolverOptions options = body.model.options;
  options.gravity = Vec3::Zero();
  const auto n = own.X.size();
  m.model = build_model(own, m.part, body.materials, std::vector<FixedMask>(n),
                        std::vector<double>(n, 1.0), options);
  m.state = make_state(m.model);
  m.scratch = make_scratch(m.model);
  m.neighbours = make_neighbours(m.halo, m.model, communicator);
  const auto n_values = 3 * static_cast<std::size_t>(m.part.n_owned);
  m.start_force.resize(n_values);
  m.z.resize(n_values);
  m.z_before.resize(n_values);
  m.moves.resize(static_cast<std::size_t>(m.part.n_owned));
}

// u on all local nodes, what moves in this step.
void begin(const MultiRateStep& step, MultiRate& m) {
  parallel_for_nodes(std::ssize(m.whole), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
      std::copy_n(&step.state.u[3 * std::int64_t{m.whole[i]}], 3, &m.state.u[3 * i]);
  });
  for (std::size_t i = 0; i < m.moves.size(); ++i)
    m.moves[i] =
        m.is_fine[i] == 0 ? FixedMask{0} : static_cast<FixedMask>(~step.model.fixed[m.whole[i]]);
  for (const PrescribedNode& held : step.prescribed)
    if (const std::int32_t i = m.of_whole[held.node]; i >= 0) m.moves[i] = 0;
  std::fill(m.z.begin(), m.z.end(), 0.0);
  std::fill(m.z_before.begin(), m.z_before.end(), 0.0);
}

// From z_k to z_k+1, with the elements' forces at u + P z_k in scratch.
void advance(const MultiRateStep& step, int k, const Scratch& whole, MultiRate& m) {
  const double back = m.steps.back[k], gain = m.steps.gain[k] * step.dt * step.dt;
  parallel_for_nodes(m.part.n_owned, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t w = m.whole[i];
      for (std::int64_t j = 0; j < 3; ++j) {
        const std::int64_t at = 3 * i + j;
        const double change = m.scratch.force[at] - m.start_force[at];
        const double a = (whole.force[3 * w + j] + change) / inertia_of(step.model)[w];
        const double z = m.z[at];
        m.z[at] = (1 + back) * z - back * m.z_before[at] + gain * a;
        m.z_before[at] = z;
      }
    }
  });
}

void move_fine_nodes(const MultiRateStep& step, MultiRate& m) {
  parallel_for_nodes(m.part.n_owned, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
      for (std::int64_t j = 0; j < 3; ++j)
        if ((m.moves[i] >> j & 1) != 0)
          m.state.u[3 * i + j] = step.state.u[3 * std::int64_t{m.whole[i]} + j] + m.z[3 * i + j];
  });
}

void give_force(const MultiRateStep& step, const MultiRate& m, Scratch& scratch) {
  const double scale = 2 / (step.dt * step.dt);
  const std::vector<double>& inertia = inertia_of(step.model);
  parallel_for_nodes(m.part.n_owned, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t w = m.whole[i];
      for (std::int64_t j = 0; j < 3; ++j)
        scratch.force[3 * w + j] = inertia[w] * (scale * m.z[3 * i + j]);
    }
  });
}

}  // namespace

LocalSteps local_steps(int p) {
  CHECK_OP(p & (p - 1), ==, 0);
  const double d = chebyshev_argument(p);
  const Chebyshev c = chebyshev(p, d);
  const double w = 2 * c.derivative / c.T.back();
  LocalSteps steps{.back = {0}, .gain = {1 / (w * d)}, .limit = std::sqrt(w * (1 + d))};
  for (std::size_t k = 1; k + 1 < c.T.size(); ++k) {
    steps.back.push_back(c.T[k - 1] / c.T[k + 1]);
    steps.gain.push_back(2 / w * c.T[k] / c.T[k + 1]);
  }
  return steps;
}

MultiRatePlan plan_multirate(const Mesh& mesh, const NodeCorners& corners,
                             std::span<const RestingElement> resting) {
  const double least = least_step(resting), n = static_cast<double>(resting.size());
  MultiRatePlan best;
  std::vector<std::int32_t> fine;
  for (int p = 2; p <= most_substeps && least > 0; p *= 2) {
    const double longer = local_steps(p).limit / 2;  // than the step without
    const auto gain = [&](std::size_t n_fine) {
      return longer * n / (n + p * static_cast<double>(n_fine));
    };
    const double enough = std::max(least_local_gain, best.gain);
    if (gain(count_below(longer * least, resting)) <= enough) continue;
    const std::vector<std::int32_t> nodes = nodes_below(longer * least, mesh, resting);
    std::vector<std::int32_t> elements = elements_around(corners, nodes);
    if (gain(elements.size()) <= enough) continue;
    best.gain = gain(elements.size());
    best.n_substeps = p;
    best.element = std::move(elements);
    fine = nodes;
  }
  best.is_fine.assign(mesh.X.size(), 0);
  for (const std::int32_t i : fine) best.is_fine[i] = 1;
  return best;
}

std::unique_ptr<MultiRate> make_multirate(const MultiRatePlan& plan, const MultiRateBody& body,
                                          Communicator& communicator) {
  auto multirate = std::make_unique<MultiRate>();
  MultiRate& m = *multirate;
  m.steps = local_steps(plan.n_substeps);
  m.share = static_cast<double>(plan.element.size()) / body.mesh.n_elements();
  const SubMesh sub = make_sub_mesh(body.mesh, plan.element);
  const std::vector<std::int32_t> owner = values_of(body.node_owner, sub.node);
  m.part = make_part(sub.mesh, owner, communicator.rank());
  m.halo = make_halo(sub.mesh, owner, m.part);
  m.coarse_fixed = body.model.fixed;
  for (std::size_t i = 0; i < m.coarse_fixed.size(); ++i)
    if (plan.is_fine[body.part.node_global[i]] != 0) m.coarse_fixed[i] = all_components;
  m.of_whole.assign(static_cast<std::size_t>(body.model.n_owned), -1);
  m.whole.resize(m.part.node_global.size());
  for (std::int32_t i = 0; i < m.part.n_local(); ++i) {
    const std::int32_t global = sub.node[m.part.node_global[i]];
    m.whole[i] = body.part.node_local[global];
    if (i >= m.part.n_owned) continue;
    m.of_whole[m.whole[i]] = i;
    m.is_fine.push_back(plan.is_fine[global]);
  }
  if (m.part.n_owned > 0) build_body(body, sub.mesh, m, communicator);
  return multirate;
}

void refine_force(const MultiRateStep& step, MultiRate& m, Scratch& scratch) {
  if (m.part.n_owned == 0) return;
  begin(step, m);
  find_force(m.model, m.neighbours, m.state, m.scratch);
  m.start_force = m.scratch.force;
  advance(step, 0, scratch, m);
  for (int k = 1; k < static_cast<int>(m.steps.back.size()); ++k) {
    move_fine_nodes(step, m);
    start_exchange(m.neighbours, m.state);
    find_force(m.model, m.neighbours, m.state, m.scratch);
    advance(step, k, scratch, m);
  }
  give_force(step, m, scratch);
}

}  // namespace trocar
