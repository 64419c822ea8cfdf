#include <algorithm>
#include <numeric>
#include <utility>

#include "collision/surface_tree.h"

namespace trocar {

namespace {

constexpr double least_opposite = -0.1;  // n·n of normals that face each other is less
constexpr double slack = 1e-9;           // for rounding

// The least a·b of all a and b in two boxes.
double least_dot(const Box& a, const Box& b) {
  const auto both = [](const Vec3& p, const Vec3& q) { return Vec3(p.cwiseProduct(q)); };
  return both(a.low, b.low)
      .cwiseMin(both(a.low, b.high))
      .cwiseMin(both(a.high, b.low))
      .cwiseMin(both(a.high, b.high))
      .sum();
}

}  // namespace

// Goes down the tree with itself.
class FacingSearch {
 public:
  FacingSearch(const SurfaceTree& tree, std::span<const Vec3> ahead, double reach, double depth)
      : tree_(tree),
        ahead_(ahead),
        reach_(reach),
        depth_(depth),
        parts_(tree.node_.size()),
        seen_(tree.x_.size()) {
    for (std::size_t t = 0; t < tree.triangle_.size(); ++t) {
      normal_.push_back(
          unit_normal(tree.corners(static_cast<std::int32_t>(t))).value_or(Vec3::Zero()));
      Box& box = box_ahead_.emplace_back();
      for (const std::int32_t node : tree.triangle_[t]) box.add(ahead[node]);
      way_.emplace_back(tree.box_[t]).add(box);
    }
    for (std::size_t k = parts_.size(); k-- > 0;) {  // children stand behind their parents
      for_triangles(k, [&](std::int32_t t) {
        parts_[k].normals.add(normal_[t]);
        parts_[k].way.add(way_[t]);
      });
      if (is_leaf(k)) continue;
      for (const std::size_t child : {k + 1, right_of(k)}) {
        parts_[k].normals.add(parts_[child].normals);
        parts_[k].way.add(parts_[child].way);
      }
    }
  }

  std::vector<SurfaceTree::Facing> found() {
    if (!tree_.node_.empty()) within(0);
    sort_opposites();
    for (std::size_t t = 0; t < tree_.triangle_.size(); ++t)
      for (std::size_t k = first_[t]; k < first_[t + 1]; ++k)
        for (const std::int32_t node : tree_.nodes(opposite_[k].triangle))
          take_node(node, static_cast<std::int32_t>(t), opposite_[k]);
    std::sort(found_.begin(), found_.end(), [](const auto& f, const auto& g) {
      return f.node != g.node ? f.node < g.node : f.triangle < g.triangle;
    });
    return std::move(found_);
  }

 private:
  bool is_leaf(std::size_t k) const { return tree_.node_[k].count > 0; }
  std::size_t right_of(std::size_t k) const {
    return static_cast<std::size_t>(tree_.node_[k].right);
  }
  template <class Visit>
  void for_triangles(std::size_t k, Visit visit) const {
    const SurfaceTree::Node& node = tree_.node_[k];
    for (std::int32_t j = node.first; j < node.first + node.count; ++j) visit(tree_.order_[j]);
  }

  struct Opposite {
    std::int32_t triangle = 0;
    double opposition = 0;
  };
  // The triangle that looked at a node last, and where it stands in found_, if it does.
  struct Seen {
    std::int32_t by = -1, found = -1;
  };

  void within(std::size_t k) {
    if (least_dot(parts_[k].normals, parts_[k].normals) >= least_opposite) return;
    if (!is_leaf(k)) {
      within(k + 1);
      within(right_of(k));
      between(k + 1, right_of(k));
      return;
    }
    for_triangles(k, [&](std::int32_t s) {
      for_triangles(k, [&](std::int32_t t) {
        if (s < t) take(s, t);
      });
    });
  }

  void between(std::size_t a, std::size_t b) {
    const Part &part_a = parts_[a], &part_b = parts_[b];
    if (!part_a.way.overlaps(part_b.way, reach_) ||
        least_dot(part_a.normals, part_b.normals) >= least_opposite)
      return;
    if (is_leaf(a) && is_leaf(b)) {
      for_triangles(a,
                    [&](std::int32_t s) { for_triangles(b, [&](std::int32_t t) { take(s, t); }); });
      return;
    }
    const bool goes_into_a = is_leaf(b) || (!is_leaf(a) && part_a.way.size().squaredNorm() >=
                                                               part_b.way.size().squaredNorm());
    const std::size_t parent = goes_into_a ? a : b, other = goes_into_a ? b : a;
    between(parent + 1, other);
    between(right_of(parent), other);
  }

  void take(std::int32_t s, std::int32_t t) {
    const double opposition = normal_[s].dot(normal_[t]);
    if (opposition < least_opposite && way_[s].overlaps(way_[t], (1 + slack) * reach_))
      pairs_.push_back({s, t, opposition});
  }

  // By triangle, so that a node that several of them share is looked at once.
  void sort_opposites() {
    first_.assign(tree_.triangle_.size() + 1, 0);
    for (const Pair& pair : pairs_) {
      ++first_[pair.s];
      ++first_[pair.t];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    opposite_.resize(2 * pairs_.size());
    for (const Pair& pair : pairs_) {
      opposite_[--first_[pair.s]] = {pair.t, pair.opposition};
      opposite_[--first_[pair.t]] = {pair.s, pair.opposition};
    }
  }

  // Of a triangle that faces t.
  void take_node(std::int32_t node, std::int32_t t, const Opposite& s) {
    Seen& seen = seen_[node];
    if (seen.by != t) {
      seen = {.by = t};
      if (!may_meet(node, t)) return;
      seen.found = static_cast<std::int32_t>(found_.size());
      found_.push_back({node, t, s.opposition, s.triangle});
    }
    if (seen.found < 0) return;
    SurfaceTree::Facing& f = found_[seen.found];
    if (std::pair(s.opposition, s.triangle) < std::pair(f.opposition, f.own))
      f = {node, t, s.opposition, s.triangle};
  }

  bool may_meet(std::int32_t node, std::int32_t t) const {
    const std::array<std::int32_t, 3>& own = tree_.nodes(t);
    const Vec3& n = normal_[t];
    const Vec3 &x = tree_.position(node), &x_ahead = ahead_[node];
    const double now = n.dot(x - tree_.position(own[0]));
    const double later = n.dot(x_ahead - ahead_[own[0]]);
    return std::max(now, later) > -depth_ && std::min(now, later) < reach_ &&
           comes_near(x, x_ahead, t) && std::find(own.begin(), own.end(), node) == own.end();
  }

  // As seen from the triangle's box.
  bool comes_near(const Vec3& x, const Vec3& x_ahead, std::int32_t t) const {
    const Box &now = tree_.box_[t], &later = box_ahead_[t];
    Box way;
    for (const Vec3& d : {Vec3(x - now.low), Vec3(x - now.high), Vec3(x_ahead - later.low),
                          Vec3(x_ahead - later.high)})
      way.add(d);
    return way.distance2(Vec3::Zero()) < reach_ * reach_;
  }

  struct Part {
    Box normals, way;
  };
  struct Pair {
    std::int32_t s = 0, t = 0;
    double opposition = 0;
  };

  const SurfaceTree& tree_;
  std::span<const Vec3> ahead_;
  double reach_, depth_;
  std::vector<Vec3> normal_;        // (n_triangles)
  std::vector<Box> box_ahead_;      // (n_triangles)
  std::vector<Box> way_;            // (n_triangles) now and ahead
  std::vector<Part> parts_;         // (n tree nodes)
  std::vector<Pair> pairs_;         // of triangles, each once
  std::vector<std::size_t> first_;  // (n_triangles + 1) into opposite_
  std::vector<Opposite> opposite_;
  std::vector<Seen> seen_;  // (n_nodes)
  std::vector<SurfaceTree::Facing> found_;
};

std::vector<SurfaceTree::Facing> SurfaceTree::facing(std::span<const Vec3> ahead, double reach,
                                                     double depth) const {
  return FacingSearch(*this, ahead, reach, depth).found();
}

}  // namespace trocar
