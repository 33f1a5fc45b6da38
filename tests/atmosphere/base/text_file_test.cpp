// SPDX-License-Identifier: MIT
#include "atmosphere/base/text_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

using tests::FaultOf;

TEST(TextFile, UnreadableFilesAreNamed) {
  EXPECT_THAT(FaultOf([] { (void)ReadTextFile("/no/such/file.toml"); }),
              testing::HasSubstr("/no/such/file.toml: cannot be read"));
  EXPECT_NE(FaultOf([] { (void)ReadTextFile("/"); }), "no fault");
}

}  // namespace
}  // namespace alpenglow::atmosphere
