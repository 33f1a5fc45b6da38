// SPDX-License-Identifier: MIT
#include "atmosphere/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace alpenglow::atmosphere {
namespace {

TEST(Error, RangeMessageNamesKeyValueAndRange) {
  try {
    RequireInRange(91.0, -90.0, 90.0, "latitude");
    FAIL() << "91 degrees were accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "latitude is 91; it must lie in [-90, 90]");
  }
}

TEST(Error, NotANumberIsNeverInRange) {
  EXPECT_THROW((void)RequireInRange(std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0, "g"),
               InputError);
}

TEST(Error, EnsurePrintsBothValues) {
  try {
    ALPENGLOW_ENSURE(1 + 1, ==, 3);
    FAIL() << "2 == 3 was accepted";
  } catch (const InternalError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("expected 1 + 1 == 3, got 2 and 3"));
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
