// Builds a model: elements into blocks, the order of their sums, stable steps of the undeformed
// elements.
#include "solver/model.h"

#include <algorithm>

#include "base/check.h"
#include "base/threads.h"
#include "solver/element_list.h"
#include "solver/history.h"
#include "solver/material_check.h"
#include "solver/material_setup.h"
#include "solver/model_lists.h"
#include "solver/node_layout.h"
#include "solver/prefetch.h"
#include "solver/sum_order.h"
#include "solver/volume_averages.h"

namespace trocar {

namespace {

void check_source(const ModelSource& source) {
  CHECK_OP(source.materials.size(), >=, source.mesh.region_name.size());
  CHECK_OP(source.fixed.size(), ==, source.mesh.X.size());
  CHECK_OP(source.mass.size(), ==, source.mesh.X.size());
  check_materials(source.mesh, source.materials, source.options);
}

void check_formulations(const SolverOptions& options) {
  CHECK(shape_of(options.tri3) == ElementType::tri3);
  CHECK(shape_of(options.tet4) == ElementType::tet4);
  CHECK(shape_of(options.hex8) == ElementType::hex8);
}

// Counts the elements of each kind, gives each kind that occurs its blocks, and the elements their
// lanes, ascending.
void make_lists(const ModelSource& source, Model& model) {
  const auto key_of = [&](std::int32_t k) {
    return list_key(source, source.part.element_global[k]);
  };
  const std::size_t n_keys = n_formulations * source.materials.size();
  std::vector<std::int32_t> count(n_keys), next(n_keys), list_of_key(n_keys);
  for (std::int32_t k = 0; k < source.n_elements(); ++k) ++count[key_of(k)];
  for (std::size_t key = 0; key < n_keys; ++key) {
    if (count[key] == 0) continue;
    list_of_key[key] = static_cast<std::int32_t>(model.blocks.size());
    model.blocks.push_back(empty_blocks(source, key, count[key]));
  }
  for (std::int32_t k = 0; k < source.n_elements(); ++k) {
    const std::size_t key = key_of(k);
    model.blocks[list_of_key[key]].element_local[next[key]++] = k;
  }
}

void fill_blocks(const ModelSource& source, Model& model) {
  model.element_step.resize(source.part.element_global.size());
  for (ElementBlocks& blocks : model.blocks)
    parallel_for(std::int64_t{blocks.n_blocks}, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t lane = begin * blocks.lanes; lane < end * blocks.lanes; ++lane)
        fill_lane(source, lane, blocks, model.element_step);
    });
  for (std::size_t k = 0; k < model.element_step.size(); ++k) check_step(source, k, model);
}

}  // namespace

Model build_model(const Mesh& mesh, const Part& part, std::span<const Material> materials,
                  std::span<const FixedMask> fixed, std::span<const double> mass,
                  const SolverOptions& options) {
  const ModelSource source{mesh, part, materials, options, fixed, mass};
  check_source(source);
  check_formulations(options);
  Model model;
  model.options = options;
  resize_nodes(part, model);
  const FixedMask plane = held_by_plane(mesh);
  for (std::int32_t i = 0; i < model.n_owned; ++i) take_node(source, i, plane, model);
  make_lists(source, model);
  fill_blocks(source, model);
  model.n_history = place_history(model.blocks);
  order_sums(model);
  mark_aligned(mesh, part, model);
  take_positions(source, model);
  link_volume_averages(mesh, materials, model);
  return model;
}

RestingElement resting_element(const Mesh& mesh, std::span<const Material> materials,
                               const SolverOptions& options, std::int32_t number) {
  const Part none;  // constants do not ask for it
  const ModelSource source{mesh, none, materials, options};
  const ElementConstants constants = constants_of(source, number);
  const Material& material = source.material(number);
  return {.number = number,
          .step = resting_step(constants, stiffening_at_rest(material)),
          .mass = material.density * mesh.density_factor[number] * constants.volume};
}

std::vector<RestingElement> resting_elements(const Mesh& mesh, std::span<const Material> materials,
                                             const SolverOptions& options) {
  std::vector<RestingElement> elements(mesh.element_type.size());
  parallel_for(std::ssize(elements), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
      elements[k] = resting_element(mesh, materials, options, static_cast<std::int32_t>(k));
  });
  return elements;
}

void edit_resting_elements(const Mesh& mesh, std::span<const Material> materials,
                           const SolverOptions& options, std::span<const std::int32_t> elements,
                           std::vector<RestingElement>& resting) {
  resting.resize(mesh.element_type.size());
  for (const std::int32_t e : elements) resting[e] = resting_element(mesh, materials, options, e);
}

State make_state(const Model& model) {
  State state;
  state.u.assign(static_cast<std::size_t>(model.n_local) * 3, 0.0);
  state.v.assign(static_cast<std::size_t>(model.n_local) * 3, 0.0);
  state.history.assign(static_cast<std::size_t>(model.n_history), 0.0);
  state.theta.assign(
      static_cast<std::size_t>(model.n_local) * static_cast<std::size_t>(model.averages.n_fields),
      0.0);
  return state;
}

Scratch make_scratch(const Model& model) {
  Scratch scratch;
  fit_scratch(model, scratch);
  return scratch;
}

void keep_works(const Model& model, Scratch& scratch) {
  scratch.keeps_works = true;
  const auto n_owned = static_cast<std::size_t>(model.n_owned);
  const auto fit = [](bool is_used, std::size_t n, std::vector<double>& values) {
    values.resize(is_used ? n : 0);
  };
  const bool has_clusters = !model.clusters.node.empty();
  fit(model.options.mass_damping > 0, 3 * n_owned, scratch.swept);
  fit(model.n_history > 0, 3 * n_owned, scratch.viscous_work);
  fit(model.n_history > 0, 3 * n_owned, scratch.viscous_force);
  fit(has_clusters, 3 * n_owned, scratch.middle);
  fit(has_clusters, n_owned, scratch.cluster_work);
}

void fit_scratch(const Model& model, Scratch& scratch) {
  const auto n_owned = static_cast<std::size_t>(model.n_owned);
  with_sums(model, scratch,
            [&](auto& sum) { sum.resize(static_cast<std::size_t>(n_sums(model))); });
  scratch.u_by_component.resize(
      model.is_by_component ? static_cast<std::size_t>(model.sums.window.back().at) : 0);
  scratch.volume_change.resize(static_cast<std::size_t>(model.averages.n_lanes));
  scratch.force.resize(3 * n_owned);
  scratch.has_force = false;
  if (scratch.keeps_works) keep_works(model, scratch);
  scratch.viscous.resize(model.blocks.size());
  scratch.is_beyond_cache = is_beyond_cache(model, scratch);
}

}  // namespace trocar
