#include "solver/model_lists.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "solver/block_ranges.h"
#include "solver/kernels.h"
#include "solver/material_setup.h"
#include "solver/simd.h"

namespace trocar {

namespace {

Formulation formulation_of(const ModelSource& source, std::int32_t e) {
  const SolverOptions& options = source.options;
  return of_shape(source.mesh.element_type[e], options.tri3, options.tet4, options.hex8);
}

std::size_t key_of(std::int32_t region, Formulation formulation) {
  return static_cast<std::size_t>(region) * n_formulations + static_cast<std::size_t>(formulation);
}

// Unit vector.
Vec3 fibre_of_element(const ModelSource& source, std::int32_t e) {
  return source.mesh.fibre.empty() ? unit_fibre(source.material(e)) : source.mesh.fibre[e];
}

// Constants of the lane's element e: those of the material, then those of the element.
void fill_values(const ModelSource& source, std::int32_t e, const ElementConstants& element,
                 std::int64_t lane, ElementBlocks& blocks) {
  const BlockKernels kernels = kernels_for(kernels_of(Simd::scalar), blocks);
  std::array<double, max_values> value{};
  fill_material(source.material(e), element.volume, fibre_of_element(source, e), value);
  std::copy_n(element.value.begin(), kernels.n_values - kernels.n_material_values,
              value.begin() + kernels.n_material_values);
  const std::int64_t first = first_of_lane(lane, blocks.lanes, kernels.n_values);
  for (std::int64_t k = 0; k < kernels.n_values; ++k) {
    const double x = value[k];
    if (blocks.precision == Precision::in_single)
      blocks.data_single[first + k * blocks.lanes] = static_cast<float>(x);
    else
      blocks.data[first + k * blocks.lanes] = x;
  }
}

}  // namespace

std::size_t list_key(const ModelSource& source, std::int32_t e) {
  return key_of(source.mesh.element_region[e], formulation_of(source, e));
}

std::size_t list_key(const ElementBlocks& blocks) {
  return key_of(blocks.region, blocks.formulation);
}

ElementBlocks empty_blocks(const ModelSource& source, std::size_t key, std::int32_t n_elements) {
  ElementBlocks blocks;
  blocks.formulation = static_cast<Formulation>(key % n_formulations);
  blocks.region = static_cast<std::int32_t>(key / n_formulations);
  const Material& material = source.materials[blocks.region];
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

ElementConstants constants_of(const ModelSource& source, std::int32_t e) {
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

double resting_step(const ElementConstants& constants, double stiffening) {
  return constants.volume > 0 ? 2 / std::sqrt(constants.omega2 * stiffening) : 0;
}

void fill_corners(const ModelSource& source, std::int64_t lane, ElementBlocks& blocks) {
  const std::int32_t e = source.part.element_global[blocks.element_local[lane]];
  const std::span<const std::int32_t> node = source.mesh.corners(e);
  const auto n = static_cast<std::int64_t>(node.size());
  const std::int64_t first = first_of_lane(lane, blocks.lanes, n);
  for (std::int64_t a = 0; a < n; ++a)
    blocks.corner[first + a * blocks.lanes] = source.part.node_local[node[a]];
}

void fill_lane(const ModelSource& source, std::int64_t lane, ElementBlocks& blocks,
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

void check_step(const ModelSource& source, std::size_t k, const Model& model) {
  if (!(model.element_step[k] > 0))
    throw InputError("element " + std::to_string(source.part.element_global[k]) +
                     " has no positive volume, or a stiffness or density that is not finite");
}

FixedMask held_by_plane(const Mesh& mesh) {
  return mesh.dimension() == 2 ? 4 : 0;
}

void resize_nodes(const Part& part, Model& model) {
  const auto n_owned = static_cast<std::size_t>(part.n_owned);
  model.n_local = part.n_local();
  model.n_owned = part.n_owned;
  model.mass.resize(n_owned);
  model.fixed.resize(n_owned);
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

// Rounded alike on all ranks and for any numbering, so that all elements at a node see it at the
// same place. After an edit all are taken anew: the least of the coordinates may have changed.
void take_positions(const ModelSource& source, Model& model) {
  const auto is_reader = [](const ElementBlocks& blocks) {
    return kernels_for(kernels_of(Simd::scalar), blocks).element.reads_positions;
  };
  if (std::none_of(model.blocks.begin(), model.blocks.end(), is_reader)) return;
  Vec3 least = source.mesh.X[0];
  for (const Vec3& X : source.mesh.X) least = least.cwiseMin(X);
  const std::int64_t stride = component_stride(model.n_local);
  model.position.assign(
      static_cast<std::size_t>(model.is_by_component ? 3 * stride : 4 * model.n_local), 0);
  for (std::int64_t i = 0; i < model.n_local; ++i) {
    const Vec3 X = source.mesh.X[source.part.node_global[i]] - least;
    for (int j = 0; j < 3; ++j)
      model.position[model.is_by_component ? j * stride + i : 4 * i + j] = static_cast<float>(X[j]);
  }
}

}  // namespace trocar
