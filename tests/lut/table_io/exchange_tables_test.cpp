// SPDX-License-Identifier: MIT
// Tables for other programs are read by code of this file alone. It was written from the
// description of those programs' formats: which texel is where, and what it must hold.
#include "lut/table_io/exchange_tables.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <span>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/reference/path_tracer.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"
#include "lut/table_io/exchange_check.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/quantile.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using Rgba = std::array<double, 4>;

constexpr double kPlanet_km = 6360.0, kTop_km = 6420.0;
const double kHorizon_km = std::sqrt(kTop_km * kTop_km - kPlanet_km * kPlanet_km);
constexpr std::array<double, 3> kSun{1.474, 1.8504, 1.91198};  // red, green, blue

/// The place of a texel of a scattering texture.
struct TexelPosition {
  double altitude_m, mu, mu_s, nu;
};

double CosineOfDistance(double distance, double from_squared, double to_squared, double r) {
  return distance == 0.0 ? 1.0
                         : (to_squared - from_squared - distance * distance) / (2.0 * r * distance);
}

/// Returns the place of a texel, where x = nu * 32 + mu_s; y < 64 hits the ground.
TexelPosition PlaceOf(int x, int y, int z, double mu_s_min) {
  const double H = kHorizon_km, rb = kPlanet_km, rt = kTop_km;
  const double rho = H * z / 31.0;
  const double r = std::sqrt(rho * rho + rb * rb);
  TexelPosition place{};
  place.altitude_m = (r - rb) * 1000.0;
  if (y < 64) {
    const double d = (r - rb) + (63 - y) / 63.0 * (rho - (r - rb));
    place.mu = d == 0.0 ? -1.0 : -(rho * rho + d * d) / (2.0 * r * d);
  } else {
    const double d = (rt - r) + (y - 64) / 63.0 * (rho + H - (rt - r));
    place.mu = CosineOfDistance(d, rho * rho, H * H, r);
  }
  const auto excess = [&](double d) { return (d - (rt - rb)) / (H - (rt - rb)); };
  const double A =
      excess(-rb * mu_s_min + std::sqrt(rb * rb * (mu_s_min * mu_s_min - 1.0) + rt * rt));
  const double u = (x % 32) / 31.0;
  const double a = (1.0 - u) * A / (1.0 + u * A);
  place.mu_s = CosineOfDistance((rt - rb) + a * (H - (rt - rb)), 0.0, H * H, rb);
  place.mu = std::clamp(place.mu, -1.0, 1.0);
  place.mu_s = std::clamp(place.mu_s, -1.0, 1.0);
  const double sines = std::sqrt((1.0 - place.mu * place.mu) * (1.0 - place.mu_s * place.mu_s));
  place.nu = std::clamp(2.0 * (x / 32) / 7.0 - 1.0, place.mu * place.mu_s - sines,
                        place.mu * place.mu_s + sines);
  return place;
}

double HalfFromBits(unsigned bits) {
  const int exponent = static_cast<int>(bits >> 10U & 31U);
  const double mantissa = bits & 1023U;
  const double magnitude =
      exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0 + mantissa, exponent - 25);
  return (bits >> 15U) != 0 ? -magnitude : magnitude;
}

/// Reads a raw file of RGBA: x fastest, then y, then z, little-endian.
class Raw {
 public:
  Raw(const fs::path& file, std::size_t width, std::size_t height, std::size_t bytes_a_value)
      : text_(ContentOf(file)), width_(width), height_(height), size_(bytes_a_value) {}

  [[nodiscard]] std::size_t bytes() const { return text_.size(); }
  [[nodiscard]] Rgba At(std::size_t x, std::size_t y, std::size_t z) const {
    Rgba rgba{};
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t at = (4 * ((z * height_ + y) * width_ + x) + c) * size_;
      std::uint32_t bits = 0;
      for (std::size_t i = 0; i < size_; ++i) {
        bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(text_.at(at + i)))
                << (8U * i);
      }
      float wide = 0.0F;
      std::memcpy(&wide, &bits, sizeof wide);
      rgba[c] = size_ == 2 ? HalfFromBits(bits) : static_cast<double>(wide);
    }
    return rgba;
  }

 private:
  std::string text_;
  std::size_t width_, height_, size_;
};

/// Reads an EXR of half RGBA whose last scan line is row 0.
class ReversedExr {
 public:
  explicit ReversedExr(const fs::path& file, std::size_t height_of_layer)
      : height_(height_of_layer) {
    Imf::InputFile input(file.c_str());
    const Imath::Box2i window = input.header().dataWindow();
    width_ = static_cast<std::size_t>(window.max.x) + 1;
    rows_ = static_cast<std::size_t>(window.max.y) + 1;
    increasing_ = input.header().lineOrder() == Imf::INCREASING_Y;
    for (auto c = input.header().channels().begin(); c != input.header().channels().end(); ++c) {
      channels_ += c.name();
      all_half_ = all_half_ && c.channel().type == Imf::HALF;
    }
    texels_.resize(4 * width_ * rows_);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < 4; ++c) {
      buffer.insert(std::string(1, "RGBA"[c]),
                    Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&texels_[c]), 4 * sizeof(half),
                               4 * sizeof(half) * width_));
    }
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
  }

  [[nodiscard]] Rgba At(std::size_t x, std::size_t y, std::size_t z) const {
    const std::size_t line = rows_ - 1 - (z * height_ + y);
    Rgba rgba{};
    for (std::size_t c = 0; c < 4; ++c) {
      rgba[c] = static_cast<double>(static_cast<float>(texels_[4 * (line * width_ + x) + c]));
    }
    return rgba;
  }

  std::size_t width_ = 0, rows_ = 0, height_;
  std::string channels_;
  bool all_half_ = true, increasing_ = false;

 private:
  std::vector<half> texels_;
};

/// Returns a texture in which every texel has its coordinates as values.
ExchangeTexture Numbered(const char* name, std::size_t width, std::size_t height,
                         std::size_t depth) {
  ExchangeTexture texture{name, width, height, depth, {}};
  for (std::size_t i = 0; i < width * height * depth; ++i) {
    for (const std::size_t value : {i % width, i / width % height, i / width / height})
      texture.rgba.push_back(static_cast<float>(value));
    texture.rgba.push_back(0.5F);
  }
  return texture;
}

class ExchangeFiles : public TemporaryFolder {};

TEST_F(ExchangeFiles, TakramExrIsHalfRgbaWithItsLastLineFirst) {
  const Medium air = MediumPreset("bruneton2017");
  WriteExchangeTables({Numbered("scattering", 256, 128, 32), Numbered("irradiance", 64, 16, 1)},
                      air, {}, folder_);
  const ReversedExr scattering(folder_ / "scattering.exr", 128);
  EXPECT_EQ(scattering.width_, 256U);
  EXPECT_EQ(scattering.rows_, 4096U);
  EXPECT_EQ(scattering.channels_, "ABGR") << "OpenEXR sorts by name";
  EXPECT_TRUE(scattering.all_half_);
  EXPECT_TRUE(scattering.increasing_);
  EXPECT_EQ(scattering.At(3, 5, 7), (Rgba{3.0, 5.0, 7.0, 0.5}));
  EXPECT_EQ(scattering.At(255, 0, 31), (Rgba{255.0, 0.0, 31.0, 0.5}));
  const ReversedExr irradiance(folder_ / "irradiance.exr", 16);
  EXPECT_EQ(irradiance.At(63, 2, 0), (Rgba{63.0, 2.0, 0.0, 0.5}));
  EXPECT_EQ(MediumHash(ReadMedium(folder_ / "atmosphere.toml")), MediumHash(air));
}

TEST_F(ExchangeFiles, RawFilesAreLittleEndianFromTheFirstRow) {
  const Medium air = MediumPreset("bruneton2017");
  const std::vector<ExchangeTexture> textures{Numbered("scattering", 256, 128, 32),
                                              Numbered("transmittance", 256, 64, 1)};
  WriteExchangeTables(textures, air, {.type = {}, .format = TexelFormat::kBin}, folder_);
  WriteExchangeTables(textures, air, {.user = TableUser::kBrunetonDemo, .type = {}, .format = {}},
                      folder_);
  const Raw bin(folder_ / "scattering.bin", 256, 128, 2);
  EXPECT_EQ(bin.bytes(), 8388608U);
  EXPECT_EQ(bin.At(200, 100, 30), (Rgba{200.0, 100.0, 30.0, 0.5}));
  EXPECT_EQ(fs::file_size(folder_ / "transmittance.bin"), 131072U);
  const Raw dat(folder_ / "scattering.dat", 256, 128, 4);
  EXPECT_EQ(dat.bytes(), 16777216U);
  EXPECT_EQ(dat.At(200, 100, 30), (Rgba{200.0, 100.0, 30.0, 0.5}));
  EXPECT_EQ(fs::file_size(folder_ / "transmittance.dat"), 262144U);
}

TEST_F(ExchangeFiles, ImagesThatNoProgramLoadsAreRefused) {
  const auto refused = [](TableUser user, std::optional<TexelType> type,
                          std::optional<TexelFormat> format) {
    return FaultOf({.user = user, .type = type, .format = format}).has_value();
  };
  EXPECT_TRUE(refused(TableUser::kThreeAtmosphere, {}, TexelFormat::kDat));
  EXPECT_TRUE(refused(TableUser::kThreeAtmosphere, TexelType::kFloat, TexelFormat::kBin));
  EXPECT_TRUE(refused(TableUser::kBrunetonDemo, {}, TexelFormat::kBin));
  EXPECT_TRUE(refused(TableUser::kBrunetonDemo, TexelType::kHalf, {}));
  EXPECT_FALSE(refused(TableUser::kThreeAtmosphere, TexelType::kFloat, TexelFormat::kExr));
  EXPECT_FALSE(refused(TableUser::kBrunetonDemo, TexelType::kHalf, TexelFormat::kExr));
  EXPECT_THROW(WriteExchangeTables({}, MediumPreset("bruneton2017"),
                                   {.type = {}, .format = TexelFormat::kDat}, folder_),
               InputError);
  EXPECT_THROW(static_cast<void>(TexelTypeFromName("double")), InputError);
  EXPECT_THROW(static_cast<void>(TexelFormatFromName("png")), InputError);
  EXPECT_THROW(static_cast<void>(MakeExchangeTextures(MediumPreset("earth"), {})), InputError)
      << "four bands";
  EXPECT_FALSE(IsTheMediumThatLoadersAssume(MediumPreset("earth")));
}

// The constant of the demo is that of its half precision, though its files are float.
TEST(LowestSun, IsThatOfTheProgramUnlessGiven) {
  const double demo = std::cos(102.0 / 180.0 * std::acos(-1.0));
  const ExportOptions bruneton{.user = TableUser::kBrunetonDemo};
  EXPECT_DOUBLE_EQ(LowestSunOf(bruneton), demo);
  EXPECT_DOUBLE_EQ(LowestSunOf({.user = TableUser::kBrunetonDemo, .type = TexelType::kHalf}), demo);
  EXPECT_EQ(LowestSunOf({.user = TableUser::kBrunetonDemo, .lowest_sun_deg = 120.0}), -0.5);
  EXPECT_EQ(LowestSunOf({}), -0.5) << "takram";
  EXPECT_FALSE(FaultOf({.lowest_sun_deg = 120.0}).has_value());
  EXPECT_TRUE(FaultOf({.lowest_sun_deg = 102.0}).has_value()) << "takram loads no such files";
  EXPECT_TRUE(FaultOf({.user = TableUser::kBrunetonDemo, .lowest_sun_deg = 110.0}).has_value());
}

/// Returns air whose molecules depolarise like those of the earth. Loaders multiply by the phase
/// function of molecules that do not: textures must contain the difference.
Medium DepolarisingAir() {
  Medium air = MediumPreset("bruneton2017");
  air.rayleigh_depolarisation = {0.0279};
  return air;
}

/// Returns the whole set of takram, which is made once.
const std::vector<ExchangeTexture>& TakramTextures() {
  static const auto textures = MakeExchangeTextures(DepolarisingAir(), {});
  return textures;
}

/// The whole set of takram in .bin files. Every test has its own, and may damage them.
class TakramSet : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    static std::map<std::string, std::string> files;  // by name; written once
    if (files.empty()) {
      WriteExchangeTables(TakramTextures(), air_, {.type = {}, .format = TexelFormat::kBin},
                          folder_);
      for (const auto& file : fs::directory_iterator(folder_))
        files[file.path().filename().string()] = ContentOf(file.path());
    }
    for (const auto& [name, content] : files) WriteText(folder_ / name, content);
  }
  [[nodiscard]] Raw Bin(const std::string& name, std::size_t width, std::size_t height) const {
    return {folder_ / (name + ".bin"), width, height, 2};
  }

  const Medium air_ = DepolarisingAir();
};

/// Returns air of six bands: those of the given air, then the same with aerosol that takes light,
/// but scatters none.
Medium WithAndWithoutHazeLight(const Medium& air) {
  Medium both = air;
  for (auto member :
       {&Medium::wavelengths_nm, &Medium::solar_irradiance, &Medium::rayleigh_scattering_per_m,
        &Medium::mie_scattering_per_m, &Medium::mie_extinction_per_m,
        &Medium::ozone_absorption_per_m, &Medium::ground_albedo}) {
    const std::vector<double>& once = air.*member;
    (both.*member).insert((both.*member).end(), once.begin(), once.end());
  }
  std::fill(both.mie_scattering_per_m.begin() + 3, both.mie_scattering_per_m.end(), 0.0);
  return both;
}

/// Light scattered once [per unit irradiance, red first], by molecules and by aerosol, without
/// phase functions, from the reference solution.
struct Once {
  Rgba molecules, aerosol;
};
Once ReferenceOnce(const Medium& both, const TexelPosition& place) {
  const ViewRay ray{place.altitude_m, place.mu, place.mu_s, place.nu};
  const std::vector<double> light = reference::SingleScatteringAlong(both, ray).inscatter;
  const double nu = place.nu, g = 0.8;
  const double pi = std::acos(-1.0);
  const double rayleigh = 3.0 / (16.0 * pi) * (1.0 + nu * nu);
  const double mie = 3.0 / (8.0 * pi) * (1.0 - g * g) / (2.0 + g * g) * (1.0 + nu * nu) /
                     std::pow(1.0 + g * g - 2.0 * g * nu, 1.5);
  Once once{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double all = light[2 - c], molecules = light[5 - c];
    once.molecules[c] = kSun[c] * molecules / rayleigh;
    once.aerosol[c] = kSun[c] * (all - molecules) / mie;
  }
  return once;
}

struct Errors {
  std::vector<double> relative;
  void Add(double value, double truth) { relative.push_back(std::abs(value / truth - 1.0)); }
  [[nodiscard]] double Quantile(double share) {
    std::sort(relative.begin(), relative.end());
    return tests::Quantile(relative, share);
  }
};

TEST_F(TakramSet, SingleScatteringEqualsTheReference) {
  const Raw scattering = Bin("scattering", 256, 128);
  const Raw higher = Bin("higher_order_scattering", 256, 128);
  const Raw mie = Bin("single_mie_scattering", 256, 128);
  const Medium both = WithAndWithoutHazeLight(air_);
  std::mt19937 random(1);
  Errors molecules, aerosol;
  for (int i = 0; i < tests::ScaledDown(100, 30); ++i) {
    const auto x = static_cast<int>(random() % 256), y = static_cast<int>(random() % 128);
    const auto z = static_cast<int>(random() % 32);
    const TexelPosition place = PlaceOf(x, y, z, -0.5);
    const auto at = [&](const Raw& file) {
      return file.At(static_cast<std::size_t>(x), static_cast<std::size_t>(y),
                     static_cast<std::size_t>(z));
    };
    const Rgba all = at(scattering), more = at(higher), haze = at(mie);
    EXPECT_EQ(all[3], haze[0]) << "A is the red of the aerosol";
    EXPECT_EQ(more[3], 0.0);
    EXPECT_EQ(haze[3], 1.0);
    const Once truth = ReferenceOnce(both, place);
    for (std::size_t c = 0; c < 3; ++c) {
      // A half keeps 11 bits down to 6e-5, and steps of 6e-8 below.
      const double step = 6e-8 + all[c] / 2048.0 + more[c] / 2048.0;
      EXPECT_NEAR(all[c] - more[c], truth.molecules[c], step + 2e-3 * truth.molecules[c])
          << x << " " << y << " " << z << " channel " << c;
      EXPECT_NEAR(haze[c], truth.aerosol[c], 6e-8 + 2.5e-3 * truth.aerosol[c])
          << x << " " << y << " " << z << " channel " << c;
      if (truth.molecules[c] > 1e-3) molecules.Add(all[c] - more[c], truth.molecules[c]);
      if (truth.aerosol[c] > 1e-3) aerosol.Add(haze[c], truth.aerosol[c]);
    }
  }
  ASSERT_GT(aerosol.relative.size(), tests::ScaledDown(50U, 15U));
  // Rounding to half alone is 0.012 % in the median, twice that for the difference of two textures.
  EXPECT_LT(molecules.Quantile(0.5), 5e-4);
  EXPECT_LT(molecules.Quantile(0.9), 2e-3);
  EXPECT_LT(aerosol.Quantile(0.5), 2e-4);
  EXPECT_LT(aerosol.Quantile(0.9), 5e-4);
}

TEST_F(TakramSet, HigherOrdersEqualPathsOfFourEvents) {
  const Raw higher = Bin("higher_order_scattering", 256, 128);
  const double pi = std::acos(-1.0);
  constexpr double kError = tests::ScaledDown(2e-3, 1e-2);
  for (const auto& [x, y, z] : {std::array{5 * 32 + 26, 80, 2}, {6 * 32 + 29, 115, 0}}) {
    const TexelPosition place = PlaceOf(x, y, z, -0.5);
    const ViewRay ray{place.altitude_m, place.mu, place.mu_s, place.nu};
    const auto paths =
        reference::TraceRadiance(air_, ray, {.relative_error = kError, .max_order = 4});
    const auto once = reference::SingleScatteringAlong(air_, ray);
    const Rgba texel = higher.At(static_cast<std::size_t>(x), static_cast<std::size_t>(y),
                                 static_cast<std::size_t>(z));
    const double phase = 3.0 / (16.0 * pi) * (1.0 + place.nu * place.nu);
    for (std::size_t c = 0; c < 3; ++c) {
      const double truth = kSun[c] * (paths.total[2 - c] - once.inscatter[2 - c]);
      const double sigma = kSun[c] * paths.standard_error[2 - c];
      EXPECT_NEAR(texel[c] * phase, truth, 4.0 * sigma + 0.01 * truth)
          << x << " " << y << " " << z << " channel " << c
          << ": four standard errors, 1 % of the moments";
    }
  }
}

// The irradiances, from above at 60 km * y / 15 with mu_s = 2 x / 63 - 1, are those of
// reference::TraceIrradiance with max_order 3 of bruneton2017, to 0.2 %; blue first. Depolarisation
// changes the phase function by up to 1.4 %, and not in the mean.
TEST_F(TakramSet, IrradianceHasThreeOrdersOfScattering) {
  struct Traced {
    std::size_t x, y;
    std::array<double, 3> value;
  };
  const Raw irradiance = Bin("irradiance", 64, 16);
  for (const auto& [x, y, value] : {Traced{40, 0, {0.0810139, 0.0429804, 0.0240537}},
                                    {33, 3, {0.0193116, 0.00750021, 0.00432893}},
                                    {60, 8, {0.0030131, 0.00112556, 0.000475284}}}) {
    const Rgba texel = irradiance.At(x, y, 0);
    EXPECT_EQ(texel[3], 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(texel[c] / (kSun[c] * value[2 - c]), 1.0, 0.018)
          << x << " " << y << " channel " << c << ": four standard errors, 1 % of the moments";
    }
  }
}

TEST_F(TakramSet, TransmittanceEqualsTheReferenceToHalfFloats) {
  const Raw transmittance = Bin("transmittance", 256, 64);
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<int>(random() % 256), y = static_cast<int>(random() % 64);
    const double rho = kHorizon_km * y / 63.0;
    const double r = std::sqrt(rho * rho + kPlanet_km * kPlanet_km);
    const double d = (kTop_km - r) + x / 255.0 * (rho + kHorizon_km - (kTop_km - r));
    // The ray is one rounding above the horizon, which the last column touches.
    const double mu = std::clamp(
        CosineOfDistance(d, rho * rho, kHorizon_km * kHorizon_km, r) + (x == 255 ? 1e-12 : 0.0),
        -1.0, 1.0);
    const auto tau = reference::OpticalDepthAlong(air_, {(r - kPlanet_km) * 1000.0, mu, 1.0, mu});
    const Rgba texel =
        transmittance.At(static_cast<std::size_t>(x), static_cast<std::size_t>(y), 0);
    EXPECT_EQ(texel[3], 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const double truth = std::exp(-tau.tau[2 - c]);
      EXPECT_NEAR(texel[c], truth, 6e-8 + truth / 2000.0) << x << " " << y << ": half a step";
    }
  }
}

void ExpectRefused(const fs::path& folder, const std::string& reason) {
  tests::ExpectNames(tests::FaultOf([&] { return DescribeExchangeTables(folder); }), folder,
                     reason);
}

TEST_F(TakramSet, IsDescribedAndComparedWithOurTexels) {
  constexpr std::array kFormats{TexelFormat::kBin, TexelFormat::kExr};
  for (const TexelFormat format : std::span(kFormats).first(tests::ScaledDown<std::size_t>(2, 1))) {
    const fs::path folder = folder_ / SuffixOf(format).substr(1);
    WriteExchangeTables(TakramTextures(), air_, {.format = format}, folder);
    EXPECT_EQ(ExchangeFolderOf(folder), folder);
    EXPECT_EQ(ExchangeFolderOf(folder / ("irradiance" + SuffixOf(format))), folder);
    const ExchangeDescription description = DescribeExchangeTables(folder);
    EXPECT_EQ(description.options.user, TableUser::kThreeAtmosphere);
    EXPECT_EQ(description.options.lowest_sun_deg, 120.0);
    EXPECT_EQ(MediumHash(description.medium), MediumHash(air_));
    EXPECT_FALSE(description.medium_is_assumed);
    ASSERT_EQ(description.textures.size(), 5U);
    for (const ExchangeDescription::Texture& texture : description.textures) {
      // Half a step of a half is 2^-12 to 2^-11 of the value: 0.012 to 0.05 %, 0.017 % in the mean.
      EXPECT_GT(texture.errors.count(), 400U) << texture.file;
      EXPECT_LT(texture.errors.Quantile(0.5), 4e-4) << texture.file;
      EXPECT_LT(texture.errors.Quantile(0.9), 6e-4) << texture.file;
    }
    const std::string text = DescriptionText(folder, description);
    const std::string hash = fmt::format("hash {:016x}", MediumHash(air_));
    for (const char* fact : {"takram", "half", "lowest sun  120", hash.c_str(),
                             "single_mie_scattering", "256 x 128 x 32"}) {
      EXPECT_THAT(text, testing::HasSubstr(fact));
    }
  }
  EXPECT_FALSE(ExchangeFolderOf(folder_ / "none").has_value());
  EXPECT_FALSE(ExchangeFolderOf(folder_ / "bin" / "atmosphere.toml").has_value());
}

TEST_F(TakramSet, OfAnotherAtmosphereIsRefused) {
  Medium hazy = air_;
  for (double& k : hazy.mie_scattering_per_m) k *= 1.5;
  for (double& k : hazy.mie_extinction_per_m) k *= 1.5;
  WriteText(folder_ / kMediumFileName, TomlFromMedium(hazy));
  ExpectRefused(folder_, "differ from those of this program by");
}

// The loader may have combinedScattering and higherOrderScattering: false, and it assumes an
// atmosphere.
TEST_F(TakramSet, OptionalFilesMayBeAbsent) {
  for (const char* name :
       {"single_mie_scattering.bin", "higher_order_scattering.bin", kMediumFileName})
    fs::remove(folder_ / name);
  const ExchangeDescription description = DescribeExchangeTables(folder_);
  EXPECT_TRUE(description.medium_is_assumed);
  EXPECT_TRUE(IsTheMediumThatLoadersAssume(description.medium));
  EXPECT_EQ(description.textures.size(), 3U);
  EXPECT_EQ(description.absent.size(), 2U);
  EXPECT_THAT(DescriptionText(folder_, description),
              testing::HasSubstr("absent      single_mie_scattering.bin"));
}

TEST_F(TakramSet, ImagesWithoutAlphaAreReadAsByTheirLoader) {
  WriteExchangeTables(TakramTextures(), air_, {}, folder_);
  for (const char* name : {"scattering.bin", "irradiance.exr"}) fs::remove(folder_ / name);
  const ExchangeTexture& irradiance = TakramTextures()[1];
  std::vector<float> rgb;  // last row first
  for (std::size_t y = irradiance.height; y-- > 0;) {
    for (std::size_t x = 0; x < irradiance.width; ++x) {
      const float* texel = &irradiance.rgba[4 * (y * irradiance.width + x)];
      rgb.insert(rgb.end(), texel, texel + 3);
    }
  }
  WriteTableImage(
      folder_ / "irradiance.exr",
      {irradiance.width, irradiance.height, {"R", "G", "B"}, rgb, {}, TexelType::kHalf});
  const ExchangeDescription description = DescribeExchangeTables(folder_);
  EXPECT_EQ(description.textures[1].rgba[3].lowest, 1.0F);
  EXPECT_LT(description.textures[1].errors.Quantile(0.5), 4e-4) << "half a step of a half";
}

TEST_F(TakramSet, DamagedTexturesAreRefusedByName) {
  const fs::path file = folder_ / "higher_order_scattering.bin";
  const std::string whole = ContentOf(file);
  const std::string irradiance = ContentOf(folder_ / "irradiance.bin");
  fs::remove(folder_ / "irradiance.bin");
  ExpectRefused(folder_, "irradiance.bin: is missing");
  WriteText(folder_ / "irradiance.bin", irradiance);
  WriteText(file, whole.substr(0, whole.size() - 8));
  ExpectRefused(folder_,
                "higher_order_scattering.bin: has 8388600 bytes; such a table has 8388608");
  constexpr std::array kOutOfRange{"\x00\x7e", "\x00\x7c", "\x00\xbc",
                                   "\x00\x78"};  // nan, inf, -1, 32768
  for (const char* bits : std::span(kOutOfRange).first(tests::ScaledDown<std::size_t>(4, 1))) {
    std::string bad = whole;
    bad.replace(8 * 1000 + 2, 2, bits, 2);
    WriteText(file, bad);
    ExpectRefused(folder_, "channel G of texel 1000 is");
  }
  // Rows go from the first to the last, as three-atmosphere does not read them.
  std::string turned;
  for (std::size_t row = 4096; row-- > 0;) turned += whole.substr(row * 2048, 2048);
  WriteText(file, turned);
  ExpectRefused(folder_, "higher_order_scattering.bin: is not of the atmosphere");
}

}  // namespace
}  // namespace alpenglow::lut
