// Graded plane meshes: rows of nodes whose number and spacing change from one side to the other.
#include <numeric>
#include <string>

#include "base/error.h"
#include "mesh/generate.h"

namespace trocar {

namespace {

// t in [0, 1] to [0, 1]: steps at the far end are grade^2 times those at the near end.
double graded(double t, double grade) {
  return t / (grade + (1 - grade) * t);
}

struct Row {
  std::int32_t begin = 0;
  int n = 0;
};

// Triangles between two rows: of the two possible next edges always the shorter one.
void add_strip(Mesh& mesh, const Row& below, const Row& above) {
  std::int32_t i = below.begin, j = above.begin;
  const std::int32_t last_i = i + below.n - 1, last_j = j + above.n - 1;
  while (i < last_i || j < last_j) {
    bool is_below = j == last_j;
    if (i < last_i && j < last_j)
      is_below =
          (mesh.X[i + 1] - mesh.X[j]).squaredNorm() <= (mesh.X[i] - mesh.X[j + 1]).squaredNorm();
    const std::int32_t next = is_below ? i + 1 : j + 1;
    add_element(mesh, ElementType::tri3, std::array<std::int32_t, 3>{i, next, j});
    (is_below ? i : j) = next;
  }
}

void check_rows(std::span<const int> n_row_nodes, double grade_x, double grade_y) {
  if (n_row_nodes.size() < 2) throw InputError("a graded mesh needs at least 2 rows of nodes");
  for (const int n : n_row_nodes)
    if (n < 2)
      throw InputError("a row of a graded mesh needs at least 2 nodes, not " + std::to_string(n));
  if (!(grade_x > 0) || !(grade_y > 0)) throw InputError("grades of a mesh must be positive");
}

}  // namespace

Mesh make_graded_rectangle(const Vec2& size, std::span<const int> n_row_nodes, double grade_x,
                           double grade_y) {
  if (!(size.x() > 0) || !(size.y() > 0))
    throw InputError("a plane mesh needs a positive width and height");
  check_rows(n_row_nodes, grade_x, grade_y);
  Mesh mesh;
  Row below;
  const int n_rows = static_cast<int>(n_row_nodes.size());
  for (int r = 0; r < n_rows; ++r) {
    const Row row{mesh.n_nodes(), n_row_nodes[r]};
    const double y = size.y() * graded(1.0 * r / (n_rows - 1), grade_y);
    for (int i = 0; i < row.n; ++i)
      mesh.X.emplace_back(size.x() * graded(1.0 * i / (row.n - 1), grade_x), y, 0.0);
    if (r > 0) add_strip(mesh, below, row);
    below = row;
  }
  return mesh;
}

}  // namespace trocar
