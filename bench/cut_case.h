// What bench_cut cuts: families of meshes, kinds of cuts, and the exact answer by subdivision.
#pragma once

#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "cutting_tet.h"

namespace trocar::cut_bench {

using cutting_test::Blade;
using cutting_test::Body;

struct Family {
  std::string name;
  std::function<Mesh(unsigned seed)> make;
};
// Of `n_cells` cells a direction.
std::vector<Family> generated_families(int n_cells);
// Those, and meshes from files.
std::vector<Family> families(int n_cells, const std::vector<std::string>& mesh_files);
// Cubes of two regions that meet in the middle plane across z.
std::vector<Family> layered_families();
// Plates one cell thick, flat and bent.
std::vector<Family> plate_families();

// One stroke of a blade and the surface that it sweeps: phi its signed distance, > 0 where `normal`
// points.
struct Stroke {
  Blade blade;
  Vec3 normal = Vec3::UnitZ();
  int n_steps = 1;
  std::function<double(const Vec3&)> phi;
};

struct Kind {
  std::string name;
  bool is_through = true;  // the strokes part the body
  std::function<std::vector<Stroke>(const Mesh& mesh, std::mt19937_64& random)> strokes;
};
std::vector<Kind> kinds();
// These and planes nearly along the middle plane, up to an edge beside it.
std::vector<Kind> layered_kinds();
// Planes along a plate of plate_families.
std::vector<Kind> plate_kinds();

// Sheared, stretched and bent; F stays within some 40 % of the identity.
cutting_test::Deformation random_bend(std::mt19937_64& random);

// Prints what the same incision costs in boxes of so many cells along an edge, six tetrahedra each.
void print_scaling(std::span<const int> cells, std::FILE* file);

// Random cuts of bent bodies, the generated families and all kinds in turn: prints how many left an
// element inverted, in the reference or in the present configuration, or the body unsound, and the
// seed of each such cut. Ends after `minutes`. False if there was one.
struct LongRun {
  unsigned seed = 1;
  int n_cuts = 100000;
  double minutes = 1e9;
};
bool print_long_run(const LongRun& run, std::FILE* file);

// Random cuts of bent bodies in free motion; then `n_steps` steps of central differences at 0.9 of
// the elements' bound that the cut left, and at a scene's default. Prints limits and energies by
// family; false if one blew up. Throws InputError if no cut is of the family.
struct AfterRun {
  unsigned seed = 1;
  int n_cuts = 200, n_steps = 10000;
  std::string family = {};  // of those cuts; empty: all
};
bool print_after(const AfterRun& run, std::FILE* file);

// The textbook's way, for comparison: every crossed edge gets a node where the surface meets it,
// and elements are split there (all edges that `strokes` cross, whether the blade gets there or
// not).
struct Subdivision {
  Mesh mesh;
  std::vector<double> piece_volume;  // of the pieces that the surfaces part exactly
};
Subdivision subdivide(const Mesh& mesh, const std::vector<Stroke>& strokes);

}  // namespace trocar::cut_bench
