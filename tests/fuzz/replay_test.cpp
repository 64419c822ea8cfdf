// What libFuzzer starts from, read by the same functions in every build.
#include <gtest/gtest.h>

#include <random>

#include "fuzz_targets.h"

namespace trocar {
namespace {

TEST(Hostile, seeds_of_the_fuzz_targets_are_read) {
  for (const FuzzTarget& target : fuzz_targets())
    for (const FuzzSeed& seed : target.seeds())
      EXPECT_TRUE(target.read(seed.bytes)) << target.name << " " << seed.name;
}

TEST(Hostile, counts_that_no_honest_file_has_are_refused_or_read_soundly) {
  std::mt19937_64 random(1);
  for (const FuzzTarget& target : fuzz_targets())
    for (const FuzzSeed& seed : target.seeds())
      for (int k = 0; k < 50; ++k) {
        const std::uint64_t number = random();
        const ChangeBytes change = [&](const std::string& bytes) {
          return with_hostile_count(bytes, number);
        };
        target.read(target.change_inside == nullptr
                        ? change(seed.bytes)
                        : target.change_inside(seed.bytes, change, random()));
      }
}

TEST(Hostile, a_change_inside_makes_the_checksums_right_again) {
  const ChangeBytes same = [](const std::string& bytes) { return bytes; };
  for (const FuzzTarget& target : fuzz_targets())
    for (std::uint64_t k = 0; target.change_inside != nullptr && k < 8; ++k)
      EXPECT_TRUE(target.read(target.change_inside(target.seeds()[0].bytes, same, k)))
          << target.name << " " << k;
}

}  // namespace
}  // namespace trocar
