// Builds a model: elements into blocks, the order of their sums, stable steps of the undeformed
// elements.
#include "solver/model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "base/threads.h"
#include "solver/block_ranges.h"
#include "solver/element_setup.h"
#include "solver/history.h"
#include "solver/kernels.h"
#include "solver/material_check.h"
#include "solver/material_setup.h"
#include "solver/model_edit.h"
#include "solver/simd.h"
#include "solver/sum_order.h"
#include "solver/volume_averages.h"

namespace trocar {

namespace {

// What build_model reads, under one name.
struct Source {
  const Mesh& mesh;
  const Part& part;
  std::span<const Material> materials;
  const SolverOptions& options;

  std::int32_t n_elements() const { return static_cast<std::int32_t>(part.element_global.size()); }
  const Material& material(std::int32_t e) const { return materials[mesh.element_region[e]]; }
};

void check_source(const Source& source, std::span<const FixedMask> fixed,
                  std::span<const double> mass) {
  CHECK_OP(source.materials.size(), >=, source.mesh.region_name.size());
  CHECK_OP(fixed.size(), ==, source.mesh.X.size());
  CHECK_OP(mass.size(), ==, source.mesh.X.size());
  check_materials(source.mesh, source.materials, source.options);
}

Formulation formulation_of(const Source& source, std::int32_t e) {
  const Formulation of_shape[] = {source.options.tri3, source.options.tet4, source.options.hex8};
  return of_shape[static_cast<int>(source.mesh.element_type[e])];
}

void check_formulations(const SolverOptions& options) {
  CHECK(shape_of(options.tri3) == ElementType::tri3);
  CHECK(shape_of(options.tet4) == ElementType::tet4);
  CHECK(shape_of(options.hex8) == ElementType::hex8);
}

bool reads_halo(const Source& source, std::int32_t e) {
  const std::span<const std::int32_t> node = source.mesh.corners(e);
  return std::any_of(node.begin(), node.end(), [&](std::int32_t i) {
    return source.part.node_local[i] >= source.part.n_owned;
  });
}

// Lists are in the order of their keys.
std::size_t list_key(const Source& source, std::int32_t e) {
  const std::size_t region = static_cast<std::size_t>(source.mesh.element_region[e]);
  const std::size_t block = reads_halo(source, e) ? source.materials.size() : 0;
  return (block + region) * n_formulations + static_cast<std::size_t>(formulation_of(source, e));
}

ElementBlocks empty_blocks(const Source& source, int key, std::int32_t n_elements) {
  ElementBlocks blocks;
  const int n_regions = static_cast<int>(source.materials.size());
  blocks.formulation = static_cast<Formulation>(key % n_formulations);
  blocks.region = key / n_formulations % n_regions;
  blocks.reads_halo = key / n_formulations >= n_regions;
  const Material& material = source.materials[static_cast<std::size_t>(blocks.region)];
  blocks.material = material.model;
  blocks.stiffening_at_rest = stiffening_at_rest(material);
  blocks.prony = material.prony;
  blocks.precision = source.options.precision;
  const bool is_single = blocks.precision == Precision::in_single;
  blocks.lanes = is_single ? lanes_of_block<float> : lanes_of_block<double>;
  blocks.n_elements = n_elements;
  blocks.n_blocks = (n_elements + blocks.lanes - 1) / blocks.lanes;
  const BlockKernels kernels = kernels_for(kernels_of(Simd::scalar), blocks);
  CHECK_OP(kernels.element.n_corners, ==, n_corners(shape_of(blocks.formulation)));
  CHECK_OP(kernels.element.n_stash, <=, max_stash_values);
  const auto n_lanes = static_cast<std::size_t>(blocks.n_blocks * blocks.lanes);
  const std::size_t n_numbers = n_lanes * static_cast<std::size_t>(kernels.n_values);
  blocks.element_local.resize(n_lanes);
  blocks.corner.resize(n_lanes * static_cast<std::size_t>(kernels.element.n_corners));
  blocks.data.resize(is_single ? 0 : n_numbers);
  blocks.data_single.resize(is_single ? n_numbers : 0);
  return blocks;
}

// Counts the elements of each kind, gives each kind that occurs its blocks, and the elements their
// lanes, ascending.
void make_lists(const Source& source, Model& model) {
  const auto key_of = [&](std::int32_t k) {
    return list_key(source, source.part.element_global[k]);
  };
  const std::size_t n_keys = 2 * n_formulations * source.materials.size();
  std::vector<std::int32_t> count(n_keys), next(n_keys), list_of_key(n_keys);
  for (std::int32_t k = 0; k < source.n_elements(); ++k) ++count[key_of(k)];
  for (std::size_t key = 0; key < n_keys; ++key) {
    if (count[key] == 0) continue;
    list_of_key[key] = static_cast<std::int32_t>(model.blocks.size());
    model.blocks.push_back(empty_blocks(source, static_cast<int>(key), count[key]));
  }
  for (std::int32_t k = 0; k < source.n_elements(); ++k) {
    const std::size_t key = key_of(k);
    model.blocks[list_of_key[key]].element_local[next[key]++] = k;
  }
}

ElementConstants constants_of(const Source& source, std::int32_t e) {
  const std::span<const std::int32_t> node = source.mesh.corners(e);
  std::array<Vec3, max_corners> X;
  for (std::size_t a = 0; a < node.size(); ++a) X[a] = source.mesh.X[node[a]];
  const Material& material = source.material(e);
  return element_constants(formulation_of(source, e),
                           {.X = {X.data(), node.size()},
                            .lambda = lame_lambda(material),
                            .mu = lame_mu(material),
                            .density = material.density * source.mesh.density_factor[e],
                            .hourglass = source.options.hourglass,
                            .thickness = source.options.thickness});
}

// Unit vector.
Vec3 fibre_of_element(const Source& source, std::int32_t e) {
  return source.mesh.fibre.empty() ? unit_fibre(source.material(e)) : source.mesh.fibre[e];
}

// Constants of the lane's element e: those of the material, then those of the element.
void fill_values(const Source& source, std::int32_t e, const ElementConstants& element,
                 std::int64_t lane, ElementBlocks& blocks) {
  const BlockKernels kernels = kernels_for(kernels_of(Simd::scalar), blocks);
  std::array<double, max_values> value{};
  fill_material(source.material(e), element.volume, fibre_of_element(source, e), value);
  std::copy_n(element.value.begin(), kernels.n_values - kernels.n_material_values,
              value.begin() + kernels.n_material_values);
  const std::int64_t first =
      lane / blocks.lanes * kernels.n_values * blocks.lanes + lane % blocks.lanes;
  for (std::int64_t k = 0; k < kernels.n_values; ++k) {
    const double x = value[static_cast<std::size_t>(k)];
    if (blocks.precision == Precision::in_single)
      blocks.data_single[first + k * blocks.lanes] = static_cast<float>(x);
    else
      blocks.data[first + k * blocks.lanes] = x;
  }
}

double resting_step(const ElementConstants& constants, double stiffening) {
  return constants.volume > 0 ? 2 / std::sqrt(constants.omega2 * stiffening) : 0;
}

// Lanes behind the last element repeat its corners.
void fill_corners(const Source& source, std::int64_t lane, ElementBlocks& blocks) {
  const std::int64_t block = lane / blocks.lanes, l = lane % blocks.lanes;
  const std::int32_t e = source.part.element_global[blocks.element_local[lane]];
  const std::span<const std::int32_t> node = source.mesh.corners(e);
  const auto n = static_cast<std::int64_t>(node.size());
  for (std::int64_t a = 0; a < n; ++a)
    blocks.corner[(block * n + a) * blocks.lanes + l] = source.part.node_local[node[a]];
}

// A lane's element; all constants behind the last one are zero.
void fill_lane(const Source& source, std::int64_t lane, ElementBlocks& blocks,
               std::vector<double>& element_step) {
  const bool is_padding = lane >= blocks.n_elements;
  if (is_padding) blocks.element_local[lane] = blocks.element_local[blocks.n_elements - 1];
  fill_corners(source, lane, blocks);
  if (is_padding) return;
  const std::int32_t k = blocks.element_local[lane], e = source.part.element_global[k];
  const ElementConstants constants = constants_of(source, e);
  fill_values(source, e, constants, lane, blocks);
  element_step[k] = resting_step(constants, blocks.stiffening_at_rest);
}

void check_step(const Source& source, std::size_t k, const Model& model) {
  if (!(model.element_step[k] > 0))
    throw InputError("element " + std::to_string(source.part.element_global[k]) +
                     " has no positive volume, or a stiffness or density that is not finite");
}

void fill_blocks(const Source& source, Model& model) {
  model.element_step.resize(source.part.element_global.size());
  for (ElementBlocks& blocks : model.blocks)
    parallel_for(std::int64_t{blocks.n_blocks}, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t lane = begin * blocks.lanes; lane < end * blocks.lanes; ++lane)
        fill_lane(source, lane, blocks, model.element_step);
    });
  for (std::size_t k = 0; k < model.element_step.size(); ++k) check_step(source, k, model);
}

// Plane bodies hold z.
FixedMask held_by_plane(const Mesh& mesh) {
  return mesh.dimension() == 2 ? 4 : 0;
}

void take_node(const ModelSource& source, std::int32_t i, FixedMask plane, Model& model) {
  const std::int32_t global = source.part.node_global[i];
  const double mass = source.mass[global];
  if (!(mass > 0))
    throw InputError("node " + std::to_string(global) +
                     " has no mass: each node must belong to an element");
  model.mass[i] = mass;
  model.fixed[i] = static_cast<FixedMask>(source.fixed[global] | plane);
}

void resize_nodes(const Part& part, Model& model) {
  const auto n_owned = static_cast<std::size_t>(part.n_owned);
  model.n_local = part.n_local();
  model.n_owned = part.n_owned;
  model.mass.resize(n_owned);
  model.fixed.resize(n_owned);
}

// Rounded alike on all ranks and for any numbering, so that all elements at a node see it at the
// same place. After an edit all are taken anew: the least of the coordinates may have changed.
void take_positions(const Source& source, Model& model) {
  const auto is_reader = [](const ElementBlocks& blocks) {
    return kernels_for(kernels_of(Simd::scalar), blocks).element.reads_positions;
  };
  if (std::none_of(model.blocks.begin(), model.blocks.end(), is_reader)) return;
  Vec3 least = source.mesh.X[0];
  for (const Vec3& X : source.mesh.X) least = least.cwiseMin(X);
  model.position.resize(static_cast<std::size_t>(model.n_local) * 4);
  for (std::int64_t i = 0; i < model.n_local; ++i) {
    const Vec3 X = source.mesh.X[source.part.node_global[i]] - least;
    for (int j = 0; j < 3; ++j) model.position[4 * i + j] = static_cast<float>(X[j]);
  }
}

// Where element k of the part is.
struct Place {
  std::size_t list;
  std::int64_t lane;
};
Place place_of(std::int32_t k, const Model& model) {
  for (std::size_t list = 0; list < model.blocks.size(); ++list) {
    const ElementBlocks& blocks = model.blocks[list];
    const auto end = blocks.element_local.begin() + blocks.n_elements;
    const auto at = std::lower_bound(blocks.element_local.begin(), end, k);
    if (at != end && *at == k) return {list, at - blocks.element_local.begin()};
  }
  CHECK(false);
  return {0, 0};
}

// Elements ascend, so that those of a block mostly follow each other.
std::vector<BlockPlace> blocks_of(const Part& part, std::span<const std::int32_t> elements,
                                  const Model& model) {
  std::vector<BlockPlace> blocks;
  for (const std::int32_t e : elements) {
    const std::int64_t k = part.place_of(e);
    if (k < 0) continue;
    const Place place = place_of(static_cast<std::int32_t>(k), model);
    const BlockPlace block{
        .list = place.list,
        .block = static_cast<std::int32_t>(place.lane / model.blocks[place.list].lanes)};
    if (blocks.empty() || blocks.back() != block) blocks.push_back(block);
  }
  return blocks;
}

std::vector<std::int32_t> owned_of(const Part& part, std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> owned;
  for (const std::int32_t node : nodes)
    if (const std::int32_t i = part.node_local[node]; i >= 0 && i < part.n_owned)
      owned.push_back(i);
  return owned;
}

// With the padding that repeats its corners.
void refill(const Source& source, std::int32_t k, Model& model) {
  const Place place = place_of(k, model);
  ElementBlocks& blocks = model.blocks[place.list];
  fill_lane(source, place.lane, blocks, model.element_step);
  check_step(source, static_cast<std::size_t>(k), model);
  if (place.lane + 1 < blocks.n_elements) return;
  for (std::int64_t lane = place.lane + 1; lane < std::ssize(blocks.element_local); ++lane)
    fill_corners(source, lane, blocks);
}

}  // namespace

Model build_model(const Mesh& mesh, const Part& part, std::span<const Material> materials,
                  std::span<const FixedMask> fixed, std::span<const double> mass,
                  const SolverOptions& options) {
  const Source source{mesh, part, materials, options};
  check_source(source, fixed, mass);
  check_formulations(options);
  Model model;
  model.options = options;
  resize_nodes(part, model);
  const FixedMask plane = held_by_plane(mesh);
  for (std::int32_t i = 0; i < model.n_owned; ++i)
    take_node({mesh, part, materials, fixed, mass}, i, plane, model);
  make_lists(source, model);
  fill_blocks(source, model);
  model.n_history = place_history(model.blocks);
  take_positions(source, model);
  order_sums(model);
  link_volume_averages(mesh, materials, model);
  return model;
}

void edit_model(const ModelSource& from, const ModelEdit& edit, Model& model) {
  CHECK(model.clusters.node.empty());
  const Source source{from.mesh, from.part, from.materials, model.options};
  resize_nodes(from.part, model);
  const FixedMask plane = held_by_plane(from.mesh);
  const std::vector<std::int32_t> owned = owned_of(from.part, edit.nodes);
  for (const std::int32_t i : owned) take_node(from, i, plane, model);
  for (const std::int32_t e : edit.elements)
    if (const std::int64_t k = from.part.place_of(e); k >= 0)
      refill(source, static_cast<std::int32_t>(k), model);
  for (ElementBlocks& blocks : model.blocks)
    for (std::int64_t lane = 0; blocks.reads_halo && lane < std::ssize(blocks.element_local);
         ++lane)  // numbers of halo nodes have moved up
      fill_corners(source, lane, blocks);
  take_positions(source, model);
  edit_sums(owned, blocks_of(from.part, edit.touching, model), model);
  model.averages = {};
  link_volume_averages(from.mesh, from.materials, model);
}

std::vector<RestingElement> resting_elements(const Mesh& mesh, std::span<const Material> materials,
                                             const SolverOptions& options) {
  const Part none;  // constants do not ask for it
  const Source source{mesh, none, materials, options};
  std::vector<RestingElement> elements(mesh.element_type.size());
  parallel_for(std::ssize(elements), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const auto e = static_cast<std::int32_t>(k);
      const ElementConstants constants = constants_of(source, e);
      const double density = source.material(e).density * mesh.density_factor[e];
      elements[k] = {.number = e,
                     .step = resting_step(constants, stiffening_at_rest(source.material(e))),
                     .mass = density * constants.volume};
    }
  });
  return elements;
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
            [&](auto& sum) { sum.resize(static_cast<std::size_t>(model.sums.n_places) * 4); });
  scratch.volume_change.resize(static_cast<std::size_t>(model.averages.n_lanes));
  scratch.force.resize(3 * n_owned);
  scratch.has_force = false;
  if (scratch.keeps_works) keep_works(model, scratch);
  scratch.viscous.resize(model.blocks.size());
}

}  // namespace trocar
