// What signals end: runs in their first frames, the search for equilibrium, single ranks.
#include <gtest/gtest.h>

#include <iterator>

#include "program_start.h"

namespace trocar {
namespace {

// A frame of about 20 s, during which the first signal is only noted.
TEST(Signals, a_second_one_ends_a_run_at_once) {
  const std::string folder = test_folder("second-signal");
  const pid_t child = start(
      {TROCAR_PROGRAM, "run", config("block_hex.toml"), "-q", "-o", folder + "/out", "--set",
       "output=[]", "--set", "time.frame_rate='1 Hz'", "--set", "tissue.shape.cells=[50, 50, 50]"},
      folder);
  wait_for(folder + "/out/scene.toml");  // its first frame takes seconds from then on
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  int status = 0;
  kill(child, SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(waitpid(child, &status, WNOHANG), 0);  // it finishes its frame
  kill(child, SIGTERM);
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, stopped);
  EXPECT_NE(read_text(folder + "/first").find("ended within a frame"), std::string::npos);
}

// Waits until the program listens to the signal.
void wait_for_handler(pid_t child, int signal) {
  const std::string file = "/proc/" + std::to_string(child) + "/status", key = "SigCgt:";
  for (int tries = 0; tries < 1000; ++tries) {
    const std::string status = read_text(file);
    const std::size_t at = status.find(key);
    if (at != std::string::npos &&
        (std::stoull(status.substr(at + key.size()), nullptr, 16) >> (signal - 1) & 1) != 0)
      return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ADD_FAILURE() << "no handler of signal " << signal;
}

int exit_code_of(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<pid_t> children_of(pid_t process) {
  const std::string number = std::to_string(process);
  std::istringstream list(read_text("/proc/" + number + "/task/" + number + "/children"));
  return {std::istream_iterator<pid_t>(list), {}};
}

// MPI starts on one rank only when the other has begun, which here waits for a file.
TEST(Signals, that_come_while_mpi_starts_end_the_run_as_later_ones_do) {
  const std::string folder = test_folder("early-signal"), gate = folder + "/gate";
  const std::string second_waits = "test $OMPI_COMM_WORLD_RANK = 0 || until test -e " + gate +
                                   "; do sleep 0.05; done; exec \"$@\"";
  const pid_t mpirun =
      start(mpirun_words(2, "sh",
                         {"-c", second_waits, "sh", TROCAR_PROGRAM, "run", config("block_hex.toml"),
                          "-q", "-o", folder + "/out", "--set", "output=[]"}),
            folder);
  wait_until([&] { return children_of(mpirun).size() == 2; });
  const pid_t first = children_of(mpirun)[0];
  wait_until([&] { return read_text("/proc/" + std::to_string(first) + "/comm") == "trocar\n"; });
  wait_for_handler(first, SIGTERM);
  EXPECT_FALSE(std::filesystem::exists(folder + "/out"));
  kill(first, SIGTERM);
  write_text(gate, "");
  EXPECT_EQ(exit_code_of(mpirun), stopped) << read_text(folder + "/first");
  EXPECT_EQ(read_summary(folder + "/out")["frames"], 0);
}

// Of 216,000 hexahedra, which takes half a minute without the signal.
TEST(Signals, end_the_search_for_equilibrium) {
  const std::string folder = test_folder("equilibrium-signal");
  const pid_t child =
      start({TROCAR_PROGRAM, "run", config("block_hex.toml"), "-o", folder + "/out", "--set",
             "output=[]", "--set", "start.state='equilibrium'", "--set", "start.tolerance=1.1e-12",
             "--set", "start.max_iterations=100000000", "--set", "tissue.shape.cells=[60, 60, 60]"},
            folder);
  wait_for_handler(child, SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  kill(child, SIGTERM);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, stopped);
  EXPECT_EQ(read_summary(folder + "/out")["trouble"], "stopped by a signal");
  EXPECT_EQ(read_summary(folder + "/out")["frames"], 0);
  EXPECT_NE(read_text(folder + "/first").find("start it anew, without --resume"),
            std::string::npos);
}

// Before there is a checkpoint. mpirun's exit code is 128 + the signal.
TEST(Signals, that_kill_one_rank_are_told_by_the_other) {
  for (const std::size_t lost : {0, 1}) {
    const std::string folder = test_folder("lost-rank");
    const pid_t mpirun = start(mpirun_words(2, TROCAR_PROGRAM,
                                            {"run", config("block_hex.toml"), "-q", "-o",
                                             folder + "/out", "--set", "output=[]"}),
                               folder);
    wait_for(folder + "/out/scene.toml");
    const std::vector<pid_t> ranks = children_of(mpirun);
    ASSERT_EQ(ranks.size(), 2U);
    kill(ranks[lost], SIGKILL);
    int status = 0;
    waitpid(mpirun, &status, 0);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 128 + SIGKILL);
    const std::string told = read_text(folder + "/first"),
                      who = "trocar: error: rank " + std::to_string(lost) + " (process " +
                            std::to_string(ranks[lost]) + " on ";
    EXPECT_NE(told.find(who), std::string::npos) << told;
    EXPECT_EQ(told.find("trocar: error", told.find(who) + 1), std::string::npos) << told;
    EXPECT_FALSE(std::filesystem::exists(folder + "/out/checkpoint.bin"));
  }
}

pid_t start_ranks(int n, const std::string& folder, const std::string& patience) {
  const pid_t mpirun =
      start(mpirun_words(n, TROCAR_PROGRAM,
                         {"run", config("block_hex.toml"), "-q", "--patience", patience, "-o",
                          folder + "/out", "--set", "output=[]", "--set", "time.duration=0.5"}),
            folder);
  wait_for(folder + "/out/scene.toml");
  return mpirun;
}

// The others would wait for ever.
TEST(Signals, that_stop_one_rank_are_told_once_and_end_the_run) {
  for (const std::size_t which : {0, 2}) {
    const std::string folder = test_folder("stopped-rank");
    const pid_t mpirun = start_ranks(3, folder, "2");
    const std::vector<pid_t> ranks = children_of(mpirun);
    ASSERT_EQ(ranks.size(), 3U);
    kill(ranks[which], SIGSTOP);
    EXPECT_EQ(exit_code_of(mpirun), 4);
    const std::string told = read_text(folder + "/first"),
                      who = "rank " + std::to_string(which) + " (process " +
                            std::to_string(ranks[which]) + " on ";
    EXPECT_NE(told.find(who), std::string::npos) << told;
    EXPECT_NE(told.find("has been stopped for 2 s"), std::string::npos) << told;
    EXPECT_EQ(told.find("trocar: error", told.find(who)), std::string::npos) << told;
  }
}

TEST(Signals, that_stop_all_ranks_for_a_while_change_nothing) {
  const std::string folder = test_folder("suspended");
  const pid_t mpirun = start_ranks(2, folder, "3");
  const std::vector<pid_t> ranks = children_of(mpirun);
  ASSERT_EQ(ranks.size(), 2U);
  for (const pid_t rank : ranks) kill(rank, SIGSTOP);
  std::this_thread::sleep_for(std::chrono::seconds(5));
  for (const pid_t rank : ranks) kill(rank, SIGCONT);
  EXPECT_EQ(exit_code_of(mpirun), 0) << read_text(folder + "/first");
}

}  // namespace
}  // namespace trocar
