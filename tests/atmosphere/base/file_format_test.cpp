// SPDX-License-Identifier: MIT
#include "atmosphere/base/file_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "atmosphere/base/text_file.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::atmosphere {
namespace {

using namespace std::string_view_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using FileFormats = TemporaryFolder;

std::string NameOf(std::string_view bytes) {
  const auto format = FormatOf(bytes, bytes.size());
  return format ? format->name : "none";
}

TEST(FileFormat, IsRecognisedByItsFirstBytes) {
  for (const auto& [bytes, name] : {std::pair{"PK\x03\x04\x14"sv, "zip"},
                                    {"\x1F\x8B\x08"sv, "gzip"},
                                    {"BZh9"sv, "bzip2"},
                                    {"\x89PNG\r\n\x1A\n"sv, "PNG"},
                                    {"\xFF\xD8\xFF\xE0"sv, "JPEG"},
                                    {"%PDF-1.7"sv, "PDF"},
                                    {"II*\0\x08"sv, "TIFF"},
                                    {"glTF\x02\0\0\0"sv, "glTF"},
                                    {"ply\nformat ascii"sv, "PLY"},
                                    {"Kaydara FBX Binary  \0"sv, "FBX"},
                                    {" BDV\0\0\0\0\xE0"sv, "OpenVDB"},
                                    {"\x93NUMPY\x01"sv, "NumPy"},
                                    {"NRRD0004\n"sv, "NRRD"},
                                    {"ObjectType = Image\n"sv, "MetaImage"},
                                    {"\x89HDF\r\n\x1A\n"sv, "HDF5"},
                                    {"CDF\x01"sv, "NetCDF"},
                                    {"\x76\x2F\x31\x01"sv, "OpenEXR"},
                                    {"\xFF\xFEt\0"sv, "UTF-16"},
                                    {"\x7F"
                                     "ELF\x02"sv,
                                     "program"},
                                    {"ncols 10\nnrows 3"sv, "ASCII grid"},
                                    {"AXGD1\nHFDTE160788\n"sv, "IGC"},
                                    {"solid cube\n facet normal 0 0 1"sv, "STL"}}) {
    EXPECT_THAT(NameOf(bytes), HasSubstr(name));
  }
}

TEST(FileFormat, XmlIsNamedByItsRootAndJsonByItsKeys) {
  for (const auto& [bytes, name] :
       {std::pair{"<?xml version=\"1.0\"?>\n<!-- a > b -->\n<gpx version=\"1.1\">"sv, "GPX"},
        {"\xEF\xBB\xBF<kml xmlns=\"\">"sv, "KML"},
        {"<COLLADA>"sv, "COLLADA"},
        {"<x:TrainingCenterDatabase a=\"b\">"sv, "TCX"},
        {"<!DOCTYPE html><html>"sv, "HTML"},
        {"<osm>"sv, "XML with the root <osm>"},
        {"{\"type\": \"FeatureCollection\"}"sv, "GeoJSON"},
        {"{\"asset\": {\"version\": \"2.0\"}}"sv, "glTF"},
        {"[\n {\"a\": 1}]"sv, "JSON"}}) {
    EXPECT_THAT(NameOf(bytes), HasSubstr(name)) << bytes;
  }
}

TEST(FileFormat, SupportedFormatsAreNotReportedAsForeign) {
  for (const std::string_view bytes :
       {""sv, "t_s,latitude\n0,1"sv, "[place]\nlatitude = 1"sv, "[[volume]]\n"sv, "# comment"sv,
        "o cube\nv 0 0 0"sv, "solid = true\n"sv, "# using WEBP files"sv, "# flight.FIT exported"sv,
        "\0\0\0\0\0\0\x80\x3F"sv, "preset = \"mars\""sv}) {
    EXPECT_EQ(NameOf(bytes), "none") << bytes;
  }
}

TEST(FileFormat, BinaryStlIsRecognisedByItsNumberOfTriangles) {
  std::string bytes(80, 's');
  bytes += "\x02\0\0\0"sv;
  bytes.resize(84 + 2 * 50);
  EXPECT_EQ(NameOf(bytes), "STL, a mesh");
  EXPECT_EQ(NameOf(bytes + 'x'), "none") << "the size must fit";
}

TEST_F(FileFormats, MessagesNameTheFormatAndASolution) {
  WriteText(folder_ / "a.kmz", "PK\x03\x04 and so on");
  EXPECT_THAT(
      tests::FaultOf([&] { return ReadTextFile(folder_ / "a.kmz"); }),
      AllOf(HasSubstr("a.kmz: this is a zip archive"), HasSubstr("text is read: unzip it")));
  EXPECT_FALSE(FormatOfFile(folder_ / "none").has_value());
  EXPECT_FALSE(FormatOfFile(folder_).has_value());
  WriteText(folder_ / "a.gpx", "<gpx>");
  EXPECT_EQ(ReadTextFile(folder_ / "a.gpx"), "<gpx>") << "XML is text";
  const auto refused = [&] {
    RefuseKnownFormats(folder_ / "a.gpx", "CSV is read");
    return 0;
  };
  EXPECT_THAT(tests::FaultOf(refused), HasSubstr("a.gpx: this is GPX, a track; CSV is read"));
}

TEST_F(FileFormats, APipeIsReadLikeAFile) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { WriteText(folder_ / "pipe", "from a pipe"); });
  EXPECT_EQ(ReadTextFile(folder_ / "pipe"), "from a pipe");
  writer.join();
}

TEST(Printable, ControlCharactersAndBrokenTextAreEscaped) {
  EXPECT_EQ(Printable("plain Ää 東京 \U0001F304"), "plain Ää 東京 \U0001F304");
  EXPECT_EQ(Printable("a\x1B[31mb\0c\r\n\x7F"sv), R"(a\x1b[31mb\x00c\x0d\x0a\x7f)");
  EXPECT_EQ(Printable("\xC2\x9B"
                      "31m \x9B"),
            R"(\xc2\x9b31m \x9b)")
      << "C1, in UTF-8 and bare";
  EXPECT_EQ(Printable("\xC0\x80 \xE2\x82 \xED\xA0\x80 \xF5\x80\x80\x80"),
            R"(\xc0\x80 \xe2\x82 \xed\xa0\x80 \xf5\x80\x80\x80)");
  EXPECT_EQ(Printable("a\nb\tc", "\n"), "a\nb\\x09c");
}

TEST(Printable, MessagesOfExceptionsAreComplete) {
  const std::string text("one\0two\x1B", 8);
  EXPECT_STREQ(InputError(text).what(), R"(one\x00two\x1b)");
  EXPECT_STREQ(OutputError(text).what(), R"(one\x00two\x1b)");
}

}  // namespace
}  // namespace alpenglow::atmosphere
