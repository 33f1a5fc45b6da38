// SPDX-License-Identifier: MIT
#include "viewer/hud/day_strip.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"
#include "lut/sky/sky_view_map.h"

namespace alpenglow::viewer {
namespace {

constexpr std::array<double, 6> kElevations_deg{80.0, 50.0, 28.0, 14.0, 6.0, 1.5};
constexpr int kRows = kElevations_deg.size();

/// Computes sky radiance along rays, in cd/m^2.
class Sky {
 public:
  explicit Sky(const DayStripRequest& request)
      : request_(request),
        medium_(request.multiple_scattering->medium()),
        air_(medium_),
        colour_(medium_.wavelengths_nm),
        altitude_m_(std::max(request.place.height_m, 0.0)),
        horizon_rad_(SkyViewMap(medium_, altitude_m_, 1.0).horizon_zenith_angle_rad()) {}

  /// @param elevation_deg  above the sea horizon.
  [[nodiscard]] std::array<double, 3> LinearSrgb(double elevation_deg, const SunInSky& sun) const {
    const double zenith_deg = horizon_rad_ / kRadiansPerDegree - elevation_deg;
    const auto under = [&](const SunInSky& at) {
      return RayFromAngles(altitude_m_, zenith_deg, 0.0, 90.0 - at.elevation_deg);
    };
    const ViewRay ray = under(SunForAir(sun));
    const double nu_seen = under(sun).nu;
    const RaySamples<float> samples = air_.Sample(ray, {.dark_samples = true});
    const Spectrum once = air_.Inscatter(air_.Scatter(samples), nu_seen);
    const Spectrum more =
        request_.multiple_scattering->InscatterAlong(samples, ray.nu, nu_seen, SegmentEnd::kOpen);
    std::vector<double> radiance(once.size());
    for (std::size_t band = 0; band < once.size(); ++band) {
      radiance[band] = static_cast<double>(once[band] + more[band]) *
                       medium_.solar_irradiance[band] / (sun.distance_au * sun.distance_au);
    }
    return colour_.LinearSrgb(radiance);
  }

 private:
  const DayStripRequest& request_;
  const Medium& medium_;
  SingleScattering<float> air_;
  BandColour colour_;
  double altitude_m_;
  double horizon_rad_;  // zenith angle of the sea horizon
};

using Column = std::array<std::array<double, 3>, kRows>;

double ShownEv100(const Column& column) {
  constexpr double kShareOfMeter = 0.8, kBrightDayEv100 = 14.0;
  double mean = 0.0;
  for (const auto& rgb : column) mean += shared::Luminance(rgb[0], rgb[1], rgb[2]) / kRows;
  const double darkest = std::exp2(kDarkestEv100) * kMeterConstant / 100.0;
  const double metered = std::log2(100.0 * std::max(mean, darkest) / kMeterConstant);
  return kShareOfMeter * metered + (1.0 - kShareOfMeter) * kBrightDayEv100;
}

std::array<float, 3> DisplayCode(const std::array<double, 3>& rgb, double ev100) {
  const Rgb<double> light = DisplayLight<double>(ToneCurve::kAgx, rgb, ExposureScale(ev100));
  std::array<float, 3> code{};
  for (std::size_t c = 0; c < 3; ++c)
    code[c] = static_cast<float>(shared::SrgbCode(std::clamp(light[c], 0.0, 1.0)));
  return code;
}

}  // namespace

bool LooksTheSame(const DayStripRequest& a, const DayStripRequest& b) {
  constexpr double kAngle_rad = 0.5 * kRadiansPerDegree, kTime_s = 1.0;
  constexpr double kHeight_m = 200.0, kShareOfHeight = 0.1;
  const double apart_rad = std::max(
      std::abs(a.place.latitude_rad() - b.place.latitude_rad()),
      std::abs(std::remainder(a.place.longitude_rad() - b.place.longitude_rad(), 2.0 * kPi)) *
          std::cos(a.place.latitude_rad()));
  return a.multiple_scattering == b.multiple_scattering && a.columns == b.columns &&
         std::abs(SecondsBetween(a.begin, b.begin)) < kTime_s && apart_rad < kAngle_rad &&
         std::abs(a.place.height_m - b.place.height_m) <
             std::max(kHeight_m, kShareOfHeight * std::abs(a.place.height_m));
}

DayStrip MakeDayStrip(const DayStripRequest& request) {
  ALPENGLOW_ENSURE(request.columns, >=, 2);
  DayStrip strip;
  strip.columns = request.columns;
  strip.rows = kRows;
  strip.begin = request.begin;
  strip.colours.resize(static_cast<std::size_t>(request.columns) * kRows);
  const Sky sky(request);
  const BendingAir refracting = GentleAirOf(request.multiple_scattering->medium());
  for (int x = 0; x < request.columns; ++x) {
    const UtcTime instant = AddSeconds(request.begin, (x + 0.5) / request.columns * kSecondsPerDay);
    const SunInSky sun = ApparentSunAt(request.place, instant, refracting);
    strip.sun_elevation_rad.push_back(sun.elevation_rad());
    Column column;
    for (std::size_t row = 0; row < kRows; ++row)
      column[row] = sky.LinearSrgb(kElevations_deg[row], sun);
    const double ev100 = ShownEv100(column);
    for (std::size_t row = 0; row < kRows; ++row) {
      strip.colours[row * static_cast<std::size_t>(request.columns) + static_cast<std::size_t>(x)] =
          DisplayCode(column[row], ev100);
    }
  }
  return strip;
}

}  // namespace alpenglow::viewer
