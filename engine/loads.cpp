#include "engine/loads.h"

#include <algorithm>
#include <utility>

#include "base/sort_unique.h"

namespace trocar {

namespace {

int size_of(const LoadFace& face) {
  return static_cast<int>(std::count_if(face.begin(), face.end(), [](auto i) { return i >= 0; }));
}

std::vector<LoadFace> outer_edges(const Mesh& mesh) {
  const FacetNeighbours across = facet_neighbours(mesh);
  std::vector<LoadFace> edges;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if (across.of(e, f) >= 0 || (mesh.cut_facets[e] >> f & 1) != 0) continue;
      const std::array<int, 4> corner = facet_corners(ElementType::tri3, f);
      edges.push_back({mesh.corners(e)[corner[0]], mesh.corners(e)[corner[1]], -1, -1});
    }
  return edges;
}

// The two halves of a quad are one face again.
std::vector<LoadFace> outer_faces(const Surface& surface) {
  std::vector<LoadFace> faces;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const auto& [a, b, c] = surface.triangle[t];
    LoadFace face = {a, b, c, -1};
    if (surface.is_quad_half[t] != 0) face[3] = surface.triangle[++t][2];
    if (surface.is_cut[t] == 0) faces.push_back(face);
  }
  return faces;
}

// Each node's part of the face, outward and as long as its area [m^2]: the integral of the node's
// shape function times the normal. Equal parts of a face that is no parallelogram would turn the
// body. x(node) is a position.
template <class Positions>
std::array<Vec3, 4> area_vectors(const LoadFace& face, double thickness, const Positions& x) {
  const Vec3 a = x(face[0]), b = x(face[1]);
  std::array<Vec3, 4> parts{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  if (face[2] < 0) {
    std::fill_n(parts.begin(), 2, thickness / 2 * Vec3(b.y() - a.y(), a.x() - b.x(), 0));
    return parts;
  }
  const Vec3 c = x(face[2]);
  if (face[3] < 0) {
    std::fill_n(parts.begin(), 3, (b - a).cross(c - a) / 6);
    return parts;
  }
  // The bilinear face m + along xi + up eta + twist xi eta.
  const Vec3 d = x(face[3]), along = (b + c - a - d) / 4, up = (c + d - a - b) / 4,
             twist = (a + c - b - d) / 4;
  const Vec3 whole = along.cross(up), by_xi = along.cross(twist) / 3, by_eta = twist.cross(up) / 3;
  return {whole - by_xi - by_eta, whole + by_xi - by_eta, whole + by_xi + by_eta,
          whole - by_xi + by_eta};
}

// (n_nodes) the part of a whole force that acts at each.
std::vector<double> parts_of(const Mesh& mesh, const NodeSet& region,
                             std::span<const LoadFace> faces) {
  std::vector<double> part(mesh.X.size(), 0.0);
  double sum = 0;
  for (const LoadFace& face : faces) {
    const std::array<Vec3, 4> areas =
        area_vectors(face, 1, [&](std::int32_t i) { return mesh.X[i]; });
    const Vec3 area = areas[0] + areas[1] + areas[2] + areas[3];
    sum += area.norm();
    for (int k = 0; k < size_of(face); ++k) part[face[k]] += areas[k].dot(area.normalized());
  }
  if (!(sum > 0)) {
    for (const std::int32_t node : region.node) part[node] = 1;
    sum = static_cast<double>(region.node.size());
  }
  for (double& value : part) value /= sum;
  return part;
}

// Gives each owned node that a load acts on its place in Loads::node.
struct Placing {
  const Part& part;
  Loads& loads;
  std::vector<std::int32_t> of_node = std::vector<std::int32_t>(part.n_owned, -1);

  // -1 for nodes of other ranks and for none.
  std::int32_t operator()(std::int32_t node) {
    const std::int32_t local = node < 0 ? -1 : part.owned(node);
    if (local < 0) return -1;
    if (of_node[local] < 0) {
      of_node[local] = static_cast<std::int32_t>(loads.node.size());
      loads.node.push_back(local);
    }
    return of_node[local];
  }
};

void take_force(std::int32_t load, const Mesh& mesh, const NodeSet& region,
                std::span<const LoadFace> faces, Placing& placing) {
  const std::vector<double> parts = parts_of(mesh, region, faces);
  for (const std::int32_t node : region.node) {
    const std::int32_t place = parts[node] != 0 ? placing(node) : -1;
    if (place >= 0)
      placing.loads.shares.push_back({.load = load, .place = place, .part = parts[node]});
  }
}

// (faces.size()) Of edges in the plane, ascending; -1 of other faces.
std::vector<std::int32_t> elements_of(const Mesh& mesh, std::span<const LoadFace> faces) {
  std::vector<std::int32_t> element(faces.size(), -1);
  if (mesh.dimension() == 3) return element;
  std::size_t k = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3 && k < faces.size(); ++f) {
      const std::array<int, 4> corner = facet_corners(ElementType::tri3, f);
      if (mesh.corners(e)[corner[0]] == faces[k][0] && mesh.corners(e)[corner[1]] == faces[k][1])
        element[k++] = e;
    }
  return element;
}

void take_pressure(std::int32_t load, const Mesh& mesh, std::span<const LoadFace> faces,
                   Placing& placing) {
  const std::vector<std::int32_t> element = elements_of(mesh, faces);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const LoadFace& face = faces[k];
    Loads::Face local = {.load = load, .node = {-1, -1, -1, -1}, .place = {}};
    if (element[k] >= 0)
      local.element = static_cast<std::int32_t>(placing.part.place_of(element[k]));
    for (std::size_t j = 0; j < 4; ++j) {
      local.place[j] = placing(face[j]);
      if (face[j] >= 0) local.node[j] = placing.part.node_local[face[j]];
    }
    if (std::any_of(local.place.begin(), local.place.end(), [](auto i) { return i >= 0; }))
      placing.loads.faces.push_back(local);
  }
}

// Of all faces, sorted; of plane ones their ends, each as an edge from itself to itself.
std::vector<BorderEdge> edges_of(std::span<const LoadFace> faces) {
  std::vector<BorderEdge> edges;
  for (const LoadFace& face : faces) {
    const int n = size_of(face);
    for (int k = 0; k < n; ++k) {
      const std::int32_t a = face[k], b = n == 2 ? a : face[(k + 1) % n];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::ranges::sort(edges);
  return edges;
}

std::vector<LoadFace> faces_at(std::span<const BorderEdge> edges, const Mesh& mesh,
                               std::vector<LoadFace> faces) {
  std::vector<std::uint8_t> is_at(mesh.X.size(), 0);
  for (const auto& [a, b] : edges) is_at[a] = is_at[b] = 1;
  std::erase_if(faces, [&](const LoadFace& face) {
    return std::ranges::none_of(face, [&](std::int32_t i) { return i >= 0 && is_at[i] != 0; });
  });
  return faces;
}

std::ptrdiff_t count_of(std::span<const BorderEdge> sorted, const BorderEdge& edge) {
  return std::ranges::ssize(std::ranges::equal_range(sorted, edge));
}

DisplacementPath path_of(const SceneLoad& load) {
  std::vector<SupportKey> keys;
  for (const LoadKey& key : load.path)
    keys.push_back({.time = key.time, .displacement = Vec3(key.factor, 0, 0)});
  if (keys.empty()) keys.push_back({.displacement = Vec3(1, 0, 0)});
  return DisplacementPath(keys);
}

// Of faces in the mesh as it is; a quad that a cut has made two triangles of is left out with both.
bool is_left_out(const LoadFace& face, const Mesh& mesh, const NodeSet& region) {
  const std::vector<FacetNodes>& left_out = region.left_out;
  FacetNodes nodes = face;
  for (std::int32_t& i : nodes)
    if (i >= 0) i = mesh.uncut_node(i);
  std::ranges::sort(nodes);
  if (std::ranges::binary_search(left_out, nodes)) return true;
  if (nodes[0] >= 0) return false;
  const auto quads = std::ranges::lower_bound(left_out, FacetNodes{});  // behind all with a -1
  return std::any_of(quads, left_out.end(), [&](const FacetNodes& quad) {
    return std::ranges::includes(quad, std::span(nodes).subspan(1));
  });
}

std::vector<LoadFace> loadable_faces(const Mesh& mesh, const Surface& surface) {
  return mesh.dimension() == 2 ? outer_edges(mesh) : outer_faces(surface);
}

// Of these, those in the region.
std::vector<LoadFace> faces_in(const NodeSet& region, const Mesh& mesh,
                               std::span<const LoadFace> faces) {
  std::vector<std::uint8_t> is_inside(mesh.X.size(), 0);
  for (const std::int32_t node : region.node) is_inside[node] = 1;
  std::vector<LoadFace> found;
  std::ranges::copy_if(faces, std::back_inserter(found), [&](const LoadFace& face) {
    return std::ranges::all_of(face, [&](std::int32_t i) { return i < 0 || is_inside[i] != 0; }) &&
           !is_left_out(face, mesh, region);
  });
  return found;
}

void add_border(std::span<const LoadFace> faces, std::vector<BorderEdge>& border) {
  const std::vector<BorderEdge> loaded = edges_of(faces);
  for (const BorderEdge& edge : loaded)
    if (count_of(loaded, edge) == 1) border.push_back(edge);
}

}  // namespace

LoadedAreas find_loaded_areas(std::span<const SceneLoad> scene, const Mesh& mesh,
                              const Surface& surface) {
  LoadedAreas areas{.outer = loadable_faces(mesh, surface)};
  for (const SceneLoad& load : scene)
    areas.of_load.push_back(faces_in(*find_node_set(mesh, load.region), mesh, areas.outer));
  return areas;
}

std::vector<BorderEdge> load_borders(const LoadedAreas& areas, const Mesh& mesh) {
  std::vector<BorderEdge> border;
  for (const std::vector<LoadFace>& faces : areas.of_load) add_border(faces, border);
  sort_unique(border);
  if (border.empty()) return border;
  // At a wound there is no face beyond.
  const std::vector<BorderEdge> edges = edges_of(faces_at(border, mesh, areas.outer));
  std::erase_if(border, [&](const BorderEdge& edge) { return count_of(edges, edge) != 2; });
  return border;
}

void localise_loads(std::span<const SceneLoad> scene, const Mesh& mesh, const LoadedAreas& areas,
                    const Part& part, Loads& loads) {
  loads = {};
  Placing placing{.part = part, .loads = loads};
  for (std::size_t k = 0; k < scene.size(); ++k) {
    loads.path.push_back(path_of(scene[k]));
    const NodeSet& region = *find_node_set(mesh, scene[k].region);
    const std::vector<LoadFace>& faces = areas.of_load[k];
    const auto load = static_cast<std::int32_t>(k);
    if (scene[k].force != Vec3::Zero()) take_force(load, mesh, region, faces, placing);
    if (scene[k].pressure != 0) take_pressure(load, mesh, faces, placing);
  }
  loads.force.assign(loads.node.size(), Vec3::Zero());
}

bool do_loads_change(const Loads& loads, double t0, double t1) {
  return std::any_of(loads.path.begin(), loads.path.end(),
                     [&](const DisplacementPath& path) { return path.travel(t0, t1) > 0; });
}

void find_loads(std::span<const SceneLoad> scene, const Mesh& mesh, const Part& part,
                double thickness, double time, std::span<const double> u, Loads& loads) {
  std::fill(loads.force.begin(), loads.force.end(), Vec3::Zero());
  loads.factor.clear();
  for (const DisplacementPath& path : loads.path) loads.factor.push_back(path.at(time).x());
  for (const Loads::Share& share : loads.shares)
    loads.force[share.place] += loads.factor[share.load] * share.part * scene[share.load].force;
  const auto x = [&](std::int32_t local) -> Vec3 {
    return mesh.X[part.node_global[local]] + Vec3(u[3 * local], u[3 * local + 1], u[3 * local + 2]);
  };
  for (const Loads::Face& face : loads.faces) {
    const double pressure = loads.factor[face.load] * scene[face.load].pressure;
    const std::array<Vec3, 4> areas = area_vectors(face.node, face.stretch * thickness, x);
    for (std::size_t k = 0; k < 4; ++k)
      if (face.place[k] >= 0) loads.force[face.place[k]] -= pressure * areas[k];
  }
}

void add_loads(const Loads& loads, double share, std::span<double> force) {
  for (std::size_t k = 0; k < loads.node.size(); ++k)
    for (int j = 0; j < 3; ++j) force[3 * loads.node[k] + j] += share * loads.force[k][j];
}

}  // namespace trocar
