#include "engine/summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/digest.h"
#include "base/exact_sum.h"
#include "base/heap.h"
#include "base/quantile.h"
#include "base/threads.h"
#include "engine/state_digest.h"
#include "engine/version.h"
#include "mesh/quality.h"
#include "solver/element_setup.h"
#include "solver/step.h"

namespace trocar {

namespace {

using Json = nlohmann::ordered_json;

Json traffic_json(const Traffic& t) {
  return {{"collectives", t.n_collectives},
          {"exchanges", t.n_exchanges},
          {"messages", t.n_messages},
          {"bytes", t.n_bytes}};
}

Json mesh_json(const Simulation& s) {
  const ElementStatistics m = element_statistics(s.mesh);
  const SceneSolver& solver = s.scene.solver;
  Json elements, formulations;
  for (int type = 0; type < n_element_types; ++type)
    if (const auto n = m.n_elements_by_type[type]; n > 0) {
      const auto shape = static_cast<ElementType>(type);
      elements[element_type_name(shape)] = n;
      formulations.push_back(
          name_of(of_shape(shape, solver.triangle, solver.tetrahedron, solver.hexahedron)));
    }
  return {{"nodes", s.mesh.n_nodes()},
          {"elements", elements},
          {"formulations", formulations},
          {"pieces", s.n_pieces},
          {"quality_min", m.quality_min}};
}

Json refusals_json(const CutRecord& c) {
  Json list = Json::array();
  for (const CutRefusal& r : c.figures.refusals) {
    list.push_back({{"X_m", {r.X.x(), r.X.y(), r.X.z()}}, {"reason", reason_of(r)}});
    if (r.area > 0) list.back()["area_m2"] = r.area;
  }
  return list;
}

Json edits_json(const CutRecord& c) {
  return {{"stable_step_ratio", c.stable_step_ratio},
          {"quality_min", c.least_quality},
          {"mass_change", c.mass_change},
          {"momentum_change", c.momentum_change},
          {"kinetic_energy_change_J", c.kinetic_energy_change},
          {"strain_energy_change", c.strain_energy_change},
          {"deviation_max_m", c.figures.largest_deviation},
          {"deviation_mean_m", c.figures.mean_deviation()},
          {"edge_mean_m", c.figures.mean_edge}};
}

// What a stroke without edits has, too.
Json stroke_json(const CutRecord& c) {
  Json stroke = {{"tool", c.tool},
                 {"start_s", c.start},
                 {"end_s", c.end},
                 {"edits", c.n_edits},
                 {"edits_askew", c.n_askew},
                 {"refused", c.figures.n_refused},
                 {"refusals", refusals_json(c)},
                 {"nodes_beside_blade", c.figures.n_beside},
                 {"elements_turned", c.figures.n_turned},
                 {"chips", c.figures.n_chips},
                 {"nodes_pulled_back", c.figures.n_pulled_back},
                 {"nodes_inserted", c.figures.n_inserted},
                 {"nodes_moved", c.figures.n_moved},
                 {"nodes_duplicated", c.figures.n_duplicated},
                 {"facets_opened", c.figures.n_opened_facets},
                 {"pieces", c.n_pieces},
                 {"ranks", c.n_ranks},
                 {"elements_added", c.n_elements_added},
                 {"elements_dissolved", c.n_elements_dissolved},
                 {"hexahedra_converted", c.figures.n_converted},
                 {"hexahedra_kept", c.figures.n_kept_hexahedra},
                 {"scene_stable_step_ratio", c.scene_step_ratio},
                 {"blade_travel_m", c.blade_travel},
                 {"edge_inside_max_m", c.deepest},
                 {"milliseconds", 1e3 * c.seconds},
                 {"milliseconds_worst", 1e3 * c.worst_seconds}};
  if (c.n_edits > 0) stroke.update(edits_json(c));
  return stroke;
}

Json cuts_json(const Simulation& s) {
  Json list = Json::array();
  for (const CutStage& stage : s.cuts)
    for (const CutRecord& stroke : stage.strokes) {
      list.push_back(stroke_json(stroke));
      if (s.mesh.dimension() == 3)
        list.back().update({{"from_surface_to_surface", stroke.figures.goes_through},
                            {"swept_area_m2", stroke.swept_area},
                            {"parted_area_m2", stroke.parted_area}});
    }
  return list;
}

Json latency_json(const Simulation& s) {
  std::vector<double> seconds;
  for (const FrameRow& row : s.log.rows) seconds.push_back(1e3 * row.latency);
  return {{"p50", quantile(seconds, 0.5)},
          {"p99", quantile(seconds, 0.99)},
          {"p999", quantile(seconds, 0.999)},
          {"worst", quantile(seconds, 1)}};
}

double mean_share_asleep(const std::vector<FrameRow>& rows) {
  double sum = 0;
  for (const FrameRow& row : rows) sum += row.asleep;
  return rows.empty() ? 0 : sum / static_cast<double>(rows.size());
}

Json tools_json(const Simulation& s) {
  Json tools = Json::object();
  for (std::size_t k = 0; k < s.tools.size(); ++k) {
    double largest = 0;
    for (const FrameRow& row : s.log.rows) largest = std::max(largest, row.tools[k].force.norm());
    tools[s.tools[k].name] = {{"largest_force_N", largest}};
  }
  return tools;
}

// Rows from before a resumed run was asked for metrics know of none.
Json supports_json(const Simulation& s) {
  Json supports = Json::object();
  const std::vector<std::string> names = support_names(s.scene.supports);
  for (std::size_t k = 0; k < names.size(); ++k) {
    double largest = 0;
    for (const FrameRow& row : s.log.rows)
      if (!row.support_forces.empty()) largest = std::max(largest, row.support_forces[k].norm());
    supports[names[k]] = {{"largest_force_N", largest}};
  }
  return supports;
}

Json phases_json(const Simulation& s, const RunTimes& times) {
  Json phases = {{"set-up", times.setup_seconds}};
  for (const auto& [name, seconds] : s.timers.totals()) phases[name] = seconds;
  phases["closing files"] = times.finish_seconds;
  phases["drawing (own thread)"] = times.drawing_seconds;
  return phases;
}

Json added_mass_json(const AddedMass& a) {
  return {{"kg", a.mass},
          {"share_of_body", a.share},
          {"elements", a.n_elements},
          {"nodes", a.n_nodes},
          {"clusters", a.n_clusters},
          {"nodes_of_largest_cluster", a.largest_cluster},
          {"heaviest_node", a.heaviest_node},
          {"box_low_m", {a.box.low[0], a.box.low[1], a.box.low[2]}},
          {"box_high_m", {a.box.high[0], a.box.high[1], a.box.high[2]}}};
}

Json equilibrium_json(const Equilibrium& e) {
  return {{"iterations", e.iterations}, {"residual", e.residual}, {"seconds", e.seconds}};
}

// Names no element where none is deformed.
Json least_det_F_json(const FrameLog& log) {
  Json least = {{"value", log.least_J}};
  if (log.least_J_element >= 0) least["element"] = log.least_J_element;
  return least;
}

// What the body holds at the end, the works since the start, and how well the balance closes.
Json energies_json(const Simulation& s, const FrameRow& last) {
  const BalanceError error = balance_error(s);
  const EnergyState& e = last.energy;
  const EnergyWorks& w = last.works;
  return {{"kinetic", e.kinetic},
          {"strain", e.strain},
          {"hourglass", e.hourglass},
          {"gravity", e.gravity},
          {"contact_work", w.contact},
          {"hold_work", w.holds},
          {"blade_work", w.blade},
          {"load_work", w.loads},
          {"damping_work", w.damping},
          {"viscous_work", w.viscous},
          {"cut", w.cut},
          {"largest_balance_error", error.largest},
          {"largest_balance_error_share", error.share},
          {"largest_hourglass_share", s.energy->memory.largest_hourglass_share}};
}

Json wound_json(const Simulation& s, const FrameRow& last) {
  double largest = 0;
  for (const FrameRow& row : s.log.rows) largest = std::max(largest, row.wound_width);
  return {{"partner_nodes", s.duplicate_node.size()},
          {"largest_width_m", largest},
          {"width_at_end_m", last.wound_width}};
}

}  // namespace

std::string make_summary(Simulation& s, const RunTimes& times, const std::string& trouble) {
  const double simulated = s.scene.time.at(s.frame);
  const double resumed_at = s.scene.time.at(s.first_frame);
  const FrameRow last = s.log.rows.empty() ? FrameRow{} : s.log.rows.back();
  Json j;
  j["scene"] = s.scene.name;
  j["version"] = version_text();
  j["finished"] = trouble.empty();
  if (!trouble.empty()) j["trouble"] = trouble;
  if (s.first_frame > 0) j["resumed_at_s"] = resumed_at;
  j["ranks"] = s.communicator->size();
  j["threads"] = thread_count();
  j["traffic_of_rank_0"] = traffic_json(s.communicator->traffic());
  j["peak_memory_bytes"] =
      static_cast<std::int64_t>(s.communicator->all_max(static_cast<double>(peak_memory_bytes())));
  j["precision"] = name_of(s.scene.solver.precision);
  j["simd"] = simd_name();
  j["mesh"] = mesh_json(s);
  j["mass_kg"] = exact_sum(s.mass);
  if (s.added_mass) j["added_mass"] = added_mass_json(*s.added_mass);
  if (s.log.equilibrium.iterations > 0) j["equilibrium"] = equilibrium_json(s.log.equilibrium);
  j["duration_s"] = simulated;
  j["frames"] = s.frame;
  j["steps"] = s.state.step;
  j["stable_step_s"] = {{"min", s.log.least_stable_step}, {"max", s.log.largest_stable_step}};
  j["wall_seconds"] = {{"total", times.setup_seconds + times.loop_seconds + times.finish_seconds},
                       {"loop", times.loop_seconds},
                       {"by_phase", phases_json(s, times)}};
  j["real_time_factor"] =
      times.loop_seconds > 0 ? (simulated - resumed_at) / times.loop_seconds : 0;
  j["deadlines_missed"] = s.log.n_deadlines_missed;
  j["frame_latency_ms"] = latency_json(s);
  j["roll_backs"] = s.log.n_roll_backs;
  if (s.scene.solver.stable_step == StableStep::frequency)
    j["searches"] = {{"body", s.log.searches.n_of_body}, {"parts", s.log.searches.n_of_parts}};
  if (s.multirate)
    j["multirate"] = {{"substeps", s.multirate->steps.gain.size()},
                      {"share_of_elements", s.multirate->share}};
  if (s.sleep) j["share_asleep_mean"] = mean_share_asleep(s.log.rows);
  j["least_det_F"] = least_det_F_json(s.log);
  j["instruments"] = tools_json(s);
  if (s.energy) j["supports"] = supports_json(s);
  j["wound"] = wound_json(s, last);
  j["cuts"] = cuts_json(s);
  if (s.energy) j["energies_J"] = energies_json(s, last);
  j["events"] = s.log.events;
  j["state_digest"] = digest_text(state_digest(s));
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace trocar
