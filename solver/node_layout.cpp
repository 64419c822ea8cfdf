#include "solver/node_layout.h"

#include <algorithm>
#include <array>
#include <utility>

#include "solver/block_ranges.h"
#include "solver/element_setup.h"
#include "solver/sum_order.h"

namespace trocar {

namespace {

// Of blocks; below it, what has to be added number by number costs more than rows gain.
constexpr double least_share_of_rows = 0.75;

// A run's window in nodes, by those of its widest stride: with 2 in place of 3 a step of a million
// elements takes 3 % longer, with all nodes 6 %; and as many as the second cache holds along with
// the rest.
constexpr std::int32_t strides_of_window = 3, least_window = 4096;

// Where the second of two rows begins, and how many numbers are skipped there.
struct RowEnd {
  int lane = 0;
  std::int32_t skip = 0;
};

// Whether n numbers follow each other so.
bool follow_each_other(const std::int32_t* number, int n, const RowEnd& end) {
  for (int lane = 1; lane < n; ++lane)
    if (number[lane] != number[0] + lane + (lane >= end.lane ? end.skip : 0)) return false;
  return true;
}

// Whether kernels, which add corners in the order of box_row, give each node its elements' forces
// in the order of the lanes; start: the first lane's node at each corner. Behind the nodes, a place
// gets one force.
bool keeps_order(const std::array<std::int32_t, 8>& start, int n_lanes, const RowEnd& end) {
  for (int k = 0; k < 8; ++k)
    for (int l = k + 1; l < 8; ++l) {
      const std::int32_t ahead =
          start[corner_of_row(box_row, l)] - start[corner_of_row(box_row, k)];
      if (0 < ahead && ahead < n_lanes) return false;
      if (0 < ahead - end.skip && ahead - end.skip < n_lanes) return false;
    }
  return true;
}

// [block][corner] The first lane of numbers_of(block) [corner][lane].
template <class Numbers>
std::vector<std::int32_t> first_lanes(const ElementBlocks& blocks, const Numbers& numbers_of) {
  const std::int64_t n = corners_of_block(blocks);
  std::vector<std::int32_t> first;
  first.reserve(static_cast<std::size_t>(blocks.n_blocks * n / blocks.lanes));
  for (std::int64_t block = 0; block < blocks.n_blocks; ++block)
    for (std::int64_t k = 0; k < n; k += blocks.lanes) first.push_back(numbers_of(block)[k]);
  return first;
}

std::uint32_t row_break_of(const ElementBlocks& blocks, std::int64_t block) {
  const int n = blocks.lanes;
  const std::int32_t* const node = &blocks.corner[block * corners_of_block(blocks)];
  const std::int32_t* const target = targets(blocks, block);
  RowEnd end{.lane = 1};
  while (end.lane < n && node[end.lane] == node[0] + end.lane) ++end.lane;
  if (end.lane < n) end.skip = node[end.lane] - node[0] - end.lane;
  if (end.skip < 0 || std::cmp_greater(end.skip, max_skip)) return 0;
  std::array<std::int32_t, 8> start{};
  unsigned unpaired = 0;
  for (int a = 0; a < 8; ++a) {
    if (!follow_each_other(node + a * n, n, end)) return 0;
    start[a] = node[a * n];
  }
  if (!keeps_order(start, n, end)) return 0;
  const auto follow = [&](const std::int32_t* at) {
    return target == node || follow_each_other(at, n, end);
  };
  for (int pair = 0; pair < 4; ++pair) {
    const std::int32_t* const at = target + corner_of_row(box_row, 2 * pair) * n;
    const std::int32_t* const beside = target + corner_of_row(box_row, 2 * pair + 1) * n;
    if (at[0] != beside[0] + 1 || !follow(at) || !follow(beside)) unpaired |= 1U << pair;
  }
  return row_break(end.lane, unpaired, static_cast<std::uint32_t>(end.skip));
}

// Finds rows of all lists; returns whether most blocks stand in them.
bool find_rows_of_box(Model& model) {
  std::int64_t n = 0, n_rows = 0;
  for (ElementBlocks& blocks : model.blocks) {
    n += blocks.n_blocks;
    blocks.row_break.assign(static_cast<std::size_t>(blocks.n_blocks), 0);
    if (shape_of(blocks.formulation) != ElementType::hex8) continue;
    for (std::int64_t block = 0; block < blocks.n_blocks; ++block)
      n_rows += (blocks.row_break[block] = row_break_of(blocks, block)) > 0 ? 1 : 0;
  }
  return static_cast<double>(n_rows) > least_share_of_rows * static_cast<double>(n);
}

// Below, registers of two doubles take no rows (hexahedra 64 ns by component, 53 node by node), and
// of four floats gain nothing.
bool has_wide_registers() {
  return active_simd() >= Simd::avx2;
}

NodeRange united(const NodeRange& a, const NodeRange& b) {
  if (a.begin == a.end) return b;
  if (b.begin == b.end) return a;
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

StrideNodes united(const StrideNodes& a, const StrideNodes& b) {
  return {united(a.own, b.own), united(a.halo, b.halo)};
}

// Calls body(first, last) for nodes of a block that follow each other: those of a corner in a row.
template <class Body>
void for_node_runs(const ElementBlocks& blocks, std::int64_t block, const Body& body) {
  const std::int64_t n = corners_of_block(blocks);
  const std::uint32_t row = blocks.row_break[block];
  for (std::int64_t corner = block * n; corner < (block + 1) * n; corner += blocks.lanes) {
    const std::int32_t* const node = &blocks.corner[corner];
    for (int lane = 0, end = 0; lane < blocks.lanes; lane = end) {
      end = row == 0 ? lane + 1 : lane == 0 ? lane_of_break(row) : blocks.lanes;
      body(node[lane], node[end - 1]);
    }
  }
}

StrideNodes nodes_of_blocks(const Model& model, std::int64_t begin, std::int64_t end) {
  StrideNodes nodes;
  const auto add = [&](std::int32_t first, std::int32_t last) {  // halo nodes may begin within
    if (first < model.n_owned)
      nodes.own = united(nodes.own, {first, std::min(last + 1, model.n_owned)});
    if (last >= model.n_owned)
      nodes.halo = united(nodes.halo, {std::max(first, model.n_owned), last + 1});
  };
  for_block_range(model, begin, end,
                  [&](const ElementBlocks& blocks, std::int64_t first, std::int64_t n) {
                    for (std::int64_t block = first; block < first + n; ++block)
                      for_node_runs(blocks, block, add);
                  });
  if (nodes.own.end < nodes.halo.begin || nodes.halo == NodeRange{}) return nodes;
  return {united(nodes.own, nodes.halo), {}};
}

// Finds the nodes of all strides; returns those of their runs.
std::vector<StrideNodes> find_stride_nodes(Model& model) {
  SumOrder& sums = model.sums;
  std::vector<StrideNodes> run_nodes;
  for (std::int32_t run = 0; run < sums.n_runs; ++run) {
    StrideNodes of_run;
    for (std::int64_t block = sums.run_block[run]; block < sums.run_block[run + 1];
         block += stride_blocks) {
      const std::int64_t end = std::min(block + stride_blocks, sums.run_block[run + 1]);
      sums.stride_nodes.push_back(nodes_of_blocks(model, block, end));
      of_run = united(of_run, sums.stride_nodes.back());
    }
    run_nodes.push_back(of_run);
  }
  return run_nodes;
}

bool is_read_by_another(std::int32_t node, std::int32_t run,
                        const std::vector<StrideNodes>& run_nodes) {
  for (std::int32_t other = 0; other < std::ssize(run_nodes); ++other)
    if (other != run && run_nodes[other].own.begin <= node && node < run_nodes[other].own.end)
      return true;
  return false;
}

// Nodes that one run alone meets and that lie in the range of another one, which reads but never
// uses them, are finished with those that several meet, if they are few; returns whether they are.
bool share_nodes_of_others(const std::vector<StrideNodes>& run_nodes, SumOrder& sums) {
  if (sums.n_runs < 2) return true;
  constexpr std::size_t most = 8;  // one of so many
  std::vector<std::int32_t> own, first = {0}, read;
  for (std::int32_t run = 0; run < sums.n_runs; ++run)
    for (std::int32_t stride = sums.run_stride[run]; stride < sums.run_stride[run + 1]; ++stride) {
      for (std::int32_t k = sums.stride_first[stride]; k < sums.stride_first[stride + 1]; ++k)
        (is_read_by_another(sums.node[k], run, run_nodes) ? read : own).push_back(sums.node[k]);
      first.push_back(static_cast<std::int32_t>(own.size()));
    }
  if (most * read.size() > own.size()) return false;
  sums.node = std::move(own);
  sums.stride_first = std::move(first);
  sums.shared_node.insert(sums.shared_node.end(), read.begin(), read.end());
  std::sort(sums.shared_node.begin(), sums.shared_node.end());
  return true;
}

// Windows do not slide where halo nodes lie far behind the others.
void place_windows(const std::vector<StrideNodes>& run_nodes, SumOrder& sums) {
  std::int64_t at = 0;
  for (std::int32_t run = 0; run < sums.n_runs; ++run) {
    const auto& [own, halo] = run_nodes[run];
    const bool slides = halo == NodeRange{};
    std::int32_t n = std::max(own.end, halo.end) - own.begin, widest = 0;
    for (std::int32_t stride = sums.run_stride[run]; stride < sums.run_stride[run + 1]; ++stride) {
      const NodeRange& of_stride = sums.stride_nodes[stride].own;
      widest = std::max(widest, of_stride.end - of_stride.begin);
    }
    if (slides) n = std::min(n, std::max(least_window, strides_of_window * widest));
    sums.window.push_back({at, slides ? ComponentWindow::slides : own.begin});
    at += 3 * component_stride(n);
  }
  sums.window.push_back({at});
}

// Whether the edges xi, eta, zeta of a hexahedron lie along x, y, z, to the bit.
bool is_aligned_box(std::span<const Vec3> X, const Part& part, const std::int32_t* node,
                    std::int64_t lanes) {
  const auto at = [&](int a) -> const Vec3& { return X[part.node_global[node[a * lanes]]]; };
  const Vec3 &low = at(0), &high = at(6);
  for (int a = 1; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      if (at(a)[i] != (hex_corner_xi[a][i] < 0 ? low : high)[i]) return false;
  return true;
}

bool has_aligned_lanes(std::span<const Vec3> X, const Part& part, const ElementBlocks& blocks,
                       std::int64_t block) {
  const std::int32_t* const node = &blocks.corner[block * corners_of_block(blocks)];
  for (std::int64_t lane = 0; lane < blocks.lanes; ++lane)
    if (!is_aligned_box(X, part, node + lane, blocks.lanes)) return false;
  return true;
}

}  // namespace

void mark_aligned(const Mesh& mesh, const Part& part, Model& model) {
  for (ElementBlocks& blocks : model.blocks) {
    parallel_for(std::ssize(blocks.row_break), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t block = begin; block < end; ++block) {
        std::uint32_t& row = blocks.row_break[block];
        row &= ~aligned_bit;
        if (row != 0 && has_aligned_lanes(mesh.X, part, blocks, block)) row |= aligned_bit;
      }
    });
    blocks.n_aligned = static_cast<std::int32_t>(
        std::ranges::count_if(blocks.row_break, [](std::uint32_t row) { return is_aligned(row); }));
  }
}

void lay_out_nodes(Model& model) {
  SumOrder& sums = model.sums;
  sums.stride_nodes.clear();
  sums.window.clear();
  model.is_by_component = has_wide_registers() && find_rows_of_box(model);
  if (model.is_by_component) {
    const std::vector<StrideNodes> run_nodes = find_stride_nodes(model);
    model.is_by_component = share_nodes_of_others(run_nodes, sums);
    if (model.is_by_component) place_windows(run_nodes, sums);
  }
  if (!model.is_by_component) sums.stride_nodes.clear();
  for (ElementBlocks& blocks : model.blocks)
    if (model.is_by_component) {
      blocks.row_start = first_lanes(blocks, [&](std::int64_t block) {
        return blocks.corner.data() + block * corners_of_block(blocks);
      });
      blocks.row_target.clear();
      if (!blocks.target.empty())
        blocks.row_target =
            first_lanes(blocks, [&](std::int64_t block) { return targets(blocks, block); });
    } else {
      blocks.row_break = std::vector<std::uint32_t>();
      blocks.row_start = blocks.row_target = std::vector<std::int32_t>();
    }
}

}  // namespace trocar
