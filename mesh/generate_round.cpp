// Balls and cylinders as mapped boxes.
#include <functional>
#include <string>

#include "base/error.h"
#include "base/sort_unique.h"
#include "mesh/box_cells.h"

namespace trocar {

namespace {

// Position of node (i, j, k); all coordinates of the box run from -1 to 1.
using BoxMap = std::function<Vec3(const Vec3& c)>;

// From the square or cube to the disc or ball: x = (1 - s) 0.7 c + s (s / |c|) c with
// s = max |c_i|: concentric squares become rounder towards the outside. For cells about as high as
// wide the mean-ratio quality of Kuhn's tetrahedra stays above 0.6 for any n, and the least
// altitude of all elements above 0.3 of the edge 2 radius / n. Rejected: the radial map alone
// (quality 0.51), and x_i sqrt(1 - …) of Fong 2015, which flattens cells without bound (0.1 at n =
// 32).
Vec3 map_to_ball(const Vec3& c) {
  const double s = c.cwiseAbs().maxCoeff();
  return s > 0 ? Vec3(((1 - s) * 0.7 + s * (s / c.norm())) * c) : c;
}

void check_round(double radius, int n, BoxElements elements) {
  if (!(radius > 0)) throw InputError("the radius of a round mesh must be positive");
  if (n < 2)
    throw InputError("a round mesh needs at least 2 cells across, not " + std::to_string(n));
  // On an edge of the box one of the five has two faces on the round surface: altitude 3 % of the
  // edge at n = 8.
  if (elements == BoxElements::tet4_five)
    throw InputError(
        "round meshes of five tetrahedra a cell have flat elements at the edges of the mapped box; "
        "use "
        "Kuhn's six tetrahedra or hexahedra");
}

double box_coordinate(int i, int n) {
  return static_cast<double>(2 * i - n) / n;
}

// In each half the diagonals run outward, so no tetrahedron has two faces on a rounded edge of the
// box.
unsigned mirror_if_low(int i, int n, unsigned direction) {
  return i < n / 2 ? direction : 0U;
}

void map_nodes(Mesh& mesh, const std::array<int, 3>& n, const BoxMap& map) {
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
        mesh.X.push_back(
            map({box_coordinate(i, n[0]), box_coordinate(j, n[1]), box_coordinate(k, n[2])}));
}

// The union of the first `n_sides` sets, which are sides of the box.
NodeSet joined_sides(const Mesh& mesh, std::size_t n_sides, const std::string& name) {
  NodeSet set{name, {}};
  for (std::size_t s = 0; s < n_sides; ++s)
    set.node.insert(set.node.end(), mesh.node_sets[s].node.begin(), mesh.node_sets[s].node.end());
  sort_unique(set.node);
  return set;
}

}  // namespace

Mesh make_ball(const Vec3& centre, double radius, int n, BoxElements elements) {
  check_round(radius, n, elements);
  check_cells({n, n, n});
  Mesh mesh;
  map_nodes(mesh, {n, n, n}, [&](const Vec3& c) { return Vec3(centre + radius * map_to_ball(c)); });
  add_box_cells(mesh, {n, n, n}, elements, [n](int i, int j, int k) {
    return mirror_if_low(i, n, 1) | mirror_if_low(j, n, 2) | mirror_if_low(k, n, 4);
  });
  mesh.node_sets = {joined_sides(mesh, 6, "surface")};
  return mesh;
}

Mesh make_cylinder(const Vec3& base_centre, double radius, double height, int n, int nz,
                   BoxElements elements) {
  check_round(radius, n, elements);
  check_cells({n, n, nz});
  if (!(height > 0)) throw InputError("the height of a cylinder must be positive");
  Mesh mesh;
  map_nodes(mesh, {n, n, nz}, [&](const Vec3& c) {
    const Vec3 disc = radius * map_to_ball({c.x(), c.y(), 0});
    return Vec3(base_centre + Vec3(disc.x(), disc.y(), height * ((1 + c.z()) / 2)));
  });
  add_box_cells(mesh, {n, n, nz}, elements,
                [n](int i, int j, int) { return mirror_if_low(i, n, 1) | mirror_if_low(j, n, 2); });
  mesh.node_sets = {mesh.node_sets[4], mesh.node_sets[5], joined_sides(mesh, 4, "side")};
  return mesh;
}

}  // namespace trocar
