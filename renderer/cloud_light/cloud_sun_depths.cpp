// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_sun_depths.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_tracking.h"

namespace alpenglow::renderer {

bool IsLowCloudSun(const glm::dvec3& to_sun) {
  return to_sun.z < std::sin(kLowestCloudSun_deg * kRadiansPerDegree);
}

CloudSunDepths::CloudSunDepths(const CloudField& field, const glm::dvec3& to_sun,
                               const CloudSunMapOptions& map_options,
                               const CloudLowSunOptions& low_options,
                               const CloudLowSunMapOptions& low_map_options)
    : field_(&field), sun_([&]() -> std::variant<Unlit, CloudSunMap, CloudLowSunMap> {
        if (!IsLowCloudSun(to_sun)) return CloudSunMap(field, to_sun, map_options);
        return CloudLowSunMap(field, CloudLowSun(field, to_sun, low_options), low_map_options);
      }()) {}

const glm::dvec3& CloudSunDepths::to_sun() const {
  static const glm::dvec3 kVertical(0.0, 0.0, 1.0);
  if (IsUnlit()) return kVertical;
  return map() ? map()->to_sun() : low_sun()->to_sun();
}

double CloudSunDepths::OpticalDepth(const glm::dvec3& point) const {
  constexpr double kOpaque = 64.0;
  if (IsUnlit()) return kOpaque;
  return map() ? OpticalDepthToSun(*field_, *map(), point) : low_map()->OpticalDepth(point);
}

double CloudSunDepths::Transmittance(const glm::dvec3& point) const {
  if (IsUnlit()) return 1.0;
  return map() ? map()->Transmittance(point) : low_map()->Transmittance(point);
}

double CloudSunDepths::TransmittanceAround(const glm::dvec3& point) const {
  if (IsUnlit()) return 1.0;
  return map() ? map()->TransmittanceAround(point) : low_map()->TransmittanceAround(point);
}

double CloudSunDepths::MeanTransmittance(double altitude_m) const {
  if (low_map()) return MeanPowerOfTransmittance(altitude_m, 1.0);
  if (altitude_m >= field_->top_altitude_m()) return 1.0;
  return map() ? map()->MeanTransmittance()
               : MeanPowerOfTransmittance(field_->base_altitude_m(), 1.0);
}

double CloudSunDepths::BeamLeft(const glm::dvec3& point) const {
  constexpr double kStep_m = 20.0;
  if (map()) return map()->Transmittance(point);
  if (low_map()) return low_map()->TransmittanceAsAtPlace(point);
  const double length_m = std::max(field_->top_altitude_m() - point.z, 0.0);
  return std::exp(
      -CloudDepths(CloudTracker(*field_, false), {point, to_sun()}, length_m, kStep_m).depth());
}

double CloudSunDepths::MeanPowerOfTransmittance(double altitude_m, double exponent) const {
  constexpr int kBeams = 4096;
  const CloudLattice& lattice = field_->lattice();
  std::vector<double> left(kBeams);
  tbb::parallel_for(0, kBeams, [&](int i) {
    const glm::dvec2 place =
        glm::dvec2(lattice.origin_m) +
        glm::dvec2(lattice.size_m()) * glm::dvec2(Halton(i + 1, 2), Halton(i + 1, 3));
    left[static_cast<std::size_t>(i)] = std::pow(BeamLeft({place, altitude_m}), exponent);
  });
  return std::accumulate(left.begin(), left.end(), 0.0) / kBeams;
}

std::size_t CloudSunDepths::bytes() const {
  if (IsUnlit()) return 0;
  return map() ? map()->bytes() : low_map()->bytes();
}

}  // namespace alpenglow::renderer
