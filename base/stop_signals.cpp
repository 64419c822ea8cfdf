#include "base/stop_signals.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string_view>

#include "base/error.h"

namespace trocar {

namespace {

std::atomic<bool> stop_signal_came = false;
static_assert(std::atomic<bool>::is_always_lock_free);

// A second signal ends this rank at once, and mpirun the others: outputs are consistent at any
// time.
void ask_to_stop(int) {
  if (!stop_signal_came.exchange(true)) return;
  constexpr std::string_view why =
      "[warning] a second signal: ended within a frame; --resume goes on from the last "
      "checkpoint, if any\n";
  [[maybe_unused]] const ssize_t n = write(STDERR_FILENO, why.data(), why.size());
  std::_Exit(static_cast<int>(ExitCode::stopped));
}

}  // namespace

void listen_to_stop_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, ask_to_stop);
  if (std::signal(SIGHUP, ask_to_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
  std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& stop_asked() {
  return stop_signal_came;
}

}  // namespace trocar
