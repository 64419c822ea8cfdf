#include "base/check.h"

#include <gtest/gtest.h>

#include <csignal>

TEST(Check, ends_the_program_with_condition_and_place) {
  EXPECT_DEATH(CHECK(1 > 2), "trocar: CHECK failed: 1 > 2 at base/check_test.cpp:[0-9]+");
}

TEST(Check, prints_both_values) {
  const int n = 3;
  const int m = 4;
  EXPECT_DEATH(CHECK_OP(n, ==, m), "CHECK failed: n == m \\(3 == 4\\) at base/check_test.cpp");
}

TEST(Check, lets_a_true_condition_pass_and_evaluates_it_once) {
  int n_calls = 0;
  CHECK(++n_calls == 1);
  CHECK_OP(++n_calls, ==, 2);
  EXPECT_EQ(n_calls, 2);
}

TEST(Check, aborts_with_a_core_dump_signal_on_one_rank) {
  EXPECT_EXIT(CHECK(false), testing::KilledBySignal(SIGABRT), "");
}
