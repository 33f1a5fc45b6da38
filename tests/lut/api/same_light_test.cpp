// SPDX-License-Identifier: MIT
// Whoever asks for the light of the sky gets the same: by the library, in panoramas, from tables in
// files, by `skylut eval`, and from the tables of `skyview`. No program is started, which would
// solve every air again: `skylut sky` calls RenderPanorama of the library, and `skyseries` asks for
// radiances as the library does.
#include <alpenglow/panorama.h>
#include <alpenglow/sky.h>
#include <alpenglow/tables.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/medium/aerosol_mixture.h"
#include "atmosphere/medium/medium_presets.h"
#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/evaluate/eval.h"
#include "lut/evaluate/integral_evaluator.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/lut/camera_tables/air_reading.h"

namespace alpenglow::lut {
namespace {

constexpr int kWidth = 72, kHeight = 36;  // of panoramas; pixels of 5 degrees

/// A place, a sun, and the pixels of the sky that are compared.
struct Setting {
  double eye_m, sun_elevation_deg;

  [[nodiscard]] LocalPoint eye() const { return {.up_m = eye_m}; }
  [[nodiscard]] SunInSky sun() const {
    SunInSky sun;
    sun.elevation_deg = sun_elevation_deg;
    sun.azimuth_deg = 180.0;
    return sun;
  }
};

/// A pixel of a panorama that is centred on north, above the horizontal.
struct SkyPixel {
  int x, y;

  [[nodiscard]] double elevation_deg() const { return 90.0 - 180.0 * (y + 0.5) / kHeight; }
  [[nodiscard]] double azimuth_deg() const { return 360.0 * (x + 0.5) / kWidth - 180.0; }
  [[nodiscard]] Direction direction() const {
    return DirectionFromAngles(elevation_deg(), azimuth_deg());
  }
};

// Returns pixels all over the sky, of which those in column 0 are within 3 degrees of the azimuth
// of the sun.
std::vector<SkyPixel> SkyPixels() {
  std::vector<SkyPixel> pixels;
  for (const int x : {0, 2, 8, 20, 35}) {
    for (int y = x % 3; y < kHeight / 2; y += 3) pixels.push_back({x, y});
  }
  for (const int y : {10, 11, 12, 17}) pixels.push_back({0, y});
  return pixels;
}

/// Luminance [cd/m^2] of the pixels.
using Luminances = std::vector<double>;

// Returns the root mean square of differences relative to the light, or to a thousandth of the
// mean light where that is more.
double Difference(const Luminances& light, const Luminances& expected) {
  double mean = 0.0, squares = 0.0;
  for (const double value : expected) mean += value / static_cast<double>(expected.size());
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double error = (light[i] - expected[i]) / std::max(expected[i], 1e-3 * mean);
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(light.size()));
}

Luminances Over(const std::function<double(const SkyPixel&)>& light) {
  Luminances luminances;
  for (const SkyPixel& pixel : SkyPixels()) luminances.push_back(light(pixel));
  return luminances;
}

Luminances RadianceOf(const Sky& sky, const Setting& at) {
  return Over([&](const SkyPixel& pixel) {
    return Luminance(sky.atmosphere().ColourOf(
        sky.Radiance(at.eye(), pixel.direction(), at.sun().ToSunForAir())));
  });
}

SolvedAir SolvedOf(const Sky& sky) {
  const TableLookup& lookup = SkyParts::LookupOf(sky);
  return {lookup.single_scattering(), RefractedBeam(lookup.medium()), lookup.multiple_scattering()};
}

/// All ways to the light of one atmosphere. Each returns the light of the pixels.
class Ways {
 public:
  Ways(const Atmosphere& atmosphere, const std::filesystem::path& folder)
      : atmosphere_(atmosphere),
        sky_(atmosphere),
        air_(SolvedOf(sky_)),
        viewer_(MakeMediumTables(air_)),
        evaluator_(MakeIntegralEvaluator(atmosphere.medium())) {
    BakeTables(atmosphere, folder, BakeQuality::kPreview);
    baked_.emplace(ReadTables(folder, atmosphere));
    Case any;
    any.quantity = Quantity::kTotal;
    evaluator_->Prepare(std::span(&any, 1));
  }

  [[nodiscard]] Luminances Radiance(const Setting& at) const { return RadianceOf(sky_, at); }
  [[nodiscard]] Luminances Tables(const Setting& at) const { return RadianceOf(*baked_, at); }

  // Returns the light in front of an object beyond the air.
  [[nodiscard]] Luminances Between(const Setting& at) const {
    constexpr double kFar_m = 1e7;
    return Over([&](const SkyPixel& pixel) {
      const Direction view = pixel.direction();
      const LocalPoint object{.east_m = kFar_m * view.east,
                              .north_m = kFar_m * view.north,
                              .up_m = at.eye_m + kFar_m * view.up};
      return LuminanceOf(sky_.Between(at.eye(), object, at.sun().ToSunForAir()).inscattered);
    });
  }

  [[nodiscard]] Luminances Panorama(const Setting& at) const {
    PanoramaOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.altitude_m = at.eye_m;
    options.sun = at.sun();
    const HdrImage image = RenderPanorama(sky_, options);
    return Over([&](const SkyPixel& pixel) {
      const auto& rgb = image.rgb[static_cast<std::size_t>(pixel.y * kWidth + pixel.x)];
      return Luminance({rgb[0], rgb[1], rgb[2]});
    });
  }

  [[nodiscard]] Luminances Eval(const Setting& at) const {
    return Over([&](const SkyPixel& pixel) {
      Case work;
      work.quantity = Quantity::kTotal;
      work.ray = RayOf(at, pixel);
      const Estimates light = evaluator_->Evaluate(work);
      return LuminanceOf([&](std::size_t band) { return light[band].value; });
    });
  }

  [[nodiscard]] Luminances Viewer(const Setting& at) const {
    const EyeUnderLight eye = tests::EyeUnderSun(at.eye_m, at.sun_elevation_deg);
    const AirTables tables =
        MakeAirTables(air_, viewer_, eye, AirTablesSizeOf(AirQuality::kLow, at.eye_m));
    const tests::AirReading reading(tables);
    return Over([&](const SkyPixel& pixel) {
      const double above_horizon =
          pixel.elevation_deg() * kRadiansPerDegree + tables.map.horizon_dip;
      const glm::dvec4 light =
          reading.Sky(above_horizon, (180.0 + pixel.azimuth_deg()) * kRadiansPerDegree);
      return LuminanceOf([&](std::size_t band) { return light[static_cast<glm::length_t>(band)]; });
    });
  }

 private:
  [[nodiscard]] double LuminanceOf(const Spectrum& light) const {
    return Luminance(atmosphere_.ColourOf(light));
  }
  [[nodiscard]] double LuminanceOf(const std::function<double(std::size_t)>& band) const {
    Spectrum light(air_.bands());
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = static_cast<float>(band(i));
    return LuminanceOf(light);
  }
  [[nodiscard]] ViewRay RayOf(const Setting& at, const SkyPixel& pixel) const {
    return RayFrom(AltitudeOf(at.eye(), atmosphere_.planet_radius_m()),
                   UnitVectorOf(pixel.direction()), UnitVectorOf(at.sun().ToSunForAir()));
  }

  Atmosphere atmosphere_;
  Sky sky_;
  SolvedAir air_;
  MediumTables viewer_;
  std::unique_ptr<Evaluator> evaluator_;
  std::optional<Sky> baked_;
};

/// Text of an atmosphere file for each preset and each mixture of aerosols.
std::vector<std::string> AllAir() {
  std::vector<std::string> texts;
  for (const std::string& preset : MediumPresetNames())
    texts.push_back("preset = \"" + preset + "\"\n");
  for (const std::string& mixture : AerosolMixtureNames())
    texts.push_back("[aerosol]\nmixture = \"" + mixture + "\"\n");
  // Sanitizers see air with and without polarised light, and a mixture.
  if (tests::kSanitized) texts = {texts.front(), "preset = \"bruneton2017\"\n", texts.back()};
  return texts;
}

std::vector<Setting> Settings() {
  std::vector<Setting> settings{
      {2.0, 4.0}, {2.0, 33.0}, {2.0, -3.0}, {3000.0, 33.0}, {3000.0, -3.0}};
  settings.resize(tests::ScaledDown<std::size_t>(settings.size(), 1));
  return settings;
}

/// The largest differences from Sky::Radiance.
struct Bounds {
  double eval, viewer, viewer_in_twilight, tables;
};

void ExpectTheSame(const Ways& ways, const Bounds& bounds) {
  for (const Setting& at : Settings()) {
    SCOPED_TRACE(testing::Message()
                 << "eye at " << at.eye_m << " m, sun at " << at.sun_elevation_deg << " degrees");
    const bool is_day = at.sun_elevation_deg > 0.0;
    const Luminances expected = ways.Radiance(at);
    EXPECT_LT(Difference(ways.Between(at), expected), 1e-5);
    EXPECT_LT(Difference(ways.Panorama(at), expected), 7.5e-3);
    EXPECT_LT(Difference(ways.Eval(at), expected), bounds.eval);
    EXPECT_LT(Difference(ways.Viewer(at), expected),
              is_day ? bounds.viewer : bounds.viewer_in_twilight);
    EXPECT_LT(Difference(ways.Tables(at), expected), bounds.tables);
  }
}

class SameLight : public TemporaryFolder, public testing::WithParamInterface<std::string> {};

// The largest differences of panoramas and of the viewer are those of thin maritime air under a low
// sun, 0.6 %: the glow around the sun is that of one column of aerosol. Tables of the quality
// "preview" have moments to degree 2 in thin air, and 6 azimuths of light scattered once.
TEST_P(SameLight, OfPresetsIsGivenByEveryMethod) {
  const Ways ways(Atmosphere::FromToml(GetParam()), folder_ / "baked");
  ExpectTheSame(ways, {1e-3, 7.5e-3, 7.5e-3, 0.08});
}

INSTANTIATE_TEST_SUITE_P(PresetsAndMixtures, SameLight, testing::ValuesIn(AllAir()));

/// Text of air that throws light back in a narrow lobe, of thick mist, and of a small planet with
/// tall air.
std::vector<std::string> OddAir() {
  const std::string lobe =
      "[aerosol]\noptical_depth_550 = 0.5\n[mie]\nphase = \"henyey-greenstein\"\n";
  std::vector<std::string> texts{
      lobe + "g = -0.9\n", lobe + "g = -0.99\n",
      "preset = \"hazy\"\n[aerosol]\nvisibility_m = 1000\n",
      "[aerosol]\nvisibility_m = 2000\n[mie]\nphase = \"fog\"\ndroplet_diameter_um = 20\n",
      "preset = \"bruneton2017\"\n[planet]\nradius_m = 1188300\natmosphere_top_m = 1200000\n"
      "[rayleigh]\nscale_height_m = 45000\nscattering_per_m = [5.9e-6, 2.4e-6, 1.03e-6]\n"
      "[mie]\nscale_height_m = 22000\nscattering_per_m = [1e-7, 1e-7, 1e-7]\n"
      "extinction_per_m = [1.1e-7, 1.1e-7, 1.1e-7]\n[ozone]\nabsorption_per_m = [0, 0, 0]\n"};
  texts.resize(tests::ScaledDown<std::size_t>(texts.size(), 1));
  return texts;
}

class SameLightOfExtremeAir : public SameLight {};

// The bound of panoramas is that of usual air. The other ways differ by 1 % by day; the viewer by 5
// % in the twilight of the small planet and by 3.5 % in that of the narrower lobe, and the tables
// by
// 10 % around the sun behind that lobe.
TEST_P(SameLightOfExtremeAir, IsGivenByEveryMethod) {
  const Ways ways(Atmosphere::FromToml(GetParam()), folder_ / "baked");
  ExpectTheSame(ways, {3e-3, 0.012, 0.06, 0.12});
}

INSTANTIATE_TEST_SUITE_P(LobesMistAndSmallPlanets, SameLightOfExtremeAir,
                         testing::ValuesIn(OddAir()));

class BakedTables : public TemporaryFolder {};

// Sanitizers see smaller tables, with the bound that SameLight has for them.
TEST_F(BakedTables, OfStandardQualityAreAccurateInDust) {
  constexpr BakeQuality kQuality = tests::ScaledDown(BakeQuality::kStandard, BakeQuality::kPreview);
  constexpr double kBound = tests::ScaledDown(0.02, 0.08);
  const Atmosphere mars = Atmosphere::Preset("mars");
  const Sky sky(mars);
  BakeTables(mars, folder_ / "baked", kQuality);
  const Sky baked = ReadTables(folder_ / "baked", mars);
  for (const Setting& at : Settings()) {
    EXPECT_LT(Difference(RadianceOf(baked, at), RadianceOf(sky, at)), kBound)
        << "eye at " << at.eye_m << " m, sun at " << at.sun_elevation_deg << " degrees";
  }
}

/// Luminance at whole degrees below the sun.
struct Aureole {
  Luminances library, panorama, viewer;
};

Aureole AureoleOf(const Atmosphere& atmosphere, double sun_elevation_deg) {
  constexpr int kHalfHeight = 90, kDegrees = 15;
  const Sky sky(atmosphere);
  PanoramaOptions options;
  options.width = 4 * kHalfHeight;
  options.height = 2 * kHalfHeight;
  options.sun.elevation_deg = sun_elevation_deg;
  options.sun.azimuth_deg = 180.5;  // of the centre of a column
  options.centre = PanoramaCentre::kOpenExr;
  const HdrImage image = RenderPanorama(sky, options);
  const SolvedAir air = SolvedOf(sky);
  const MediumTables medium = MakeMediumTables(air);
  const EyeUnderLight eye = tests::EyeUnderSun(options.altitude_m, sun_elevation_deg);
  const AirTables tables =
      MakeAirTables(air, medium, eye, AirTablesSizeOf(AirQuality::kLow, eye.altitude_m));
  const tests::AirReading reading(tables);
  Aureole aureole;
  for (int below = 1; below <= kDegrees; ++below) {
    const double elevation_deg = sun_elevation_deg - below;
    const Spectrum light =
        sky.Radiance({.up_m = options.altitude_m}, DirectionFromAngles(elevation_deg, 180.5),
                     options.sun.ToSunForAir());
    aureole.library.push_back(Luminance(atmosphere.ColourOf(light)));
    const auto row = static_cast<int>(kHalfHeight - elevation_deg);
    const auto& rgb = image.rgb[static_cast<std::size_t>(row * image.width + image.width / 2)];
    aureole.panorama.push_back(Luminance({rgb[0], rgb[1], rgb[2]}));
    const glm::dvec4 read =
        reading.Sky(elevation_deg * kRadiansPerDegree + tables.map.horizon_dip, 0.0);
    Spectrum seen(air.bands());
    for (std::size_t band = 0; band < seen.size(); ++band)
      seen[band] = static_cast<float>(read[static_cast<glm::length_t>(band)]);
    aureole.viewer.push_back(Luminance(atmosphere.ColourOf(seen)));
  }
  return aureole;
}

class AureoleOfSharpPhases : public testing::TestWithParam<const char*> {};

// The bound is a third more than measured with g = 0.999. Beyond six degrees below the sun the sky
// gets brighter towards the horizon again.
// Hard cases 12, 23, 31.
TEST_P(AureoleOfSharpPhases, FallsSteadily) {
  constexpr std::size_t kSteady = 6;
  for (const double sun_elevation_deg : {60.5, 29.5}) {
    const Aureole aureole =
        AureoleOf(Atmosphere::FromToml("[mie]\n" + std::string(GetParam())), sun_elevation_deg);
    for (std::size_t i = 0; i < aureole.library.size(); ++i) {
      SCOPED_TRACE(testing::Message() << i + 1 << " degrees below a sun at " << sun_elevation_deg);
      EXPECT_GT(aureole.library[i], 0.0);
      EXPECT_NEAR(aureole.panorama[i] / aureole.library[i], 1.0, 0.025);
      EXPECT_NEAR(aureole.viewer[i] / aureole.library[i], 1.0, 0.025);
      if (i == 0 || i >= kSteady) continue;
      EXPECT_LT(aureole.library[i], aureole.library[i - 1]);
      EXPECT_LT(aureole.panorama[i], aureole.panorama[i - 1]);
      EXPECT_LT(aureole.viewer[i], aureole.viewer[i - 1]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, AureoleOfSharpPhases,
    testing::Values(
        "phase = \"henyey-greenstein\"\ng = 0.95\n", "phase = \"henyey-greenstein\"\ng = 0.99\n",
        "phase = \"henyey-greenstein\"\ng = 0.999\n",
        "phase = \"fog\"\ndroplet_diameter_um = 10\n[aerosol]\nvisibility_m = 10000\n",
        "phase = \"fog\"\ndroplet_diameter_um = 50\n[aerosol]\nvisibility_m = 10000\n"));

}  // namespace
}  // namespace alpenglow::lut
