// Whether a rank gets its neighbour's message, and is rid of its own, while the neighbour is busy
// with something else: otherwise each exchange would wait for the slower one of two ranks.
// scripts/on_ranks 2 slow_rank; exit code 1 if it has to wait.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <span>
#include <thread>

#include "base/communicator.h"
#include "base/timers.h"

using namespace trocar;

int main(int argc, char** argv) {
  MpiSession session(&argc, &argv);
  Communicator& ranks = session.world();
  constexpr double busy = 0.5;
  const std::span<double> send = ranks.room_to_send(8000);
  std::ranges::fill(send, ranks.rank());
  std::vector<double> receive(send.size(), -1);
  const ExchangeMessage messages[] = {{1 - ranks.rank(), send, receive}};
  ranks.barrier();
  ranks.start_exchange(messages);
  if (ranks.is_root()) std::this_thread::sleep_for(std::chrono::duration<double>(busy));
  const double start = monotonic_seconds();
  ranks.finish_exchange();
  const double waited = ranks.all_max(monotonic_seconds() - start);
  const bool is_right = receive == std::vector<double>(send.size(), 1 - ranks.rank());
  if (ranks.is_root()) std::printf("waited %g of %g s\n", waited, busy);
  return is_right && waited < busy / 2 ? 0 : 1;
}
