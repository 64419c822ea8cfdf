// The program as a process that runs on beside the test.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
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
  return start(std::move(words), folder + "/first", folder + "/first");
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
