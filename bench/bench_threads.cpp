// What it costs to share short work among threads, by the program's team and by OpenMP, alone on
// the machine and beside other processes that want its cores: microseconds from one piece of work
// to the next, of which the work itself takes some 100 on each thread. JSON to stdout.
// OMP_WAIT_POLICY=passive shows OpenMP with threads that sleep while they wait.
// bench_threads [threads, default 2] [pieces of work, default 2000]
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "base/threads.h"
#include "base/timers.h"
#include "bench/usage.h"

using namespace trocar;

namespace {

volatile double sink = 0;

void work(int n) {
  double x = 2;
  for (int k = 0; k < n; ++k) x = x * 0.999 + 1e-3;
  sink = x;
}

// Length of work() that takes about 100 us.
int calibrate() {
  constexpr int n = 1'000'000;
  const double start = monotonic_seconds();
  work(n);
  return static_cast<int>(n * 100e-6 / (monotonic_seconds() - start));
}

void share_by_openmp(int n_threads, int length) {
#pragma omp parallel for schedule(static, 1) num_threads(n_threads)
  for (int chunk = 0; chunk < n_threads; ++chunk) work(length);
}

void share_by_team(int n_threads, int length) {
  parallel_for_chunks(n_threads, [&](int) { work(length); });
}

double microseconds(void (*share)(int, int), int n_threads, int length, int n) {
  const double start = monotonic_seconds();
  for (int k = 0; k < n; ++k) share(n_threads, length);
  return 1e6 * (monotonic_seconds() - start) / n;
}

// Processes that want a core each, as long as this lives.
class Others {
 public:
  explicit Others(int n) {
    for (int k = 0; k < n; ++k) {
      const pid_t child = fork();
      if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (;;) work(1000);
      }
      if (child > 0) children_.push_back(child);
    }
  }
  ~Others() {
    for (const pid_t child : children_) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
  }
  Others(const Others&) = delete;
  Others& operator=(const Others&) = delete;

 private:
  std::vector<pid_t> children_;
};

}  // namespace

int main(int argc, char** argv) {
  const char* usage = "bench_threads [threads, default 2] [pieces of work, default 2000]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  const int n_threads = argc > 1 ? std::atoi(argv[1]) : 2;
  const int n = argc > 2 ? std::atoi(argv[2]) : 2000;
  if (n_threads < 1 || n < 1) return print_usage(usage, stderr);
  set_thread_count(n_threads);
  const int length = calibrate();
  std::printf("{\"threads\": %d, \"pieces\": %d, \"shared\": [", n_threads, n);
  for (int n_others = 0; n_others < 4; ++n_others) {
    const Others others(n_others);
    const double team = microseconds(share_by_team, n_threads, length, n);
    const double openmp = microseconds(share_by_openmp, n_threads, length, n);
    std::printf(
        "%s\n  {\"other_processes\": %d, \"team_us\": %.1f, \"openmp_us\": %.1f, \"ratio\": %.2f}",
        n_others == 0 ? "" : ",", n_others, team, openmp, openmp / team);
    std::fflush(stdout);
  }
  std::printf("\n]}\n");
}
