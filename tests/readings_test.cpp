// SPDX-License-Identifier: MIT
// The readings of the shared texts in C++: float, the twin of the graphics card, against double.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/ray/shell.h"
#include "tests/fixtures/shared_text_cases.h"

namespace alpenglow::atmosphere {
namespace {

// Hard case 9.
TEST(Readings, FloatAgreesWithDoubleToOnePartInAHundredThousand) {
  for (const tests::SharedTextCase& c : tests::AllSharedTextCases()) {
    SCOPED_TRACE(c.glsl);
    ASSERT_FALSE(c.points.empty());
    for (const auto& a : c.points) {
      const double exact = c.in_double(tests::Widen(a));
      ASSERT_NEAR(static_cast<double>(c.in_float(a)), exact, tests::Allowance(c, a))
          << "at " << ::testing::PrintToString(a)
          << "; allowed are 1e-5 and what one ulp of the arguments changes";
    }
  }
}

// The sense of the first test: an ill-conditioned formula does not pass it.
TEST(Readings, TheNaiveFormulaOfTheAltitudeFails) {
  int failures = 0;
  const tests::SharedTextCase naive{"sqrt(r^2 - R^2)",
                                    [](const tests::Arguments<double>& a) {
                                      return std::sqrt((a[2] + a[0]) * (a[2] + a[0]) - a[2] * a[2]);
                                    },
                                    [](const tests::Arguments<float>& a) {
                                      return std::sqrt((a[2] + a[0]) * (a[2] + a[0]) - a[2] * a[2]);
                                    },
                                    tests::HardRays(), 0.0};
  for (const auto& a : naive.points) {
    const double exact = shared::HorizonDistance<double>(static_cast<double>(a[0]), 6371.0);
    const double error = std::abs(static_cast<double>(naive.in_float(a)) - exact);
    if (error > 1e-5 * exact) ++failures;
  }
  EXPECT_GT(failures, 100);
}

}  // namespace
}  // namespace alpenglow::atmosphere
