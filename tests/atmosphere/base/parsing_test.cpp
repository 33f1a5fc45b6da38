// SPDX-License-Identifier: MIT
#include "atmosphere/base/parsing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alpenglow::atmosphere {
namespace {

TEST(FileExtension, IgnoresCase) {
  for (const char* name : {"track.gpx", "folder.d/TRACK.GPX", "a.b.GpX"}) {
    EXPECT_TRUE(HasExtension(name, ".gpx")) << name;
  }
  for (const char* name : {"gpx", ".gpx", "track.gp", "track.gpxx", "track.gpx/file", ""}) {
    EXPECT_FALSE(HasExtension(name, ".gpx")) << name;
  }
  EXPECT_TRUE(HasExtension("none", ""));
}

TEST(Numbers, AreParsedCompletelyWithPointAndSign) {
  EXPECT_EQ(ParseNumber("-1.5e3"), -1500.0);
  EXPECT_EQ(ParseNumber("+10"), 10.0);
  EXPECT_EQ(ParseWholeNumber("+7"), 7);
  for (const char* text : {"", "+", "+-1", "1,5", "1.5x", " 1", "1e999", "0x10", "--1"})
    EXPECT_FALSE(ParseNumber(text).has_value()) << text;
  for (const char* text : {"", "1.0", "99999999999", "+-1"})
    EXPECT_FALSE(ParseWholeNumber(text).has_value()) << text;
}

TEST(Letters, ChangeTheirCaseInAnyLocale) {
  EXPECT_EQ(LowerCase("TIF, \xC3\x84"), "tif, \xC3\x84");
  EXPECT_EQ(UpperCase('z'), 'Z');
  EXPECT_TRUE(IsLetterOrDigit('7') && IsLetterOrDigit('Q') && !IsLetterOrDigit('_'));
  EXPECT_EQ(Trimmed(" \t a b\r\n"), "a b");
  EXPECT_THAT(WordsOf(" one\ttwo \n"), testing::ElementsAre("one", "two"));
}

}  // namespace
}  // namespace alpenglow::atmosphere
