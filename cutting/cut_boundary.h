// Along what a node may be moved: freely inside the body, along its outer surface or the interface
// between two regions, along a sharp edge, the line where an interface meets the outer surface or
// another one, or the border of an area of the surface, or not at all.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/cut_patch.h"
#include "cutting/cut_stroke.h"

namespace trocar {

enum class NodeFreedom : std::uint8_t { fixed, edge, surface, free };

// The outer surface or interface around a node as it was before the move: triangles or, on an edge,
// segments (last two points equal).
struct NodeBoundary {
  NodeFreedom freedom = NodeFreedom::free;
  Vec3 direction = Vec3::Zero();  // unit; surface: mean normal; edge: tangent
  std::vector<std::array<Vec3, 3>> piece;
  bool is_interface = false;  // lies between regions, perhaps on an edge or the outer surface, too
};

// Facets that this stroke opened are no outer surface: the node lies on them, between two halves
// that move together. Facets of older cuts are; their rims inside the body stay fixed.
NodeBoundary node_boundary(const CutPatch& patch, const CutStroke& stroke,
                           std::span<const std::uint8_t> cut_facets, std::int32_t i);

// Unit normals, outward, of the outer facets at node i that no cut has opened.
std::vector<Vec3> outer_normals(const CutPatch& patch, const CutStroke& stroke,
                                std::span<const std::uint8_t> cut_facets, std::int32_t i);

// The nearest allowed position.
Vec3 project_to_boundary(const NodeBoundary& boundary, const Vec3& X);
// Part of a displacement that is allowed to first order.
Vec3 allowed_part(const NodeBoundary& boundary, const Vec3& displacement);

}  // namespace trocar
