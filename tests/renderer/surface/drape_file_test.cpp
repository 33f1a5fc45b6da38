// SPDX-License-Identifier: MIT
#include "renderer/surface/drape_file.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "renderer/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// A band of a picture of two equal pixels.
struct TestBand {
  double value;
  GDALColorInterp colour = GCI_Undefined;
  std::string description = {};
  double scale = 1.0, offset = 0.0;
  double nodata = kNoValue;  // NaN: none
};

/// sRGB decoding, IEC 61966-2-1, of codes up to `largest`.
double LinearOfCode(double code, double largest) { return tests::LightOfCode(code / largest); }

class DrapeFile : public TemporaryFolder {
 protected:
  using Options = std::vector<const char*>;

  [[nodiscard]] std::filesystem::path Write(const std::vector<TestBand>& bands,
                                            GDALDataType type = GDT_Byte,
                                            Options options = {}) const {
    GDALRegister_GTiff();
    const std::filesystem::path file = folder_ / "picture.tif";
    std::filesystem::remove(file.string() + ".aux.xml");
    // By itself GDAL declares three bands of bytes as red, green and blue.
    options.push_back("PHOTOMETRIC=MINISBLACK");
    options.push_back(nullptr);
    GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file.c_str(), 2, 1, static_cast<int>(bands.size()), type,
        const_cast<char**>(options.data()));
    for (std::size_t i = 0; i < bands.size(); ++i) {
      GDALRasterBand& band = *dataset->GetRasterBand(static_cast<int>(i) + 1);
      const TestBand& wanted = bands[i];
      band.SetColorInterpretation(wanted.colour);
      if (!wanted.description.empty()) band.SetDescription(wanted.description.c_str());
      if (wanted.scale != 1.0) band.SetScale(wanted.scale);
      if (wanted.offset != 0.0) band.SetOffset(wanted.offset);
      if (!std::isnan(wanted.nodata)) band.SetNoDataValue(wanted.nodata);
      std::array<double, 2> values{wanted.value, wanted.value};
      EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, 2, 1, values.data(), 2, 1, GDT_Float64, 0, 0),
                CE_None);
    }
    GDALClose(dataset);
    return file;
  }

  [[nodiscard]] static DrapePixels Pixels(const std::filesystem::path& file) {
    const QuietGdal quiet;
    return ReadColours(file, *OpenDrape(file, false));
  }
  [[nodiscard]] static std::string FaultOf(const std::filesystem::path& file) {
    return tests::FaultOf([&] { return Pixels(file); });
  }
};

/// Expects linear colours and a weight, to the rounding of 16 bits.
void ExpectPixel(const DrapePixels& read, const std::array<double, 3>& rgb, double weight = 1.0) {
  ASSERT_EQ(read.pixels.size(), 2U);
  constexpr double kRounding = 1.0 / 65535.0;
  for (std::size_t channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(read.pixels[0][channel] / 65535.0, weight * rgb[channel], kRounding) << channel;
  EXPECT_NEAR(read.pixels[0][3] / 65535.0, weight, kRounding);
}

const TestBand kRed{200.0, GCI_RedBand}, kGreen{100.0, GCI_GreenBand}, kBlue{50.0, GCI_BlueBand};
const TestBand kOpaque{255.0, GCI_AlphaBand}, kNir{240.0, GCI_Undefined, "NIR"};

std::array<double, 3> Orange() {
  return {LinearOfCode(200.0, 255.0), LinearOfCode(100.0, 255.0), LinearOfCode(50.0, 255.0)};
}

TEST_F(DrapeFile, DeclaredColoursWinOverTheOrderOfBands) {
  const std::vector<std::vector<TestBand>> orders{
      {kRed, kGreen, kBlue},
      {kBlue, kGreen, kRed},
      {kBlue, kGreen, kRed, kNir},
      {kNir, kRed, kGreen, kBlue},
      {kOpaque, kRed, kGreen, kBlue},
      {kOpaque, kBlue, kGreen, kRed},
      {kRed, kGreen, kBlue, kOpaque, kNir},
      {{1.0}, {2.0}, kBlue, kRed, {3.0}, kGreen},
      {{50.0, GCI_Undefined, "Blue"},
       {100.0, GCI_Undefined, "green"},
       {200.0, GCI_Undefined, "RED"}},
      {{50.0, GCI_GrayIndex, "b"}, {100.0, GCI_Undefined, "g"}, {200.0, GCI_Undefined, "r"}, kNir}};
  for (std::size_t i = 0; i < orders.size(); ++i) {
    SCOPED_TRACE(i);
    ExpectPixel(Pixels(Write(orders[i])), Orange());
  }
}

TEST_F(DrapeFile, UndeclaredBandsAreRedGreenAndBlueOrGrey) {
  ExpectPixel(Pixels(Write({{200.0}, {100.0}, {50.0}})), Orange());
  ExpectPixel(Pixels(Write({{200.0, GCI_GrayIndex}, {100.0}, {50.0}, {9.0}})), Orange());
  ExpectPixel(Pixels(Write({{255.0, GCI_AlphaBand}, {200.0}, {100.0}, {50.0}})), Orange());
  const double grey = LinearOfCode(128.0, 255.0);
  ExpectPixel(Pixels(Write({{128.0, GCI_GrayIndex}})), {grey, grey, grey});
  ExpectPixel(Pixels(Write({{128.0}})), {grey, grey, grey});
  ExpectPixel(Pixels(Write({kOpaque, {128.0, GCI_GrayIndex}})), {grey, grey, grey});
}

TEST_F(DrapeFile, BandsWithoutEachColourAreRefused) {
  for (const std::vector<TestBand>& bands :
       std::vector<std::vector<TestBand>>{{kRed, kGreen},
                                          {kNir, kRed, kGreen},
                                          {kRed, kRed, kGreen, kBlue},
                                          {kNir},
                                          {{1.0, GCI_CyanBand},
                                           {2.0, GCI_MagentaBand},
                                           {3.0, GCI_YellowBand},
                                           {4.0, GCI_BlackBand}},
                                          {{1.0}, {2.0}},
                                          {kOpaque}}) {
    EXPECT_THAT(FaultOf(Write(bands)), AllOf(HasSubstr("picture.tif: declares "),
                                             HasSubstr("red, green and blue, grey or a palette")));
  }
  EXPECT_THAT(FaultOf(Write({kNir, kRed, kGreen})), HasSubstr("Undefined (NIR), Red, Green"));
}

TEST_F(DrapeFile, AlphaBandsOfEveryTypeWeighPixels) {
  ExpectPixel(Pixels(Write({{51.0, GCI_AlphaBand}, kRed, kGreen, kBlue})), Orange(), 0.2);
  ExpectPixel(Pixels(Write({kRed, kGreen, kBlue, {51.0, GCI_AlphaBand}, kNir})), Orange(), 0.2);
  ExpectPixel(
      Pixels(Write(
          {{0.5, GCI_RedBand}, {0.25, GCI_GreenBand}, {0.125, GCI_BlueBand}, {0.5, GCI_AlphaBand}},
          GDT_Float32)),
      {0.5, 0.25, 0.125}, 0.5);
  const double half = LinearOfCode(32768.0, 65535.0);
  ExpectPixel(Pixels(Write({{32768.0, GCI_GrayIndex}, {13107.0, GCI_AlphaBand}}, GDT_UInt16)),
              {half, half, half}, 0.2);
}

TEST_F(DrapeFile, DeclaredScalesMakeLinearReflectances) {
  const auto scaled = [](double value, double scale, double offset) {
    return TestBand{value, GCI_GrayIndex, "", scale, offset};
  };
  for (const GDALDataType type :
       {GDT_UInt16, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Float32, GDT_Float64}) {
    SCOPED_TRACE(GDALGetDataTypeName(type));
    ExpectPixel(Pixels(Write({scaled(5000.0, 1e-4, 0.0)}, type)), {0.5, 0.5, 0.5});
    ExpectPixel(Pixels(Write({scaled(6000.0, 1e-4, -0.1)}, type)), {0.5, 0.5, 0.5});
  }
  ExpectPixel(Pixels(Write({scaled(51.0, 1.0 / 255.0, 0.0)})), {0.2, 0.2, 0.2});
  const DrapePixels by_band = Pixels(Write({{5000.0, GCI_BlueBand, "", 1e-4},
                                            {500.0, GCI_GreenBand, "", 1e-3},
                                            {1000.0, GCI_RedBand, "", 1e-4, 0.1}},
                                           GDT_UInt16));
  ExpectPixel(by_band, {0.2, 0.5, 0.5});
  EXPECT_EQ(by_band.note, "");
  EXPECT_THAT(FaultOf(Write({scaled(1.0, 0.0, 0.0)}, GDT_Int16)), HasSubstr("declares scale 0"));
}

/// Replaces the only occurrence of a text in a file by one of the same length.
void Patch(const std::filesystem::path& file, std::string_view from, std::string_view to) {
  std::string bytes = ContentOf(file);
  const std::size_t at = bytes.find(from);
  ASSERT_NE(at, std::string::npos);
  ASSERT_EQ(from.size(), to.size());
  bytes.replace(at, from.size(), to);
  std::ofstream(file, std::ios::binary) << bytes;
}

void WriteSidecar(const std::filesystem::path& file, const std::string& of_band) {
  std::ofstream(file.string() + ".aux.xml")
      << "<PAMDataset><PAMRasterBand band=\"1\">" << of_band << "</PAMRasterBand></PAMDataset>";
}

TEST_F(DrapeFile, AScaleOfOneIsDeclaredLikeAnyOther) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_Int32}) {
    SCOPED_TRACE(GDALGetDataTypeName(type));
    // GDAL writes no scale of 1 itself.
    const std::filesystem::path file = Write({{1.0, GCI_GrayIndex, "", 2.0}}, type);
    Patch(file, "role=\"scale\">2<", "role=\"scale\">1<");
    ExpectPixel(Pixels(file), {1.0, 1.0, 1.0});
    WriteSidecar(Write({{1.0, GCI_GrayIndex}}, type), "<Scale>1</Scale>");
    ExpectPixel(Pixels(file), {1.0, 1.0, 1.0});
    WriteSidecar(Write({{1.0, GCI_GrayIndex}}, type), "<Offset>0</Offset>");
    ExpectPixel(Pixels(file), {1.0, 1.0, 1.0});
  }
  const std::filesystem::path bright = Write({{200.0, GCI_GrayIndex, "", 2.0}});
  Patch(bright, "role=\"scale\">2<", "role=\"scale\">1<");
  EXPECT_THAT(Pixels(bright).note, HasSubstr("reach 200 "));
}

TEST_F(DrapeFile, ASidecarWithoutScaleDeclaresNone) {
  const double grey = LinearOfCode(200.0, 255.0);
  const std::filesystem::path file = Write({{200.0, GCI_GrayIndex}});
  WriteSidecar(file, "<Metadata><MDI key=\"STATISTICS_MEAN\">200</MDI></Metadata>");
  ExpectPixel(Pixels(file), {grey, grey, grey});
  WriteSidecar(Write({{200.0, GCI_GrayIndex}}, GDT_Int16), "<Description>heights</Description>");
  EXPECT_THAT(FaultOf(file), HasSubstr("declares no scale"));
}

TEST_F(DrapeFile, ValuesOutOfRangeAreCutOffWithANote) {
  const DrapePixels bright = Pixels(Write({{188.0}}, GDT_Float32));
  ExpectPixel(bright, {1.0, 1.0, 1.0});
  EXPECT_THAT(bright.note, AllOf(HasSubstr("picture.tif: its values reach 188"),
                                 HasSubstr("linear colours lie in [0, 1]")));
  EXPECT_THAT(Pixels(Write({{20000.0, GCI_GrayIndex, "", 1e-4}}, GDT_UInt16)).note,
              HasSubstr("reach 2 "));
  EXPECT_THAT(Pixels(Write({{-0.5}}, GDT_Float64)).note, HasSubstr("reach -0.5 "));
  EXPECT_EQ(Pixels(Write({{1.0}}, GDT_Float32)).note, "");
  EXPECT_EQ(Pixels(Write({{-9999.0, GCI_GrayIndex, "", 1.0, 0.0, -9999.0}}, GDT_Float32)).note, "")
      << "what has no data does not count";
}

TEST_F(DrapeFile, PixelsWithoutDataAreTransparent) {
  ExpectPixel(Pixels(Write({{0.5}, {kNoValue}, {0.5}}, GDT_Float32)), {0.0, 0.0, 0.0}, 0.0);
  ExpectPixel(Pixels(Write({{-9999.0, GCI_GrayIndex, "", 1e-4, 0.0, -9999.0}}, GDT_Int16)),
              {0.0, 0.0, 0.0}, 0.0);
}

TEST_F(DrapeFile, IntegersHaveTheBitsThatTheirFileDeclares) {
  const double grey = LinearOfCode(2048.0, 4095.0);
  ExpectPixel(Pixels(Write({{2048.0}}, GDT_UInt16, {"NBITS=12"})), {grey, grey, grey});
  ExpectPixel(Pixels(Write({{1.0}}, GDT_Byte, {"NBITS=1"})), {1.0, 1.0, 1.0});
  const double dark = LinearOfCode(55.0, 255.0);
  ExpectPixel(Pixels(Write({{200.0, GCI_GrayIndex}}, GDT_Byte, {"PHOTOMETRIC=MINISWHITE"})),
              {dark, dark, dark});
  for (const GDALDataType type : {GDT_Int16, GDT_UInt32, GDT_Int32, GDT_CFloat32})
    EXPECT_THAT(FaultOf(Write({{1.0}}, type)), HasSubstr("declares no scale")) << type;
}

TEST_F(DrapeFile, PalettesHaveTheColoursOfTheirEntries) {
  const std::filesystem::path file = Write({{1.0}});
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_Update));
  GDALColorTable palette;
  const GDALColorEntry black{0, 0, 0, 255}, orange{200, 100, 50, 255};
  palette.SetColorEntry(0, &black);
  palette.SetColorEntry(1, &orange);
  ASSERT_EQ(dataset->GetRasterBand(1)->SetColorTable(&palette), CE_None);
  GDALClose(dataset);
  ExpectPixel(Pixels(file), Orange());
}

TEST_F(DrapeFile, EntriesOfPalettesHaveWeights) {
  for (const short weight : std::array<short, 4>{255, 200, 50, 0}) {
    SCOPED_TRACE(weight);
    const std::filesystem::path bytes = Write({{1.0}});
    auto* dataset = static_cast<GDALDataset*>(GDALOpen(bytes.c_str(), GA_Update));
    GDALColorTable palette;
    const GDALColorEntry half{0, 0, 0, 128}, orange{200, 100, 50, weight};
    palette.SetColorEntry(0, &half);
    palette.SetColorEntry(1, &orange);
    ASSERT_EQ(dataset->GetRasterBand(1)->SetColorTable(&palette), CE_None);
    GDALRegister_PNG();
    const std::filesystem::path file = folder_ / "palette.png";
    GDALClose(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
        file.c_str(), dataset, FALSE, nullptr, nullptr, nullptr));
    GDALClose(dataset);
    ExpectPixel(Pixels(file), Orange(), weight / 255.0);
  }
}

TEST_F(DrapeFile, OtherFormatsAreNamed) {
  for (const auto& [name, bytes, format] :
       {std::tuple{"a.jpg", "\xFF\xD8\xFF\xE0 and more", "this is a JPEG picture"},
        {"a.pdf", "%PDF-1.4 and more", "this is PDF"},
        {"a.tif", "PK\x03\x04 and more", "this is a zip archive"}}) {
    WriteText(folder_ / name, bytes);
    EXPECT_THAT(
        FaultOf(folder_ / name),
        AllOf(HasSubstr(format), HasSubstr("pictures on terrain are read as GeoTIFF or PNG")));
  }
}

}  // namespace
}  // namespace alpenglow::renderer
