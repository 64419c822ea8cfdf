// Slices of tissue one element thick: on one side of the blade no element is whole, and the edges
// that it crosses lead from outer surface to outer surface, where elements reach from one face of
// the body to the other: no node can be displaced to in between. They are left alone until the
// stroke has gone through, and get nodes on these edges then.
#pragma once

#include <cstdint>
#include <vector>

#include "cutting/cut_label.h"
#include "cutting/cut_surroundings.h"
#include "mesh/edit.h"

namespace trocar {

struct ThinSlice {
  int side = 0;                      // +1 or -1
  std::vector<std::int32_t> node{};  // of the patch, on that side: none of their elements is whole
  std::vector<std::int32_t> rim{};   // nodes behind which thicker tissue of that side begins
  std::vector<EdgeNode> crossing{};  // of the edges at all of these, global
  double V = 0;  // what lies on that side around nodes that are not next to thicker tissue [m^3]
};
std::vector<ThinSlice> thin_slices(const Mesh& mesh, const CutSurroundings& around,
                                   const CutStroke& stroke);

// Elements around the slices are not to be parted yet, nor to get sides that stay.
void leave_slices(const CutPatch& patch, const std::vector<ThinSlice>& slices, CutLabels& labels);

// Nodes for the crossed edges of all slices that are no chips, ascending by ends: at the crossing
// or nearer to the middle of the edge, so that no part of an element of the patch gets a lower step
// bound than `floor` [m]. Edges on which no node can keep it get none.
std::vector<EdgeNode> nodes_in_slices(const Mesh& mesh, const CutSurroundings& around,
                                      const std::vector<ThinSlice>& slices, double floor);

}  // namespace trocar
