// SPDX-License-Identifier: MIT
#include "atmosphere/base/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

using testing::ElementsAre;

TEST(Csv, QuotedFieldsMayContainSeparatorsAndQuotes) {
  EXPECT_THAT(SplitCsv("a,b , c").fields, ElementsAre("a", "b", "c"));
  EXPECT_THAT(SplitCsv(R"("a","b, c" , "say ""no""" )").fields,
              ElementsAre("a", "b, c", R"(say "no")"));
  EXPECT_THAT(SplitCsv(R"("","""",,)").fields, ElementsAre("", "\"", "", ""));
  EXPECT_THAT(SplitCsv("").fields, ElementsAre(""));
}

TEST(Csv, FieldsStayValidWhenTheRecordIsMoved) {
  const std::string line = R"("a""b","c")";
  CsvRecord first = SplitCsv(line);
  const CsvRecord second = std::move(first);
  EXPECT_THAT(second.fields, ElementsAre("a\"b", "c"));
}

TEST(Csv, CommentsBeginOutsideQuotes) {
  const CsvSyntax syntax{.has_comments = true};
  EXPECT_THAT(SplitCsv("a, \"b # c\" # d, e", syntax).fields, ElementsAre("a", "b # c"));
  EXPECT_THAT(SplitCsv("# only a comment", syntax).fields, ElementsAre(""));
  EXPECT_THAT(SplitCsv("a # b").fields, ElementsAre("a # b"));
}

TEST(Csv, OpenQuotesAndTextAfterQuotesAreErrors) {
  EXPECT_EQ(SplitCsv("a,\"b").fault, "has a quote that is not closed on its line");
  EXPECT_EQ(SplitCsv("\"a\"\"").fault, "has a quote that is not closed on its line");
  EXPECT_EQ(SplitCsv("\"a\"b,c").fault, "has text behind a closing quote");
  EXPECT_EQ(SplitCsv("a\"b\",c").fault, "") << "a quote within plain text has no meaning";
}

TEST(Csv, SeparatorIsRecognisedInTheHeader) {
  EXPECT_EQ(SeparatorOf("a,b"), ',');
  EXPECT_EQ(SeparatorOf("a;b"), ';');
  EXPECT_EQ(SeparatorOf("a\tb"), '\t');
  EXPECT_EQ(SeparatorOf("\"a,b\";c"), ';');
  EXPECT_EQ(SeparatorOf("a;b # one, two"), ';');
  EXPECT_EQ(SeparatorOf("a"), ',');
  EXPECT_THAT(SplitCsv("1\t\t2", {.separator = '\t'}).fields, ElementsAre("1", "", "2"));
}

TEST(Csv, RowsFollowTheNamesOfColumns) {
  std::vector<std::string> seen;
  const auto visit = [&](const CsvRecord& row) { seen.emplace_back(row.fields.at(1)); };
  VisitCsvRows("# source\na,b\n1,2\r\n\n# more\n3,\"4\"", visit);
  EXPECT_THAT(seen, ElementsAre("2", "4"));
  EXPECT_THROW(VisitCsvRows("a\n\"1", visit), InternalError);
}

}  // namespace
}  // namespace alpenglow::atmosphere
