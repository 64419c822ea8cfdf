// Plane meshes and cuts that several tests of the plane cut share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

#include "cutting/cut_plane.h"
#include "cutting/cut_plane_paper.h"
#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh/quality.h"
#include "mesh_fixtures.h"
#include "mesh_pieces.h"

namespace trocar {

inline constexpr double mm = 1e-3;

std::vector<std::uint8_t> none_held(const Mesh& mesh);

PlaneCut cut(const Mesh& mesh, const std::vector<Vec3>& path, std::int32_t tip = -1,
             bool is_robust = true);

Mesh applied(const MeshEdit& edit, Mesh mesh);

double least_altitude(const Mesh& mesh);

// Every boundary edge runs from a node to the next, one in and one out a node.
bool has_closed_boundary(const Mesh& mesh);

// Number of element sides that are marked as opened, and whether each is a boundary edge now.
int n_marked_sides(const Mesh& mesh, bool& are_on_boundary);

}  // namespace trocar
