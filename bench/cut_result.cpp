// One random cut: made, measured, and made again by subdivision.
#include "cut_result.h"

#include <cmath>

#include "base/sort_unique.h"
#include "base/timers.h"
#include "cutting/cut_hex.h"
#include "cutting/cut_hex_shape.h"
#include "known_positions.h"
#include "larger_or_nan.h"

namespace trocar::cut_bench {

// In proportion to the element's stable step.
static double step_bound(const Mesh& mesh, std::int32_t e) {
  const auto c = mesh.corners(e);
  if (c.size() == 4) return tet_step_bound(mesh, e);
  std::array<Vec3, 8> X;
  for (std::size_t a = 0; a < 8; ++a) X[a] = mesh.X[c[a]];
  return hex_step_bound(X);
}

// Degrees.
static double least_dihedral(const Mesh& mesh, std::int32_t e) {
  const auto c = mesh.corners(e);
  std::array<Vec3, 4> normal;
  for (int f = 0; f < 4; ++f) {
    const std::array<int, 4> k = facet_corners(ElementType::tet4, f);
    const Vec3& o = mesh.X[c[k[0]]];
    normal[f] = (mesh.X[c[k[1]]] - o).cross(mesh.X[c[k[2]]] - o).normalized();
  }
  double largest = -1;  // cosine of the angle
  for (int f = 0; f < 4; ++f)
    for (int g = f + 1; g < 4; ++g) largest = larger_or_nan(largest, -normal[f].dot(normal[g]));
  return std::acos(std::min(1.0, largest)) * 180 / 3.14159265358979323846;
}

static double least_step(const Mesh& mesh) {
  double least = 1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) least = std::min(least, step_bound(mesh, e));
  return least;
}

// Element `e` of `after` against the one that it was or was a part of.
static bool is_changed(const Mesh& before, std::int32_t origin, const Mesh& after, std::int32_t e) {
  if (before.element_type[origin] != after.element_type[e]) return true;
  const auto a = before.corners(origin), b = after.corners(e);
  for (std::size_t c = 0; c < a.size(); ++c)
    if (a[c] != b[c] || before.X[a[c]] != after.X[b[c]]) return true;
  return false;
}

static int n_hexahedra(const Mesh& mesh) {
  return int(std::count(mesh.element_type.begin(), mesh.element_type.end(), ElementType::hex8));
}

static void measure_elements(const Mesh& before, const CutBody& cut, Result& result) {
  const Mesh& after = cut.body.mesh;
  double step_before = 1e300, step_after = 1e300;
  for (std::int32_t e = 0; e < after.n_elements(); ++e) {
    if (!(element_volume(after, e, after.X) > 0)) ++result.n_inverted;
    const std::int32_t origin = cut.origin[std::size_t(e)];
    if (!is_changed(before, origin, after, e)) continue;
    step_before = std::min(step_before, step_bound(before, origin));
    step_after = std::min(step_after, step_bound(after, e));
    if (after.element_type[e] == ElementType::tet4)
      result.least_dihedral = std::min(result.least_dihedral, least_dihedral(after, e));
    else
      ++result.n_reshaped;
  }
  result.n_hexahedra = n_hexahedra(before);
  result.n_converted = result.n_hexahedra - n_hexahedra(after);
  if (step_before < 1e300) result.cut_ratio = step_after / step_before;
  result.body_ratio = least_step(after) / least_step(before);
  result.n_added = after.n_elements() - before.n_elements();
  result.volume_error = std::abs(total_volume(after) / total_volume(before) - 1);
  result.mass_error = std::abs(total_mass(after) / total_mass(before) - 1);
}

static void measure_regions(const Mesh& before, const Mesh& after, Result& result) {
  if (before.region_name.size() < 2) return;
  const std::vector<double> old = cutting_test::region_volumes(before),
                            now = cutting_test::region_volumes(after);
  for (std::size_t r = 0; r < old.size(); ++r)
    result.region_error = std::max(result.region_error, std::abs(now[r] / old[r] - 1));
}

static void measure_deviation(const Mesh& mesh, const std::vector<Stroke>& strokes, double h,
                              Result& result) {
  std::vector<std::int32_t> node;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
      if ((mesh.cut_facets[e] >> f & 1) != 0)
        for (const int c : facet_corners(mesh.element_type[e], f))
          if (c >= 0) node.push_back(mesh.corners(e)[c]);
  sort_unique(node);
  for (const std::int32_t i : node) {
    double least = 1e300;
    for (const Stroke& stroke : strokes)
      least = std::min(least, std::abs(stroke.phi(mesh.X[i])) / h);
    result.deviation.push_back(least);
  }
}

static void subdivide_instead(const Mesh& mesh, const Kind& kind,
                              const std::vector<Stroke>& strokes, double h, Result& result) {
  HexTets tets;
  update_hex_tets(mesh, tets);
  const Subdivision exact = subdivide(tets.mesh, strokes);
  result.split_elements = double(exact.mesh.n_elements()) / mesh.n_elements();
  result.split_ratio = least_step(exact.mesh) / least_step(mesh);
  result.n_exact = kind.is_through ? int(exact.piece_volume.size()) : n_pieces(mesh);
  if (!kind.is_through) return;
  for (const double volume : exact.piece_volume) result.n_thin += volume < h * h * h ? 1 : 0;
}

static void apply(const MeshEdit& edit, const CutFigures& figures, CutBody& cut) {
  const SplitNumbers numbers(edit.splits, cut.body.mesh.n_elements());
  cutting_test::apply(edit, figures, cut.body, cut.ledger);
  if (edit.is_empty()) return;
  std::vector<std::int32_t> origin;
  for (std::int32_t e = 0; e < cut.body.mesh.n_elements(); ++e)
    origin.push_back(cut.origin[std::size_t(numbers.whole(e))]);
  cut.origin = std::move(origin);
  cut.boxes = make_element_boxes(cut.body.mesh, cut.body.x);
}

void run_stroke(const Stroke& stroke, TetCutter& cutter, CutBody& cut, Result& result) {
  Body& body = cut.body;
  cutter.start_stroke();
  for (int k = 0; k < stroke.n_steps; ++k) {
    BladeSweep sweep{stroke.blade(double(k) / stroke.n_steps),
                     stroke.blade(double(k + 1) / stroke.n_steps), stroke.normal};
    for (bool is_parted = false; !is_parted; sweep.before = sweep.after) {
      CutFigures figures;
      KnownPositions positions(body.mesh, body.x, cut.boxes);
      const double start = thread_seconds();
      const MeshEdit edit = cutter.advance(body.mesh, positions, {body.is_held}, sweep,
                                           k + 1 == stroke.n_steps, figures);
      const double seconds = thread_seconds() - start;
      result.seconds += seconds;
      result.longest_advance = std::max(result.longest_advance, seconds);
      apply(edit, figures, cut);
      result.n_inserted += figures.n_inserted;
      is_parted = edit.inserted.empty();
    }
  }
}

Result make_cut(const Mesh& mesh, const Kind& kind, std::mt19937_64& random,
                const CutTetOptions& options) {
  const std::vector<Stroke> strokes = kind.strokes(mesh, random);
  const double h = mean_edge_length(mesh);
  Result result;
  subdivide_instead(mesh, kind, strokes, h, result);
  CutBody cut(mesh);
  TetCutter cutter{options};
  cutter.prepare(cut.body.mesh);  // not timed, as a run prepares at its start
  for (const Stroke& stroke : strokes) run_stroke(stroke, cutter, cut, result);
  const Body& body = cut.body;
  const cutting_test::Ledger& ledger = cut.ledger;
  result.n_edits = ledger.n_edits;
  result.n_refused = ledger.total.n_refused;
  result.n_opened = ledger.total.n_opened_facets;
  result.n_duplicated = ledger.total.n_duplicated;
  result.n_turned = ledger.total.n_turned;
  result.n_chips = ledger.total.n_chips;
  result.n_beside = ledger.total.n_beside;
  result.n_pulled_back = ledger.total.n_pulled_back;
  result.n_inverted_by_move = ledger.total.n_inverted;
  result.fault = cutting_test::fault(body);
  result.n_pieces = n_pieces(body.mesh);
  measure_elements(mesh, cut, result);
  measure_regions(mesh, body.mesh, result);
  measure_deviation(body.mesh, strokes, h, result);
  return result;
}

}  // namespace trocar::cut_bench
