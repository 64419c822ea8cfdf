// The program as a process that runs on beside the test.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "program.h"

namespace trocar {

// Exit code of a run that a signal ended.
inline constexpr int stopped = 75;

// Starts the program and lets it run on; what it says goes to the file "first".
inline pid_t start(std::vector<std::string> words, const std::string& folder) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  for (const int stream : {1, 2})
    posix_spawn_file_actions_addopen(&files, stream, (folder + "/first").c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0644);
  pid_t child = -1;
  EXPECT_EQ(posix_spawnp(&child, words[0].c_str(), &files, nullptr, argv.data(), environ), 0);
  posix_spawn_file_actions_destroy(&files);
  return child;
}

// A minute at most.
template <class Is>
void wait_until(const Is& is) {
  for (int k = 0; k < 6000 && !is(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(is());
}

inline void wait_for(const std::string& file) {
  wait_until([&] { return std::filesystem::exists(file); });
}

}  // namespace trocar
