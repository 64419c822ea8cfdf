// What one cut of bench_cut gave, measured on the mesh alone, and tables of many.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cut_case.h"
#include "mesh/element_boxes.h"

namespace trocar::cut_bench {

struct Result {
  std::string fault;                                          // empty if the body is sound
  int n_inverted = 0, n_pieces = 0, n_exact = 0, n_thin = 0;  // thin: exact pieces below h^3
  int n_refused = 0, n_edits = 0, n_opened = 0, n_duplicated = 0;
  int n_turned = 0, n_chips = 0, n_beside = 0, n_pulled_back = 0;  // rungs, see CutFigures
  int n_inverted_by_move = 0;                                      // see CutFigures
  int n_inserted = 0;                                              // nodes on edges
  int n_added = 0;                                                 // elements; negative: dissolved
  int n_hexahedra = 0, n_converted = 0, n_reshaped = 0;  // before; reshaped: stay hexahedra
  // Element bound of the stable step, V / sqrt(sum of squared facet areas), after over before: of
  // the whole body, and of the elements that the cut changed.
  double body_ratio = 1, cut_ratio = 1;
  double least_dihedral = 180;              // degrees, of changed elements
  std::vector<double> deviation;            // of nodes of the cut's facets from the blade, over h
  double volume_error = 0, mass_error = 0;  // relative
  // The same of the volumes of regions, hexahedra as their tetrahedra; -1 if there is one region.
  double region_error = -1;
  double seconds = 0, longest_advance = 0;
  double split_elements = 1, split_ratio = 1;  // the subdivision's, after over before
  bool is_right() const {
    return fault.empty() && n_inverted == 0 && n_pieces <= n_exact && n_pieces >= n_exact - n_thin;
  }
};

// A body under the knife.
struct CutBody {
  Body body;
  cutting_test::Ledger ledger;
  std::vector<std::int32_t> origin;  // (n_elements) of the uncut body
  ElementBoxes boxes;
  explicit CutBody(const Mesh& mesh)
      : body(mesh), origin(mesh.element_type.size()), boxes(make_element_boxes(mesh, mesh.X)) {
    std::iota(origin.begin(), origin.end(), 0);
  }
};
// Adds the times to `result`.
void run_stroke(const Stroke& stroke, TetCutter& cutter, CutBody& cut, Result& result);

Result make_cut(const Mesh& mesh, const Kind& kind, std::mt19937_64& random,
                const CutTetOptions& options);

struct Row {
  std::string family, kind;
  std::vector<Result> result;
};
void print_head(std::FILE* file);
void print_row(const Row& row, std::FILE* file);
void print_json(const std::vector<Row>& rows, std::FILE* file);

}  // namespace trocar::cut_bench
