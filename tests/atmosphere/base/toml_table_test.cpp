// SPDX-License-Identifier: MIT
#include "atmosphere/base/toml_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

using tests::FaultOf;

TomlTable Camera(const std::string& line) {
  return *TomlTable("[camera]\n" + line + "\n", "s.toml").Table("camera");
}

TEST(TomlTable, ReadsNumbersTextsBooleansAndTables) {
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

TEST(TomlTable, InvalidNumbersAreRefused) {
  for (const char* value : {"nan", "inf", "-inf", "1e999", "\"46d33N\"", "true", "[1]"}) {
    EXPECT_NE(
        FaultOf([&] { (void)Camera(std::string("fov = ") + value).Number("fov", -1e300, 1e300); }),
        "no fault")
        << value;
  }
  EXPECT_EQ(FaultOf([] { (void)Camera("c = [1, nan]").Numbers("c", 0.0, 2.0); }),
            "s.toml:2: camera.c[1] is nan; it must lie in [0, 2]");
}

TEST(TomlTable, ReadsRowsWithOptionalColumns) {
  const std::vector<TomlColumn> columns{{"a", 0.0, 1.0}, {"b", -5.0, 5.0}};
  const TomlTable camera = Camera("r = [[0.5, -2], [1]]\nempty = []");
  EXPECT_EQ(camera.Rows("r", columns, 1), (std::vector<std::vector<double>>{{0.5, -2.0}, {1.0}}));
  EXPECT_EQ(camera.Rows("empty", columns, 1), std::vector<std::vector<double>>{});
  EXPECT_EQ(camera.Rows("absent", columns, 1), std::nullopt);
}

TEST(TomlTable, RowsAreRefusedWithTheirOwnLine) {
  const std::vector<TomlColumn> columns{{"a", 0.0, 1.0}, {"b", -5.0, 5.0}};
  const auto fault = [&](const char* line) {
    return FaultOf([&] { (void)Camera(line).Rows("r", columns, 1); });
  };
  EXPECT_EQ(fault("r = [[0],\n[1, 9]]"), "s.toml:3: b of camera.r[1] is 9; it must lie in [-5, 5]");
  EXPECT_EQ(fault("r = [[0],\n\n[1, nan]]"),
            "s.toml:4: b of camera.r[1] is nan; it must lie in [-5, 5]");
  EXPECT_EQ(fault("r = [\n[]]"), "s.toml:3: camera.r[0] has 0 numbers; it must have 1 to 2: a, b");
  EXPECT_EQ(fault("r = [[1],\n2]"), "s.toml:3: camera.r[1] is 2; it must be a list of a, b");
  EXPECT_EQ(fault("r = 2"), "s.toml:2: camera.r is 2; it must be a list, each item a list of a, b");
  EXPECT_EQ(FaultOf([] { Camera("r = [[1],\n[2]]").FailInRow("r", 1, "a fault"); }),
            "s.toml:3: a fault");
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

TEST(TomlTable, InvalidTomlIsRefusedWithItsLine) {
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

TEST(TomlTable, AByteOrderMarkAndAnEmptyDocumentAreAccepted) {
  EXPECT_EQ(TomlTable("\xef\xbb\xbf"
                      "a = 1\n",
                      "s.toml")
                .Number("a", 0.0, 1.0),
            1.0);
  EXPECT_FALSE(TomlTable("", "s.toml").Has("a"));
}

}  // namespace
}  // namespace alpenglow::atmosphere
