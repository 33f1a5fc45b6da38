// SPDX-License-Identifier: MIT
// Light of the twilight sky is compared with the published illuminances of the U.S. Naval
// Observatory (Brown 1952), average clear sky at sea level. Skies of Mars have the
// colours that people see: butterscotch by day, a blue glow around the setting sun.
//
// Deep twilight is light scattered at 20 to 80 km, where the air is thinner than an exponential of
// 8 km says: by a factor of 2 at 40 km in the U.S. Standard Atmosphere 1976. With the scale height
// that the standard atmosphere has there, and the same column, illuminance is right within a
// quarter from sunset to the end of nautical twilight. With 8 km it is twice too bright from -6
// degrees on.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/sky/panorama.h"
#include "lut/sky/sky_view.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/solved_media.h"

namespace alpenglow::lut {
namespace {

constexpr double kNightSky_lux = 0.0005;  // what the table adds (Janiczek, DeYoung 1987)
constexpr int kBands = tests::ScaledDown(8, 4);

/// Returns two columns of a published table as x -> y.
std::map<double, double> Table(const std::string& file, std::size_t x, std::size_t y) {
  std::ifstream in(std::filesystem::path(tests::kSourceFolder) / "tests" / "data" / "tables" /
                   file);
  std::map<double, double> table;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || (line[0] != '-' && (line[0] < '0' || line[0] > '9'))) continue;
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    table[row.at(x)] = row.at(y);
  }
  return table;
}

std::map<double, double> PublishedLux() { return Table("illuminance_vs_sun_altitude.csv", 0, 2); }

/// Returns the relative density at 40 km of the U.S. Standard Atmosphere.
double DensityAt40Km() { return Table("ussa76_profile.csv", 0, 6).at(40.0); }

/// Returns the true elevation of an apparent one of the table. Refraction lifts a sun on the horizon
/// by 34'; below, where no ray arrives, it is taken to fade to nothing until civil twilight ends.
double TrueElevation(double apparent_deg) {
  const std::map<double, double> refraction_minutes{{0.0, 34.0}, {-3.0, 27.0}};
  const auto at = refraction_minutes.find(apparent_deg);
  const double minutes = at == refraction_minutes.end() ? 0.0 : at->second;
  return (apparent_deg - minutes / 60.0) * kRadiansPerDegree;
}

/// Computes illuminance [lx] of a horizontal plane on the ground.
class Daylight {
 public:
  explicit Daylight(const Medium& medium) : air_(medium), multiple_scattering_(medium) {}

  [[nodiscard]] double Lux(double true_elevation_rad) const {
    SunInSky sun;
    sun.elevation_deg = true_elevation_rad / kRadiansPerDegree;
    return HorizontalIlluminance(air_, multiple_scattering_, 0.0, sun) + kNightSky_lux;
  }

 private:
  SingleScattering<float> air_;
  MultipleScattering multiple_scattering_;
};

/// Returns the medium with the same column of molecules in one exponential.
Medium WithOneExponential(Medium medium, double height_m) {
  for (double& scattering : medium.rayleigh_scattering_per_m)
    scattering *= MoleculeColumn_m(medium) / height_m;
  medium.rayleigh_scale_height_m = height_m;
  medium.rayleigh_deficit = {};
  return medium;
}

double RatioToTable(const Daylight& daylight, double apparent_deg) {
  return daylight.Lux(TrueElevation(apparent_deg)) / PublishedLux().at(apparent_deg);
}

TEST(Twilight, DensityOfMoleculesFollowsTheStandardAtmosphere) {
  const std::map<double, double> standard = Table("ussa76_profile.csv", 0, 6);
  const Medium medium = MediumPreset("earth");
  double column_m = 0.0, last_km = 0.0, last_density = 1.0;
  for (const auto& [altitude_km, density] : standard) {
    const double ratio = MoleculeDensity(medium, 1000.0 * altitude_km) / density;
    if (altitude_km <= 55.0) {
      EXPECT_NEAR(ratio, 1.0, altitude_km <= 25.0 ? 0.1 : 0.22) << altitude_km << " km";
    }
    column_m += 500.0 * (altitude_km - last_km) * (density + last_density);
    last_km = altitude_km;
    last_density = density;
  }
  EXPECT_NEAR(MoleculeColumn_m(medium), column_m, 0.002 * column_m)
      << "trapezoids over steps of 1 and 2 km: 0.1 % too much";
}

// Hard case 22.
TEST(Twilight, IsAsBrightAsPublished) {
  const Daylight daylight(MediumPreset("earth", WavelengthSet(kBands)));
  for (const double apparent_deg : {0.0, -3.0, -6.0, -9.0, -12.0}) {
    const double ratio = RatioToTable(daylight, apparent_deg);
    EXPECT_NEAR(ratio, 1.0, 0.25) << "sun at " << apparent_deg << " degrees";
    RecordProperty("ratio_at_" + std::to_string(static_cast<int>(-apparent_deg)),
                   std::to_string(ratio));
  }
}

TEST(Twilight, OfOneExponentialIsTooBright) {
  const double height_m = 8000.0;
  const double too_dense = std::exp(-40e3 / height_m) / DensityAt40Km();
  EXPECT_NEAR(too_dense, 2.1, 0.1) << "the reason: molecules at 40 km, times too many";
  const Daylight daylight(
      WithOneExponential(MediumPreset("earth", WavelengthSet(kBands)), height_m));
  for (const double apparent_deg : {-6.0, -9.0, -12.0}) {
    EXPECT_GT(RatioToTable(daylight, apparent_deg), 1.2) << apparent_deg;
    EXPECT_LT(RatioToTable(daylight, apparent_deg), 1.2 * too_dense) << apparent_deg;
  }
}

class MarsSky : public testing::Test {
 protected:
  // Returns linear sRGB of the sky without the sun.
  // Angles in degrees: elevations, azimuth from the sun.
  static std::array<double, 3> Sky(double sun_deg, double elevation_deg, double azimuth_deg) {
    const SkyView view(Mars().single_scattering(), Mars().multiple_scattering(), 2.0,
                       std::sin(sun_deg * kRadiansPerDegree));
    const Spectrum sky =
        view.Radiance((90.0 - elevation_deg) * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree);
    std::vector<double> radiance;
    for (std::size_t band = 0; band < sky.size(); ++band) {
      radiance.push_back(static_cast<double>(sky[band]) * Mars().medium().solar_irradiance[band]);
    }
    return BandColour(Mars().medium().wavelengths_nm).LinearSrgb(radiance);
  }
  static double BlueOverRed(const std::array<double, 3>& colour) { return colour[2] / colour[0]; }

 private:
  static const SolvedAir& Mars() {
    static const SolvedAir mars = tests::SolvedAsClearAir(MediumPreset("mars"));
    return mars;
  }
};

TEST_F(MarsSky, DustHasAPhaseFunctionAtEveryWavelength) {
  const Medium mars = MediumPreset("mars", {440.0, 550.0, 670.0});
  ASSERT_EQ(mars.mie_phase.size(), 3U);
  EXPECT_GT(Phase(mars.mie_phase[0], 1.0), 2.0 * Phase(mars.mie_phase[2], 1.0))
      << "the peak of diffraction is narrower and higher in the blue";
  EXPECT_LT(Phase(mars.mie_phase[0], 0.5), Phase(mars.mie_phase[2], 0.5));
  for (const PhaseFunction& phase : mars.mie_phase) {
    EXPECT_NEAR(phase.table->integral(), 1.0, 2e-3) << "normalised where it was made";
    EXPECT_NEAR(MeanCosine(phase), 0.68, 0.09) << "retrievals lie between 0.6 and 0.8";
  }
}

TEST_F(MarsSky, IsButterscotchByDay) {
  for (const double azimuth : {60.0, 120.0, 180.0}) {
    const auto colour = Sky(50.0, 30.0, azimuth);
    EXPECT_GT(colour[0], colour[1]) << "azimuth " << azimuth;
    EXPECT_GT(colour[1], colour[2]) << "azimuth " << azimuth;
    EXPECT_GT(colour[0], 1.3 * colour[2]) << "azimuth " << azimuth;
  }
}

TEST_F(MarsSky, HasABlueGlowAroundTheSettingSun) {
  const double near = BlueOverRed(Sky(3.0, 5.0, 0.0));
  const double aside = BlueOverRed(Sky(3.0, 5.0, 40.0));
  const double opposite = BlueOverRed(Sky(3.0, 5.0, 180.0));
  EXPECT_GT(near, 1.0) << "blue outshines red two degrees from the sun";
  EXPECT_GT(near, 2.0 * aside);
  EXPECT_GT(near, 2.0 * opposite);
  EXPECT_GT(Sky(3.0, 5.0, 0.0)[2], 10.0 * Sky(3.0, 5.0, 40.0)[2]);
}

}  // namespace
}  // namespace alpenglow::lut
