#include "render/surface_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/grouped.h"

namespace trocar {

namespace {

// Farther from the origin than this, single precision draws nothing useful. [m]
constexpr double far_away = 1e6;
constexpr std::uint8_t full = 255;
constexpr int cut_smoothing_passes = 2;

bool is_drawable(const Vec3& p) {
  return std::abs(p.x()) < far_away && std::abs(p.y()) < far_away && std::abs(p.z()) < far_away;
}

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// The triangles that can be drawn, with their normals.
struct Faces {
  std::vector<std::array<std::int32_t, 3>> node;
  std::vector<std::uint8_t> is_cut;
  std::vector<std::array<float, 3>> colour;
  std::vector<Vec3> normal;            // present, as long as twice the area
  std::vector<Vec3> reference_normal;  // unit, or zero if flat
};

Faces drawable_faces(const SurfaceShape& shape) {
  CHECK_OP(shape.x.size(), ==, shape.X.size());
  CHECK(shape.is_cut.empty() || shape.is_cut.size() == shape.triangle.size());
  CHECK(shape.colour.empty() || shape.colour.size() == shape.triangle.size());
  const auto n_nodes = static_cast<std::int32_t>(shape.x.size());
  Faces faces;
  faces.node.reserve(shape.triangle.size());
  for (std::size_t t = 0; t < shape.triangle.size(); ++t) {
    bool is_kept = true;
    for (const std::int32_t i : shape.triangle[t]) {
      CHECK(i >= 0 && i < n_nodes);
      is_kept = is_kept && is_drawable(shape.x[i]) && is_drawable(shape.X[i]);
    }
    if (!is_kept) continue;
    const auto [i, j, k] = shape.triangle[t];
    faces.node.push_back(shape.triangle[t]);
    faces.is_cut.push_back(shape.is_cut.empty() ? 0 : shape.is_cut[t] != 0);
    faces.colour.push_back(to_float(shape.colour.empty() ? Vec3::Zero() : shape.colour[t]));
    faces.normal.push_back((shape.x[j] - shape.x[i]).cross(shape.x[k] - shape.x[i]));
    faces.reference_normal.push_back(
        (shape.X[j] - shape.X[i]).cross(shape.X[k] - shape.X[i]).stableNormalized());
  }
  return faces;
}

// Corners (3 * face + corner) around each node, ascending.
Grouped<> corners_at_nodes(const Faces& faces, std::size_t n_nodes) {
  return group_items(n_nodes, [&](const auto& put) {
    for (std::size_t t = 0; t < faces.node.size(); ++t)
      for (int c = 0; c < 3; ++c) put(faces.node[t][c], static_cast<std::int32_t>(3 * t) + c);
  });
}

// Cut faces are torn by the mesh; a crease there is noise.
bool is_same_sheet(const Faces& faces, std::int32_t a, std::int32_t b, double crease_cosine) {
  if (faces.is_cut[a] != faces.is_cut[b]) return false;
  return a == b || faces.is_cut[a] ||
         faces.reference_normal[a].dot(faces.reference_normal[b]) >= crease_cosine;
}

Vec3 unit_or_up(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3::UnitZ();
}

// The vertices of one node: corners whose sheets are the same share one.
void add_node_vertices(const SurfaceShape& shape, const Faces& faces, std::int32_t node,
                       std::span<const std::int32_t> corners, SurfaceMesh& mesh) {
  const std::size_t first = mesh.vertex.size();
  const auto is_cut = [&](std::int32_t corner) { return faces.is_cut[corner / 3] != 0; };
  const bool is_rim = std::any_of(corners.begin(), corners.end(), is_cut) &&
                      !std::all_of(corners.begin(), corners.end(), is_cut);
  for (const std::int32_t corner : corners) {
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t other : corners)
      if (is_same_sheet(faces, corner / 3, other / 3, shape.crease_cosine))
        sum += faces.normal[other / 3];
    const SurfaceVertex vertex{
        .x = to_float(shape.x[node]),
        .X = to_float(shape.X[node]),
        .normal = to_float(unit_or_up(sum)),
        .colour = faces.colour[corner / 3],
        .edge = {full, full, full, full},
        .mark = {is_cut(corner) ? full : std::uint8_t{0}, is_rim ? full : std::uint8_t{0}, 0, 0}};
    std::size_t v = first;
    while (v < mesh.vertex.size() &&
           (mesh.vertex[v].normal != vertex.normal || mesh.vertex[v].mark != vertex.mark ||
            mesh.vertex[v].colour != vertex.colour))
      ++v;
    if (v == mesh.vertex.size()) {
      mesh.vertex.push_back(vertex);
      mesh.point.push_back(static_cast<std::uint32_t>(node));
    }
    mesh.index[corner] = static_cast<std::uint32_t>(v);
  }
}

// Averages the normals of cut faces with their neighbours': a cut follows element faces, and their
// zigzag would glitter. Cut faces that meet at one of the n_nodes have one normal there.
void smooth_cut_normals(SurfaceMesh& mesh, std::size_t n_nodes) {
  std::vector<Vec3f> sum(n_nodes, Vec3f::Zero());
  for (std::size_t k = 0; k < mesh.index.size(); k += 3) {
    const std::uint32_t* v = &mesh.index[k];
    if (mesh.vertex[v[0]].mark[0] == 0) continue;
    for (int c = 0; c < 3; ++c)
      sum[mesh.point[v[c]]] += as_vector(mesh.vertex[v[(c + 1) % 3]].normal) +
                               as_vector(mesh.vertex[v[(c + 2) % 3]].normal);
  }
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    if (mesh.vertex[v].mark[0] == 0) continue;
    const Vec3f n = sum[mesh.point[v]] + 4.0f * as_vector(mesh.vertex[v].normal);
    if (n.squaredNorm() > 1e-6f) Eigen::Map<Vec3f>(mesh.vertex[v].normal.data()) = n.normalized();
  }
}

}  // namespace

SurfaceMesh make_surface_mesh(const SurfaceShape& shape) {
  const Faces faces = drawable_faces(shape);
  const Grouped<> around = corners_at_nodes(faces, shape.x.size());
  SurfaceMesh mesh;
  mesh.index.resize(around.item.size());
  mesh.vertex.reserve(faces.node.size());
  for (std::int32_t i = 0; i < std::ssize(shape.x); ++i)
    add_node_vertices(shape, faces, i, around.of(i), mesh);
  if (std::find(faces.is_cut.begin(), faces.is_cut.end(), 1) != faces.is_cut.end())
    for (int pass = 0; pass < cut_smoothing_passes; ++pass)
      smooth_cut_normals(mesh, shape.x.size());
  return mesh;
}

SurfaceMesh mark_edges(const SurfaceMesh& mesh, std::span<const std::uint8_t> is_quad_half) {
  const std::size_t n = mesh.index.size() / 3;
  std::vector<int> diagonal(n, -1);  // the corner across, -1: none
  if (is_quad_half.size() == n)      // no triangle was dropped
    for (std::size_t t = 0; t < n; ++t)
      if (is_quad_half[t] != 0) diagonal[t] = t > 0 && diagonal[t - 1] == 1 ? 2 : 1;
  SurfaceMesh marked;
  marked.vertex.reserve(mesh.index.size());
  for (std::size_t k = 0; k < mesh.index.size(); ++k) {
    SurfaceVertex vertex = mesh.vertex[mesh.index[k]];
    const std::size_t c = k % 3;
    vertex.edge = {0, 0, 0, full};
    vertex.edge[c] = full;
    if (diagonal[k / 3] >= 0) vertex.edge[diagonal[k / 3]] = full;
    marked.vertex.push_back(vertex);
    marked.point.push_back(mesh.point[mesh.index[k]]);
    marked.index.push_back(static_cast<std::uint32_t>(k));
  }
  return marked;
}

}  // namespace trocar
