#include "render/work_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

using namespace trocar;

TEST(WorkQueue, has_done_all_jobs_in_order_when_one_has_waited) {
  std::vector<int> done;
  WorkQueue<int> queue(2, [&](const int& job) { done.push_back(job); });
  for (int k = 0; k < 5; ++k) queue.add(k);
  queue.wait();
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
  queue.wait();  // there is nothing to wait for
  queue.add(5);
  queue.finish();
  EXPECT_EQ(done.back(), 5);
}

TEST(WorkQueue, tells_whoever_asks_what_went_wrong_and_drops_the_rest) {
  std::atomic<int> n_done = 0;
  WorkQueue<int> queue(2, [&](const int& job) {
    if (job == 1) throw std::runtime_error("one");
    ++n_done;
  });
  queue.add(0);
  queue.add(1);
  EXPECT_THROW(queue.wait(), std::runtime_error);
  EXPECT_THROW(queue.add(2), std::runtime_error);
  EXPECT_THROW(queue.finish(), std::runtime_error);
  EXPECT_EQ(n_done, 1);
}
