// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_sun_depths.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {

bool IsLowCloudSun(const glm::dvec3& to_sun) {
  return to_sun.z < std::sin(kLowestCloudSun_deg * kRadiansPerDegree);
}

CloudSunDepths::CloudSunDepths(const CloudField& field, const glm::dvec3& to_sun,
                               const CloudSunMapOptions& map_options,
                               const CloudLowSunOptions& low_options,
                               const CloudLowSunMapOptions& low_map_options)
    : field_(&field), sun_([&]() -> std::variant<CloudSunMap, CloudLowSunMap> {
        if (!IsLowCloudSun(to_sun)) return CloudSunMap(field, to_sun, map_options);
        return CloudLowSunMap(field, CloudLowSun(field, to_sun, low_options), low_map_options);
      }()) {}

double CloudSunDepths::OpticalDepth(const glm::dvec3& point) const {
  return map() ? OpticalDepthToSun(*field_, *map(), point) : low_map()->OpticalDepth(point);
}

double CloudSunDepths::Transmittance(const glm::dvec3& point) const {
  return map() ? map()->Transmittance(point) : low_map()->Transmittance(point);
}

double CloudSunDepths::MeanTransmittance(double altitude_m) const {
  if (map()) return altitude_m < field_->top_altitude_m() ? map()->MeanTransmittance() : 1.0;
  return MeanPowerOfTransmittance(altitude_m, 1.0);
}

double CloudSunDepths::MeanPowerOfTransmittance(double altitude_m, double exponent) const {
  constexpr int kBeams = 4096;
  const CloudLattice& lattice = field_->lattice();
  std::vector<double> left(kBeams);
  tbb::parallel_for(0, kBeams, [&](int i) {
    const glm::dvec2 place =
        glm::dvec2(lattice.origin_m) +
        glm::dvec2(lattice.size_m()) * glm::dvec2(Halton(i + 1, 2), Halton(i + 1, 3));
    const glm::dvec3 point(place, altitude_m);
    const double of_beam =
        map() ? map()->Transmittance(point) : low_map()->TransmittanceAsAtPlace(point);
    left[static_cast<std::size_t>(i)] = std::pow(of_beam, exponent);
  });
  return std::accumulate(left.begin(), left.end(), 0.0) / kBeams;
}

std::size_t CloudSunDepths::bytes() const { return map() ? map()->bytes() : low_map()->bytes(); }

}  // namespace alpenglow::renderer
