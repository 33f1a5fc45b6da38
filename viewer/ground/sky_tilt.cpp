// SPDX-License-Identifier: MIT
#include "viewer/ground/sky_tilt.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/sky/sky_view.h"

namespace alpenglow {
namespace {

// A coarse table of the sky: the fit takes means over it.
constexpr SkyViewSize kCoarseSky{.sky_rows = 20, .ground_rows = 5, .azimuths = 9, .ray_nodes = 8};
constexpr std::size_t kSkyRows = 64;     // even in the sine of the elevation
constexpr std::size_t kSkyColumns = 36;  // of half a turn from the sun's azimuth
constexpr int kFitTilts = 6, kFitAzimuths = 36;

double FitTilt(int step) { return 10.0 * kRadiansPerDegree * step; }

/// Means over the azimuths of the surfaces, summed over their tilts.
struct FitSums {
  double one = 0.0, up = 0.0, sunward = 0.0;
};

// For light of radiance 1 from the azimuth 0: of E, of E n.up and of E n.x.
FitSums SumsUnder(double sine) {
  const double cosine = std::sqrt(1.0 - sine * sine);
  FitSums sums;
  for (int tilt = 0; tilt < kFitTilts; ++tilt) {
    const double z = std::cos(FitTilt(tilt)), flat = std::sin(FitTilt(tilt));
    for (int k = 0; k < kFitAzimuths; ++k) {
      const double x = flat * std::cos(2.0 * kPi * (k + 0.5) / kFitAzimuths);
      const double falls = std::max(x * cosine + z * sine, 0.0) / kFitAzimuths;
      sums.one += falls;
      sums.up += falls * z;
      sums.sunward += falls * x;
    }
  }
  return sums;
}

double SineOfSkyRow(std::size_t row) { return (static_cast<double>(row) + 0.5) / kSkyRows; }

const std::array<FitSums, kSkyRows>& SumsOfRows() {
  static const std::array<FitSums, kSkyRows> sums = [] {
    std::array<FitSums, kSkyRows> of_rows;
    for (std::size_t row = 0; row < kSkyRows; ++row) of_rows[row] = SumsUnder(SineOfSkyRow(row));
    return of_rows;
  }();
  return sums;
}

std::vector<double> AzimuthsOfColumns() {
  std::vector<double> azimuths;
  for (std::size_t i = 0; i < kSkyColumns; ++i)
    azimuths.push_back(kPi * (static_cast<double>(i) + 0.5) / kSkyColumns);
  return azimuths;
}

// Of the whole sky, band by band. Both halves of it are alike.
std::array<FitSums, 4> SumsOfSky(const SkyView& sky) {
  constexpr double kSolidAngle = 2.0 * kPi / (kSkyRows * kSkyColumns);
  const std::vector<double> azimuths = AzimuthsOfColumns();
  const SkyAzimuths columns(sky, azimuths);
  std::vector<float> radiance(kSkyColumns * sky.stride());
  std::array<FitSums, 4> sums{};
  for (std::size_t row = 0; row < kSkyRows; ++row) {
    sky.FillRow(std::acos(SineOfSkyRow(row)), columns, radiance);
    const FitSums& weight = SumsOfRows()[row];
    for (std::size_t column = 0; column < kSkyColumns; ++column) {
      const double towards_sun = std::cos(azimuths[column]);
      for (std::size_t band = 0; band < sky.bands(); ++band) {
        const double light =
            kSolidAngle * static_cast<double>(radiance[column * sky.stride() + band]);
        sums[band].one += light * weight.one;
        sums[band].up += light * weight.up;
        sums[band].sunward += light * weight.sunward * towards_sun;
      }
    }
  }
  return sums;
}

}  // namespace

// Least squares. Over even azimuths n.s is orthogonal to what depends on n.up alone.
SkyTilt::SkyTilt(const AirIntegrator<float>& air, const DiffuseLight& diffuse, double altitude_m,
                 double mu_s)
    : level(air.bands()), up(air.bands()), sunward(air.bands()) {
  ALPENGLOW_ENSURE(air.bands(), <=, std::size_t{4});
  double ups = 0.0, ups2 = 0.0, sunwards2 = 0.0;
  for (int tilt = 0; tilt < kFitTilts; ++tilt) {
    ups += std::cos(FitTilt(tilt));
    ups2 += std::pow(std::cos(FitTilt(tilt)), 2);
    sunwards2 += 0.5 * std::pow(std::sin(FitTilt(tilt)), 2);
  }
  const std::array<FitSums, 4> sums =
      SumsOfSky(SkyView(air, diffuse, altitude_m, mu_s, kCoarseSky));
  for (std::size_t band = 0; band < air.bands(); ++band) {
    const double slope =
        (kFitTilts * sums[band].up - ups * sums[band].one) / (kFitTilts * ups2 - ups * ups);
    up[band] = static_cast<float>(slope);
    level[band] = static_cast<float>((sums[band].one - slope * ups) / kFitTilts);
    sunward[band] = static_cast<float>(sums[band].sunward / sunwards2);
  }
}

std::array<float, 4> SkyTilt::On(double n_up, double n_sunward) const {
  std::array<float, 4> light{};
  for (std::size_t band = 0; band < level.count; ++band)
    light[band] = shared::OpenSkyOn(level[band], up[band], sunward[band], static_cast<float>(n_up),
                                    static_cast<float>(n_sunward));
  return light;
}

}  // namespace alpenglow
