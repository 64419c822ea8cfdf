// Random cuts of meshes by displaced nodes, beside subdivision of the same cuts: what
// comes out right, what the stable step and the shapes of the elements become, and what it costs.
// bench_cut --help says how to ask.
#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "base/heap.h"
#include "bench/usage.h"
#include "cut_result.h"

using namespace trocar;
using namespace trocar::cut_bench;

namespace {

constexpr const char* usage =
    R"(bench_cut [--count N] [--seed S] [--family NAME] [--kind NAME] [--mesh FILE]... [--json FILE]
          [--markdown FILE] [--stages springs|springs_then_barrier|barrier] [--split RATIO]
          [--advances N]
         N random cuts of each mesh and kind (default 20) beside the subdivision of the same cuts;
         --advances N: each stroke in N advances in place of its own
         --cells N: generated meshes of N cells a side (default 8)
         --family layers: of bodies of two regions, also along where these meet
         --family plates: of plates one cell thick, in their plane
       bench_cut --cuts N [--seed S] [--minutes M]
         N cuts of bent bodies, the invariants alone
       bench_cut --after N [--steps M] [--seed S] [--family NAME]
         N cuts of moving bodies, and M steps after each (default 10000)
       bench_cut scaling [N]...
         the same incision in boxes of N x N x N cells (default: 6,000 to 1,000,000 tetrahedra))";

struct Arguments {
  int count = 20, cells = 8, advances = 0, cuts = 0, after = 0, steps = 10000;
  unsigned seed = 1;
  double minutes = 1e9;
  std::string family, kind, json, markdown;
  CutTetOptions options;
  std::vector<std::string> mesh;
};

CutStages stages_named(const std::string& name) {
  if (name == "springs") return CutStages::springs;
  if (name == "springs_then_barrier") return CutStages::springs_then_barrier;
  if (name == "barrier") return CutStages::barrier;
  throw InputError("there are no stages " + name);
}

double number_of(const std::string& name, const char* value) {
  char* end = nullptr;
  const double number = std::strtod(value, &end);
  if (end == value || *end != 0) throw InputError(name + " takes a number, not " + value);
  return number;
}

bool read_number(const std::string& name, const char* value, Arguments& a) {
  if (name == "--count")
    a.count = int(number_of(name, value));
  else if (name == "--cells")
    a.cells = int(number_of(name, value));
  else if (name == "--advances")
    a.advances = int(number_of(name, value));
  else if (name == "--cuts")
    a.cuts = int(number_of(name, value));
  else if (name == "--after")
    a.after = int(number_of(name, value));
  else if (name == "--steps")
    a.steps = int(number_of(name, value));
  else if (name == "--minutes")
    a.minutes = number_of(name, value);
  else if (name == "--seed")
    a.seed = unsigned(number_of(name, value));
  else
    return false;
  return true;
}

bool read_name(const std::string& name, const char* value, Arguments& a) {
  if (name == "--stages")
    a.options.stages = stages_named(value);
  else if (name == "--split")
    a.options.split_step_ratio = number_of(name, value);
  else if (name == "--family")
    a.family = value;
  else if (name == "--kind")
    a.kind = value;
  else if (name == "--json")
    a.json = value;
  else if (name == "--markdown")
    a.markdown = value;
  else if (name == "--mesh")
    a.mesh.emplace_back(value);
  else
    return false;
  return true;
}

// Throws InputError.
Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  for (int k = 1; k < argc; k += 2) {
    const std::string name = argv[k];
    if (k + 1 == argc) throw InputError(name + " is unknown or lacks a value");
    if (!read_number(name, argv[k + 1], a) && !read_name(name, argv[k + 1], a))
      throw InputError("unknown option " + name);
  }
  return a;
}

struct Cuts {
  std::vector<Family> families;
  std::vector<Kind> kinds;
};

Kind in_advances(Kind kind, int n) {
  kind.strokes = [strokes = kind.strokes, n](const Mesh& mesh, std::mt19937_64& random) {
    std::vector<Stroke> all = strokes(mesh, random);
    for (Stroke& stroke : all) stroke.n_steps = n;
    return all;
  };
  return kind;
}

Cuts asked_cuts(const Arguments& a) {
  if (a.family.starts_with("layers")) return {layered_families(), layered_kinds()};
  if (a.family.starts_with("plates")) return {plate_families(), plate_kinds()};
  return {families(a.cells, a.mesh), kinds()};
}

bool is_asked_for(const Family& family, const Kind& kind, const Arguments& a) {
  const bool is_set = a.family.empty() || a.family == "layers" || a.family == "plates";
  const bool is_family = is_set || family.name == a.family;
  return is_family && (a.kind.empty() || kind.name == a.kind);
}

// Each cut has a generator of its own: --seed 7 --count 1 repeats the cut that the run before
// printed as seed 7.
Row run(const Family& family, Kind kind, const Arguments& a) {
  if (a.advances > 0) kind = in_advances(std::move(kind), a.advances);
  Row row{family.name, kind.name, {}};
  for (unsigned seed = a.seed; seed < a.seed + unsigned(a.count); ++seed) {
    std::mt19937_64 random(seed);
    row.result.push_back(make_cut(family.make(seed), kind, random, a.options));
    const Result& r = row.result.back();
    if (!r.is_right())
      std::fprintf(stderr, "%s %s seed %u: %d pieces of %d (%d thin), %d refused, %d inverted %s\n",
                   family.name.c_str(), kind.name.c_str(), seed, r.n_pieces, r.n_exact, r.n_thin,
                   r.n_refused, r.n_inverted, r.fault.c_str());
  }
  return row;
}

// Throws InputError; stdout without a name.
std::FILE* opened(const std::string& name) {
  std::FILE* file = name.empty() ? stdout : std::fopen(name.c_str(), "w");
  if (file == nullptr) throw InputError("can't write " + name);
  return file;
}

void print_rows(const Arguments& a) {
  std::FILE *table = opened(a.markdown), *json = opened(a.json);
  std::vector<Row> rows;
  const Cuts cuts = asked_cuts(a);
  print_head(table);
  for (const Family& family : cuts.families)
    for (const Kind& kind : cuts.kinds) {
      if (!is_asked_for(family, kind, a)) continue;
      rows.push_back(run(family, kind, a));
      print_row(rows.back(), table);
    }
  if (rows.empty()) throw InputError("there is no family or no kind of that name");
  if (json != stdout) print_json(rows, json);
  for (std::FILE* file : {table, json})
    if (file != stdout) std::fclose(file);
}

int run_all(int argc, char** argv) {
  if (argc >= 2 && std::string(argv[1]) == "scaling") {
    std::vector<int> cells;
    for (int k = 2; k < argc; ++k) cells.push_back(std::max(8, std::atoi(argv[k])));
    if (cells.empty()) cells = {10, 15, 24, 55};
    print_scaling(cells, stdout);
    return 0;
  }
  const Arguments a = read_arguments(argc, argv);
  if (a.cuts > 0) return print_long_run({a.seed, a.cuts, a.minutes}, stdout) ? 0 : 1;
  if (a.after > 0) return print_after({a.seed, a.after, a.steps, a.family}, stdout) ? 0 : 1;
  print_rows(a);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (is_help_asked(argc, argv)) return print_usage(usage, stdout);
  keep_freed_memory();
  try {
    return run_all(argc, argv);
  } catch (const InputError& error) {
    std::fprintf(stderr, "bench_cut: %s; see bench_cut --help\n", error.what());
    return 2;
  }
}
