// SPDX-License-Identifier: MIT
#include "atmosphere/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/parsing.h"
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

TEST(FileExtension, IsTheSameInWhateverCase) {
  for (const char* name : {"track.gpx", "folder.d/TRACK.GPX", "a.b.GpX"}) {
    EXPECT_TRUE(HasExtension(name, ".gpx")) << name;
  }
  for (const char* name : {"gpx", ".gpx", "track.gp", "track.gpxx", "track.gpx/file", ""}) {
    EXPECT_FALSE(HasExtension(name, ".gpx")) << name;
  }
  EXPECT_TRUE(HasExtension("none", ""));
}

TomlTable Camera(const std::string& line) {
  return *TomlTable("[camera]\n" + line + "\n", "s.toml").Table("camera");
}

TEST(TomlTable, ReadsNumbersTextsTruthsAndTables) {
  const TomlTable document(
      "a = 3\nb = [1, 2.5]\nc = \"text\"\nd = true\n[e]\nf = -1e-3\n[[g]]\nh = 1\n[[g]]\nh = 2\n",
      "s.toml");
  EXPECT_EQ(document.Number("a", 0.0, 5.0), 3.0);
  EXPECT_EQ(document.Numbers("a", 0.0, 5.0), std::vector<double>{3.0});
  EXPECT_EQ(document.Numbers("b", 0.0, 5.0), (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(document.Text("c"), "text");
  EXPECT_EQ(document.Truth("d"), true);
  EXPECT_EQ(document.Table("e")->Number("f", -1.0, 1.0), -1e-3);
  ASSERT_EQ(document.Tables("g").size(), 2U);
  EXPECT_EQ(document.Tables("g")[1].Number("h", 0.0, 5.0), 2.0);
  EXPECT_EQ(document.Number("absent", 0.0, 1.0), std::nullopt);
  EXPECT_TRUE(document.Tables("absent").empty());
}

TEST(TomlTable, MessageNamesFileLineKeyValueAndRange) {
  EXPECT_EQ(FaultOf([] { (void)Camera("fov = 400").Number("fov", 0.1, 360.0); }),
            "s.toml:2: camera.fov is 400; it must lie in [0.1, 360]");
}

TEST(TomlTable, NumbersThatAreNoneAreRefused) {
  for (const char* value : {"nan", "inf", "-inf", "1e999", "\"46d33N\"", "true", "[1]"}) {
    EXPECT_NE(
        FaultOf([&] { (void)Camera(std::string("fov = ") + value).Number("fov", -1e300, 1e300); }),
        "no fault")
        << value;
  }
  EXPECT_EQ(FaultOf([] { (void)Camera("c = [1, nan]").Numbers("c", 0.0, 2.0); }),
            "s.toml:2: camera.c[1] is nan; it must lie in [0, 2]");
}

TEST(TomlTable, WrongTypesAreRefused) {
  const auto fault = [](const char* line, const auto& read) {
    return FaultOf([&] { return read(Camera(line)); });
  };
  const auto text = [](const TomlTable& table) { return table.Text("a"); };
  const auto tables = [](const TomlTable& table) { return table.Tables("a"); };
  EXPECT_THAT(fault("a = 3", text), testing::HasSubstr("camera.a is 3; it must be text"));
  EXPECT_THAT(fault("a = 3", [](const TomlTable& table) { return table.Truth("a"); }),
              testing::HasSubstr("true or"));
  EXPECT_THAT(fault("a = 3", [](const TomlTable& table) { return table.Table("a"); }),
              testing::HasSubstr("a table"));
  EXPECT_THAT(fault("a = 3", tables), testing::HasSubstr("[[camera.a"));
  EXPECT_THAT(fault("a = [3]", tables), testing::HasSubstr("holds 3"));
  EXPECT_THAT(fault("a = 2026-06-21", text), testing::HasSubstr("a date or time"));
}

TEST(TomlTable, AnUnknownKeyIsRefusedWithTheNearestKnownOne) {
  const auto fault = [](const char* line) {
    return FaultOf([&] {
      Camera(line).AllowOnly({"heading", "pitch"});
      return 0;
    });
  };
  EXPECT_EQ(fault("headin = 3"), "s.toml:2: unknown key camera.headin; did you mean heading?");
  EXPECT_EQ(fault("zzz = 3"), "s.toml:2: unknown key camera.zzz; known are heading, pitch");
  EXPECT_EQ(fault("pitch = 3"), "no fault");
}

TEST(NearestName, IsNearRelativeToTheLengthOfTheWord) {
  const std::vector<std::string> known{"heading", "size", "K2", "KDEN", "eval", "Köln"};
  EXPECT_EQ(NearestName("headin", known), "heading");
  EXPECT_EQ(NearestName("haeding", known), "heading");
  EXPECT_EQ(NearestName("siez", known), "size") << "two letters in the other order are one edit";
  EXPECT_EQ(NearestName("evaluate", known), "eval") << "the beginning of the word";
  EXPECT_EQ(NearestName("Kölm", known), "Köln") << "a letter of two bytes is one letter";
  for (const char* far : {"", "x", "K", "koln", "東京", "size", "hding"})
    EXPECT_EQ(NearestName(far, {"size", "K2", "KDEN"}), std::nullopt) << far;
}

TEST(TomlTable, WhatIsNoTomlIsRefusedWithItsLine) {
  const std::string deep = "a = " + std::string(5000, '[') + std::string(5000, ']');
  const std::string utf16(
      "a\0=\0"
      "1\0",
      6);
  for (const std::string& text : {std::string("a = 1\na = 2\n"), std::string("a = \n"),
                                  std::string("[a\n"), std::string("\xff\xff"), utf16, deep}) {
    EXPECT_THAT(FaultOf([&] { TomlTable(text, "s.toml"); }),
                testing::MatchesRegex("s\\.toml:[0-9]+: .*"));
  }
  EXPECT_THAT(FaultOf([] { TomlTable("a = 1\na = 2\n", "s.toml"); }),
              testing::HasSubstr("s.toml:2: not valid TOML"));
  EXPECT_THAT(FaultOf([] { TomlTable("\xff\xfe", "s.toml"); }),
              testing::HasSubstr("s.toml: this is UTF-16 text"));
}

TEST(TomlTable, KeysDeeperThanTheStackAreRefused) {
  std::string deep = "a";
  for (int i = 0; i < 200000; ++i) deep += ".a";
  for (const std::string& text : {"\n" + deep + " = 1\n", "\n[" + deep + "]\n"}) {
    EXPECT_EQ(FaultOf([&] { TomlTable(text, "s.toml"); }),
              "s.toml:2: more than 256 dots in a row of keys");
  }
}

TEST(TomlTable, AByteOrderMarkAndAnEmptyDocumentAreToml) {
  EXPECT_EQ(TomlTable("\xef\xbb\xbf"
                      "a = 1\n",
                      "s.toml")
                .Number("a", 0.0, 1.0),
            1.0);
  EXPECT_FALSE(TomlTable("", "s.toml").Has("a"));
}

TEST(TomlTable, FilesThatCannotBeReadAreNamed) {
  EXPECT_THAT(FaultOf([] { (void)ReadTextFile("/no/such/file.toml"); }),
              testing::HasSubstr("/no/such/file.toml: cannot be read"));
  EXPECT_NE(FaultOf([] { (void)ReadTextFile("/"); }), "no fault");
}

TEST(Numbers, AreReadWholeWithPointAndSign) {
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
