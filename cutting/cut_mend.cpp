// Greedy: the change of one side, of two neighbours' sides, or of those of all that hangs together
// at a node, that leaves the fewest pinched nodes, again and again.
#include "cutting/cut_mend.h"

#include <algorithm>

namespace trocar {

// Each trial opens the whole patch: as many as cost some milliseconds.
static constexpr std::ptrdiff_t n_element_trials = 300'000;

namespace {

struct Mending {
  const CutSurroundings& around;
  const PatchMesh& mesh;
  const CutStroke& stroke;
  CutLabels& labels;
  std::vector<std::int32_t> pinched;
  std::ptrdiff_t n_trials = 0;
};

struct Change {
  std::vector<std::int32_t> element;  // empty: nothing helps
  std::vector<std::int32_t> pinched;  // afterwards
};

}  // namespace

static void turn(CutLabels& labels, std::span<const std::int32_t> element) {
  for (const std::int32_t e : element) labels.side[e] = static_cast<std::int8_t>(-labels.side[e]);
}

static bool may_turn(const Mending& m, std::int32_t e) {
  return m.labels.side[e] != 0 && m.labels.kind[e] != CutKind::front &&
         find_element(m.stroke.opened, m.around.patch.element[e]) == nullptr;
}

static bool may_change(const Mending& m, std::int32_t e) {
  const std::vector<std::int8_t>& side = m.labels.side;
  const auto is_other = [&](std::int32_t u) { return u >= 0 && side[u] == -side[e]; };
  return may_turn(m, e) && std::ranges::any_of(m.around.patch.across[e], is_other);
}

static void try_change(Mending& m, const std::vector<std::int32_t>& element, Change& best) {
  if (m.n_trials <= 0) return;
  --m.n_trials;
  turn(m.labels, element);
  std::vector<std::int32_t> left = pinched_nodes(m.around, m.mesh, m.labels);
  turn(m.labels, element);
  if (left.size() < best.pinched.size()) best = {element, std::move(left)};
}

// Together with a neighbour that lies on the same side.
static void try_pairs(Mending& m, std::int32_t e, Change& best) {
  for (const std::int32_t u : m.around.patch.across[e]) {
    if (u < 0 || m.labels.side[u] != m.labels.side[e]) continue;
    turn(m.labels, {&e, 1});
    const bool is_allowed = may_change(m, u);
    turn(m.labels, {&e, 1});
    if (is_allowed) try_change(m, {e, u}, best);
  }
}

// The elements around `node` that hang together with e, across facets at the node, on its side.
static std::vector<std::int32_t> star_part(const Mending& m, std::int32_t node, std::int32_t e) {
  const CutPatch& patch = m.around.patch;
  std::vector<std::int32_t> part{e};
  for (std::size_t k = 0; k < part.size(); ++k)
    for (std::size_t f = 0; f < 4; ++f) {
      const std::int32_t u = patch.across[part[k]][f];
      if (u < 0 || patch.corner[part[k]][f] == node || m.labels.side[u] != m.labels.side[e] ||
          std::ranges::find(part, u) != part.end())
        continue;
      part.push_back(u);
    }
  return part;
}

// What pinches the node may be a tent: elements that reach up to it from the other side.
static void try_parts(Mending& m, std::int32_t node, Change& best) {
  for (const std::int32_t e : m.around.patch.star(node)) {
    if (m.labels.side[e] == 0) continue;
    const std::vector<std::int32_t> part = star_part(m, node, e);
    const auto is_free = [&](std::int32_t u) { return may_turn(m, u); };
    if (e == std::ranges::min(part) && std::ranges::all_of(part, is_free))
      try_change(m, part, best);
  }
}

// The change at the first pinched node that helps most.
static Change best_change(Mending& m) {
  Change best{{}, m.pinched};
  const std::span<const std::int32_t> star = m.around.patch.star(m.pinched.front());
  for (const std::int32_t e : star)
    if (may_change(m, e)) try_change(m, {e}, best);
  if (!best.element.empty()) return best;
  for (const std::int32_t e : star)
    if (may_change(m, e)) try_pairs(m, e, best);
  if (best.element.empty()) try_parts(m, m.pinched.front(), best);
  return best;
}

std::int32_t mend_labels(const CutSurroundings& around, const PatchMesh& mesh,
                         const CutStroke& stroke, CutLabels& labels) {
  const std::vector<std::int8_t> side = labels.side;
  Mending m{around,
            mesh,
            stroke,
            labels,
            pinched_nodes(around, mesh, labels),
            20 + n_element_trials / std::max(1, around.patch.n_elements())};
  std::vector<std::int32_t> hopeless;  // ascending
  while (!m.pinched.empty() && m.n_trials > 0) {
    const std::int32_t node = m.pinched.front();
    Change change = best_change(m);
    if (change.element.empty())
      hopeless.insert(std::lower_bound(hopeless.begin(), hopeless.end(), node), node);
    turn(labels, change.element);
    m.pinched = std::move(change.pinched);
    std::erase_if(m.pinched, [&](std::int32_t i) {
      return std::binary_search(hopeless.begin(), hopeless.end(), i);
    });
  }
  std::int32_t n_turned = 0;
  for (std::size_t e = 0; e < side.size(); ++e) n_turned += side[e] == labels.side[e] ? 0 : 1;
  return n_turned;
}

}  // namespace trocar
