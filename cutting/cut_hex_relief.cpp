// What is left of a hexahedron's positions without the affine map that fits them best.
#include "cutting/cut_hex_relief.h"

#include <algorithm>
#include <array>

#include "cutting/cut_patch.h"

namespace trocar {

namespace {

// Of the hourglass deformation. Measured (docs/cutting.md): less leaves more energy gained at the
// worst edits, more takes energy from all others.
constexpr double left_out = 0.5;
constexpr double least_residual = 1e-12;  // squared, over the distance from the centre: rounding
constexpr double least_volume = 0.25;     // of a tetrahedron, over its volume without relief

using Weights = std::array<double, max_corners>;

// A corner of a converted hexahedron.
struct Corner {
  std::int32_t node = 0, hex = 0;
  Vec3 residual = Vec3::Zero();  // present position off the affine map
};

// The affine map that fits the corners' reference positions: weight of corner b at corner a.
struct AffineFit {
  std::array<Vec3, 8> R;  // from the centre
  Mat3 inverse;

  AffineFit(const Mesh& mesh, std::int32_t hex) {
    const std::span<const std::int32_t> corner = mesh.corners(hex);
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t i : corner) centre += mesh.X[i] / 8;
    Mat3 squares = Mat3::Zero();
    for (std::size_t a = 0; a < 8; ++a) {
      R[a] = mesh.X[corner[a]] - centre;
      squares += R[a] * R[a].transpose();
    }
    inverse = squares.inverse();
  }
  double weight(std::size_t a, std::size_t b) const { return 0.125 + R[a].dot(inverse * R[b]); }
};

// A node on its way to be relieved.
struct Relief {
  NodeMove move;
  Vec3 before, after;  // present positions without and with it
};

// By node, then by hexahedron.
std::vector<Corner> residuals(const Mesh& body, std::span<const Vec3> x, const MeshEdit& edit) {
  std::vector<Corner> result;
  for (const HexSplit& split : edit.splits) {
    const AffineFit fit(body, split.element);
    const std::span<const std::int32_t> node = body.corners(split.element);
    for (std::size_t a = 0; a < 8; ++a) {
      Corner corner{node[a], split.element, x[node[a]]};
      for (std::size_t b = 0; b < 8; ++b) corner.residual -= fit.weight(a, b) * x[node[b]];
      if (corner.residual.squaredNorm() < least_residual * fit.R[a].squaredNorm())
        corner.residual.setZero();
      result.push_back(corner);
    }
  }
  std::sort(result.begin(), result.end(), [](const Corner& a, const Corner& b) {
    return a.node != b.node ? a.node < b.node : a.hex < b.hex;
  });
  return result;
}

const NodeMove* find_move(const MeshEdit& edit, std::int32_t node) {
  const auto at =
      std::lower_bound(edit.moves.begin(), edit.moves.end(), node,
                       [](const NodeMove& move, std::int32_t i) { return move.node < i; });
  return at != edit.moves.end() && at->node == node ? &*at : nullptr;
}

// The hexahedron that the node takes its values from: where its move has them from, else the one
// with the largest residual, the first of equal ones. Null if the move's is none of them.
const Corner* choose_host(std::span<const Corner> around, const NodeMove* move) {
  const Corner* host = nullptr;
  for (const Corner& corner : around) {
    if (move != nullptr && move->host != corner.hex) continue;
    if (host == nullptr || corner.residual.squaredNorm() > host->residual.squaredNorm())
      host = &corner;
  }
  return host;
}

// The part of the host's residual that all hexahedra around have in the mean.
double agreement(std::span<const Corner> around, const Corner& host) {
  Vec3 mean = Vec3::Zero();
  for (const Corner& corner : around) mean += corner.residual / static_cast<double>(around.size());
  const double square = host.residual.squaredNorm();
  return square > 0 ? std::clamp(mean.dot(host.residual) / square, 0.0, 1.0) : 0;
}

Vec3 position(const Mesh& body, std::span<const Vec3> x, const NodeMove& move) {
  Vec3 result = Vec3::Zero();
  const std::span<const std::int32_t> corner = body.corners(move.host);
  for (std::size_t a = 0; a < corner.size(); ++a) result += move.weight[a] * x[corner[a]];
  return result;
}

NodeMove stay(const Mesh& body, const Corner& at) {
  NodeMove move{at.node, body.X[at.node], at.hex, {}};
  const std::span<const std::int32_t> corner = body.corners(at.hex);
  move.weight[static_cast<std::size_t>(std::find(corner.begin(), corner.end(), at.node) -
                                       corner.begin())] = 1;
  return move;
}

Relief relieve(const Mesh& body, std::span<const Vec3> x, const NodeMove& move, double part) {
  Relief relief{move, position(body, x, move), {}};
  const AffineFit fit(body, move.host);
  for (std::size_t b = 0; b < 8; ++b) {
    double affine = 0;
    for (std::size_t a = 0; a < 8; ++a) affine += move.weight[a] * fit.weight(a, b);
    relief.move.weight[b] += part * (affine - move.weight[b]);
  }
  relief.after = position(body, x, relief.move);
  return relief;
}

std::vector<Relief> find_reliefs(const Mesh& body, std::span<const Vec3> x,
                                 std::span<const std::uint8_t> is_held, const MeshEdit& edit) {
  const std::vector<Corner> all = residuals(body, x, edit);
  std::vector<Relief> result;
  for (std::size_t k = 0, end = 0; k < all.size(); k = end) {
    while (end < all.size() && all[end].node == all[k].node) ++end;
    const std::span<const Corner> around(&all[k], end - k);
    const NodeMove* move = find_move(edit, all[k].node);
    const Corner* host = choose_host(around, move);
    if (host == nullptr || is_held[host->node] != 0) continue;
    const double part = left_out * agreement(around, *host);
    if (part > 0)
      result.push_back(relieve(body, x, move != nullptr ? *move : stay(body, *host), part));
  }
  return result;
}

// Present positions after the edit, with the reliefs or without; a copy lies where its parent does.
struct Present {
  const Mesh& body;
  std::span<const Vec3> x;
  const MeshEdit& edit;
  const std::vector<Relief>& reliefs;  // ascending node

  std::int32_t parent(std::int32_t i) const {
    while (i >= body.n_nodes())
      i = edit.duplicate_parent[static_cast<std::size_t>(i - body.n_nodes())];
    return i;
  }
  Vec3 of(std::int32_t i, bool is_relieved) const {
    i = parent(i);
    const auto at =
        std::lower_bound(reliefs.begin(), reliefs.end(), i,
                         [](const Relief& r, std::int32_t node) { return r.move.node < node; });
    if (at != reliefs.end() && at->move.node == i) return is_relieved ? at->after : at->before;
    const NodeMove* move = find_move(edit, i);
    return move != nullptr ? position(body, x, *move) : x[i];
  }
};

bool is_squeezed(const Present& present, std::span<const std::int32_t> tet) {
  if (tet.size() != 4) return false;  // a hexahedron that can't be split
  std::array<Vec3, 4> before, after;
  for (std::size_t a = 0; a < 4; ++a) {
    before[a] = present.of(tet[a], false);
    after[a] = present.of(tet[a], true);
  }
  constexpr std::array<std::int32_t, 4> all{0, 1, 2, 3};
  return six_volumes(after, all) < least_volume * six_volumes(before, all);
}

// Gives up reliefs around squeezed tetrahedra until there is none; at worst all.
void give_up_squeezing(const Mesh& tets, const CutIndex& index, const Present& present,
                       std::vector<Relief>& reliefs) {
  std::vector<std::int32_t> node;  // and copies
  for (const Relief& relief : reliefs) node.push_back(relief.move.node);
  for (std::size_t k = 0; k < present.edit.duplicate_parent.size(); ++k)
    node.push_back(present.body.n_nodes() + static_cast<std::int32_t>(k));
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (const std::int32_t i : node)
      for (const std::int32_t e : index.star(i)) {
        if (!is_squeezed(present, tets.corners(e))) continue;
        for (const std::int32_t j : tets.corners(e))
          is_changed =
              std::erase_if(
                  reliefs, [&](const Relief& r) { return r.move.node == present.parent(j); }) > 0 ||
              is_changed;
      }
  }
}

}  // namespace

void relieve_hourglass(const Mesh& body, std::span<const Vec3> x,
                       std::span<const std::uint8_t> is_held, const Mesh& tets,
                       const CutIndex& index, MeshEdit& edit) {
  std::vector<Relief> reliefs = find_reliefs(body, x, is_held, edit);
  give_up_squeezing(tets, index, {body, x, edit, reliefs}, reliefs);
  std::vector<NodeMove> moves;
  for (const Relief& relief : reliefs) moves.push_back(relief.move);
  for (const NodeMove& move : edit.moves)
    if (std::none_of(moves.begin(), moves.begin() + static_cast<std::ptrdiff_t>(reliefs.size()),
                     [&](const NodeMove& other) { return other.node == move.node; }))
      moves.push_back(move);
  std::sort(moves.begin(), moves.end(),
            [](const NodeMove& a, const NodeMove& b) { return a.node < b.node; });
  edit.moves = std::move(moves);
}

}  // namespace trocar
