// SPDX-License-Identifier: MIT
#include "renderer/clouds/periodic_index.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace alpenglow::renderer {
namespace {

TEST(PeriodicIndex, CountsOnAcrossAllPeriods) {
  for (const int count : {1, 2, 7, 64}) {
    int expected = 0;
    for (int index = -3 * count; index <= 3 * count; ++index) {
      EXPECT_EQ(PeriodicIndex(index, count), expected) << index << " of " << count;
      EXPECT_EQ(PeriodicIndex(static_cast<double>(index), count), expected)
          << index << " of " << count;
      expected = expected + 1 < count ? expected + 1 : 0;
    }
  }
}

TEST(PeriodicIndex, WholeNumbersBeyondIntegersAreExact) {
  constexpr int kCount = 1000;
  for (const std::int64_t whole : {4'503'599'627'370'495LL, -4'503'599'627'370'495LL}) {
    EXPECT_EQ(PeriodicIndex(static_cast<double>(whole), kCount),
              PeriodicIndex(whole, std::int64_t{kCount}));
  }
  const int of_greatest = PeriodicIndex(1e300, kCount);
  EXPECT_GE(of_greatest, 0);
  EXPECT_LT(of_greatest, kCount);
}

}  // namespace
}  // namespace alpenglow::renderer
