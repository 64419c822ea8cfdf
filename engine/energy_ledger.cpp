#include "engine/energy_ledger.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/number_text.h"
#include "base/options.h"
#include "engine/event_log.h"
#include "engine/frame_force.h"
#include "engine/frame_watch.h"
#include "engine/simulation.h"
#include "solver/mass_clusters.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Hourglass energy over what is stored: beyond 5 to 10 % of it, a stiffness that is made up says
// too much (that of enhanced hexahedra is the material's). And what the balance of energies may
// miss.
constexpr double hourglass_alarm = 0.05, balance_alarm = 0.05;

Vec3 velocity_of(const State& state, std::int32_t local) {
  const double* v = state.v.data() + 3 * std::int64_t{local};
  return {v[0], v[1], v[2]};
}

}  // namespace

void add_nodal_energies(const RankBody& body, std::vector<double>& kinetic,
                        std::vector<double>& gravity) {
  const double half_dt = body.state.last_dt / 2;
  for (std::int64_t i = 0; i < body.model.n_owned; ++i) {
    double v2 = 0, vf = 0, gu = 0;
    for (std::int64_t j = 0; j < 3; ++j) {
      const auto k = static_cast<std::size_t>(3 * i + j);
      v2 += body.state.v[k] * body.state.v[k];
      vf += body.state.v[k] * body.scratch.force[k];
      gu += body.model.options.gravity[j] * body.state.u[k];
    }
    const double m = body.model.mass[i];
    kinetic.push_back(0.5 * m * v2 + half_dt * vf);
    gravity.push_back(-m * gu);
  }
  add_cluster_squares(body.model, body.state.v, 0.5, kinetic);
}

// What viscous forces do in the half step from where works stand to the end of the last one.
static double last_viscous_work(const Simulation& s) {
  std::vector<double> work(s.scratch.viscous_force.size() / 3);
  for (std::size_t i = 0; i < work.size(); ++i)
    work[i] = s.state.last_dt / 2 *
              velocity_of(s.state, static_cast<std::int32_t>(i))
                  .dot(Eigen::Map<const Vec3>(s.scratch.viscous_force.data() + 3 * i));
  return sum_over_ranks(work, *s.communicator);
}

void open_energy_ledger(Simulation& s) {
  s.energy = std::make_unique<EnergyLedger>();
  keep_works(s.model, s.scratch);
  localise_supports(s.scene.supports, s.mesh, s.part, s.energy->support_forces);
  update_volume_change(s.model, s.neighbours, s.state, s.scratch);
  s.energy->memory.first_frame = s.frame;
  s.energy->memory.initial = mechanical_energy(s).sum();
  s.energy->memory.works.viscous = -last_viscous_work(s);
}

// Forces as the substeps of small elements have them; loads count there, and do work.
static void refine_last_forces(Simulation& s) {
  s.scratch.has_force = false;
  // After a cut the last step may be too long for the substeps of new small elements.
  if (s.state.last_dt == 0 || s.state.last_dt > s.watch.stable_step) return;
  find_loads_at(s, s.state.time);
  add_loads(s.loads, 1, s.scratch.force);
  refine_forces(s, s.state.last_dt);
  add_loads(s.loads, -1, s.scratch.force);
}

EnergyState mechanical_energy(Simulation& s) {
  if (!s.scratch.has_force) {
    compute_force(s.model, s.state, s.scratch);
    s.scratch.has_force = keeps_forces(s);
  }
  find_viscous_force(s.model, s.state, s.scratch);
  if (s.multirate && s.has_local_steps) refine_last_forces(s);
  EnergyTerms terms;
  energy_terms(s.model, s.part, s.state, terms);
  terms.strain.insert(terms.strain.end(), terms.volumetric.begin(), terms.volumetric.end());
  std::vector<double> kinetic, gravity;
  add_nodal_energies(s, kinetic, gravity);
  const Communicator& communicator = *s.communicator;
  return {.kinetic = sum_over_ranks(kinetic, communicator),
          .strain = sum_over_ranks(terms.strain, communicator),
          .hourglass = sum_over_ranks(terms.hourglass, communicator),
          .gravity = sum_over_ranks(gravity, communicator)};
}

void begin_frame_work(Simulation& s) {
  EnergyLedger& ledger = *s.energy;
  ledger.contact.work.clear();
  ledger.earlier_contact_work.clear();
  begin_contact_work(s);
  ledger.holds.work.assign(s.holds.owned.size(), 0.0);
  ledger.blade.work.assign(s.drag.node.size(), 0.0);
  ledger.loads.work.assign(s.loads.node.size(), 0.0);
  forget_works(s.scratch);
  forget_support_forces(ledger.support_forces);
}

void begin_contact_work(Simulation& s) {
  EnergyLedger& ledger = *s.energy;
  std::vector<double>& work = ledger.contact.work;
  ledger.earlier_contact_work.insert(ledger.earlier_contact_work.end(), work.begin(), work.end());
  work.assign(s.contact ? s.contact->set.local.size() : 0, 0.0);
}

// local_of: a node's number on this rank.
template <class Nodes, class LocalOf>
static void note_before(const State& state, const Nodes& nodes, const LocalOf& local_of,
                        ForceWorks& works) {
  works.before.clear();
  for (const auto& node : nodes) works.before.push_back(velocity_of(state, local_of(node)));
}

void note_velocities(Simulation& s, double dt) {
  EnergyLedger& ledger = *s.energy;
  ledger.dt_mid = (s.state.last_dt + dt) / 2;
  ledger.start_velocity.reset();
  if (s.state.last_dt == 0)
    ledger.start_velocity.emplace(s.state.v.begin(), s.state.v.begin() + 3 * s.model.n_owned);
  const auto itself = [](std::int32_t node) { return node; };
  if (s.contact) note_before(s.state, s.contact->set.local, itself, ledger.contact);
  note_before(s.state, s.holds.prescribed, std::mem_fn(&PrescribedNode::node), ledger.holds);
  note_before(s.state, s.drag.node, std::mem_fn(&BladeDrag::Node::local), ledger.blade);
  note_before(s.state, s.loads.node, itself, ledger.loads);
}

// What is held moves as it is told to, whatever the forces.
static std::vector<double> kinetic_of_start(const Simulation& s) {
  std::vector<double> v = *s.energy->start_velocity;
  for (std::size_t k = 0; k < v.size(); ++k) v[k] = s.state.v[k] - v[k];
  for (const PrescribedNode& node : s.holds.prescribed)
    std::fill_n(v.begin() + 3 * std::ptrdiff_t{node.node}, 3, 0.0);
  std::vector<double> kinetic;
  for (std::size_t i = 0; 3 * i < v.size(); ++i)
    kinetic.push_back(0.5 * s.model.mass[i] * Eigen::Map<const Vec3>(&v[3 * i]).squaredNorm());
  add_cluster_squares(s.model, v, 0.5, kinetic);
  return kinetic;
}

void add_work(Simulation& s) {
  EnergyLedger& ledger = *s.energy;
  if (ledger.start_velocity)
    ledger.start_kinetic = sum_over_ranks(kinetic_of_start(s), *s.communicator);
  const double half_dt = ledger.dt_mid / 2;
  add_support_forces(s.scratch.force, ledger.support_forces);
  const auto add = [&](std::size_t k, std::int32_t local, const Vec3& force, ForceWorks& works) {
    works.work[k] += half_dt * force.dot(works.before[k] + velocity_of(s.state, local));
  };
  for (std::size_t k = 0; k < ledger.contact.work.size(); ++k) {
    const ContactSet& set = s.contact->set;
    add(k, set.local[k], set.force[set.owned[k]], ledger.contact);
  }
  for (std::size_t k = 0; k < ledger.holds.work.size(); ++k)
    add(k, s.holds.prescribed[k].node, s.holds.prescribed[k].reaction, ledger.holds);
  for (std::size_t k = 0; k < ledger.blade.work.size(); ++k) {
    const BladeDrag::Node& node = s.drag.node[k];
    add(k, node.local, node.force * node.direction, ledger.blade);
  }
  for (std::size_t k = 0; k < ledger.loads.work.size(); ++k)
    add(k, s.loads.node[k], s.loads.force[k], ledger.loads);
}

void close_frame_work(Simulation& s) {
  EnergyLedger& ledger = *s.energy;
  ledger.memory.initial -= std::exchange(ledger.start_kinetic, 0);
  std::vector<double>& contact_work = ledger.contact.work;
  contact_work.insert(contact_work.end(), ledger.earlier_contact_work.begin(),
                      ledger.earlier_contact_work.end());
  const auto sum = [&](std::span<const double> terms) {
    return sum_over_ranks(terms, *s.communicator);
  };
  EnergyWorks& works = ledger.memory.works;
  works.contact += sum(contact_work);
  works.holds += sum(ledger.holds.work);
  works.blade += sum(ledger.blade.work);
  works.loads += sum(ledger.loads.work);
  works.damping -= sum(find_damping_work(s.model, s.scratch));
  works.viscous += sum(s.scratch.viscous_work);
}

// Beside energies of motion and height, what a body that falls freely stores is rounding; and its
// shape counts from strains of 1e-3 on, in the mean of the whole body.
static double least_stored(const Simulation& s, const EnergyState& energy) {
  double softest = std::numeric_limits<double>::infinity();  // speed of shear waves squared
  for (const Material& m : s.materials) softest = std::min(softest, lame_mu(m) / m.density);
  return 1e-6 * std::max({energy.kinetic, std::abs(energy.gravity), softest * s.whole_mass});
}

void report_energies(Simulation& s, FrameRow& row) {
  EnergyLedger& ledger = *s.energy;
  row.energy = mechanical_energy(s);
  row.works = ledger.memory.works;
  row.works.viscous += last_viscous_work(s);
  row.energy_error = row.energy.sum() - ledger.memory.initial - row.works.sum();
  const double stored = row.energy.strain + row.energy.hourglass;
  ledger.memory.largest_stored = std::max(ledger.memory.largest_stored, stored);
  const double least = std::max(0.01 * ledger.memory.largest_stored, least_stored(s, row.energy));
  if (stored < least || !(stored > 0)) return;  // next to nothing is stored
  const double share = row.energy.hourglass / stored;
  if (share > hourglass_alarm && ledger.memory.largest_hourglass_share <= hourglass_alarm &&
      s.scene.solver.hexahedron == Formulation::hex8_one_point)
    note_event(s, row.time,
               "hourglass energy is " + number_text(std::round(1000 * share) / 10) +
                   " % of the stored energy: the mesh is too coarse for how the tissue bends or "
                   "for the tip that presses it; a finer one helps, or hexahedra whose hourglass "
                   "energy is the material's (solver.hexahedron = \"enhanced\")");
  ledger.memory.largest_hourglass_share = std::max(ledger.memory.largest_hourglass_share, share);
}

// What strains that rounding makes would store, and more. [J]
static double negligible_energy(const Simulation& s) {
  const double strain = s.scene.solver.precision == Precision::in_single ? 1e-5 : 1e-9;
  double stiffest = 0;  // speed of pressure waves squared
  for (const Material& m : s.materials)
    stiffest = std::max(stiffest, (lame_lambda(m) + 2 * lame_mu(m)) / m.density);
  return s.whole_mass * strain * strain * stiffest;
}

BalanceError balance_error(const Simulation& s) {
  BalanceError error;
  double turned_over = 0, before = 0, largest_jump = 0;
  for (const FrameRow& row : s.log.rows) {
    error.largest = std::max(error.largest, std::abs(row.energy_error));
    if (const double jump = std::abs(row.energy_error - before); jump > largest_jump) {
      largest_jump = jump;
      error.time = row.time;
    }
    before = row.energy_error;
    const EnergyState& e = row.energy;
    turned_over = std::max({turned_over, e.kinetic, e.strain, std::abs(e.gravity),
                            std::abs(row.works.contact), std::abs(row.works.holds),
                            std::abs(row.works.blade), std::abs(row.works.loads)});
  }
  if (turned_over > 0 && error.largest > negligible_energy(s))
    error.share = error.largest / turned_over;
  return error;
}

void note_balance(Simulation& s) {
  if (!s.energy) return;
  const BalanceError error = balance_error(s);
  if (error.share <= balance_alarm) return;
  note_event(s, s.state.time,
             "the energies do not add up: " + short_text(100 * error.share) +
                 " % of what was turned over is missing or too much, most of it since " +
                 short_text(error.time) + " s. " +
                 (s.tools.empty()
                      ? "Steps near the limit do this (solver.step_factor)"
                      : "An instrument that goes through the surface does this (a slower path, a "
                        "larger tip or a finer mesh helps), stretched tissue that a grasper lets "
                        "go, and steps near the limit (a smaller solver.step_factor)"));
}

}  // namespace trocar
