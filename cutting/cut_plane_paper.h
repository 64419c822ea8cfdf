// Table 1 of Serby, Harders and Szekely 2001: the meshes, cuts that fit it, and the printed rows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cutting/cut_plane_statistics.h"

namespace trocar {

inline constexpr int n_paper_configurations = 6;

// 1, 2: right triangles; 3, 4: equilateral ones; 70 mm wide. 5, 6: the paper's meshes are not
// given; these are graded ones with its numbers of nodes and elements and its mean area.
Mesh paper_mesh(int configuration);
// The paper does not say where it cut. These straight cuts give its numbers of nodes, and for 1 and
// 2 all that it prints of the rows OR.
std::vector<Vec3> paper_cut(int configuration);

enum class PaperRowKind { initial, old_remeshing, new_remeshing };

struct PaperRow {
  int configuration = 0;
  PaperRowKind kind = PaperRowKind::initial;
  PlaneStatistics printed;  // `edge` as printed; edge_sigma_of_two is not set
  double seconds = 0;       // on an SGI Octane of 195 MHz; 0: not given
  std::string misprint;     // what of it contradicts itself, "" if nothing
};
std::span<const PaperRow> paper_table();

}  // namespace trocar
