#include "base/threads.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace trocar {
namespace {

TEST(ParallelFor, visits_each_index_exactly_once_for_any_number_of_threads) {
  for (const int n_threads : {1, 2, 3, 4, 7, 16}) {
    set_thread_count(n_threads);
    for (const std::int64_t n : {0, 1, 2, 63, 64, 65, 100, 127, 1000, 4099}) {
      std::vector<std::atomic<int>> n_visits(static_cast<std::size_t>(n));
      parallel_for(n, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) ++n_visits[i];
      });
      for (const std::atomic<int>& n_visit : n_visits) ASSERT_EQ(n_visit, 1);
    }
  }
}

TEST(ParallelFor, runs_as_many_threads_as_asked_for) {
  set_thread_count(3);
  std::atomic<int> n_inside = 0;
  // Each chunk waits until all three are inside; fewer threads would not get there.
  parallel_for(300, [&](std::int64_t, std::int64_t) {
    ++n_inside;
    const auto start = std::chrono::steady_clock::now();
    while (n_inside < 3 && std::chrono::steady_clock::now() - start < std::chrono::seconds(5))
      std::this_thread::yield();
  });
  EXPECT_EQ(n_inside, 3);
}

TEST(ParallelFor, hands_over_all_that_was_written_however_often_and_long_threads_wait) {
  set_thread_count(3);
  std::vector<int> value(3, 0), sum(3, 0);  // no atomics: who reads must wait for who wrote
  for (int k = 1; k <= 3000; ++k) {
    parallel_for_chunks(3, [&](int chunk) { value[chunk] = k; });
    parallel_for_chunks(3, [&](int chunk) { sum[chunk] = value[0] + value[1] + value[2]; });
    for (const int x : sum) ASSERT_EQ(x, 3 * k);
    if (k % 300 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

TEST(ParallelFor, within_itself_and_beside_another_thread_runs_on_one) {
  set_thread_count(2);
  std::atomic<int> n_calls = 0;
  parallel_for_chunks(2, [&](int) {
    const auto outer = std::this_thread::get_id();
    parallel_for_chunks(2, [&](int) {
      ++n_calls;
      EXPECT_EQ(std::this_thread::get_id(), outer);
    });
    std::thread([&] {
      const auto other = std::this_thread::get_id();
      EXPECT_EQ(thread_count(), 1);
      parallel_for_chunks(2, [&](int) {
        ++n_calls;
        EXPECT_EQ(std::this_thread::get_id(), other);
      });
    }).join();
  });
  EXPECT_EQ(n_calls, 8);
}

TEST(ThreadCount, is_what_was_set) {
  set_thread_count(5);
  EXPECT_EQ(thread_count(), 5);
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
}

TEST(ThreadCount, refuses_none) {
  EXPECT_DEATH(set_thread_count(0), "CHECK failed");
}

TEST(AvailableCores, follow_the_affinity_mask) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(available_cores(), CPU_COUNT(&before));
  int core = 0;
  while (!CPU_ISSET(core, &before)) ++core;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(available_cores(), 1);
  EXPECT_EQ(core_list(), std::to_string(core));
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
}

}  // namespace
}  // namespace trocar
