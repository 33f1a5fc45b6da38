// SPDX-License-Identifier: MIT
#include "lut/image/image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "atmosphere/base/error.h"
#include "lut/image/development.h"
#include "lut/layer.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Image TestImage() {
  Image image(37, 23);
  Channel depth{"depth.Z", std::vector<float>(image.rgb.size())};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto u = static_cast<float>(x);
      const auto v = static_cast<float>(y);
      image.at(x, y) = {u * 1e-9F, v * 1.6e9F, -u * v};
      depth.values[static_cast<std::size_t>(y * image.width + x)] =
          x == 0 ? std::numeric_limits<float>::infinity() : u + v;
    }
  }
  image.layers.push_back(std::move(depth));
  return image;
}

const Metadata kMetadata = {{"place", "46.5 N 8.0 E"}, {"zone", "Zürich"}, {"unit", "cd/m^2"}};

DisplayImage TestDisplayImage() {
  DisplayImage image{31, 17, {}};
  for (int i = 0; i < 31 * 17 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * 7));
  return image;
}

using ExrFile = TemporaryFolder;
using PngFile = TemporaryFolder;

TEST_F(ExrFile, ReturnsEveryBitOfPixelsLayersAndMetadata) {
  const Image image = TestImage();
  const fs::path file = folder_ / "a.exr";
  WriteExr(file, image, kMetadata);
  const Image back = ReadExr(file);
  EXPECT_EQ(back.width, image.width);
  EXPECT_EQ(back.height, image.height);
  EXPECT_EQ(back.rgb, image.rgb);
  ASSERT_EQ(back.layers.size(), 1U);
  EXPECT_EQ(back.layers[0].name, "depth.Z");
  EXPECT_EQ(back.layers[0].values, image.layers[0].values);
  EXPECT_EQ(ReadExrMetadata(file), kMetadata);
  EXPECT_EQ(FileCount(), 1U) << "no temporary is left";
}

TEST_F(ExrFile, APictureWithAValueThatIsNotFiniteIsNotWritten) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const auto fault_of = [&](const Image& image) -> std::string {
    try {
      WriteExr(folder_ / "a.exr", image, kMetadata);
    } catch (const InternalError& fault) {
      return fault.what();
    }
    return "none";
  };
  Image image = TestImage();
  image.at(3, 4)[1] = kNan;
  EXPECT_NE(fault_of(image).find("a.exr is not written: pixel (3, 4) of layer G is nan"),
            std::string::npos)
      << fault_of(image);
  image = TestImage();
  image.at(0, 1)[2] = kInfinite;
  EXPECT_NE(fault_of(image).find("pixel (0, 1) of layer B is inf"), std::string::npos);
  image = TestImage();
  image.layers[0].values[5] = kNan;
  EXPECT_NE(fault_of(image).find("pixel (5, 0) of layer depth.Z is nan"), std::string::npos);
  image.layers[0].name = "normal.Z";
  image.layers[0].values[5] = 0.0F;
  EXPECT_NE(fault_of(image).find("of layer normal.Z is inf"), std::string::npos)
      << "only distances are infinite where there is nothing";
  EXPECT_EQ(FileCount(), 0U) << "nothing is left, under no name";
  for (float& value : image.layers[0].values) value = -0.5F;
  EXPECT_EQ(fault_of(image), "none") << "a ceiling looks down";
}

// Hard case 44.
TEST_F(ExrFile, OnePixelAndOneColumnAreImages) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 500}, std::pair{16384, 1}}) {
    Image image(width, height);
    image.at(0, height - 1) = {1.0F, 2.0F, 3.0F};
    WriteExr(folder_ / "a.exr", image, {});
    EXPECT_EQ(ReadExr(folder_ / "a.exr").rgb, image.rgb);
  }
}

TEST_F(ExrFile, EveryTruncationIsRefused) {
  WriteExr(folder_ / "a.exr", TestImage(), kMetadata);
  const std::string whole = ContentOf(folder_ / "a.exr");
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 60) {
    WriteText(folder_ / "cut.exr", whole.substr(0, size));
    try {
      (void)ReadExr(folder_ / "cut.exr");
      FAIL() << size << " of " << whole.size() << " bytes were accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("cut.exr"));
    }
  }
}

TEST_F(ExrFile, MissingForeignAndChannelLessFilesAreRefused) {
  EXPECT_THROW((void)ReadExr(folder_ / "missing.exr"), InputError);
  EXPECT_THROW((void)ReadExr(folder_), InputError);
  WriteText(folder_ / "text.exr", "this is no picture");
  EXPECT_THROW((void)ReadExr(folder_ / "text.exr"), InputError);

  Imf::Header header(4, 4);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  {
    std::vector<float> values(16, 1.0F);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 16));
    Imf::OutputFile output((folder_ / "red.exr").c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(4);
  }
  try {
    (void)ReadExr(folder_ / "red.exr");
    FAIL() << "a picture without green was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("channel G is missing"));
  }
}

TEST_F(ExrFile, AMissingFolderIsAnOutputError) {
  try {
    WriteExr(folder_ / "none" / "a.exr", TestImage(), {});
    FAIL() << "a folder was made up";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr((folder_ / "none" / "a.exr").string()));
  }
}

// Hard case 46.
TEST_F(ExrFile, AFullDiskIsAnOutputError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  fs::create_symlink("/dev/full", folder_ / "a.exr");
  EXPECT_THROW(WriteExr(folder_ / "a.exr", TestImage(), {}), OutputError);
}

TEST(Image, SizesOutOfRangeAreRefused) {
  EXPECT_THROW(Image(0, 5), InputError);
  EXPECT_THROW(Image(5, -1), InputError);
  EXPECT_THROW(Image(40000, 1), InputError);
}

TEST_F(PngFile, ReturnsEveryByteAndTheMetadata) {
  const DisplayImage image = TestDisplayImage();
  const fs::path file = folder_ / "a.png";
  WritePng(file, image, kMetadata);
  const DisplayImage back = ReadPng(file);
  EXPECT_EQ(back.width, 31);
  EXPECT_EQ(back.height, 17);
  EXPECT_EQ(back.rgb, image.rgb);
  EXPECT_EQ(ReadPngMetadata(file), kMetadata);
  EXPECT_THAT(ContentOf(file), HasSubstr("sRGB"));
  EXPECT_THAT(ContentOf(file), HasSubstr("tEXtplace"));
}

TEST_F(PngFile, EveryTruncationAndForeignTextIsRefused) {
  WritePng(folder_ / "a.png", TestDisplayImage(), kMetadata);
  const std::string whole = ContentOf(folder_ / "a.png");
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 60) {
    WriteText(folder_ / "cut.png", whole.substr(0, size));
    EXPECT_THROW((void)ReadPng(folder_ / "cut.png"), InputError)
        << size << " of " << whole.size() << " bytes";
  }
  WriteText(folder_ / "text.png", "this is no picture");
  EXPECT_THROW((void)ReadPng(folder_ / "text.png"), InputError);
  EXPECT_THROW((void)ReadPngMetadata(folder_ / "text.png"), InputError);
  EXPECT_THROW((void)ReadPng(folder_ / "missing.png"), InputError);
}

Image Grey(int width, int height, float luminance) {
  Image image(width, height);
  for (auto& pixel : image.rgb) pixel = {luminance, luminance, luminance};
  return image;
}

TEST(Develop, LinearCurveReproducesTheSrgbCodeOnAverage) {
  // Light 0.2140 is code 127.5: half of the pixels 127, half 128, plus dither of one code.
  const DisplayImage display = Develop(Grey(64, 64, 0.21404F), -std::log2(1.2), ToneCurve::kLinear);
  double sum = 0.0;
  for (const std::uint8_t code : display.rgb) sum += code;
  EXPECT_NEAR(sum / static_cast<double>(display.rgb.size()), 127.5, 0.02)
      << "the tile holds every threshold once, so the mean is kept to rounding of 0.2140";
}

// Hard case 35.
TEST(Develop, ASlowGradientHasNoBands) {
  // One code over 256 columns: without dither two flat
  // bands, with it every 64-column block differs.
  Image image(256, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 256; ++x) {
      const double code = (100.0 + x / 256.0) / 255.0;
      const auto light = static_cast<float>(std::pow((code + 0.055) / 1.055, 2.4));
      image.at(x, y) = {light, light, light};
    }
  }
  const DisplayImage display = Develop(image, -std::log2(1.2), ToneCurve::kLinear);
  for (int block = 0; block < 4; ++block) {
    double sum = 0.0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 64 * block; x < 64 * (block + 1); ++x) {
        sum += display.rgb[static_cast<std::size_t>(3 * (y * 256 + x))];
      }
    }
    EXPECT_NEAR(sum / 4096.0, 100.125 + 0.25 * block, 0.05)
        << "the block's mean; the dither's own error over a block is its high frequencies only";
  }
}

TEST(Develop, IsTheSameInEveryRun) {
  const Image image = Grey(97, 41, 123.0F);
  EXPECT_EQ(Develop(image, 7.0, ToneCurve::kAgx).rgb, Develop(image, 7.0, ToneCurve::kAgx).rgb);
}

TEST(Develop, BlackStaysBlack) {
  const DisplayImage display = Develop(Grey(64, 64, 0.0F), 10.0, ToneCurve::kAgx);
  EXPECT_EQ(display.rgb, std::vector<std::uint8_t>(64 * 64 * 3, 0));
}

TEST(Develop, APixelThatIsNoNumberIsAFault) {
  Image image = Grey(4, 4, 1.0F);
  image.at(2, 1)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)Develop(image, 0.0, ToneCurve::kAgx), InternalError);
}

TEST(Dither, TileHoldsEveryRankOnce) {
  std::vector<int> seen(kDitherTileSize * kDitherTileSize, 0);
  for (const std::uint16_t rank : DitherTile()) ++seen.at(rank);
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

TEST(Dither, NeighboursDifferAsInBlueNoise) {
  // Ranks in [0, 1): white noise differs from its neighbour by 1/3 in the mean.
  double sum = 0.0;
  for (int y = 0; y < kDitherTileSize; ++y) {
    for (int x = 0; x < kDitherTileSize; ++x) {
      const int next = y * kDitherTileSize + (x + 1) % kDitherTileSize;
      sum += std::abs(DitherTile()[static_cast<std::size_t>(y * kDitherTileSize + x)] -
                      DitherTile()[static_cast<std::size_t>(next)]);
    }
  }
  EXPECT_GT(sum / 4096.0 / 4096.0, 0.37);
}

// Faint vertical stripes in an even sky, 2026-11-21: columns of the one tile stood over each other.
// Hard case 35.
TEST(Dither, ColumnsOfAnEvenPictureAreAsEvenAsIfEveryPixelHadItsOwnNoise) {
  constexpr int kWidth = 320;
  constexpr int kHeight = 704;
  double sum = 0.0;
  for (int x = 0; x < kWidth; ++x) {
    double column = 0.0;
    for (int y = 0; y < kHeight; ++y)
      column += static_cast<double>(DitheredCode(100.3F, DitherNoise(x, y, 1))) - 100.3;
    sum += column * column / (kHeight * kHeight);
  }
  EXPECT_LT(std::sqrt(sum / kWidth), 0.5 / std::sqrt(kHeight))
      << "half a code a pixel, that is, the deviation of triangular dither and rounding together";
}

// Hard case 35.
TEST(Dither, NoiseIsTriangularAndChannelsAreUncorrelated) {
  std::array<double, 3> mean = {};
  std::array<std::array<double, 3>, 3> product = {};
  for (int i = 0; i < 4096; ++i) {
    std::array<double, 3> noise = {};
    for (int c = 0; c < 3; ++c) {
      noise[static_cast<std::size_t>(c)] = static_cast<double>(DitherNoise(i % 64, i / 64, c));
    }
    for (std::size_t a = 0; a < 3; ++a) {
      mean[a] += noise[a] / 4096.0;
      for (std::size_t b = 0; b < 3; ++b) product[a][b] += noise[a] * noise[b] / 4096.0;
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(mean[a], 0.0, 1e-4);
    EXPECT_NEAR(product[a][a], 1.0 / 6.0, 1e-3) << "variance of the triangle on (-1, 1)";
    EXPECT_LT(std::abs(product[a][(a + 1) % 3]), 0.05 / 6.0) << "5 % correlation";
  }
}

// Hard case 32.
TEST_F(ExrFile, PicturesAreInFloatsAndHoldTheSunsDisk) {
  // 1.6e9 cd/m^2 in the mean, and 65504 is the largest half.
  Image image(3, 1);
  image.at(1, 0) = {1.9e9F, 1.6e9F, 1.4e9F};
  image.layers.push_back({"inscatter.R", {0.0F, 1.6e9F, 1e-30F}});
  WriteExr(folder_ / "sun.exr", image, {});
  const Imf::InputFile file((folder_ / "sun.exr").c_str());
  const Imf::ChannelList& channels = file.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    EXPECT_EQ(channel.channel().type, Imf::FLOAT) << channel.name();
  const Image back = ReadExr(folder_ / "sun.exr");
  EXPECT_EQ(back.rgb, image.rgb);
  EXPECT_EQ(back.layers[0].values, image.layers[0].values);
}

}  // namespace
}  // namespace alpenglow::lut
