// SPDX-License-Identifier: MIT
#include "viewer/ground/sky_tilt.h"

#include <cmath>

#include "atmosphere/number/constants.h"

namespace alpenglow {

// Least squares. Over even azimuths n.s is orthogonal to what depends on n.up alone.
SkyTilt::SkyTilt(const OpenSky& sky, double altitude_m, double sun_azimuth_rad, double mu_s)
    : level(sky.bands()), up(sky.bands()), sunward(sky.bands()) {
  constexpr int kTilts = 7, kAzimuths = 12;
  constexpr double kTilt_rad = 10.0 * kRadiansPerDegree;
  Horizons plain;
  plain.fill(0.0F);
  BandLight sum(sky.bands()), sum_up(sky.bands()), sum_sunward(sky.bands());
  double ups = 0.0, ups2 = 0.0, sunwards2 = 0.0;
  for (int tilt = 0; tilt < kTilts; ++tilt) {
    const double z = std::cos(kTilt_rad * tilt), flat = std::sin(kTilt_rad * tilt);
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * kPi * (k + 0.5) / kAzimuths, towards = flat * std::cos(azimuth);
      const glm::dvec3 normal(flat * std::cos(azimuth + sun_azimuth_rad),
                              flat * std::sin(azimuth + sun_azimuth_rad), z);
      const BandLight light = sky.Irradiance(altitude_m, mu_s, SectorsOf(normal), plain);
      sum = sum + light;
      sum_up = sum_up + static_cast<float>(z) * light;
      sum_sunward = sum_sunward + static_cast<float>(towards) * light;
      ups += z;
      ups2 += z * z;
      sunwards2 += towards * towards;
    }
  }
  const double count = kTilts * kAzimuths;
  for (std::size_t band = 0; band < sky.bands(); ++band) {
    const auto all = static_cast<double>(sum[band]), with_up = static_cast<double>(sum_up[band]);
    const double slope = (count * with_up - ups * all) / (count * ups2 - ups * ups);
    up[band] = static_cast<float>(slope);
    level[band] = static_cast<float>((all - slope * ups) / count);
    sunward[band] = static_cast<float>(static_cast<double>(sum_sunward[band]) / sunwards2);
  }
}

}  // namespace alpenglow
