// SPDX-License-Identifier: MIT
#include "atmosphere/base/names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace alpenglow::atmosphere {
namespace {

TEST(NearestName, AllowsErrorsByTheLengthOfTheWord) {
  const std::vector<std::string> known{"heading", "size", "K2", "KDEN", "eval", "Köln"};
  EXPECT_EQ(NearestName("headin", known), "heading");
  EXPECT_EQ(NearestName("haeding", known), "heading");
  EXPECT_EQ(NearestName("siez", known), "size") << "two letters in the other order are one edit";
  EXPECT_EQ(NearestName("evaluate", known), "eval") << "the beginning of the word";
  EXPECT_EQ(NearestName("Kölm", known), "Köln") << "a letter of two bytes is one letter";
  for (const char* far : {"", "x", "K", "koln", "東京", "size", "hding"})
    EXPECT_EQ(NearestName(far, {"size", "K2", "KDEN"}), std::nullopt) << far;
}

}  // namespace
}  // namespace alpenglow::atmosphere
