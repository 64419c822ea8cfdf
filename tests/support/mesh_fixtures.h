// Meshes that several tests of mesh/ look at, and the checks of closed surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/element_boxes.h"
#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh/mesh.h"

namespace trocar {

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

Mesh single_element(ElementType type, const std::vector<Vec3>& X);

const std::vector<Vec3>& unit_cube_corners();

// Half hexahedra, half tetrahedra on the same nodes, three materials that alternate: every list
// occurs, and elements of different lists meet at most nodes. 8 x 4 x 4 cells, n times finer.
Mesh mixed_mesh(int n = 1);

// A block of 30 mm with one layer of cells a sixteenth as thick. 10 x 3 x 3 cells, n times finer.
Mesh with_thin_layer(BoxElements elements, int n = 1);

// One of each kind of generated volume mesh.
std::vector<NamedMesh> volume_meshes();

std::vector<NamedMesh> plane_meshes();

std::vector<NamedMesh> all_meshes();

// Moves interior nodes by up to `amount` of the local edge length (deterministic in `seed`); never
// inverts.
void jitter(Mesh& mesh, double amount, unsigned seed);

// Largest component of the ways of nodes between the boxes' positions and x. [m]
double largest_way(std::span<const Vec3> x, const ElementBoxes& boxes);

double total_volume(const Mesh& mesh);

// With density 1 but for the elements' factors.
double total_mass(const Mesh& mesh);

using Triangles = std::vector<std::array<std::int32_t, 3>>;

// Each edge is run through once in each direction: closed, and consistently oriented.
bool is_closed(const Triangles& triangles);

// Vertices - edges + faces; 2 for a sphere.
int euler_characteristic(const Triangles& triangles);
// Of the surface.
int euler_characteristic(const Mesh& mesh);

// By the divergence theorem, seen from a vertex to keep cancellation small; positive if the
// triangles look outward.
double enclosed_volume(const Triangles& triangles, const std::vector<Vec3>& X);

}  // namespace trocar
