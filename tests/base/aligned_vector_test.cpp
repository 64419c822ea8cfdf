#include "base/aligned_vector.h"

#include <gtest/gtest.h>

#include <cstdint>

using namespace trocar;

TEST(AlignedVector, starts_at_a_cache_line_however_large_it_is) {
  for (const std::size_t n : {1U, 7U, 1000U, 1000000U}) {
    const AlignedVector<double> doubles(n);
    const AlignedVector<float> singles(n);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(doubles.data()) % 64, 0U);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(singles.data()) % 64, 0U);
  }
}
