// Every member of what a checkpoint is made of. A struct that gets another one does not compile
// here until that is added: then the test of the bytes asks for it.
#pragma once

#include <concepts>
#include <cstddef>
#include <tuple>

#include "engine/checkpoint.h"

namespace trocar {

// Of an aggregate, a base counting as one.
struct AnyMember {
  template <class T>
  operator T() const;
};
template <class T, class... Members>
consteval std::size_t n_members() {
  if constexpr (requires { T{Members{}..., AnyMember{}}; })
    return n_members<T, Members..., AnyMember>();
  else
    return sizeof...(Members);
}

inline auto members(Checkpoint& c) {
  auto& [version, simd, scene, body_crc, frame, digest, mesh, fixed, duplicate_parent,
         duplicate_node, u, v, time, last_dt, step, step_scale, held_step, held_by_contact, watch,
         holds, is_open, cuts, tally, rows, history, history_time, searches, looked_at,
         has_stiffening, local_steps, sleep, quiet_range, has_energies, energy, outputs] = c;
  return std::tie(version, simd, scene, body_crc, frame, digest, mesh, fixed, duplicate_parent,
                  duplicate_node, u, v, time, last_dt, step, step_scale, held_step, held_by_contact,
                  watch, holds, is_open, cuts, tally, rows, history, history_time, searches,
                  looked_at, has_stiffening, local_steps, sleep, quiet_range, has_energies, energy,
                  outputs);
}

inline auto members(Watch& w) {
  auto& [stable_step, stable_element, least_J, least_J_element, is_finite, bad_node] = w;
  return std::tie(stable_step, stable_element, least_J, least_J_element, is_finite, bad_node);
}
inline auto members(Hold& h) {
  auto& [node, tool, support, offset] = h;
  return std::tie(node, tool, support, offset);
}
inline auto members(SearchMemory& m) {
  auto& [at_step, step, of_small, growth, asked, searched] = m;
  return std::tie(at_step, step, of_small, growth, asked, searched);
}
inline auto members(GrownElement& e) {
  auto& [element, stiffening] = e;
  return std::tie(element, stiffening);
}
inline auto members(QuietRange& r) {
  auto& [recent, low, high] = r;
  return std::tie(recent, low, high);
}
inline auto members(OutputMark& m) {
  auto& [kind, file, last_frame, pending] = m;
  return std::tie(kind, file, last_frame, pending);
}

inline auto members(RunTally& t) {
  auto& [equilibrium, n_roll_backs, n_deadlines_missed, searches, least_J, least_J_element, told,
         least_stable_step, largest_stable_step, events] = t;
  return std::tie(equilibrium, n_roll_backs, n_deadlines_missed, searches, least_J, least_J_element,
                  told, least_stable_step, largest_stable_step, events);
}
inline auto members(ToldOnce& t) {
  auto& [no_local_steps, sunk_tissue] = t;
  return std::tie(no_local_steps, sunk_tissue);
}
inline auto members(Equilibrium& e) {
  auto& [iterations, residual, seconds] = e;
  return std::tie(iterations, residual, seconds);
}
inline auto members(Searches& n) {
  auto& [of_body, of_parts] = n;
  return std::tie(of_body, of_parts);
}
inline auto members(FrameRow& r) {
  auto& [frame, step, n_substeps, time, dt, stable_step, least_J, asleep, energy, works,
         energy_error, wound_width, wound_width_mean, n_contacts, n_tissue_contacts, n_held,
         n_edits, n_pieces, tools, markers, support_forces, seconds, latency] = r;
  return std::tie(frame, step, n_substeps, time, dt, stable_step, least_J, asleep, energy, works,
                  energy_error, wound_width, wound_width_mean, n_contacts, n_tissue_contacts,
                  n_held, n_edits, n_pieces, tools, markers, support_forces, seconds, latency);
}
// But for `pull`, which is told in its own frame alone.
inline auto members(ToolRow& r) {
  auto& [position, force, torque, pull] = r;
  return std::tie(position, force, torque);
}
inline auto members(EnergyState& e) {
  auto& [kinetic, strain, hourglass, gravity] = e;
  return std::tie(kinetic, strain, hourglass, gravity);
}
inline auto members(EnergyWorks& w) {
  auto& [contact, holds, blade, loads, damping, viscous, cut] = w;
  return std::tie(contact, holds, blade, loads, damping, viscous, cut);
}
inline auto members(EnergyMemory& m) {
  auto& [first_frame, works, initial, largest_stored, largest_hourglass_share] = m;
  return std::tie(first_frame, works, initial, largest_stored, largest_hourglass_share);
}

inline auto members(CutProgress& p) {
  auto& [plane_path, plane_tip, is_in_stroke, n_idle_frames, has_told_beside, strokes, is_engaged,
         tissue_velocity, knows_tissue, swept, push] = p;
  return std::tie(plane_path, plane_tip, is_in_stroke, n_idle_frames, has_told_beside, strokes,
                  is_engaged, tissue_velocity, knows_tissue, swept, push);
}
inline auto members(CutMemory& m) {
  static_assert(n_members<CutMemory>() == 2);
  return std::tuple_cat(members(static_cast<CutProgress&>(m)), std::tie(m.stroke));
}
inline auto members(SweptPlace& p) {
  auto& [X, normal, area] = p;
  return std::tie(X, normal, area);
}
inline auto members(BladePush& p) {
  auto& [way, along] = p;
  return std::tie(way, along);
}
inline auto members(CutRecord& r) {
  auto& [tool, start, end, figures, n_edits, n_ranks, n_askew, n_pieces, n_elements_added,
         n_elements_dissolved, stable_step_ratio, scene_step_ratio, scene_step_before,
         least_quality, mass_change, momentum_change, kinetic_energy_change, strain_energy_change,
         blade_travel, deepest, push, swept_area, parted_area, seconds, worst_seconds] = r;
  return std::tie(tool, start, end, figures, n_edits, n_ranks, n_askew, n_pieces, n_elements_added,
                  n_elements_dissolved, stable_step_ratio, scene_step_ratio, scene_step_before,
                  least_quality, mass_change, momentum_change, kinetic_energy_change,
                  strain_energy_change, blade_travel, deepest, push, swept_area, parted_area,
                  seconds, worst_seconds);
}
inline auto members(CutFigures& f) {
  auto& [goes_through, is_in_slit, n_opened_facets, n_moved, n_duplicated, n_refused, least_quality,
         largest_deviation, deviation_sum, n_on_cut, n_beside, n_turned, n_chips, n_pulled_back,
         n_inverted, n_converted, n_kept_hexahedra, n_inserted, refusals, mean_edge] = f;
  return std::tie(goes_through, is_in_slit, n_opened_facets, n_moved, n_duplicated, n_refused,
                  least_quality, largest_deviation, deviation_sum, n_on_cut, n_beside, n_turned,
                  n_chips, n_pulled_back, n_inverted, n_converted, n_kept_hexahedra, n_inserted,
                  refusals, mean_edge);
}
inline auto members(CutRefusal& r) {
  auto& [X, reason, area] = r;
  return std::tie(X, reason, area);
}

inline auto members(CutHit& h) {
  auto& [element, edge, is_first_plus, X, N] = h;
  return std::tie(element, edge, is_first_plus, X, N);
}
template <class T>
auto members(OfElement<T>& entry) {
  auto& [element, value] = entry;
  return std::tie(element, value);
}
inline auto members(SurfacePoint& p) {
  auto& [X, N] = p;
  return std::tie(X, N);
}
inline auto members(BladePoint& p) {
  auto& [element, is_inside, X, beyond, x, farthest, ahead] = p;
  return std::tie(element, is_inside, X, beyond, x, farthest, ahead);
}
inline auto members(CutKnown& k) {
  auto& [hit, side, opened, surface_node, parted_node] = k;
  return std::tie(hit, side, opened, surface_node, parted_node);
}
inline auto members(CutLeft& l) {
  static_assert(n_members<CutLeft>() == 1 + 3);
  return std::tuple_cat(members(static_cast<CutKnown&>(l)), std::tie(l.parted, l.at_end, l.rim));
}
inline auto members(CutStroke& s) {
  static_assert(n_members<CutStroke>() == 1 + 17);
  return std::tuple_cat(members(static_cast<CutKnown&>(s)),
                        std::tie(s.earlier_hit, s.left, s.beside, s.taken, s.step, s.whole_edge,
                                 s.made_node, s.fresh, s.in_slit, s.whole, s.unfinished, s.edge,
                                 s.at_edge, s.rim, s.is_amid, s.mean_edge, s.swept));
}

}  // namespace trocar
