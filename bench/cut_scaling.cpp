// The same incision, 6 cells long and 3 deep, in ever larger boxes of unit cells.
#include <numeric>

#include "base/timers.h"
#include "cut_case.h"
#include "known_positions.h"
#include "mesh/node_corners.h"

namespace trocar::cut_bench {

namespace {

struct Cost {
  double prepare = 0;            // the look at the whole mesh, once [s]
  std::vector<double> advances;  // [s]
  double cut() const { return std::accumulate(advances.begin(), advances.end(), 0.0); }
  double longest() const { return *std::max_element(advances.begin(), advances.end()); }
  double median() const {
    std::vector<double> sorted = advances;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

}  // namespace

// Leaves nothing of the body in the caches.
static void empty_caches() {
  static std::vector<std::int64_t> other(std::size_t{1} << 25);
  for (std::size_t i = 0; i < other.size(); i += 8) ++other[i];
}

// A body that is cut, with what saves looks at all of it.
struct CutBox {
  Body body;
  NodeCorners corners;
  ElementBoxes boxes;

  explicit CutBox(Mesh mesh)
      : body(std::move(mesh)),
        corners(node_corners(body.mesh)),
        boxes(make_element_boxes(body.mesh, body.x)) {}
  void apply(const MeshEdit& edit) {
    std::vector<std::int32_t> nodes;  // moved or new
    for (const NodeMove& move : edit.moves) nodes.push_back(move.node);
    const std::int32_t n = body.mesh.n_nodes();
    for (std::int32_t k = 0; k < std::ssize(edit.duplicate_parent); ++k) nodes.push_back(n + k);
    apply_edit(edit, body.mesh, corners);
    cutting_test::Ledger ledger;
    cutting_test::apply(edit, {}, body, ledger);
    update_element_boxes(body.mesh, body.x, {{}, nodes, elements_around(corners, nodes)}, boxes);
  }
};

// Down to 3 cells under the upper face, then along x; `step` cells an advance.
static Cost cut_box(int n, double step, bool is_cold) {
  Mesh mesh = make_box({0, 0, 0}, Vec3::Constant(n), {n, n, n}, BoxElements::tet4_kuhn);
  jitter(mesh, 0.2, 1);
  CutBox box(std::move(mesh));
  Body& body = box.body;
  TetCutter cutter{CutTetOptions{}};
  Cost cost;
  const double start = thread_seconds();
  cutter.prepare(body.mesh);
  cost.prepare = thread_seconds() - start;
  const double middle = n / 2;
  const Vec3 begin(middle - 3.2, middle + 0.3, n - 3.1);
  const int n_steps = int(6.5 / step);
  const auto edge = [&](int k) {
    std::vector<Vec3> points;
    for (int j = 0; j <= 4; ++j)
      points.push_back(begin + Vec3(step * k, 0.2 * step * k, double(j)));
    return points;
  };
  const Vec3 normal = Vec3(-0.1, 0.5, 0).normalized();
  for (int k = 0; k < n_steps; ++k) {
    CutFigures figures;
    KnownPositions positions(body.mesh, body.x, box.boxes);
    if (is_cold) empty_caches();
    const double before = thread_seconds();
    const MeshEdit edit = cutter.advance(body.mesh, positions, {body.is_held},
                                         {edge(k), edge(k + 1), normal}, k + 1 == n_steps, figures);
    cost.advances.push_back(thread_seconds() - before);
    box.apply(edit);
  }
  return cost;
}

// The quickest of some runs: others may use the machine.
static Cost least_cost(int n, double step, bool is_cold) {
  Cost best = cut_box(n, step, is_cold);
  for (int run = 1; run < 7; ++run)
    if (Cost cost = cut_box(n, step, is_cold); cost.cut() < best.cut()) best = std::move(cost);
  return best;
}

void print_scaling(std::span<const int> cells, std::FILE* file) {
  std::fprintf(file,
               "| tetrahedra | set-up, once [ms] | cut in half edges [ms] | over the first row | "
               "median, longest half edge [ms] | cut in edges [ms] | median, longest edge [ms] | "
               "half edges, caches emptied before each [ms] | over the first row |\n"
               "|---|---|---|---|---|---|---|---|---|\n");
  double first = 0, first_cold = 0;
  for (const int n : cells) {
    const Cost half = least_cost(n, 0.5, false), whole = least_cost(n, 1, false);
    const Cost cold = least_cost(n, 0.5, true);
    if (first == 0) first = half.cut(), first_cold = cold.cut();
    std::fprintf(file,
                 "| %d | %.1f | %.2f | %.2f | %.2f, %.2f | %.2f | %.2f, %.2f | %.2f | %.2f |\n",
                 6 * n * n * n, 1e3 * half.prepare, 1e3 * half.cut(), half.cut() / first,
                 1e3 * half.median(), 1e3 * half.longest(), 1e3 * whole.cut(), 1e3 * whole.median(),
                 1e3 * whole.longest(), 1e3 * cold.cut(), cold.cut() / first_cold);
    std::fflush(file);
  }
}

}  // namespace trocar::cut_bench
