// All that two models hold, bit for bit.
#pragma once

#include <gtest/gtest.h>

#include "solver/model.h"

namespace trocar {

inline void expect_equal(std::span<const PronyBranch> a, std::span<const PronyBranch> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].share, b[k].share);
    EXPECT_EQ(a[k].time, b[k].time);
  }
}

inline void expect_equal(const ElementBlocks& a, const ElementBlocks& b) {
  EXPECT_EQ(a.formulation, b.formulation);
  EXPECT_EQ(a.precision, b.precision);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.stiffening_at_rest, b.stiffening_at_rest);
  EXPECT_EQ(a.n_elements, b.n_elements);
  EXPECT_EQ(a.n_blocks, b.n_blocks);
  EXPECT_EQ(a.lanes, b.lanes);
  EXPECT_EQ(a.element_local, b.element_local);
  EXPECT_EQ(a.corner, b.corner);
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.target_block, b.target_block);
  EXPECT_EQ(a.row, b.row);
  EXPECT_EQ(a.row_break, b.row_break);
  EXPECT_EQ(a.n_aligned, b.n_aligned);
  EXPECT_EQ(a.row_start, b.row_start);
  EXPECT_EQ(a.row_target, b.row_target);
  EXPECT_TRUE(a.data == b.data);
  EXPECT_TRUE(a.data_single == b.data_single);
  expect_equal(a.prony, b.prony);
  EXPECT_EQ(a.first_history, b.first_history);
  EXPECT_EQ(a.field, b.field);
  EXPECT_EQ(a.first_lane, b.first_lane);
}

inline void expect_equal(const SumOrder& a, const SumOrder& b) {
  EXPECT_EQ(a.n_runs, b.n_runs);
  EXPECT_EQ(a.halo_block, b.halo_block);
  EXPECT_EQ(a.n_strides_before_halo, b.n_strides_before_halo);
  EXPECT_EQ(a.run_block, b.run_block);
  EXPECT_EQ(a.n_places, b.n_places);
  EXPECT_EQ(a.node, b.node);
  EXPECT_EQ(a.stride_first, b.stride_first);
  EXPECT_EQ(a.shared_node, b.shared_node);
  EXPECT_EQ(a.place_node, b.place_node);
  EXPECT_EQ(a.n_slots, b.n_slots);
  EXPECT_EQ(a.slot_first, b.slot_first);
  EXPECT_EQ(a.place_block, b.place_block);
  EXPECT_EQ(a.window, b.window);
  EXPECT_EQ(a.stride_nodes, b.stride_nodes);
  EXPECT_EQ(a.run_stride, b.run_stride);
}

inline void expect_equal(const VolumeAverages& a, const VolumeAverages& b) {
  EXPECT_EQ(a.n_fields, b.n_fields);
  EXPECT_EQ(a.n_lanes, b.n_lanes);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.lane, b.lane);
  EXPECT_EQ(a.stiffness, b.stiffness);
  EXPECT_EQ(a.share, b.share);
}

inline void expect_equal(const MassClusters& a, const MassClusters& b) {
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.node, b.node);
  EXPECT_EQ(a.added, b.added);
  EXPECT_EQ(a.total, b.total);
  EXPECT_EQ(a.of_node, b.of_node);
}

inline void expect_equal(const Model& a, const Model& b) {
  EXPECT_EQ(a.n_local, b.n_local);
  EXPECT_EQ(a.n_owned, b.n_owned);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.inertia, b.inertia);
  expect_equal(a.clusters, b.clusters);
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.is_by_component, b.is_by_component);
  EXPECT_TRUE(a.position == b.position);
  EXPECT_EQ(a.element_step, b.element_step);
  EXPECT_EQ(a.n_history, b.n_history);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t k = 0; k < a.blocks.size(); ++k) expect_equal(a.blocks[k], b.blocks[k]);
  expect_equal(a.sums, b.sums);
  expect_equal(a.averages, b.averages);
}

}  // namespace trocar
