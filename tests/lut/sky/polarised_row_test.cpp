// SPDX-License-Identifier: MIT
// Polarised skies: rows of panoramas, and where the sky is not polarised.
#include "lut/sky/panorama.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sky_view_errors.h"
#include "tests/fixtures/solved_media.h"

namespace alpenglow::lut {
namespace {

RaySamples<float> SamplesOf(const SolvedAir& lit, const ViewRay& ray) {
  return lit.single_scattering().Sample(ray, {.nodes = 24, .dark_samples = true});
}

double RadianceOf(const SolvedAir& lit, const ViewRay& ray, std::size_t band) {
  const RaySamples<float> samples = SamplesOf(lit, ray);
  return double{lit.single_scattering().Inscatter(lit.single_scattering().Scatter(samples),
                                                  ray.nu)[band]} +
         double{lit.multiple_scattering().InscatterAlong(samples, ray.nu)[band]};
}

/// Returns Q or U of all orders, of a view to the right of the sun.
double Evaluated(const SolvedAir& lit, const ViewRay& ray, std::size_t band,
                 Spectrum PolarisedLight::*part) {
  const RaySamples<float> samples = SamplesOf(lit, ray);
  const PolarisedLight once =
      PolarisedOnce(lit.medium(), lit.single_scattering().Scatter(samples), ray);
  const PolarisedLight more = lit.multiple_scattering().PolarisationAlong(samples, ray.nu);
  return double{(once.*part)[band]} + double{(more.*part)[band]};
}

TEST(PolarisedRow, EqualsTheLightOfItsDirections) {
  const SolvedAir& lit = tests::Earth();
  for (const double altitude_m : {2.0, 10e3}) {
    for (const double sun_deg : {60.0, 10.0, 0.0, -4.0}) {
      const double mu_s = std::sin(sun_deg * kRadiansPerDegree);
      double worst = 0.0;
      for (int i = 1; i <= tests::ScaledDown(24, 8); ++i) {
        const double zenith = kPi * Halton(i, 2), azimuth = kPi * Halton(i, 3);
        const PolarisedRow row(lit.single_scattering(), lit.multiple_scattering(), altitude_m, mu_s,
                               zenith);
        const ViewRay ray = SkyRay(altitude_m, zenith, mu_s, azimuth);
        const PolarisedLight right = row.At(azimuth), left = row.At(2.0 * kPi - azimuth);
        for (const std::size_t band : {std::size_t{0}, lit.single_scattering().bands() - 1}) {
          const double whole = RadianceOf(lit, ray, band);
          const double q = Evaluated(lit, ray, band, &PolarisedLight::q);
          const double u = Evaluated(lit, ray, band, &PolarisedLight::u);
          worst = std::max({worst, std::abs(double{right.q[band]} - q) / whole,
                            std::abs(double{right.u[band]} - u) / whole,
                            std::abs(double{left.q[band]} - q) / whole,
                            std::abs(double{left.u[band]} + u) / whole});
        }
      }
      EXPECT_LT(worst, sun_deg > 5.0 ? 1e-3 : 3e-3) << altitude_m << " m, sun at " << sun_deg;
    }
  }
}

/// Returns the air of a preset in three bands, which is solved once.
const SolvedAir& AirOf(std::string_view preset) {
  static std::map<std::string, SolvedAir> airs;
  const std::string name(preset);
  const auto known = airs.find(name);
  if (known != airs.end()) return known->second;
  return airs.emplace(name, tests::SolvedAsClearAir(MediumPreset(name, {450.0, 550.0, 650.0})))
      .first->second;
}

/// The meridian of the sun, by degrees over the horizon under it: beyond 90 on the other side.
class Meridian {
 public:
  Meridian(const SolvedAir& lit, double sun_deg, std::size_t band) : sun_deg_(sun_deg) {
    const double mu_s = std::sin(sun_deg * kRadiansPerDegree);
    for (int degree = 1; degree < 180; ++degree) {
      const double zenith = std::abs(90.0 - degree) * kRadiansPerDegree;
      const double nu = std::cos((degree - sun_deg) * kRadiansPerDegree);
      const ViewRay ray{2.0, std::cos(zenith), mu_s, nu};
      q_.push_back(Evaluated(lit, ray, band, &PolarisedLight::q) / RadianceOf(lit, ray, band));
    }
  }

  /// Degrees from the sun, upwards, of where light is not polarised.
  [[nodiscard]] std::vector<double> NeutralPoints() const {
    std::vector<double> points;
    for (std::size_t i = 0; i + 1 < q_.size(); ++i) {
      if ((q_[i] < 0.0) == (q_[i + 1] < 0.0)) continue;
      points.push_back(static_cast<double>(i + 1) + q_[i] / (q_[i] - q_[i + 1]) - sun_deg_);
    }
    return points;
  }
  [[nodiscard]] double Strongest() const { return -*std::min_element(q_.begin(), q_.end()); }
  /// Degrees from the sun.
  [[nodiscard]] double StrongestAt() const {
    return static_cast<double>(std::min_element(q_.begin(), q_.end()) - q_.begin()) + 1.0 -
           sun_deg_;
  }

 private:
  double sun_deg_;
  std::vector<double> q_;  // Q / I
};

// Coulson (1988), Polarization and Intensity of Light in the Atmosphere, and Horvath, Varju (2004),
// Polarized Light in Animal Vision, give the observed distances. Babinet's point is over the sun
// and Brewster's below it by 10 to 25 degrees, nearer to a high sun. Arago's is 18 to 25 degrees
// over the antisolar point of a low sun, farther in the blue than in the red and after sunset than
// before.
TEST(PolarisedSky, NeutralPointsAreAtTheirObservedPlaces) {
  for (const char* air : {"clear-mountain", "hazy"}) {
    const SolvedAir& lit = AirOf(air);
    const auto points_at = [&](double sun_deg, std::size_t band) {
      return Meridian(lit, sun_deg, band).NeutralPoints();
    };
    const std::vector<double> low = points_at(0.0, 0), low_green = points_at(0.0, 1),
                              low_red = points_at(0.0, 2), dusk = points_at(-4.0, 0),
                              day = points_at(30.0, 0), noon = points_at(60.0, 0);
    for (const std::vector<double>& points : {low, low_green, low_red, dusk, day, noon})
      ASSERT_EQ(points.size(), 2U) << air << ": Babinet with Arago at a low sun, else Brewster";
    const auto arago = [](const std::vector<double>& points) { return 180.0 - points[1]; };
    const auto observed = [&](double degrees) { return degrees > 10.0 && degrees < 25.0; };
    EXPECT_TRUE(arago(low) > 18.0 && observed(arago(low))) << air;
    EXPECT_GT(arago(low), arago(low_green));
    EXPECT_GT(arago(low_green), arago(low_red));
    EXPECT_GT(arago(dusk), arago(low) + 1.0) << air;
    EXPECT_LT(arago(dusk), 27.0) << air;
    for (const double babinet : {low[0], low_green[0], dusk[0], day[1]})
      EXPECT_TRUE(observed(babinet)) << air << ", " << babinet;
    EXPECT_TRUE(observed(-day[0])) << air << ", Brewster at " << day[0];
    EXPECT_LT(-noon[0], 0.7 * -day[0]) << air << ", Brewster";
    EXPECT_LT(noon[1], 0.7 * day[1]) << air << ", Babinet";
  }
}

TEST(PolarisedSky, IsMostPolarisedAtRightAnglesToTheSunAndLessInHaze) {
  const SolvedAir &clear = AirOf("clear-mountain"), &hazy = AirOf("hazy");
  for (const double sun_deg : {30.0, 10.0, 0.0, -4.0}) {
    const Meridian meridian(clear, sun_deg, 1);
    EXPECT_NEAR(meridian.StrongestAt(), 90.0, 2.0) << sun_deg;
    EXPECT_GT(meridian.Strongest(), Meridian(hazy, sun_deg, 1).Strongest() + 0.1) << sun_deg;
    EXPECT_GT(meridian.Strongest(), sun_deg < 20.0 ? 0.75 : 0.65) << sun_deg;
    EXPECT_LT(meridian.Strongest(), 0.85) << sun_deg << ": Coulson (1988), Mauna Loa: to 0.85";
  }
}

}  // namespace
}  // namespace alpenglow::lut
