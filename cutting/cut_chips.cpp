// Pieces by flooding across the facets that stay joined, in the patch and a little beyond.
#include "cutting/cut_chips.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "cutting/cut_constraints.h"
#include "cutting/cut_flake.h"
#include "cutting/cut_survey.h"

namespace trocar {

// Flakes are looked for below this (over h^3).
static constexpr double flake_volume = 16;
// And above this their necks go with them where they can (over h^3).
static constexpr double with_neck = 1;

namespace {

struct Tissue {
  const Mesh& mesh;
  const CutIndex& index;
  std::span<const std::uint8_t> is_held;  // (n_nodes)
  const CutStroke& stroke;
  const TetCut& cut;
};

struct SmallPiece {
  std::vector<std::int32_t> element, beyond;  // in the patch: local; outside: global
  double V = 0;                               // over h^3
};

}  // namespace

// Adds the volume of an element; false if the piece is no small one with it.
static bool add_volume(const Tissue& t, std::span<const Vec3> X,
                       const std::array<std::int32_t, 4>& corner, SmallPiece& piece) {
  const double h = t.cut.around.h;
  piece.V += six_volumes(X, corner) / (6 * h * h * h);
  return piece.V < flake_volume;
}

namespace {

// What searches for small pieces know of an element.
enum class PieceMark : std::uint8_t { unseen, seen, in_large };

}  // namespace

// Adds the elements of the patch that hang together with `first` after the opening; false if they
// are no small piece. Then the rest of them is left to other searches, which end here.
static bool flood_patch(const Tissue& t, std::int32_t first, std::vector<PieceMark>& mark,
                        SmallPiece& piece) {
  const CutPatch& patch = t.cut.around.patch;
  bool is_small = true;
  mark[first] = PieceMark::seen;
  piece.element.push_back(first);
  for (std::size_t k = 0; is_small && k < piece.element.size(); ++k) {
    const std::int32_t e = piece.element[k];
    is_small = add_volume(t, patch.X, patch.corner[e], piece);
    for (int f = 0; is_small && f < 4; ++f) {
      const std::int32_t u = patch.across[e][f];
      if (u < 0 || mark[u] == PieceMark::seen || !is_joined(patch, t.cut.opening.corner, e, f))
        continue;
      is_small = mark[u] == PieceMark::unseen;
      if (is_small) piece.element.push_back(u);
      if (is_small) mark[u] = PieceMark::seen;
    }
  }
  for (const std::int32_t e : piece.element)
    if (!is_small) mark[e] = PieceMark::in_large;
  return is_small;
}

// Adds the element across facet f of `element` (global) if it lies outside the patch; false if it
// belongs to the patch, but not to the piece.
static bool add_beyond(const Tissue& t, std::int32_t element, int f, SmallPiece& piece) {
  const std::int32_t u = element_across(t.mesh, t.index, element, f);
  if (u < 0 || std::ranges::find(piece.beyond, u) != piece.beyond.end()) return true;
  const std::int32_t local = t.cut.around.patch.local_element(u);
  if (local < 0) piece.beyond.push_back(u);
  return local < 0 || std::ranges::find(piece.element, local) != piece.element.end();
}

static bool is_held_fast(const Tissue& t, std::int32_t i) {
  return t.is_held[i] != 0 && t.is_held[i] != may_slide;
}

// Whether the node is held, or an element of another shape has it.
static bool is_fast(const Tissue& t, std::int32_t i) {
  return is_held_fast(t, i) || std::ranges::any_of(t.index.star(i), [&](std::int32_t e) {
           return t.mesh.element_type[e] != ElementType::tet4;
         });
}

// Adds what hangs together with the piece outside the patch; false if that is not small, something
// holds it, or the piece hangs together with more of the patch there.
static bool follow_beyond(const Tissue& t, SmallPiece& piece) {
  const CutPatch& patch = t.cut.around.patch;
  for (const std::int32_t e : piece.element)
    for (int f = 0; f < 4; ++f)
      if (patch.across[e][f] < 0 && !is_outer(patch, e, f))
        add_beyond(t, patch.element[e], f, piece);
  for (std::size_t k = 0; k < piece.beyond.size(); ++k) {
    const std::int32_t u = piece.beyond[k];
    const std::array<std::int32_t, 4> node = tet_nodes(t.mesh, u);
    if (!add_volume(t, t.mesh.X, node, piece) ||
        std::ranges::any_of(node, [&](std::int32_t i) { return is_fast(t, i); }))
      return false;
    for (int f = 0; f < 4; ++f)
      if (!add_beyond(t, u, f, piece)) return false;
  }
  std::ranges::sort(piece.beyond);
  return true;
}

// Whether the piece is small outside the patch, too, and nothing holds it; adds what lies there.
static bool is_free(const Tissue& t, SmallPiece& piece) {
  const CutPatch& patch = t.cut.around.patch;
  const auto is_held = [&](std::int32_t i) {
    return patch.is_joined[i] != 0 || patch.is_bent[i] != 0 || is_held_fast(t, patch.node[i]);
  };
  for (const std::int32_t e : piece.element)
    if (std::ranges::any_of(patch.corner[e], is_held)) return false;
  return follow_beyond(t, piece);
}

// The pieces below the flakes' volume that the opening would free, the smallest first.
static std::vector<SmallPiece> small_pieces(const Tissue& t) {
  std::vector<SmallPiece> pieces;
  std::vector<PieceMark> mark(t.cut.around.patch.element.size(), PieceMark::unseen);
  for (const auto& [first, f] : t.cut.opening.facet) {
    SmallPiece p;
    if (mark[first] == PieceMark::unseen && flood_patch(t, first, mark, p) && is_free(t, p))
      pieces.push_back(std::move(p));
  }
  std::ranges::stable_sort(pieces, {}, &SmallPiece::V);
  return pieces;
}

// Sides of this advance, by global element.
static std::vector<OfElement<std::int8_t>> given_sides(const TetCut& cut) {
  std::vector<OfElement<std::int8_t>> side;
  for (std::int32_t e = 0; e < cut.around.patch.n_elements(); ++e)
    if (cut.labels.side[e] != 0) side.push_back({cut.around.patch.element[e], cut.labels.side[e]});
  for (const CutChip& chip : cut.chips) merge_elements(side, chip.beyond);
  return side;
}

static Flake find_flake(const Tissue& t, const SmallPiece& piece) {
  std::vector<std::int32_t> element = piece.beyond;
  for (const std::int32_t e : piece.element) element.push_back(t.cut.around.patch.element[e]);
  std::ranges::sort(element);
  return find_flake(t.mesh, t.index, t.stroke, element, t.cut.labels.side[piece.element.front()],
                    given_sides(t.cut));
}

// Gives the piece the other side.
static void attach(SmallPiece piece, TetCut& cut) {
  for (const std::int32_t e : piece.element)
    cut.labels.side[e] = static_cast<std::int8_t>(-cut.labels.side[e]);
  CutChip chip{centre_of(cut.around.patch, piece.element), std::move(piece.element), {}};
  for (const std::int32_t e : piece.beyond)
    chip.beyond.push_back({e, cut.labels.side[chip.element.front()]});
  cut.chips.push_back(std::move(chip));
}

// Gives the elements around the neck the flake's side, but those that an advance before gave the
// other one, chips, and what is a neck already; whether there are any.
static bool keep_neck(const Tissue& t, std::span<const std::int32_t> neck, std::int8_t side,
                      TetCut& cut) {
  const CutPatch& patch = cut.around.patch;
  std::vector<std::int32_t> taken = cut.neck;
  for (const CutChip& chip : cut.chips)
    taken.insert(taken.end(), chip.element.begin(), chip.element.end());
  sort_unique(taken);
  const std::size_t n_before = cut.neck.size();
  for (const std::int32_t node : neck) {
    const std::int32_t i = patch.local_node(node);
    if (i < 0 || !patch.is_whole(i)) continue;
    for (const std::int32_t e : patch.star(i)) {
      if (cut.labels.side[e] != -side || std::ranges::binary_search(taken, e) ||
          find_element(t.stroke.side, patch.element[e]) != nullptr)
        continue;
      cut.labels.side[e] = side;
      cut.neck.push_back(e);
    }
  }
  return cut.neck.size() > n_before;
}

bool join_chip(const Mesh& mesh, const CutIndex& index, std::span<const std::uint8_t> is_held,
               const CutStroke& stroke, bool is_last, TetCut& cut) {
  if (cut.opening.duplication.duplicate_parent.empty()) return false;
  const Tissue tissue{mesh, index, is_held, stroke, cut};
  for (SmallPiece& piece : small_pieces(tissue)) {
    const bool is_chip = piece.V < chip_volume;
    const Flake flake = is_chip ? Flake{} : find_flake(tissue, piece);
    if (!is_chip && !flake.is_one) continue;
    if (is_last && piece.V > with_neck &&
        keep_neck(tissue, flake.neck, cut.labels.side[piece.element.front()], cut))
      return true;
    if (is_chip || is_last)
      attach(std::move(piece), cut);
    else
      leave_elements(cut.around.patch, piece.element, cut.labels);
    return true;
  }
  return false;
}

}  // namespace trocar
