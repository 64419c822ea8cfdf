#include "solver/volume_averages.h"

#include <algorithm>
#include <limits>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "solver/block_ranges.h"
#include "solver/element_setup.h"
#include "solver/simd.h"
#include "solver/step.h"
#include "solver/sum_order.h"

namespace trocar {

namespace {

bool averages_volume(const ElementBlocks& blocks) {
  return kernels_for(active_kernels(), blocks).element.volume_change != nullptr;
}

// One field for each region of the whole mesh with such elements, so that all ranks have the same.
std::vector<std::int32_t> number_fields(const Mesh& mesh, VolumeAverages& averages) {
  std::vector<std::int32_t> field(mesh.region_name.size(), -1);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (mesh.element_type[e] == shape_of(Formulation::tet4_nodal_pressure))
      field[mesh.element_region[e]] = 0;
  for (std::int32_t& f : field)
    if (f == 0) f = averages.n_fields++;
  return field;
}

// Of the shear modulus that is left when all has relaxed: a share that followed the whole one would
// hold what has relaxed, and what has not is stiff enough in shear.
double relaxed_mu(const Material& material) {
  double left = 1;
  for (const PronyBranch& branch : material.prony) left -= branch.share;
  return std::max(left, 0.0) * lame_mu(material);
}

void set_shares(std::span<const Material> materials, std::span<const std::int32_t> field,
                Model& model) {
  model.averages.share.resize(static_cast<std::size_t>(model.averages.n_fields));
  for (std::size_t r = 0; r < field.size(); ++r)
    if (field[r] >= 0)
      model.averages.share[field[r]] =
          std::min(1.0, model.options.own_volume_stiffness * relaxed_mu(materials[r]) /
                            bulk_modulus(materials[r]));
}

double stiffness_of(const ElementBlocks& blocks, int n_values, std::int64_t lane) {
  const std::int64_t at =
      first_of_lane(lane, blocks.lanes, n_values) + std::int64_t{value_K_V} * blocks.lanes;
  return blocks.precision == Precision::in_single ? static_cast<double>(blocks.data_single[at])
                                                  : blocks.data[at];
}

// Calls body(item, lane, K V) for each owned corner of all lists, ascending global element number;
// an item is a node's number in a field.
template <class Body>
void for_owned_corners(const Model& model, const Body& body) {
  for_lanes_in_order(model.blocks, [&](std::size_t list, std::int64_t lane) {
    const ElementBlocks& blocks = model.blocks[list];
    if (!averages_volume(blocks) || lane >= blocks.n_elements) return;
    const BlockKernels kernels = kernels_for(active_kernels(), blocks);
    const std::int64_t n_corners = kernels.element.n_corners;
    const std::int64_t first = first_of_lane(lane, blocks.lanes, n_corners);
    for (std::int64_t a = 0; a < n_corners; ++a) {
      const std::int64_t node = blocks.corner[first + a * blocks.lanes];
      if (node < model.n_owned)
        body(node * model.averages.n_fields + blocks.field, blocks.first_lane + lane,
             stiffness_of(blocks, kernels.n_values, lane));
    }
  });
}

// K V (J - 1) of the elements of the list's blocks in [first, last).
void find_volume_change(const Model& model, const ElementBlocks& blocks, std::int64_t first,
                        std::int64_t last, const State& state, Scratch& scratch) {
  if (!averages_volume(blocks)) return;
  const BlockKernels kernels = kernels_for(active_kernels(), blocks);
  parallel_for(last - first, [&](std::int64_t begin, std::int64_t end) {
    StashBytes unused;
    const FlushSubnormals flush(blocks.precision == Precision::in_single);
    kernels.element.volume_change(
        block_task(model, blocks, kernels, state, {}, first + begin, end - begin, unused),
        scratch.volume_change.data() + blocks.first_lane + (first + begin) * blocks.lanes);
  });
}

// The first block that reads halo nodes, or behind all.
BlockPlace first_with_halo(const Model& model) {
  const std::vector<BlockPlace>& places = model.sums.halo_block;
  return places.empty() ? BlockPlace{model.blocks.size(), 0} : places.front();
}

void link_lanes(Model& model) {
  VolumeAverages& averages = model.averages;
  const std::int64_t n = std::int64_t{model.n_owned} * averages.n_fields;
  averages.stiffness.assign(static_cast<std::size_t>(n), 0);
  averages.offset.assign(static_cast<std::size_t>(n) + 1, 0);
  for_owned_corners(model, [&](std::int64_t item, std::int64_t, double K_V) {
    ++averages.offset[item + 1];
    averages.stiffness[item] += K_V;
  });
  for (std::int64_t item = 0; item < n; ++item) averages.offset[item + 1] += averages.offset[item];
  averages.lane.resize(static_cast<std::size_t>(averages.offset.back()));
  std::vector<std::int64_t> next(averages.offset.begin(), averages.offset.end() - 1);
  CHECK_OP(averages.n_lanes, <=, std::numeric_limits<std::int32_t>::max());
  for_owned_corners(model, [&](std::int64_t item, std::int64_t lane, double) {
    averages.lane[next[item]++] = static_cast<std::int32_t>(lane);
  });
}

}  // namespace

void link_volume_averages(const Mesh& mesh, std::span<const Material> materials, Model& model) {
  if (model.options.tet4 != Formulation::tet4_nodal_pressure) return;
  const std::vector<std::int32_t> field = number_fields(mesh, model.averages);
  set_shares(materials, field, model);
  for (ElementBlocks& blocks : model.blocks) {
    if (!averages_volume(blocks)) continue;
    blocks.field = field[blocks.region];
    blocks.first_lane = model.averages.n_lanes;
    model.averages.n_lanes += std::ssize(blocks.element_local);
  }
  link_lanes(model);
}

void begin_volume_change(const Model& model, const State& state, Scratch& scratch) {
  if (model.averages.n_fields == 0) return;
  const BlockPlace halo = first_with_halo(model);
  for (std::size_t list = 0; list < model.blocks.size() && list <= halo.list; ++list)
    find_volume_change(model, model.blocks[list], 0,
                       list < halo.list ? model.blocks[list].n_blocks : halo.block, state, scratch);
}

void end_volume_change(const Model& model, State& state, Scratch& scratch) {
  const VolumeAverages& averages = model.averages;
  if (averages.n_fields == 0) return;
  CHECK_OP(std::ssize(state.theta), ==, std::int64_t{model.n_local} * averages.n_fields);
  const BlockPlace halo = first_with_halo(model);
  for (std::size_t list = halo.list; list < model.blocks.size(); ++list)
    find_volume_change(model, model.blocks[list], list == halo.list ? halo.block : 0,
                       model.blocks[list].n_blocks, state, scratch);
  const std::int64_t n = std::int64_t{model.n_owned} * averages.n_fields;
  const double* const change = scratch.volume_change.data();
  parallel_for_nodes(n, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t item = begin; item < end; ++item) {
      double sum = 0;
      const std::int32_t* const lane = averages.lane.data() + averages.offset[item];
      const std::int64_t n_lanes = averages.offset[item + 1] - averages.offset[item];
#pragma GCC unroll 4
      for (std::int64_t k = 0; k < n_lanes; ++k) sum += change[lane[k]];
      state.theta[item] = averages.stiffness[item] > 0 ? sum / averages.stiffness[item] : 0;
    }
  });
}

void average_volume_change(const Model& model, State& state, Scratch& scratch) {
  begin_volume_change(model, state, scratch);
  end_volume_change(model, state, scratch);
}

}  // namespace trocar
