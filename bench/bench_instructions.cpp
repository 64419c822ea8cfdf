// Instructions of a step's parts per element, one thread, neo-Hookean: counted one by one in a
// child process, so that no one else on the machine changes them. JSON to stdout.
// bench_instructions [elements, about (default 4096)] [instruction set (default auto)]
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "bench/step_parts.h"
#include "bench/usage.h"

using namespace trocar;

namespace {

// Of a child that stops itself before and after body().
template <class Body>
double stops_between_marks(const Body& body) {
  const pid_t child = fork();
  if (child == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    std::raise(SIGSTOP);
    body();
    std::raise(SIGSTOP);
    _exit(0);
  }
  int status = 0;
  double n = 0;
  waitpid(child, &status, WUNTRACED);
  do {
    if (ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0) {
      std::perror("bench_instructions: ptrace");
      kill(child, SIGKILL);
      std::exit(4);
    }
    waitpid(child, &status, 0);
    ++n;
  } while (WIFSTOPPED(status) && WSTOPSIG(status) == SIGTRAP);
  ptrace(PTRACE_KILL, child, nullptr, nullptr);
  waitpid(child, &status, 0);
  return n;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage = "bench_instructions [elements (4096)] [instruction set (auto)]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  const int n_elements = argc > 1 ? std::atoi(argv[1]) : 4096;
  if (n_elements < 1) return print_usage(usage, stderr);
  if (argc > 2) select_simd(argv[2]);
  const double of_marks = stops_between_marks([] {});
  std::printf("{\"simd\": \"%s\", \"parts\": [", simd_name());
  report_parts(n_elements, [&](const auto& parts) {
    std::array<double, n_step_parts> n{};
    for (std::size_t k = 0; k < n.size(); ++k) {
      parts[k]();  // once for what happens at the first call alone
      std::fflush(stdout);
      n[k] = stops_between_marks(parts[k]) - of_marks;
    }
    return n;
  });
  std::printf("\n]}\n");
}
