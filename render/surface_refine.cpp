// Refinement of a drawn surface: rounder outlines from a coarse simulation mesh.
#include <algorithm>
#include <utility>

#include "render/surface_mesh.h"

namespace trocar {

namespace {

// The middle may leave the chord by at most this part of its length.
constexpr float max_rise = 0.15f;
// Outlines run where the surface is seen at a flatter angle than this cosine.
constexpr float outline_cosine = 0.3f;

// How the middle of an edge rises from the chord so that the curve is normal to both normals.
Vec3f rise(const SurfaceVertex& a, const SurfaceVertex& b) {
  const Vec3f chord = as_vector(b.x) - as_vector(a.x);
  const Vec3f na = as_vector(a.normal), nb = as_vector(b.normal);
  Vec3f r = 0.125f * (chord.dot(nb) * nb - chord.dot(na) * na);
  const float limit = max_rise * chord.norm(), length = r.norm();
  if (length > limit) r *= limit / length;
  return r;
}

// Edges by their two points: the split vertices of a point meet again here.
struct EdgeTable {
  struct Slot {
    std::int64_t key = -1;  // lower point << 32 | higher point
    std::array<std::array<std::uint32_t, 2>, 2>
        end;                              // vertices of the first two sheets that meet here
    std::array<std::uint32_t, 2> middle;  // vertex made for each of them
    int n_sheets = 0;
    bool is_split = false;
  };
  std::vector<Slot> slot;
  std::uint64_t mask;

  explicit EdgeTable(std::size_t n_edges) {
    std::size_t n = 64;
    while (n < 2 * n_edges) n *= 2;
    slot.resize(n);
    mask = n - 1;
  }
  Slot& of(std::int64_t key) {
    std::uint64_t k = static_cast<std::uint64_t>(key) * 0x9E3779B97F4A7C15ull;
    for (k = (k ^ (k >> 29)) & mask; slot[k].key >= 0 && slot[k].key != key; k = (k + 1) & mask) {
    }
    slot[k].key = key;
    return slot[k];
  }
};

struct Refinement {
  const SurfaceMesh& coarse;
  std::vector<float> cosine;  // (n_vertices) between normal and sight; empty: all edges are split
  EdgeTable edges;
  std::uint32_t n_points = 0;
  SurfaceMesh fine;

  Refinement(const SurfaceMesh& mesh, const Vec3* eye)
      : coarse(mesh), edges(mesh.index.size() / 2 + 64) {
    for (const std::uint32_t p : mesh.point) n_points = std::max(n_points, p + 1);
    if (eye != nullptr)
      for (const SurfaceVertex& v : mesh.vertex)
        cosine.push_back(
            as_vector(v.normal).dot((eye->cast<float>() - as_vector(v.x)).normalized()));
    fine.vertex.reserve(3 * mesh.vertex.size());
    fine.vertex = mesh.vertex;
    fine.point = mesh.point;
    fine.index.reserve(4 * mesh.index.size());
  }

  EdgeTable::Slot& edge(std::uint32_t& a, std::uint32_t& b) {
    const auto& point = coarse.point;
    if (point[a] > point[b]) std::swap(a, b);
    return edges.of(static_cast<std::int64_t>(point[a]) << 32 | point[b]);
  }

  bool is_near_outline(std::uint32_t a, std::uint32_t b) const {
    return cosine.empty() || cosine[a] * cosine[b] < 0 ||
           std::min(std::abs(cosine[a]), std::abs(cosine[b])) < outline_cosine;
  }

  void note(std::uint32_t a, std::uint32_t b) {
    EdgeTable::Slot& e = edge(a, b);
    e.is_split = e.is_split || is_near_outline(a, b);
    for (int s = 0; s < e.n_sheets; ++s)
      if (e.end[s][0] == a && e.end[s][1] == b) return;
    if (e.n_sheets == 2) return;  // a third sheet takes the middle of the second
    e.end[e.n_sheets++] = {a, b};
  }

  void make_middles() {
    for (std::size_t k = 0; k < coarse.index.size(); ++k) {
      std::uint32_t a = coarse.index[k], b = coarse.index[k % 3 == 2 ? k - 2 : k + 1];
      EdgeTable::Slot& e = edge(a, b);
      if (e.n_sheets < 0 || !e.is_split) continue;
      Vec3f lift = Vec3f::Zero();
      for (int s = 0; s < e.n_sheets; ++s)
        lift += rise(coarse.vertex[e.end[s][0]], coarse.vertex[e.end[s][1]]);
      lift /= static_cast<float>(e.n_sheets);
      for (int s = 0; s < e.n_sheets; ++s) e.middle[s] = add_middle(e.end[s], lift);
      e.n_sheets = -e.n_sheets;  // made
      ++n_points;
    }
  }

  std::uint32_t add_middle(const std::array<std::uint32_t, 2>& end, const Vec3f& lift) {
    const SurfaceVertex &a = coarse.vertex[end[0]], &b = coarse.vertex[end[1]];
    SurfaceVertex m = a;
    Eigen::Map<Vec3f>(m.x.data()) = 0.5f * (as_vector(a.x) + as_vector(b.x)) + lift;
    Eigen::Map<Vec3f>(m.X.data()) = 0.5f * (as_vector(a.X) + as_vector(b.X));
    const Vec3f n = as_vector(a.normal) + as_vector(b.normal);
    if (n.squaredNorm() > 1e-6f) Eigen::Map<Vec3f>(m.normal.data()) = n.normalized();
    for (std::size_t k = 0; k < m.mark.size(); ++k)
      m.mark[k] = static_cast<std::uint8_t>((a.mark[k] + b.mark[k]) / 2);
    fine.vertex.push_back(m);
    fine.point.push_back(n_points);
    return static_cast<std::uint32_t>(fine.vertex.size() - 1);
  }

  // Of a split edge; -1 else.
  std::int64_t middle(std::uint32_t a, std::uint32_t b) {
    const EdgeTable::Slot& e = edge(a, b);
    if (!e.is_split) return -1;
    const bool is_first = e.end[0][0] == a && e.end[0][1] == b;
    return e.middle[is_first || e.n_sheets == -1 ? 0 : 1];
  }

  void add(std::int64_t a, std::int64_t b, std::int64_t c) {
    for (const std::int64_t v : {a, b, c}) fine.index.push_back(static_cast<std::uint32_t>(v));
  }

  // By the number of its edges that are split; turned until they are the first.
  void add_triangle(std::array<std::int64_t, 3> v, std::array<std::int64_t, 3> m) {
    const auto n_split = std::count_if(m.begin(), m.end(), [](std::int64_t k) { return k >= 0; });
    const bool is_turned = n_split == 1 || n_split == 2;
    while (is_turned && (m[0] < 0 || (n_split == 2 && m[1] < 0))) {
      std::rotate(v.begin(), v.begin() + 1, v.end());
      std::rotate(m.begin(), m.begin() + 1, m.end());
    }
    if (n_split == 0) return add(v[0], v[1], v[2]);
    if (n_split == 1) {
      add(v[0], m[0], v[2]);
      return add(m[0], v[1], v[2]);
    }
    add(m[0], v[1], m[1]);
    if (n_split == 2) {
      add(v[0], m[0], v[2]);
      return add(m[0], m[1], v[2]);
    }
    add(v[0], m[0], m[2]);
    add(m[2], m[1], v[2]);
    add(m[0], m[1], m[2]);
  }
};

}  // namespace

SurfaceMesh refine_surface_mesh(const SurfaceMesh& mesh, const Vec3* eye) {
  Refinement r(mesh, eye);
  for (std::size_t k = 0; k < mesh.index.size(); ++k)
    r.note(mesh.index[k], mesh.index[k % 3 == 2 ? k - 2 : k + 1]);
  r.make_middles();
  for (std::size_t k = 0; k < mesh.index.size(); k += 3) {
    const std::uint32_t a = mesh.index[k], b = mesh.index[k + 1], c = mesh.index[k + 2];
    r.add_triangle({a, b, c}, {r.middle(a, b), r.middle(b, c), r.middle(c, a)});
  }
  return std::move(r.fine);
}

}  // namespace trocar
