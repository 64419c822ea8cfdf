// What explicit time integration does after a cut: bodies that move are cut, and stepped on.
#include <map>

#include "base/error.h"
#include "cut_case.h"
#include "engine/apply_cut.h"
#include "known_positions.h"
#include "larger_or_nan.h"
#include "stability_body.h"

namespace trocar::cut_bench {

namespace {

constexpr int n_cells = 4;
constexpr int steps_an_advance = 4;  // of the blade
constexpr int steps_a_frame = 10;    // the limit is looked for anew each time, as a scene does
constexpr double blown_up = 1;       // growth of the energy

// The step: a part of 2 / omega or of the elements' least bound, in the present deformation.
// Central differences conserve an energy near the true one as long as the step stays what it is;
// one that falls and rises with the deformation swings with the body's own modes and drives them.
// So it falls at once but rises slowly or not at all, but for two rules that show it.
constexpr double follows = std::numeric_limits<double>::infinity();
struct Rule {
  const char* name;
  double part;
  bool is_sharp;
  double rise;  // at most, in a step, over the step
};
constexpr std::array<Rule, 4> rules{{{"0.9 of the elements' bound", 0.9, false, 0},
                                     {"the same, step follows", 0.9, false, follows},
                                     {"a scene's: 0.85 of 2 / omega", 0.85, true, 1e-4},
                                     {"the same, step follows", 0.85, true, follows}}};

struct After {
  double bound_ratio = 1, limit_ratio = 1;  // after / before the cut, in the present deformation
  double energy = 0;                        // before the first edit
  double most = 1;                          // energy while it was cut, over the first
  std::array<double, rules.size()> growth{}, uncut{};  // of the energy, less 1; of the uncut body
  std::vector<double> jump;  // at each edit: of strain and kinetic energy, over what it was
  double least_J = 1;        // det F after an edit
};

BodyOptions tissue() {
  return {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}}};
}

}  // namespace

// Bent by some 10 %, with waves of a tenth of the speed of sound in shear (1 m/s).
static trocar::Body moving_body(Mesh mesh, std::mt19937_64& random) {
  trocar::Body body = make_body(std::move(mesh), tissue());
  const cutting_test::Deformation bend = random_bend(random), wave = random_bend(random);
  displace(body, [&](const Vec3& X) { return Vec3(0.25 * (bend(X) - X)); });
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i) {
    const Vec3 v = 0.5 * (wave(body.mesh.X[i]) - body.mesh.X[i]);
    for (std::size_t k = 0; k < 3; ++k) body.state.v[3 * i + k] = v[Eigen::Index(k)];
  }
  return body;
}

static std::vector<Vec3> present(const trocar::Body& body) {
  std::vector<Vec3> x = body.mesh.X;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += Vec3(body.state.u[3 * i], body.state.u[3 * i + 1], body.state.u[3 * i + 2]);
  return x;
}

// As a running scene does.
static void apply(const MeshEdit& edit, trocar::Body& body) {
  if (edit.is_empty()) return;
  Communicator alone;
  Simulation s;
  s.communicator = &alone;
  for (const char* name : phase_names) s.timers.phase(name);
  s.mesh = body.mesh;
  s.materials = body.materials;
  s.fixed.assign(s.mesh.X.size(), 0);
  s.node_owner.assign(s.mesh.X.size(), 0);
  rebuild_topology(s);
  s.state = body.state;  // v is of the middle of the last step
  GlobalState global = gather_state(s);
  CutRecord record;
  apply_cut(s, edit, global, record);
  body = make_body(std::move(s.mesh), tissue());
  body.state.u = s.state.u;
  body.state.v = s.state.v;
  body.state.last_dt = s.state.last_dt;
}

static double present_energy(trocar::Body& body) {
  return stored_energy(body) + kinetic(body);
}

// What central differences conserve has the velocities of half a step before and behind. Of two
// steps of different lengths their product is off by the square of both: so in the second of two.
static double two_steps(trocar::Body& body, double dt) {
  step(body, dt);
  return step_and_measure(body, dt);
}

// The body moves on by some steps between two advances of the blade.
static void cut_in_motion(const Stroke& stroke, double dt, TetCutter& cutter, trocar::Body& body,
                          After& after) {
  cutter.start_stroke();
  for (int k = 0; k < stroke.n_steps; ++k) {
    const BladeSweep sweep{stroke.blade(double(k) / stroke.n_steps),
                           stroke.blade(double(k + 1) / stroke.n_steps), stroke.normal};
    const std::vector<std::uint8_t> is_held(body.mesh.X.size(), 0);
    CutFigures figures;
    const std::vector<Vec3> x = present(body);
    KnownPositions positions(body.mesh, x);
    const MeshEdit edit =
        cutter.advance(body.mesh, positions, {is_held}, sweep, k + 1 == stroke.n_steps, figures);
    const double energy = present_energy(body);
    apply(edit, body);
    if (!edit.is_empty()) {
      after.jump.push_back(present_energy(body) / energy - 1);
      after.least_J = std::min(after.least_J, look(body).least_J);
    }
    for (int n = 2; n < steps_an_advance; ++n) step(body, dt);
    after.most = std::max(after.most, two_steps(body, dt) / after.energy);
  }
}

// As engine finds it: 2 / omega, or the elements' bound where that is larger.
static double limit_in_scene(trocar::Body& body) {
  const double bound = look(body).stable_step;
  if (!(bound > 0)) return 0;
  const double omega = search_frequency(body, {.amplitude = 1e-8}).omega;
  return std::max(bound, 2 / (frequency_margin * omega));
}

static double limit_for(const Rule& rule, trocar::Body& body) {
  if (!is_finite(body)) return 0;
  return rule.is_sharp ? limit_in_scene(body) : look(body).stable_step;
}

// Steps by dt; the energy at its beginning.
static double one_frame(trocar::Body& body, double dt) {
  const double energy = two_steps(body, dt);
  for (int k = 2; k < steps_a_frame; ++k) step(body, dt);
  return energy;
}

// Largest energy over the first one, less 1; infinite if the body is not finite any more. A frame
// whose step was too long for its end is stepped again, as in a scene.
static double growth(trocar::Body body, const Rule& rule, int n_steps) {
  double first = 0, most = 0, dt = std::numeric_limits<double>::infinity();
  double limit = limit_for(rule, body);
  for (int done = 0; done < n_steps; done += steps_a_frame) {
    const State good = body.state;
    double energy = 0;
    dt = std::min(dt * (1 + steps_a_frame * rule.rise), rule.part * limit);
    for (bool is_done = false; !is_done;) {
      energy = one_frame(body, dt);
      limit = limit_for(rule, body);
      if (!(limit > 0)) return std::numeric_limits<double>::infinity();
      is_done = dt <= limit;
      if (is_done) continue;
      body.state = good;
      dt = rule.part * limit;
    }
    if (done == 0) first = energy;
    most = larger_or_nan(most, energy);
  }
  return most / first - 1;
}

static After cut_and_step(const Family& family, const Kind& kind, unsigned seed, int n_steps) {
  std::mt19937_64 random(seed);
  trocar::Body body = moving_body(family.make(seed), random);
  After after;
  for (std::size_t k = 0; k < rules.size(); ++k) after.uncut[k] = growth(body, rules[k], n_steps);
  Mesh shape = body.mesh;  // the blade moves in space
  shape.X = present(body);
  const double limit = limit_of(body), bound = look(body).stable_step;
  TetCutter cutter{CutTetOptions{}};
  // One step throughout, so that energies compare: half of the floor under a body of hexahedra.
  const double dt = 0.27 * bound;
  after.energy = two_steps(body, dt);
  for (const Stroke& stroke : kind.strokes(shape, random))
    cut_in_motion(stroke, dt, cutter, body, after);
  after.limit_ratio = limit_of(body) / limit;
  after.bound_ratio = look(body).stable_step / bound;
  for (std::size_t k = 0; k < rules.size(); ++k) after.growth[k] = growth(body, rules[k], n_steps);
  return after;
}

template <class Value>
static std::string least_and_median(const std::vector<After>& cuts, const Value& value) {
  std::vector<double> v;
  for (const After& cut : cuts) v.push_back(value(cut));
  std::sort(v.begin(), v.end());
  return text("%.2f, %.2f", v[0], v[v.size() / 2]);
}

// Median, 99th percentile and largest of what edits changed of the energy, and the most that one
// added, in percent.
static std::string jumps(const std::vector<After>& cuts) {
  std::vector<double> size;
  double most = 0;
  for (const After& cut : cuts)
    for (const double jump : cut.jump) {
      size.push_back(100 * std::abs(jump));
      most = larger_or_nan(most, 100 * jump);
    }
  if (size.empty()) return "-";
  std::sort(size.begin(), size.end());
  return text("%.2f, %.2f, %.2f; %+.2f", size[size.size() / 2], size[(size.size() - 1) * 99 / 100],
              size.back(), most);
}

static void print_family(const std::string& name, const std::vector<After>& cuts, std::FILE* file) {
  std::size_t n_edits = 0;
  double most_in_cut = 0;
  for (const After& cut : cuts) {
    n_edits += cut.jump.size();
    most_in_cut = larger_or_nan(most_in_cut, cut.most);
  }
  std::fprintf(file, "| %s | %zu | %zu | %s | %s | %s | %.3f |", name.c_str(), cuts.size(), n_edits,
               least_and_median(cuts, [](const After& c) { return c.bound_ratio; }).c_str(),
               least_and_median(cuts, [](const After& c) { return c.limit_ratio; }).c_str(),
               jumps(cuts).c_str(), most_in_cut);
  for (std::size_t k = 0; k < rules.size(); ++k) {
    double most = 0;
    int n_blown = 0, n_uncut = 0;
    for (const After& cut : cuts) {
      n_blown += cut.growth[k] < blown_up ? 0 : 1;
      n_uncut += cut.uncut[k] < blown_up ? 0 : 1;
      if (cut.growth[k] < blown_up) most = larger_or_nan(most, cut.growth[k]);
    }
    std::fprintf(file, " %d (%d), %.3f |", n_blown, n_uncut, 1 + most);
  }
  std::fprintf(file, "\n");
}

// That an edit inverts nothing and changes the energy by 1 % at most.
static bool keeps_promises(const std::string& name, unsigned seed, const After& after,
                           std::FILE* file) {
  double most = 0;
  for (const double jump : after.jump) most = larger_or_nan(most, std::abs(jump));
  if (most <= 0.01 && after.least_J > 0) return true;
  std::fprintf(file, "seed %u: %s, an edit changed the energy by %.2f %%, least det F %.3f\n", seed,
               name.c_str(), 100 * most, after.least_J);
  return false;
}

static void print_head(int n_steps, std::FILE* file) {
  std::fprintf(
      file,
      "| mesh | cuts | edits | bound after / before: least, median | 2 / omega | "
      "energy changed by an edit, %%: median, p99, max; most added | largest energy while cut |");
  for (const Rule& rule : rules) std::fprintf(file, " %s |", rule.name);
  std::fprintf(file, "\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::fprintf(stderr,
               "last columns: bodies that blew up in %d steps (uncut ones), largest energy "
               "of the others over that at the cut\n",
               n_steps);
}

bool print_after(const AfterRun& run, std::FILE* file) {
  const std::vector<Family> all = generated_families(n_cells);
  const std::vector<Kind> kind = kinds();
  std::map<std::string, std::vector<After>> of_family;
  bool is_sound = true;
  for (int k = 0; k < run.n_cuts; ++k) {
    const unsigned seed = run.seed + unsigned(k);
    const Family& family = all[seed % all.size()];
    if (!run.family.empty() && family.name != run.family) continue;
    const Kind& cut = kind[seed / all.size() % kind.size()];
    const After after = cut_and_step(family, cut, seed, run.n_steps);
    of_family[family.name].push_back(after);
    is_sound = keeps_promises(family.name, seed, after, file) && is_sound;
    for (std::size_t r = 0; r < rules.size(); ++r) {
      if (rules[r].rise == follows || after.growth[r] < blown_up) continue;
      is_sound = false;
      std::fprintf(file, "seed %u blew up: %s %s, %s, energy %.3g-fold; uncut %.3g-fold\n", seed,
                   family.name.c_str(), cut.name.c_str(), rules[r].name, 1 + after.growth[r],
                   1 + after.uncut[r]);
    }
  }
  if (of_family.empty()) throw InputError("none of these cuts is of family " + run.family);
  print_head(run.n_steps, file);
  for (const auto& [name, cuts] : of_family) print_family(name, cuts, file);
  return is_sound;
}

}  // namespace trocar::cut_bench
