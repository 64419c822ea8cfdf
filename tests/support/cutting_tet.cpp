#include "cutting_tet.h"

#include "cutting/cut_hex.h"
#include "known_positions.h"

namespace trocar::cutting_test {

Vec3 at_rest(const Vec3& X) {
  return X;
}

CutIndex index_of(const Mesh& mesh) {
  CutIndex index;
  update_index(mesh, index);
  return index;
}

CutPatch whole_patch(const Body& body) {
  std::vector<std::int32_t> all(body.mesh.element_type.size());
  std::iota(all.begin(), all.end(), 0);
  CutIndex index = index_of(body.mesh);
  KnownPositions positions(body.mesh, body.x);
  return make_patch(body.mesh, index, positions, {body.is_held, body.border}, all);
}

void apply(const MeshEdit& edit, const CutFigures& figures, Body& body, Ledger& ledger) {
  add(figures, !edit.is_empty(), ledger.total);
  if (edit.is_empty()) return;
  std::vector<double> field;
  for (const Vec3& p : body.x) field.insert(field.end(), {p.x(), p.y(), p.z()});
  apply_edit(edit, body.mesh, 3, field);
  apply_edit(edit, body.mesh);
  body.x.clear();
  for (std::size_t i = 0; i + 2 < field.size(); i += 3)
    body.x.emplace_back(field[i], field[i + 1], field[i + 2]);
  for (const EdgeNode& node : edit.inserted) {
    const auto held = [&](std::int32_t i) { return body.is_held[i] != 0; };
    body.is_held.push_back(held(node.end[0]) && held(node.end[1]) ? 1 : 0);
  }
  for (const std::int32_t parent : edit.duplicate_parent) {
    const std::uint8_t held = body.is_held[parent];
    body.is_held.push_back(held);
  }
  ++ledger.n_edits;
  ledger.deviation_sum += figures.deviation_sum;
}

CutterEdit advance(TetCutter& cutter, Body& body, const BladeSweep& sweep, bool is_last,
                   Ledger& ledger) {
  CutFigures figures;
  KnownPositions positions(body.mesh, body.x);
  const CutConstraints constraints{body.is_held, body.border};
  CutterEdit edit = cutter.advance(body.mesh, positions, constraints, sweep, is_last, figures);
  apply(edit, figures, body, ledger);
  if (!edit.is_empty()) body.edit_fault = fault(body);
  return edit;
}

Blade straight_blade(const Vec3& from, const Vec3& to, const Vec3& way, int n) {
  return [=](double t) {
    std::vector<Vec3> edge;
    for (int k = 0; k <= n; ++k) edge.push_back(from + (to - from) * (double(k) / n) + t * way);
    return edge;
  };
}

Ledger cut(Body& body, const Blade& blade, const Vec3& normal, int n_steps, TetCutter& cutter,
           const Motion& motion) {
  Ledger ledger;
  cutter.start_stroke();
  for (int k = 0; k < n_steps; ++k) {
    if (motion) body.deform([&](const Vec3& X) { return motion(X, double(k) / n_steps); });
    BladeSweep sweep{blade(double(k) / n_steps), blade(double(k + 1) / n_steps), normal};
    for (bool is_parted = false; !is_parted; sweep.before = sweep.after)
      is_parted = advance(cutter, body, sweep, k + 1 == n_steps, ledger).inserted.empty();
  }
  return ledger;
}

Ledger cut(Body& body, const Blade& blade, const Vec3& normal, int n_steps) {
  TetCutter cutter{CutTetOptions{}};
  return cut(body, blade, normal, n_steps, cutter);
}

Blade plane_blade(const Vec3& centre, const Vec3& normal, double size) {
  const Vec3 along = normal.unitOrthogonal(), way = normal.cross(along);
  const Vec3 begin = centre - size * way;
  return straight_blade(begin - size * along, begin + size * along, 2 * size * way, 16);
}

Ledger cut_with_index(const Vec3& across, Body& body, CutIndex& index,
                      const std::function<void(int k)>& before_advance,
                      const std::function<void()>& after_advance) {
  constexpr int n = 20;
  const Vec3 normal = across.normalized();
  const Blade blade = plane_blade(Vec3::Constant(0.5), normal, 1);
  TetCutter cutter{CutTetOptions{}};
  Ledger ledger;
  for (int k = 0; k < n; ++k) {
    before_advance(k);
    const BladeSweep sweep{blade(double(k) / n), blade(double(k + 1) / n), normal};
    const Mesh before = body.mesh;
    edit_index(before, advance(cutter, body, sweep, k + 1 == n, ledger), index);
    after_advance();
  }
  return ledger;
}

void add_region(Mesh& mesh, const std::function<bool(const Vec3&)>& is_there) {
  const auto region = static_cast<std::int32_t>(mesh.region_name.size());
  mesh.region_name.push_back("region " + std::to_string(region));
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (std::ranges::any_of(mesh.corners(e), [&](std::int32_t i) { return is_there(mesh.X[i]); }))
      mesh.element_region[e] = region;
}

std::vector<double> region_volumes(const Mesh& mesh) {
  HexTets tets;
  update_hex_tets(mesh, tets);
  std::vector<double> V(mesh.region_name.size(), 0);
  for (std::int32_t e = 0; e < tets.mesh.n_elements(); ++e)
    V[tets.mesh.element_region[e]] += element_volume(tets.mesh, e, tets.mesh.X);
  return V;
}

double least_step_of(const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    least = std::min(least, tet_step_bound(mesh, e));
  return least;
}

Mesh irregular(Mesh mesh, double amount, unsigned seed) {
  std::mt19937_64 random(seed);
  for (Vec3& X : mesh.X)
    for (double& x : X) x += amount * (double(random() >> 11) * 0x1p-52 - 1);
  return mesh;
}

std::array<Vec3, 2> crossing_normals(double angle, double tilt) {
  const Vec3 across = std::cos(tilt) * Vec3(-std::sin(angle), std::cos(angle), 0),
             up = std::sin(tilt) * Vec3::UnitZ();
  return {across + up, across - up};
}

std::string boundary_fault(const Mesh& mesh) {
  const Surface surface = boundary_surface(mesh);
  std::vector<std::array<std::int32_t, 2>> edge;
  std::vector<std::vector<std::array<std::int32_t, 2>>> link(mesh.X.size());
  for (const auto& t : surface.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      edge.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
      link[t[k]].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  std::sort(edge.begin(), edge.end());
  for (std::size_t begin = 0, end = 0; begin < edge.size(); begin = end) {
    while (end < edge.size() && edge[end] == edge[begin]) ++end;
    if (end - begin != 2)
      return "edge " + std::to_string(edge[begin][0]) + " " + std::to_string(edge[begin][1]) +
             " has " + std::to_string(end - begin) + " boundary facets";
  }
  for (std::size_t i = 0; i < link.size(); ++i) {
    if (link[i].empty()) continue;
    std::int32_t at = link[i][0][0];
    std::size_t n = 0;
    do {
      const auto next =
          std::find_if(link[i].begin(), link[i].end(), [&](const auto& k) { return k[0] == at; });
      if (next == link[i].end()) return "the link of node " + std::to_string(i) + " has an end";
      at = (*next)[1];
    } while (++n < link[i].size() && at != link[i][0][0]);
    if (n != link[i].size()) return "the link of node " + std::to_string(i) + " is not one cycle";
  }
  return "";
}

std::string fault(const Body& body) {
  if (!body.edit_fault.empty()) return body.edit_fault;
  if (const auto broken = validate(body.mesh); !broken.empty()) return broken.front();
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e)
    if (!(element_volume(body.mesh, e, body.x) > 0))
      return "element " + std::to_string(e) + " is inverted in the present configuration";
  return boundary_fault(body.mesh);
}

}  // namespace trocar::cutting_test
