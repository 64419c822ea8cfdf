// How kernels may reach the nodes of eight lanes. Elements that stand in a row of a regular
// numbering: at each corner, the nodes and places of the lanes follow each other, so that whole
// registers are loaded and added in place of single nodes. Corners are then added with the last
// node first: two corners meet the same node in different lanes only, the one that starts further
// ahead in the earlier lane, so that every node still gets its elements' forces in the order of the
// lanes.
#pragma once

#include <cstdint>

namespace trocar {

inline constexpr int row_lanes = 8;

// Of a row, corners in the order of adding, four bits each, the first one lowest. Of others:
// nodes stand anywhere; and the last node, behind which nothing may be read, is among them.
inline constexpr std::uint32_t no_row = ~std::uint32_t{0}, no_row_at_end = no_row - 1;

constexpr bool is_row(std::uint32_t row) {
  return row < no_row_at_end;
}

// Of hexahedra of a box whose nodes are numbered along xi first, then eta, then zeta.
inline constexpr std::uint32_t box_row = 0x01324576;

// ElementBlocks::row_break (node_layout.h): the lane, a bit for each pair of corners of box_row
// whose places do not follow each other, whether all lanes are boxes along the axes, and how many
// nodes are skipped (at most max_skip).
inline constexpr std::uint32_t max_skip = 0xFFFF, aligned_bit = 1U << 15;
constexpr std::uint32_t row_break(int lane, unsigned unpaired, std::uint32_t skip) {
  return static_cast<std::uint32_t>(lane) | unpaired << 8 | skip << 16;
}
constexpr int lane_of_break(std::uint32_t row_break) {
  return static_cast<int>(row_break & 0xFF);
}
constexpr unsigned unpaired_of_break(std::uint32_t row_break) {
  return row_break >> 8 & 0xF;
}
constexpr bool is_aligned(std::uint32_t row_break) {
  return (row_break & aligned_bit) != 0;
}
constexpr int skip_of_break(std::uint32_t row_break) {
  return static_cast<int>(row_break >> 16);
}

constexpr int corner_of_row(std::uint32_t row, int k) {
  return static_cast<int>(row >> (4 * k) & 15U);
}

}  // namespace trocar
