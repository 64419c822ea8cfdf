// The program's step against other schemes of the same step (step_schemes.h), on boxes and on
// meshes of files, their nodes and elements in several orders (scheme_orders.h), on one thread and
// on two: in turn in one run, so that others on the machine slow down all of them alike.
// Neo-Hookean, one-point hexahedra and linear tetrahedra. JSON to stdout, the same as a table to
// stderr; exit code 1 if a scheme gives other displacements than the program's. bench_schemes
// [elements of a box, about, or a mesh file]… (default 8000 64000 500000)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/error.h"
#include "bench/jittered_body.h"
#include "bench/machine.h"
#include "bench/scheme_orders.h"
#include "bench/step_schemes.h"
#include "bench/usage.h"
#include "larger_or_nan.h"
#include "mesh/mesh_file.h"

using namespace trocar;

namespace {

struct OrderedBody {
  Body body;
  SchemeData data;
  std::vector<StepScheme> schemes;
};

// Deformed alike in all orders.
void bend(Body& body) {
  const Box box = bounding_box(body.mesh.X);
  const double size = box.size().maxCoeff();
  displace(body, [&](const Vec3& X) {
    const Vec3 at = (X - box.low) / size;
    return Vec3(size * Vec3(.05 * at.y(), .02 * std::sin(3 * at.x()), .02 * at.x() * at.y()));
  });
}

std::unique_ptr<OrderedBody> make_ordered(const Mesh& mesh, MeshOrder order, Precision precision) {
  auto ordered = std::make_unique<OrderedBody>();
  ordered->body =
      make_body(in_order(order, mesh), {.materials = std::vector<Material>(mesh.region_name.size()),
                                        .solver = {.precision = precision}});
  // Rows along the axes have kernels of their own in the program's step alone.
  for (ElementBlocks& blocks : ordered->body.model.blocks) blocks.n_aligned = 0;
  bend(ordered->body);
  ordered->data = make_scheme_data(ordered->body);
  ordered->schemes = step_schemes(ordered->body, ordered->data);
  return ordered;
}

// Some steps of a scheme from rest on; the body is as before.
std::vector<double> displacements(OrderedBody& ordered, const StepScheme& scheme) {
  constexpr int n_steps = 20;
  const State before = ordered.body.state;
  const double dt = .3 * least_element_step(ordered.body);
  scheme.prepare();
  for (int step = 0; step < n_steps; ++step) scheme.step(dt);
  return std::exchange(ordered.body.state, before).u;
}

// The largest one, over the largest displacement from `before` to `expected`.
double difference(const std::vector<double>& found, const std::vector<double>& expected,
                  const std::vector<double>& before) {
  double largest = 0, moved = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    largest = larger_or_nan(largest, std::abs(found[i] - expected[i]));
    moved = larger_or_nan(moved, std::abs(expected[i] - before[i]));
  }
  return largest / moved;
}

constexpr std::size_t n_orders = order_names.size();

struct Case {
  std::string body;
  const Mesh* mesh = nullptr;
  Precision precision = Precision::in_double;
  int n_threads = 1;
};

// Of one order: [scheme][round] of a step [s], and the largest difference to the program's.
struct Timings {
  std::vector<std::vector<double>> seconds;
  double difference = 0;
};

double seconds_of_step(const StepScheme& scheme, int n_steps) {
  constexpr double dt = 1e-12;  // stays near the deformation that it starts from
  scheme.prepare();
  scheme.step(dt);
  const double start = bench_seconds();
  for (int step = 0; step < n_steps; ++step) scheme.step(dt);
  return (bench_seconds() - start) / n_steps;
}

// Rounds of all orders and schemes, each of which is shorter than a slice of a core's time.
void measure(std::vector<std::unique_ptr<OrderedBody>>& bodies, std::vector<Timings>& timings) {
  constexpr double slice = 2e-3, all = 3;
  constexpr int least_rounds = 7, most_rounds = 61;
  const double step = seconds_of_step(bodies.front()->schemes.front(), 3);
  const int n_steps = std::max(1, static_cast<int>(slice / step));
  const double start = monotonic_seconds();
  for (int round = 0; round < most_rounds; ++round) {
    if (round >= least_rounds && monotonic_seconds() - start > all) break;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const std::vector<StepScheme>& schemes = bodies[k]->schemes;
      timings[k].seconds.resize(schemes.size());
      for (std::size_t turn = 0; turn < schemes.size(); ++turn) {
        const std::size_t s = (turn + std::size_t(round)) % schemes.size();
        timings[k].seconds[s].push_back(seconds_of_step(schemes[s], n_steps));
      }
    }
  }
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

double median_ratio(const std::vector<double>& of, const std::vector<double>& over) {
  std::vector<double> ratio;
  for (std::size_t k = 0; k < of.size(); ++k) ratio.push_back(of[k] / over[k]);
  std::nth_element(ratio.begin(), ratio.begin() + std::ssize(ratio) / 2, ratio.end());
  return ratio[ratio.size() / 2];
}

void print_order(const Case& c, const OrderedBody& ordered, MeshOrder order, const Timings& timings,
                 const Timings& given, bool& is_first) {
  const Mesh& mesh = ordered.body.mesh;
  const char* const name = order_names[static_cast<std::size_t>(order)];
  const std::vector<double>& own = timings.seconds.front();
  const double of_order = median_ratio(own, given.seconds.front());
  std::printf(
      "%s\n  {\"body\": \"%s\", \"elements\": %d, \"nodes\": %d, \"precision\": \"%s\", "
      "\"threads\": %d, \"order\": \"%s\", \"over_given\": %.3f, \"by_component\": %s, "
      "\"difference\": %.1e, \"schemes\": [",
      is_first ? "" : ",", c.body.c_str(), mesh.n_elements(), mesh.n_nodes(), name_of(c.precision),
      c.n_threads, name, of_order, ordered.body.model.is_by_component ? "true" : "false",
      timings.difference);
  std::fprintf(stderr, "%-28s %8d %-7s %d %-14s %5.2f", c.body.c_str(), mesh.n_elements(),
               name_of(c.precision), c.n_threads, name, of_order);
  for (std::size_t s = 0; s < ordered.schemes.size(); ++s) {
    const std::vector<double>& seconds = timings.seconds[s];
    const double ns = 1e9 * least(seconds) / mesh.n_elements();
    const double median = median_ratio(seconds, own), of_least = least(seconds) / least(own);
    std::printf(
        "%s{\"scheme\": \"%s\", \"step_ns\": %.2f, \"median_ratio\": %.3f, "
        "\"ratio_of_least\": %.3f}",
        s == 0 ? "" : ", ", ordered.schemes[s].name, ns, median, of_least);
    if (s == 0)
      std::fprintf(stderr, " %6.1f ns", ns);
    else
      std::fprintf(stderr, "  %5.2f %5.2f", median, of_least);
  }
  std::printf("]}");
  std::fprintf(stderr, "\n");
  std::fflush(stdout);
  is_first = false;
}

// Returns whether all schemes give the same displacements, to rounding.
bool report(const Case& c, bool& is_first) {
  set_thread_count(c.n_threads);
  const double rounding = c.precision == Precision::in_single ? 1e-5 : 1e-11;
  std::vector<std::unique_ptr<OrderedBody>> bodies;
  std::vector<Timings> timings(n_orders);
  bool is_same = true;
  for (std::size_t k = 0; k < n_orders; ++k) {
    bodies.push_back(make_ordered(*c.mesh, static_cast<MeshOrder>(k), c.precision));
    OrderedBody& ordered = *bodies[k];
    const std::vector<double> expected = displacements(ordered, ordered.schemes.front());
    for (std::size_t s = 1; s < ordered.schemes.size(); ++s) {
      const double apart =
          difference(displacements(ordered, ordered.schemes[s]), expected, ordered.body.state.u);
      timings[k].difference = larger_or_nan(timings[k].difference, apart);
      if (apart <= rounding) continue;
      std::fprintf(stderr, "bench_schemes: %s, %s, %s: displacements differ by %g\n",
                   c.body.c_str(), order_names[k], ordered.schemes[s].name, apart);
      is_same = false;
    }
  }
  measure(bodies, timings);
  for (std::size_t k = 0; k < n_orders; ++k)
    print_order(c, *bodies[k], static_cast<MeshOrder>(k), timings[k], timings.front(), is_first);
  return is_same;
}

bool report_all(const std::string& body, const Mesh& mesh, bool& is_first) {
  bool is_same = true;
  for (const Precision precision : precisions)
    for (int n_threads = 1; n_threads <= std::min(2, available_cores()); ++n_threads)
      is_same &= report({body, &mesh, precision, n_threads}, is_first);
  return is_same;
}

bool report_argument(const std::string& argument, bool& is_first) {
  const int n = std::atoi(argument.c_str());
  if (std::to_string(n) != argument)
    return report_all(argument.substr(argument.rfind('/') + 1), read_mesh(argument, 1), is_first);
  bool is_same = true;
  for (const Formulation formulation : {Formulation::hex8_one_point, Formulation::tet4})
    is_same &= report_all(std::string("box of ") + name_of(formulation),
                          jittered_body(formulation, n), is_first);
  return is_same;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage =
      "bench_schemes [elements of a box, about, or a mesh file]... (8000 64000 500000)";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty()) arguments = {"8000", "64000", "500000"};
  std::printf("{\"simd\": \"%s\", \"peak_gflops\": %.1f, \"triad_gbytes\": %.1f, \"steps\": [",
              simd_name(), peak_gflops(), triad_gbytes());
  bool is_first = true, is_same = true;
  try {
    for (const std::string& argument : arguments) is_same &= report_argument(argument, is_first);
  } catch (const InputError& error) {
    std::fprintf(stderr, "bench_schemes: %s\n", error.what());
    return 2;
  }
  std::printf("\n]}\n");
  return is_same ? 0 : 1;
}
