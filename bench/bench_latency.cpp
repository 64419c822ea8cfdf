// Latency and bandwidth of an exchange between two ranks, nanoseconds of an element's step while
// both ranks compute, and what follows from these for ranks that this machine does not have
// (scaling_model.h). JSON to stdout.
// mpirun -np 2 bench_latency [latency in us] [bandwidth in 10^9 bytes/s]: of another network
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/communicator.h"
#include "bench/machine.h"
#include "bench/scaling_model.h"
#include "bench/usage.h"
#include "solver/frequency.h"
#include "solver_body.h"

using namespace trocar;

namespace {

const Material tissue{.young_modulus = 3000, .poisson_ratio = .45, .density = 1000};

constexpr int n_rounds = 25;

// Both ranks send so many bytes to each other.
double exchange_seconds(Communicator& ranks, std::size_t n_bytes) {
  std::vector<double> receive(n_bytes / sizeof(double));
  const int n = n_bytes > 100000 ? 20 : 1000;
  const double best = best_of_ranks(ranks, n_rounds, [&] {
    for (int k = 0; k < n; ++k) {
      const ExchangeMessage messages[] = {
          {1 - ranks.rank(), ranks.room_to_send(receive.size()), receive}};
      ranks.start_exchange(messages);
      ranks.finish_exchange();
    }
  });
  return best / n;
}

// Prints the times by size; the line through the smallest and the largest gives the parameters.
void measure_network(Communicator& ranks, ScalingParameters& m) {
  constexpr std::size_t smallest = 8, largest = std::size_t{8} << 18;
  double first = 0, last = 0;
  if (ranks.is_root()) std::printf("{\"exchanges\": [");
  for (std::size_t n_bytes = smallest; n_bytes <= largest; n_bytes *= 8) {
    last = exchange_seconds(ranks, n_bytes);
    if (n_bytes == smallest) first = last;
    if (ranks.is_root())
      std::printf("%s{\"bytes\": %zu, \"us\": %.3f}", n_bytes == smallest ? "" : ", ", n_bytes,
                  1e6 * last);
  }
  m.latency = first;
  m.bandwidth = static_cast<double>(largest - smallest) / (last - first);
}

// Of processor time, while the other rank does the same; of a cube of n x n x n elements.
double seconds_of_step(const Communicator& ranks, int n, int n_steps) {
  Body body = make_body(make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {n, n, n}, BoxElements::hex8),
                        {.materials = {tissue}});
  displace(body, [](const Vec3& X) { return Vec3(0.05 * X.y(), 0, 0); });
  const auto run = [&] {
    for (int k = 0; k < n_steps; ++k) step_freely(body, 1e-9);
  };
  return best_of_ranks(ranks, n_rounds, run, bench_seconds) / n_steps;
}

// Stable step of a cube of elements over their edge, as the watch finds it, and the collectives
// that this takes in a frame; some more are for forces, contact and outputs. A body is searched in
// every thirtieth frame or so (docs/architecture-measured.md), and looked at in each.
void measure_frame(ScalingParameters& m) {
  constexpr int n = 12;
  Body body =
      make_body(make_box(Vec3(0, 0, 0), Vec3(m.side, m.side, m.side), {n, n, n}, BoxElements::hex8),
                {.materials = {tissue}});
  State probe = body.state;
  Neighbours none;
  const Communicator alone;
  FrequencyOptions options;
  options.amplitude = 1e-6 * m.side / n;
  int n_forces = 0;
  const auto force_of = [&](std::vector<double>& u, std::vector<double>& f) {
    ++n_forces;
    probe.u.swap(u);
    find_force(body.model, none, probe, body.scratch);
    f = body.scratch.force;
    probe.u.swap(u);
  };
  const HighestFrequency found =
      find_highest_frequency(body.model, body.part, body.state, force_of, options, alone);
  constexpr double frames_of_search = 30;
  m.collectives = static_cast<double>(alone.traffic().n_collectives) / frames_of_search + 15;
  m.looks = n_forces / frames_of_search + 1;
  m.step_per_edge = .85 * 2 / (frequency_margin * found.omega) / (m.side / n);
}

void print_parameters(const ScalingParameters& m) {
  std::printf(
      "],\n\"parameters\": {\"latency_us\": %.3f, \"gbytes_per_second\": %.2f, "
      "\"element_step_ns\": %.2f, \"element_step_of_large_parts_ns\": %.2f, "
      "\"step_overhead_us\": %.2f, \"collectives_per_frame\": %.1f, \"looks_per_frame\": %.1f, "
      "\"stable_step_per_edge_s_per_m\": %.4f, \"body_m\": %.2f, \"bytes_per_node\": %.0f},\n",
      1e6 * m.latency, 1e-9 * m.bandwidth, 1e9 * m.small_element_step, 1e9 * m.large_element_step,
      1e6 * m.step_overhead, m.collectives, m.looks, m.step_per_edge, m.side, m.bytes_per_node);
}

void print_predictions(const ScalingParameters& m) {
  const char* comma = "";
  std::printf("\"predictions\": [");
  for (const int ranks : {1, 4, 64, 1024})
    for (const double elements : {1e5, 1e6, 1e8})
      for (const double rate : {30., 60.}) {
        const ScalingPoint p{elements, ranks};
        std::printf(
            "%s\n  {\"ranks\": %d, \"elements\": %.0f, \"rate\": %.0f, \"steps\": %.0f, "
            "\"step_us\": %.2f, \"efficiency\": %.3f, \"real_time_factor\": %.4f}",
            comma, ranks, elements, rate, steps_of_frame(p, m, rate), 1e6 * step_seconds(p, m),
            step_seconds({elements, 1}, m) / (ranks * step_seconds(p, m)),
            real_time_factor(p, m, rate));
        comma = ",";
      }
  std::printf("],\n\"limits\": [");
  comma = "";
  for (const int ranks : {1, 4, 64, 1024})
    for (const double rate : {30., 60.}) {
      std::printf("%s{\"ranks\": %d, \"rate\": %.0f, \"elements\": %.0f}", comma, ranks, rate,
                  most_elements(ranks, m, rate));
      comma = ", ";
    }
  std::printf("]}\n");
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage = "mpirun -np 2 bench_latency [latency in us] [10^9 bytes/s]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  MpiSession session(&argc, &argv);
  Communicator& ranks = session.world();
  if (ranks.size() != 2) return ranks.is_root() ? print_usage(usage, stderr) : 2;
  set_thread_count(1);
  ScalingParameters m;
  measure_network(ranks, m);
  if (argc > 2) {
    m.latency = 1e-6 * std::atof(argv[1]);
    m.bandwidth = 1e9 * std::atof(argv[2]);
  }
  constexpr int tiny_edge = 4;
  constexpr double n_tiny = tiny_edge * tiny_edge * tiny_edge;
  const auto seconds_of = [&](int edge, int n_steps) {
    return seconds_of_step(ranks, edge, n_steps);
  };
  const double tiny = seconds_of(tiny_edge, 500), small = seconds_of(small_part_edge, 20),
               large = seconds_of(large_part_edge, 4);
  m.small_element_step = (small - tiny) / (std::pow(small_part_edge, 3) - n_tiny);
  m.step_overhead = std::max(0.0, tiny - n_tiny * m.small_element_step);
  m.large_element_step = (large - m.step_overhead) / std::pow(large_part_edge, 3);
  measure_frame(m);
  if (!ranks.is_root()) return 0;
  print_parameters(m);
  print_predictions(m);
}
