#include "study/cut2d_picture.h"

#include <algorithm>
#include <set>

#include "base/box.h"
#include "mesh/facets.h"
#include "study/svg.h"

namespace trocar {

namespace {

constexpr double longest_side = 900, margin = 24, head = 30;  // [px]

// From metres to pixels, y upward to y downward.
struct Frame {
  double left = 0, top = 0, scale = 1, width = 0, height = 0;

  SvgPoint at(const Vec3& X) const {
    return {margin + scale * (X.x() - left), head + margin + scale * (top - X.y())};
  }
};

Frame frame_of(const Mesh& mesh, const std::vector<Cut2dPath>& paths) {
  Box box = bounding_box(mesh.X);
  for (const Cut2dPath& path : paths) box.add(bounding_box(path));
  const Vec3 size = box.size();
  const double scale = longest_side / std::max(size.x(), size.y());
  return {box.low.x(), box.high.y(), scale, scale * size.x() + 2 * margin,
          scale * size.y() + 2 * margin + head};
}

const SvgStroke thin{"#555555", 0.8, ""}, outline{"#111111", 2.0, ""}, cut_side{"#c01818", 2.6, ""},
    path_line{"#1f5fbf", 1.6, "7 4"};

std::string edges_svg(const Mesh& mesh, const Frame& frame) {
  const FacetNeighbours across = facet_neighbours(mesh);
  std::string inner, outer;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      const SvgPoint a = frame.at(mesh.X[mesh.corners(e)[(f + 1) % 3]]);
      const SvgPoint b = frame.at(mesh.X[mesh.corners(e)[(f + 2) % 3]]);
      const bool is_cut = (mesh.cut_facets[e] >> f & 1) != 0;
      if (is_cut || across.of(e, f) < 0)
        outer += svg_line(a, b, is_cut ? cut_side : outline);
      else if (across.of(e, f) > e)
        inner += svg_line(a, b, thin);
    }
  return inner + outer;
}

std::string cut_nodes_svg(const Mesh& mesh, const Frame& frame) {
  std::set<std::array<double, 2>> places;  // both sides of a cut at once
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f)
      for (int k = 1; k < 3 && (mesh.cut_facets[e] >> f & 1) != 0; ++k) {
        const SvgPoint p = frame.at(mesh.X[mesh.corners(e)[(f + k) % 3]]);
        places.insert({p.x, p.y});
      }
  std::string text;
  for (const auto& [x, y] : places) text += svg_marker({x, y}, 0, "#c01818", false, "");
  return text;
}

}  // namespace

std::string mesh_svg(const Mesh& mesh, const std::vector<Cut2dPath>& paths,
                     const std::string& title) {
  const Frame frame = frame_of(mesh, paths);
  std::string content = edges_svg(mesh, frame);
  for (const Cut2dPath& path : paths) {
    std::vector<SvgPoint> points;
    for (const Vec3& X : path) points.push_back(frame.at(X));
    content += svg_polyline(points, path_line);
  }
  content += cut_nodes_svg(mesh, frame);
  content += svg_text({margin, head}, {.text = title, .size = 16});
  return svg_document(frame.width, frame.height, title, content);
}

}  // namespace trocar
