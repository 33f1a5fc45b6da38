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
#include "lut/image/clipped_edge.h"
#include "lut/image/development.h"
#include "lut/image/dither.h"
#include "lut/image/exr.h"
#include "lut/image/look.h"
#include "lut/image/png.h"
#include "lut/image/tone_mapping.h"
#include "lut/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/flat_picture.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

HdrImage TestImage() {
  HdrImage image(37, 23);
  ImageLayer depth{"depth.Z", std::vector<float>(image.rgb.size())};
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

TEST_F(ExrFile, KeepsEveryBitOfPixelsLayersAndMetadata) {
  const HdrImage image = TestImage();
  const fs::path file = folder_ / "a.exr";
  WriteExr(file, image, kMetadata);
  const HdrImage back = ReadExr(file);
  EXPECT_EQ(back.width, image.width);
  EXPECT_EQ(back.height, image.height);
  EXPECT_EQ(back.rgb, image.rgb);
  ASSERT_EQ(back.layers.size(), 1U);
  EXPECT_EQ(back.layers[0].name, "depth.Z");
  EXPECT_EQ(back.layers[0].values, image.layers[0].values);
  EXPECT_EQ(ReadExrMetadata(file), kMetadata);
  EXPECT_EQ(FileCount(), 1U) << "no temporary is left";
}

TEST_F(ExrFile, NonFinitePixelsAreNotWritten) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const auto fault_of = [&](const auto& change) {
    HdrImage image = TestImage();
    change(image);
    return tests::FaultOf<InternalError>([&] { WriteExr(folder_ / "a.exr", image, kMetadata); });
  };
  EXPECT_THAT(fault_of([](HdrImage& image) { image.at(3, 4)[1] = kNan; }),
              HasSubstr("a.exr is not written: pixel (3, 4) of layer G is nan"));
  EXPECT_THAT(fault_of([](HdrImage& image) { image.at(0, 1)[2] = kInfinite; }),
              HasSubstr("pixel (0, 1) of layer B is inf"));
  EXPECT_THAT(fault_of([](HdrImage& image) { image.layers[0].values[5] = kNan; }),
              HasSubstr("pixel (5, 0) of layer depth.Z is nan"));
  EXPECT_THAT(fault_of([](HdrImage& image) { image.layers[0].name = "normal.Z"; }),
              HasSubstr("of layer normal.Z is inf"))
      << "only distances are infinite where there is nothing";
  EXPECT_THAT(fault_of([](HdrImage& image) { image.layers[0].name = "clouds.T"; }),
              HasSubstr("of layer clouds.T is inf"));
  EXPECT_EQ(FileCount(), 0U) << "nothing is left, under no name";
  EXPECT_EQ(fault_of([](HdrImage& image) { image.layers[0].name = "clouds.Z"; }), "no fault")
      << "rays past all clouds";
  const std::string of_ceiling = fault_of([](HdrImage& image) {
    image.layers[0].name = "normal.Z";
    for (float& value : image.layers[0].values) value = -0.5F;
  });
  EXPECT_EQ(of_ceiling, "no fault") << "a ceiling looks down";
}

// Hard case 44.
TEST_F(ExrFile, OnePixelAndOneColumnAreImages) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 500}, std::pair{16384, 1}}) {
    HdrImage image(width, height);
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
    EXPECT_THAT(tests::FaultOf([&] { return ReadExr(folder_ / "cut.exr"); }), HasSubstr("cut.exr"))
        << size << " of " << whole.size() << " bytes";
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
  EXPECT_THAT(tests::FaultOf([&] { return ReadExr(folder_ / "red.exr"); }),
              HasSubstr("channel G is missing"));
}

TEST_F(ExrFile, AMissingFolderIsAnOutputError) {
  const fs::path file = folder_ / "none" / "a.exr";
  EXPECT_THAT(tests::FaultOf<OutputError>([&] { WriteExr(file, TestImage(), {}); }),
              HasSubstr(file.string()));
}

// Hard case 46.
TEST_F(ExrFile, AFullDiskIsAnOutputError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  fs::create_symlink("/dev/full", folder_ / "a.exr");
  EXPECT_THROW(WriteExr(folder_ / "a.exr", TestImage(), {}), OutputError);
}

TEST(HdrImage, SizesOutOfRangeAreRefused) {
  EXPECT_THROW(HdrImage(0, 5), InputError);
  EXPECT_THROW(HdrImage(5, -1), InputError);
  EXPECT_THROW(HdrImage(40000, 1), InputError);
}

TEST_F(PngFile, KeepsEveryByteAndTheMetadata) {
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

TEST(Develop, LinearCurveReproducesTheSrgbCodeOnAverage) {
  // Light 0.2140 is code 127.5: half of the pixels 127, half 128, plus dither of one code.
  const DisplayImage display =
      Develop(tests::FlatPicture(64, 64, 0.21404F), -std::log2(1.2), {.curve = ToneCurve::kLinear});
  double sum = 0.0;
  for (const std::uint8_t code : display.rgb) sum += code;
  EXPECT_NEAR(sum / static_cast<double>(display.rgb.size()), 127.5, 0.02)
      << "the tile holds every threshold once, so the mean is kept to rounding of 0.2140";
}

// Hard case 35.
TEST(Develop, SlowGradientsHaveNoBands) {
  // One code over 256 columns: without dither two flat
  // bands, with it every 64-column block differs.
  HdrImage image(256, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 256; ++x) {
      const double code = (100.0 + x / 256.0) / 255.0;
      const auto light = static_cast<float>(std::pow((code + 0.055) / 1.055, 2.4));
      image.at(x, y) = {light, light, light};
    }
  }
  const DisplayImage display = Develop(image, -std::log2(1.2), {.curve = ToneCurve::kLinear});
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

TEST(Develop, KeepsBlackAndRefusesNan) {
  const DisplayImage display =
      Develop(tests::FlatPicture(64, 64, 0.0F), 10.0, {.curve = ToneCurve::kAgx});
  EXPECT_EQ(display.rgb, std::vector<std::uint8_t>(64 * 64 * 3, 0));
  HdrImage image = tests::FlatPicture(4, 4, 1.0F);
  image.at(2, 1)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)Develop(image, 0.0, {.curve = ToneCurve::kAgx}), InternalError);
}

TEST(Dither, TileHoldsEveryRankOnce) {
  std::vector<int> seen(kDitherTileSize * kDitherTileSize, 0);
  for (const std::uint16_t rank : DitherTile()) ++seen.at(rank);
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

TEST(Dither, IsBlueNoise) {
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

// Fixed on 2026-11-21: an even sky had faint vertical stripes, because columns of the one tile
// stood over each other.
// Hard case 35.
TEST(Dither, ColumnsOfAnEvenPictureAreEven) {
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
TEST_F(ExrFile, StoresFloatsThatHoldTheSunsDisk) {
  // 1.6e9 cd/m^2 in the mean, and 65504 is the largest half.
  HdrImage image(3, 1);
  image.at(1, 0) = {1.9e9F, 1.6e9F, 1.4e9F};
  image.layers.push_back({"inscatter.R", {0.0F, 1.6e9F, 1e-30F}});
  WriteExr(folder_ / "sun.exr", image, {});
  const Imf::InputFile file((folder_ / "sun.exr").c_str());
  const Imf::ChannelList& channels = file.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    EXPECT_EQ(channel.channel().type, Imf::FLOAT) << channel.name();
  const HdrImage back = ReadExr(folder_ / "sun.exr");
  EXPECT_EQ(back.rgb, image.rgb);
  EXPECT_EQ(back.layers[0].values, image.layers[0].values);
}

constexpr std::array<float, 3> kSky{3000.0F, 6000.0F, 12000.0F};
constexpr float kDisk = 1e9F, kWhite = 4e4F;

/// Returns the share of a pixel that a disk in the middle of a picture covers, by 32x32 rays.
float CoveredShare(int x, int y, double middle, double radius) {
  const double away = std::hypot(x + 0.5 - middle, y + 0.5 - middle) - radius;
  if (std::abs(away) > 0.75) return away < 0.0 ? 1.0F : 0.0F;  // half a diagonal is 0.71
  constexpr int kRays = 32;
  int covered = 0;
  for (int j = 0; j < kRays; ++j) {
    for (int i = 0; i < kRays; ++i) {
      const double dx = x + (i + 0.5) / kRays - middle, dy = y + (j + 0.5) / kRays - middle;
      if (std::hypot(dx, dy) < radius) ++covered;
    }
  }
  return static_cast<float>(covered) / (kRays * kRays);
}

/// Returns a white disk before a sky. Every pixel is the mean of its light.
HdrImage DiskBeforeSky(int side, double radius) {
  HdrImage image(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const float share = CoveredShare(x, y, 0.5 * side, radius);
      for (std::size_t c = 0; c < 3; ++c)
        image.at(x, y)[c] = share * kDisk + (1.0F - share) * kSky[c];
    }
  }
  return image;
}

TEST(ClippedEdge, PixelsMixDiskAndSkyByCoverage) {
  for (const double radius : {2.5, 5.3, 11.7}) {
    const HdrImage image = DiskBeforeSky(32, radius);
    int edges = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const float share = CoveredShare(x, y, 16.0, radius);
        const auto edge = ClippedEdgeAt(image, x, y, kWhite);
        if (share < 0.01F || share > 0.99F) continue;
        ++edges;
        ASSERT_TRUE(edge.has_value()) << radius << ' ' << x << ' ' << y;
        EXPECT_NEAR(edge->share, share, 1e-3F);
        EXPECT_NEAR(edge->beside[2], kSky[2], 1e-5F * kSky[2]);
      }
    }
    EXPECT_GT(edges, 8) << radius;
  }
}

TEST(ClippedEdge, NeighboursOfADiskAreLandOrSky) {
  constexpr std::array<float, 3> kLand{400.0F, 300.0F, 200.0F};
  constexpr int kRidge = 18;  // land from this row on, which is half in the sky
  HdrImage image = DiskBeforeSky(32, 9.0);
  for (int x = 0; x < 32; ++x) {
    for (std::size_t c = 0; c < 3; ++c)
      image.at(x, kRidge)[c] = 0.5F * (image.at(x, kRidge)[c] + kLand[c]);
    for (int y = kRidge + 1; y < 32; ++y) image.at(x, y) = kLand;
  }
  for (const int x : {13, 15, 16, 18}) {
    const auto on_ridge = ClippedEdgeAt(image, x, kRidge, kWhite);
    ASSERT_TRUE(on_ridge.has_value());
    EXPECT_NEAR(on_ridge->beside[2], kLand[2], 0.01F * kLand[2]) << x;
    EXPECT_NEAR(on_ridge->share, 0.5F, 1e-3F) << x;
  }
  const auto on_top = ClippedEdgeAt(image, 15, 7, kWhite);
  ASSERT_TRUE(on_top.has_value());
  EXPECT_NEAR(on_top->beside[2], kSky[2], 1e-5F * kSky[2]);
}

TEST(ClippedEdge, LimbDarkeningIsNotTakenForPartialCoverage) {
  // 0.3 + 0.93 mu - 0.23 mu^2, the sun in green light (Allen 1973), at the middle of each pixel.
  for (const double radius : {8.3, 11.7, 15.2}) {
    HdrImage image = DiskBeforeSky(36, radius);
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 36; ++x) {
        const double rho = std::min(std::hypot(x - 17.5, y - 17.5) / radius, 0.99);
        const double mu = std::sqrt(1.0 - rho * rho);
        for (float& channel : image.at(x, y)) {
          if (channel > kWhite) channel *= static_cast<float>(0.3 + 0.93 * mu - 0.23 * mu * mu);
        }
      }
    }
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 36; ++x) {
        const auto edge = ClippedEdgeAt(image, x, y, kWhite);
        if (!edge) continue;
        EXPECT_NEAR(edge->share, CoveredShare(x, y, 18.0, radius), 0.16F)
            << "a limb that is not followed is off by 0.35: " << radius << ' ' << x << ' ' << y;
      }
    }
  }
}

TEST(ClippedEdge, EdgeOfADiskIsSmoothOnTheDisplay) {
  const HdrImage image = DiskBeforeSky(32, 7.5);
  const DisplayImage shown = Develop(image, 15.0, {.curve = ToneCurve::kAgx});
  const auto blue_less_red = [&](int x, int y) {
    const std::size_t at = 3 * static_cast<std::size_t>(y * 32 + x);
    return static_cast<int>(shown.rgb[at + 2]) - static_cast<int>(shown.rgb[at]);
  };
  const int sky = blue_less_red(0, 0), disk = blue_less_red(16, 16);
  int between = 0, partly = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const float share = CoveredShare(x, y, 16.0, 7.5);
      if (share < 0.2F || share > 0.8F) continue;
      ++partly;
      const int here = blue_less_red(x, y);
      if (here > disk + (sky - disk) / 8 && here < sky - (sky - disk) / 8) ++between;
    }
  }
  EXPECT_GT(partly, 10);
  EXPECT_EQ(between, partly) << "none of them is as white as the disk, none as blue as the sky";
}

// The aureole is as bright at the disk as a share of white, and a third of that `fades_in` pixels
// farther out.
HdrImage DiskInAnAureole(double radius, float of_white, double fades_in) {
  HdrImage image = DiskBeforeSky(32, radius);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const double out = std::hypot(x - 15.5, y - 15.5) - radius;
      const float glow =
          of_white * kWhite * static_cast<float>(std::exp(-std::max(out, 0.0) / fades_in));
      for (float& channel : image.at(x, y)) channel += glow;
    }
  }
  return image;
}

// Clipping stands for the curve. A ring would be a third darker, like what lies three pixels
// behind. The sky under a sun that sets fades in four pixels of a wide picture.
TEST(ClippedEdge, SteepAureolesHaveNoDarkRingAtTheDisk) {
  constexpr double kRadius = 2.5;
  for (const double fades_in : {6.0, 4.0}) {
    for (const float of_white : {0.2F, 0.6F, 1.0F, 1.5F}) {
      const HdrImage image = DiskInAnAureole(kRadius, of_white, fades_in);
      for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
          if (CoveredShare(x, y, 16.0, kRadius) > 0.0F) continue;
          const auto edge = ClippedEdgeAt(image, x, y, kWhite);
          if (!edge) continue;
          const float pixel = std::min(image.at(x, y)[1], kWhite);
          const float mixed = std::min(edge->share * std::min(edge->light[1], kWhite) +
                                           (1.0F - edge->share) * edge->beside[1],
                                       kWhite);
          EXPECT_GT(edge->weight * mixed + (1.0F - edge->weight) * pixel, 0.88F * pixel)
              << of_white << ' ' << fades_in << ' ' << x << ' ' << y;
        }
      }
    }
  }
}

TEST(ClippedEdge, SparklesPlainSkyAndUnclippedLightAreKept) {
  HdrImage image = DiskBeforeSky(32, 0.0);
  image.at(10, 10) = {kDisk, kDisk, kDisk};
  image.at(20, 21) = {kDisk, kDisk, kDisk};
  image.at(21, 20) = {kDisk, kDisk, kDisk};
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_FALSE(ClippedEdgeAt(image, x, y, kWhite)) << x << ' ' << y;
  }
  image = DiskBeforeSky(32, 8.0);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_FALSE(ClippedEdgeAt(image, x, y, kDisk)) << x << ' ' << y;
  }
}

TEST(ClippedEdge, IsContinuousWhileADiskDims) {
  const HdrImage image = DiskBeforeSky(32, 7.5);
  int last = -1;
  for (double ev100 = 30.0; ev100 > 10.0; ev100 -= 0.125) {
    const DisplayImage shown = Develop(image, ev100, {.curve = ToneCurve::kAgx});
    const int here = shown.rgb[3 * (16 * 32 + 23) + 1];  // half of it covered
    if (last >= 0) {
      EXPECT_NEAR(here, last, 14) << ev100 << ": an eighth of a stop is 10 codes";
    }
    last = here;
  }
}

}  // namespace
}  // namespace alpenglow::lut
