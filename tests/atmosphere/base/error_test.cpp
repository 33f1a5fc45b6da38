// SPDX-License-Identifier: MIT
#include "atmosphere/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

using tests::FaultOf;

TEST(Error, RangeMessageNamesKeyValueAndRange) {
  EXPECT_EQ(FaultOf([] { return RequireInRange(91.0, -90.0, 90.0, "latitude"); }),
            "latitude is 91; it must lie in [-90, 90]");
  EXPECT_NE(FaultOf([] { return RequireInRange(std::nan(""), 0.0, 1.0, "g"); }), "no fault");
}

TEST(Error, EnsurePrintsBothValues) {
  const auto compare = [] {
    ALPENGLOW_ENSURE(1 + 1, ==, 3);
    return 0;
  };
  EXPECT_THAT(FaultOf<InternalError>(compare),
              testing::HasSubstr("expected 1 + 1 == 3, got 2 and 3"));
}

}  // namespace
}  // namespace alpenglow::atmosphere
