// The 3D cut in the order of its steps: crossings, sides, opened facets, moved nodes, edit.
#include "cutting/cut_tet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/check.h"
#include "cutting/cut_chips.h"
#include "cutting/cut_edit.h"
#include "cutting/cut_follow.h"
#include "cutting/cut_go_on.h"
#include "cutting/cut_hex.h"
#include "cutting/cut_hits.h"
#include "cutting/cut_homogenise.h"
#include "cutting/cut_index.h"
#include "cutting/cut_mend.h"
#include "cutting/cut_missed.h"
#include "cutting/cut_rim.h"
#include "cutting/cut_split.h"
#include "cutting/cut_thin.h"

namespace trocar {

// Of one advance: pieces that are turned back and forth must end.
static constexpr std::size_t most_chips = 50;

struct TetCutter::Front {
  CutTetOptions options;
  CutStroke stroke;
  CutIndex index;
  std::optional<HexTets> tets;  // of a body that has or had hexahedra
  // The least bound of the body's elements before blades touched them [m]; 0: not known yet. Edits
  // leave it as it is: what they change, the stroke remembers.
  double least_step = 0;

  // The mesh that the cut sees.
  const Mesh& seen(const Mesh& body) const { return tets ? tets->mesh : body; }

  MeshEdit advance(const Mesh& mesh, PresentPositions& positions, const CutConstraints& constraints,
                   const BladeSweep& sweep, bool is_last, CutFigures& figures);
  MeshEdit split(const Mesh& mesh, const CutSurroundings& around,
                 const std::vector<ThinSlice>& slices, CutFigures& figures);
  void open_between_sides(const Mesh& mesh, std::span<const std::uint8_t> is_held,
                          const std::vector<ThinSlice>& slices, bool is_last, TetCut& cut) const;
};

TetCutter::TetCutter(const CutTetOptions& options)
    : front_(std::make_unique<Front>(Front{options, {}, {}, {}, 0})) {}
TetCutter::~TetCutter() = default;
TetCutter::TetCutter(TetCutter&&) noexcept = default;

static void merge_earlier(const CutStroke& stroke, std::vector<CutHit>& earlier) {
  for (const CutHit& hit : stroke.hit)
    if (find_element(stroke.opened, hit.element) == nullptr) earlier.push_back(hit);
  sort_hits(earlier);
}

// Step bounds are kept: the floor under them must not sink from stroke to stroke. So are edges from
// before elements were split, and where the blade has been in vain: it does not part it twice.
void TetCutter::start_stroke() {
  CutStroke next;
  next.step = std::move(front_->stroke.step);
  next.whole_edge = std::move(front_->stroke.whole_edge);
  next.earlier_hit = std::move(front_->stroke.earlier_hit);
  merge_earlier(front_->stroke, next.earlier_hit);
  next.left = left_by(front_->stroke);
  next.beside = std::move(front_->stroke.beside);
  front_->stroke = std::move(next);
}

CutLeft TetCutter::left() const {
  return left_by(front_->stroke);
}
void TetCutter::take_over(const CutLeft& left) {
  add_left(left, front_->stroke);
}

const CutStroke& TetCutter::stroke() const {
  return front_->stroke;
}
void TetCutter::set_stroke(CutStroke stroke) {
  front_->stroke = std::move(stroke);
}

static void check_arguments(const Mesh& mesh, std::span<const Vec3> x,
                            const CutConstraints& constraints, const BladeSweep& sweep) {
  CHECK_OP(x.size(), ==, mesh.X.size());
  CHECK_OP(constraints.is_held.size(), ==, mesh.X.size());
  CHECK_OP(sweep.before.size(), ==, sweep.after.size());
  CHECK_OP(sweep.before.size(), >=, 2U);
  CHECK_OP(mesh.dimension(), ==, 3);
}

static std::vector<Vec3> moved_positions(const TetCut& cut, const CutTetOptions& options,
                                         const MoveLimits& limits) {
  std::vector<Vec3> X = cut.around.patch.X;
  if (options.stages == CutStages::springs)
    homogenise_nodes(cut.around, cut.role, -std::numeric_limits<double>::infinity(), X);
  if (options.stages == CutStages::springs_then_barrier)
    homogenise_nodes(cut.around, cut.role, limits.floor, X);
  if (options.stages != CutStages::springs) move_nodes(cut.around, cut.role, limits, X);
  return X;
}

static std::int32_t count_inverted(const CutPatch& patch, std::span<const Vec3> X) {
  const auto is_inverted = [&](const auto& corner) { return !(six_volumes(X, corner) > 0); };
  return static_cast<std::int32_t>(std::ranges::count_if(patch.corner, is_inverted));
}

static std::int32_t count_different(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::int32_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += a[i] == b[i] ? 0 : 1;
  return n;
}

static void add_refusals(const std::vector<CutRefusal>& list, CutFigures& figures) {
  figures.refusals.insert(figures.refusals.end(), list.begin(), list.end());
  figures.n_refused = static_cast<std::int32_t>(figures.refusals.size());
}

static double find_least_step(const Mesh& mesh, const CutStroke& stroke) {
  double least = std::numeric_limits<double>::infinity();
  auto before = stroke.step.begin();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    while (before != stroke.step.end() && before->element < e) ++before;
    const bool is_known = before != stroke.step.end() && before->element == e;
    least = std::min(least, is_known ? before->value : tet_step_bound(mesh, e));
  }
  return least;
}

// Puts nodes on the crossed edges of thin slices; empty if that can't be.
MeshEdit TetCutter::Front::split(const Mesh& mesh, const CutSurroundings& around,
                                 const std::vector<ThinSlice>& slices, CutFigures& figures) {
  if (slices.empty()) return {};
  if (least_step == 0) least_step = find_least_step(mesh, stroke);
  std::vector<EdgeNode> inserted =
      nodes_in_slices(mesh, around, slices, options.split_step_ratio * least_step);
  if (inserted.empty()) return {};
  MeshEdit edit = split_edges(mesh, around.patch.element, std::move(inserted));
  split_stroke(mesh, edit, stroke);
  figures.n_inserted = static_cast<std::int32_t>(edit.inserted.size());
  figures.mean_edge = around.h;
  edit_index(mesh, edit, index);
  return edit;
}

// Gives elements their sides and opens the facets between these, such that no chip comes off.
void TetCutter::Front::open_between_sides(const Mesh& mesh, std::span<const std::uint8_t> is_held,
                                          const std::vector<ThinSlice>& slices, bool is_last,
                                          TetCut& cut) const {
  const bool is_out = is_last && has_come_out(stroke);
  const CutSurroundings& around = cut.around;
  const PatchMesh patch = make_patch_mesh(around.patch);
  cut.labels = label_elements(around, stroke, is_last);
  if (is_out) part_bridges(around, stroke, cut.labels);
  if (is_last) cut.rungs.n_turned = mend_labels(around, patch, stroke, cut.labels);
  if (is_out && part_bridges(around, stroke, cut.labels))
    cut.rungs.n_turned += mend_labels(around, patch, stroke, cut.labels);
  std::vector<std::uint8_t> stays_whole(around.patch.node.size(), 0);
  if (!is_last) {
    stays_whole = unripe_nodes(around, cut.labels);
    leave_slices(around.patch, slices, cut.labels);
  }
  do cut.opening = open_facets(around, patch, cut.labels, stays_whole);
  while (cut.chips.size() < most_chips && join_chip(mesh, index, is_held, stroke, is_last, cut));
}

// Cuts the tetrahedra of `mesh`.
MeshEdit TetCutter::Front::advance(const Mesh& mesh, PresentPositions& positions,
                                   const CutConstraints& constraints, const BladeSweep& sweep,
                                   bool is_last, CutFigures& figures) {
  add_hits(mesh, index, positions, sweep, stroke);
  if (!is_last && stroke.swept < options.advance * stroke.mean_edge) return {};

  if (is_last) drop_covered_rim(stroke);
  TetCut cut;
  cut.around =
      survey(mesh, tets ? &*tets : nullptr, index, positions, constraints, stroke, is_last);
  if (cut.around.patch.n_elements() == 0) {
    if (is_last) add_refusals(missed_places(mesh, cut, stroke), figures);
    return {};
  }
  const bool is_through = is_last && has_gone_through(stroke);
  std::vector<ThinSlice> slices;
  if (options.split_step_ratio > 0 && !tets && (!is_last || is_through))
    slices = thin_slices(mesh, cut.around, stroke);
  if (is_through)
    if (MeshEdit edit = split(mesh, cut.around, slices, figures); !edit.is_empty()) return edit;
  open_between_sides(mesh, constraints.is_held, slices, is_last, cut);
  set_roles(cut, stroke, is_last);
  cut.X = moved_positions(cut, options, move_limits(cut.around, stroke, options.least_step_ratio));
  cut.rungs.n_inverted = count_inverted(cut.around.patch, cut.X);
  const std::vector<Vec3> wanted = cut.X;
  cut.transfer = transfer_moves(cut.around.patch, cut.X);
  cut.rungs.n_pulled_back = count_different(wanted, cut.X);

  figures = make_figures(cut, is_last);
  remember(cut, mesh, stroke);
  if (is_last) add_refusals(missed_places(mesh, cut, stroke), figures);
  MeshEdit edit = make_edit(mesh, cut);
  edit_index(mesh, edit, index);
  return edit;
}

void TetCutter::prepare(const Mesh& mesh) {
  Front& f = *front_;
  if (!is_prepared(mesh)) f.least_step = 0;
  if (is_index_of(f.index, mesh) || !was_hexahedral(mesh)) {  // none if it is the index of `mesh`
    f.tets.reset();
    return update_index(mesh, f.index);
  }
  if (!f.tets) f.tets.emplace();
  update_hex_tets(mesh, *f.tets);
  update_index(f.tets->mesh, f.index);
}

bool TetCutter::meets(const Mesh& mesh, PresentPositions& positions, const BladeSweep& sweep) {
  prepare(mesh);
  Front& f = *front_;
  CutStroke passing;
  add_hits(f.seen(mesh), f.index, positions, sweep, passing);
  return !passing.hit.empty();
}

bool TetCutter::has_crossed_ahead(const Mesh& mesh, std::int32_t element, const Vec3& X,
                                  const Vec3& ahead, const Vec3& normal) const {
  constexpr double least_cosine = 0.5;
  const Front& f = *front_;
  std::int32_t first = element, end = element + 1;
  if (f.tets && are_tets_of(*f.tets, mesh)) {
    first = f.tets->first[element];
    end = f.tets->end(element);
  }
  const auto is_one_ahead = [&](const std::vector<CutHit>& hits) {
    auto hit = std::ranges::lower_bound(hits, first, {}, &CutHit::element);
    for (; hit != hits.end() && hit->element < end; ++hit)
      if (ahead.dot(hit->X - X) > 0 && std::abs(normal.dot(hit->N)) > least_cosine) return true;
    return false;
  };
  return is_one_ahead(f.stroke.hit) || is_one_ahead(f.stroke.earlier_hit);
}

bool TetCutter::is_prepared(const Mesh& mesh) const {
  const Front& f = *front_;
  return (!f.tets || are_tets_of(*f.tets, mesh)) && is_index_of(f.index, f.seen(mesh));
}

void TetCutter::follow(const Mesh& mesh, const CutterEdit& edit) {
  Front& f = *front_;
  if (!edit.inserted.empty())
    follow_splits(mesh, edit, f.stroke);
  else if (edit.tets.is_empty())
    follow_opening(mesh, edit, edit.along, f.stroke);
  if (!is_prepared(mesh)) return;
  if (!f.tets) {
    keep_steps_around(mesh, f.index, edit, f.stroke);
    return edit_index(mesh, edit, f.index);
  }
  keep_steps_around(f.tets->mesh, f.index, edit.tets, f.stroke);
  follow_opening(f.tets->mesh, edit.tets, edit.along, f.stroke);
  edit_index(f.tets->mesh, edit.tets, f.index);
  edit_hex_tets(edit.splits, edit.tets, *f.tets);
}

CutterEdit TetCutter::advance(const Mesh& mesh, PresentPositions& positions,
                              const CutConstraints& constraints, const BladeSweep& sweep,
                              bool is_last, CutFigures& figures) {
  check_arguments(mesh, positions.x(), constraints, sweep);
  figures = {};
  prepare(mesh);
  Front& f = *front_;
  const Mesh& tets = f.seen(mesh);
  MeshEdit edit = f.advance(tets, positions, constraints, sweep, is_last, figures);
  if (is_last && edit.inserted.empty()) forget_uncrossed(tets, f.stroke);
  figures.goes_through = is_last && has_gone_through(f.stroke);
  figures.is_in_slit = is_last && f.stroke.hit.empty() && !f.stroke.in_slit.empty();
  CutKnown along;
  if (!edit.is_empty() && edit.inserted.empty())
    along = known_around(edit, tets.n_nodes(), f.index, f.stroke);
  if (!f.tets || edit.is_empty()) return {std::move(edit), {}, std::move(along)};
  MeshEdit of_body = edit_of_body(mesh, positions, f.index, edit, *f.tets, figures);
  return {std::move(of_body), std::move(edit), std::move(along)};
}

}  // namespace trocar
