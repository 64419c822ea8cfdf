// The long run: nothing but the invariants, on small bodies, so that there are many cuts.
#include <cmath>

#include "base/timers.h"
#include "cut_result.h"
#include "larger_or_nan.h"

namespace trocar::cut_bench {

namespace {

constexpr int n_cells = 5;
constexpr double most_mass_error = 1e-12;  // of the body's, rounding

struct Count {
  int cuts = 0, edits = 0, inverted_reference = 0, inverted_present = 0, unsound = 0,
      other_mass = 0;
  double mass_error = 0;
  int faults() const { return inverted_reference + inverted_present + unsound + other_mass; }
};

}  // namespace

static void count_inverted(const Body& body, Count& count) {
  bool is_in_reference = false, is_present = false;
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    is_in_reference = is_in_reference || !(element_volume(body.mesh, e, body.mesh.X) > 0);
    is_present = is_present || !(element_volume(body.mesh, e, body.x) > 0);
  }
  count.inverted_reference += is_in_reference ? 1 : 0;
  count.inverted_present += is_present ? 1 : 0;
}

static void cut_once(const Family& family, const Kind& kind, unsigned seed, Count& count) {
  std::mt19937_64 random(seed);
  CutBody cut(family.make(seed));
  cut.body.deform(random_bend(random));
  Mesh present = cut.body.mesh;  // the blade moves in space
  present.X = cut.body.x;
  const double mass = total_mass(cut.body.mesh);
  TetCutter cutter{CutTetOptions{}};
  Result result;
  for (const Stroke& stroke : kind.strokes(present, random)) {
    run_stroke(stroke, cutter, cut, result);
    count_inverted(cut.body, count);
  }
  ++count.cuts;
  count.edits += cut.ledger.n_edits;
  count.unsound += cutting_test::fault(cut.body).empty() ? 0 : 1;
  const double mass_error = std::abs(total_mass(cut.body.mesh) / mass - 1);
  count.mass_error = larger_or_nan(count.mass_error, mass_error);
  count.other_mass += mass_error <= most_mass_error ? 0 : 1;
}

static void print_count(const Count& count, unsigned seed, std::FILE* file) {
  std::fprintf(file,
               "seeds from %u: %d cuts, %d edits; inverted in the reference %d, in the present "
               "configuration %d; unsound %d; largest mass error %.1e\n",
               seed, count.cuts, count.edits, count.inverted_reference, count.inverted_present,
               count.unsound, count.mass_error);
  std::fflush(file);
}

bool print_long_run(const LongRun& run, std::FILE* file) {
  const std::vector<Family> all = generated_families(n_cells);
  const std::vector<Kind> kind = kinds();
  const double start = monotonic_seconds();
  Count count;
  for (int k = 0; k < run.n_cuts; ++k) {
    const unsigned seed = run.seed + unsigned(k);
    const Family& family = all[seed % all.size()];
    const Kind& cut = kind[seed / all.size() % kind.size()];
    const int before = count.faults();
    cut_once(family, cut, seed, count);
    if (count.faults() > before)
      std::fprintf(file, "seed %u is not sound: %s %s\n", seed, family.name.c_str(),
                   cut.name.c_str());
    if (count.cuts % 10000 == 0) print_count(count, run.seed, file);
    if (monotonic_seconds() - start > 60 * run.minutes) break;
  }
  print_count(count, run.seed, file);
  return count.faults() == 0;
}

}  // namespace trocar::cut_bench
