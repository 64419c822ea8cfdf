// One rank, with and without MPI; what several ranks do is tested through mpirun in
// tests/invariance.
#include "base/communicator.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace trocar {
namespace {

// MPI can be started once a process.
MpiSession& session() {
  static MpiSession the_session(nullptr, nullptr);
  return the_session;
}

// Every test runs on a communicator without MPI and on MPI's world of one rank: no test may tell
// them apart.
class OneRank : public testing::TestWithParam<bool> {
 protected:
  Communicator& ranks() { return GetParam() ? session().world() : alone_; }

 private:
  Communicator alone_;
};

TEST_P(OneRank, is_the_root_of_one) {
  EXPECT_EQ(ranks().rank(), 0);
  EXPECT_EQ(ranks().size(), 1);
  EXPECT_TRUE(ranks().is_root());
  EXPECT_FALSE(has_other_ranks());
  ranks().barrier();
}

TEST_P(OneRank, reduces_to_its_own_value_bit_by_bit) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -0.0, 1.5, -2.5e-308, 4.9e-324, -1e300, inf, -inf}) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(ranks().all_min(value)),
              std::bit_cast<std::uint64_t>(value));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(ranks().all_max(value)),
              std::bit_cast<std::uint64_t>(value));
  }
}

TEST_P(OneRank, keeps_a_nan_in_minimum_and_maximum) {
  EXPECT_TRUE(std::isnan(ranks().all_min(std::nan(""))));
  EXPECT_TRUE(std::isnan(ranks().all_max(-std::nan(""))));
}

TEST_P(OneRank, has_the_lowest_number) {
  EXPECT_EQ(ranks().lowest(7), 7);
  EXPECT_EQ(ranks().lowest(0), 0);
  EXPECT_EQ(ranks().lowest(-1), -1);
}

TEST_P(OneRank, sums_to_its_own_value) {
  std::array<std::uint64_t, 2> values{7, std::numeric_limits<std::uint64_t>::max()};
  ranks().all_sum(values);
  EXPECT_EQ(values, (std::array<std::uint64_t, 2>{7, std::numeric_limits<std::uint64_t>::max()}));
  EXPECT_EQ(ranks().all_sum(std::uint64_t{5}), 5u);
}

TEST_P(OneRank, gathers_and_broadcasts_what_it_has) {
  const std::vector<double> values{1, 2, 3};
  EXPECT_EQ(ranks().all_gather(values), values);
  EXPECT_EQ(ranks().gather(values), values);
  EXPECT_TRUE(ranks().all_gather(std::span<const double>()).empty());
  const std::string text("a\0b", 3);
  EXPECT_EQ(ranks().all_gather(text), std::vector<std::string>{text});
  EXPECT_EQ(ranks().first_text(text), text);
  EXPECT_EQ(ranks().first_text(""), "");
  std::vector<std::byte> bytes{std::byte{1}, std::byte{255}};
  const std::vector<std::byte> before = bytes;
  ranks().broadcast(bytes);
  EXPECT_EQ(bytes, before);
  EXPECT_EQ(ranks().all_gather(std::span<const std::byte>(bytes)), before);
}

TEST_P(OneRank, exchanges_with_itself_in_order_and_again) {
  const std::vector<double> first{1, 2};
  const std::vector<double> second{3, 4, 5};
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::vector<double> first_received(2);
    std::vector<double> second_received(3);
    const std::span<double> room = ranks().room_to_send(5);
    std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), room.begin()));
    const ExchangeMessage messages[] = {{0, room.first(2), first_received},
                                        {0, room.subspan(2), second_received}};
    ranks().start_exchange(messages);
    ranks().finish_exchange();
    EXPECT_EQ(first_received, first);
    EXPECT_EQ(second_received, second);
  }
  ranks().room_to_send(0);
  ranks().start_exchange({});
  ranks().finish_exchange();
}

TEST_P(OneRank, is_the_group_of_itself) {
  const int itself[] = {0};
  EXPECT_EQ(ranks().group(itself), &ranks());
}

INSTANTIATE_TEST_SUITE_P(, OneRank, testing::Bool(), [](const auto& test) {
  return std::string(test.param ? "with_mpi" : "without_mpi");
});

TEST(AbortAllRanks, exits_with_the_code_where_mpi_is_not_running) {
  EXPECT_EXIT(abort_all_ranks(4), testing::ExitedWithCode(4), "");
}

TEST(MpiVersion, names_the_library) {
  EXPECT_NE(mpi_version().find("MPI"), std::string::npos);
  EXPECT_EQ(mpi_version().find_first_of(",\n"), std::string::npos);
}

}  // namespace
}  // namespace trocar
