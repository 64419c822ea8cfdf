// Whether a rank gets its neighbour's message, and is rid of its own, while the neighbour is busy
// with something else: otherwise each exchange would wait for the slower one of two ranks.
// scripts/on_ranks 2 slow_rank; exit code 1 if it has to wait.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <thread>

#include "base/communicator.h"

using namespace trocar;

// Busy until the file is there, which the other rank writes when it has done its exchange; a rank
// that waits for this one never writes it. Whether it did within half a minute.
static bool is_busy_until(const std::string& file) {
  for (int k = 0; k < 3000 && !std::filesystem::exists(file); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return std::filesystem::exists(file);
}

int main(int argc, char** argv) {
  MpiSession session(&argc, &argv);
  Communicator& ranks = session.world();
  const std::string mine = ranks.is_root() ? std::filesystem::temp_directory_path().string() +
                                                 "/trocar_slow_rank_" + std::to_string(getpid())
                                           : "";
  const std::string file = ranks.first_text(mine);
  const std::span<double> send = ranks.room_to_send(8000);
  std::ranges::fill(send, ranks.rank());
  std::vector<double> receive(send.size(), -1);
  const ExchangeMessage messages[] = {{1 - ranks.rank(), send, receive}};
  ranks.barrier();
  ranks.start_exchange(messages);
  const bool did_other = !ranks.is_root() || is_busy_until(file);
  ranks.finish_exchange();
  if (!ranks.is_root()) std::ofstream(file) << "done\n";
  const bool is_right = receive == std::vector<double>(send.size(), 1 - ranks.rank());
  ranks.barrier();
  if (ranks.is_root()) std::filesystem::remove(file);
  if (!did_other) std::printf("rank 1 waited for rank 0, which was busy\n");
  return is_right && did_other ? 0 : 1;
}
