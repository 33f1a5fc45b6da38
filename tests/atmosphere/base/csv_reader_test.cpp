// SPDX-License-Identifier: MIT
#include "atmosphere/base/csv_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::atmosphere {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::array<std::string_view, 3> kNamedColumns{"t_s", "name", "height_m"};

class CsvFile : public TemporaryFolder {
 protected:
  /// Returns "time name height" of each line.
  [[nodiscard]] std::vector<std::string> LinesOf(std::string_view text,
                                                 bool has_comments = false) const {
    WriteText(folder_ / "a.csv", std::string(text));
    CsvReader reader(folder_ / "a.csv", kNamedColumns, {2, has_comments});
    std::vector<std::string> lines;
    while (reader.Next()) {
      const double height_m = reader.Has(2) ? reader.Number(2, -1e4, 1e4) : 0.0;
      lines.push_back(
          fmt::format("{} {} {}", reader.Number(0, -1e9, 1e9), reader.Field(1), height_m));
    }
    EXPECT_EQ(reader.bytes_read(), text.size());
    return lines;
  }
  [[nodiscard]] std::string FaultOf(std::string_view text) const {
    return tests::FaultOf([&] { return LinesOf(text); });
  }
};

TEST_F(CsvFile, QuotesAndLineEndsOfEveryProgramAreRead) {
  const auto two_lines = ElementsAre("0 a 5", "10 b 6");
  for (const std::string_view text :
       {"t_s,name,height_m\n0,a,5\n10,b,6\n",
        "\"t_s\",\"name\",\"height_m\"\n\"0\",\"a\",\"5\"\n"
        "\"10\",\"b\",\"6\"\n",
        "\xEF\xBB\xBF\"t_s\",\"name\",\"height_m\"\r\n0,a,5\r\n10,b,6\r\n",
        "t_s,name,height_m\r0,a,5\r10,b,6", "height_m;name;t_s\n5;a;0\n6;b;10\n",
        "t_s\tname\theight_m\n0\ta\t5\n10\tb\t6\n", "t_s, name, height_m\n +0, a , +5\n+10,b,6"}) {
    EXPECT_THAT(LinesOf(text), two_lines) << text;
  }
  EXPECT_THAT(LinesOf("t_s,name\n1,\"say \"\"a, b\"\"\"\n"), ElementsAre("1 say \"a, b\" 0"));
}

TEST_F(CsvFile, CommentsBeginOutsideQuotes) {
  EXPECT_THAT(LinesOf("# flight, of today\n\nt_s;name # a, b\n0;\"a # b\" # c\n\n", true),
              ElementsAre("0 a # b 0"));
}

TEST_F(CsvFile, MessagesNameLineAndField) {
  EXPECT_THAT(FaultOf("t_s,name\n0,\"a\n"), HasSubstr("a.csv:2: has a quote that is not closed"));
  EXPECT_THAT(FaultOf("t_s,name\n0,\"a\"b\n"), HasSubstr("a.csv:2: has text behind a closing"));
  EXPECT_THAT(FaultOf("t_s;name\n0,5;a\n"),
              HasSubstr("a.csv:2: t_s is \"0,5\"; it must be a number with a decimal point"));
  EXPECT_THAT(FaultOf("t_s,name\n+-1,a\n"), HasSubstr("t_s is \"+-1\"; it must be a number"));
  EXPECT_THAT(FaultOf("t_s,name\r\n0,a\r\n1\r\n"), HasSubstr("a.csv:3: has 1 fields"));
}

TEST_F(CsvFile, OtherFormatsAreNamedAndBytesAreEscaped) {
  using namespace std::string_view_literals;
  EXPECT_THAT(FaultOf("PK\x03\x04\0\0"sv), HasSubstr("a.csv: this is a zip archive"));
  EXPECT_THAT(FaultOf("\xFF\xFEt\0_\0s\0"sv), HasSubstr("this is UTF-16 text; CSV is read: save"));
  EXPECT_THAT(FaultOf("<?xml version=\"1.0\"?><gpx>"), HasSubstr("this is GPX, a track"));
  EXPECT_THAT(FaultOf("\x1B[31mred\0x,t_s\n0,1\n"sv),
              HasSubstr(R"(a.csv:1: column "\x1b[31mred\x00x" is unknown; the columns are t_s)"));
}

TEST_F(CsvFile, HeadersNameColumnsAlsoInQuotes) {
  WriteText(folder_ / "a.csv", "\xEF\xBB\xBF\"id\";\"lamp_x\"\r\n");
  EXPECT_TRUE(HeaderNames(folder_ / "a.csv", "lamp_x"));
  EXPECT_TRUE(HeaderNames(folder_ / "a.csv", "id"));
  EXPECT_FALSE(HeaderNames(folder_ / "a.csv", "lamp"));
}

}  // namespace
}  // namespace alpenglow::atmosphere
