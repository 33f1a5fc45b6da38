// SPDX-License-Identifier: MIT
#include "renderer/media/body_glow.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr int kGlowPoints = 16;  // along each side

/// Returns the mean over six directions of the transmittance from a point to the outside.
double EscapingFrom(const LocalBody& body, const glm::dvec3& point, double absorption_per_m) {
  double sum = 0.0;
  const VolumePlacement& place = body.placement();
  for (const glm::dvec3& axis : {place.across, place.ahead, place.up}) {
    for (const double sign : {-1.0, 1.0}) {
      const double column_m =
          body.Column(point, sign * axis, std::numeric_limits<double>::infinity());
      sum += std::exp(-absorption_per_m * column_m) / 6.0;
    }
  }
  return sum;
}

}  // namespace

BodyGlow GlowOf(const LocalBody& body) {
  const MediumOptics& optics = body.optics();
  const std::size_t bands = optics.emission_per_m.size();
  const glm::dvec3& size_m = body.placement().size_m;
  const double volume_m3 = size_m.x * size_m.y * size_m.z;
  BodyGlow glow{Lamp{}, Spectrum(bands)};
  glow.lamp.position_m = body.Middle();
  glow.lamp.radius_m = std::cbrt(0.75 / kPi * volume_m3);
  const double part_m3 = volume_m3 / std::pow(kGlowPoints, 3);
  for (int i = 0; i < kGlowPoints * kGlowPoints * kGlowPoints; ++i) {
    const glm::dvec3 cell(i % kGlowPoints, i / kGlowPoints % kGlowPoints,
                          i / (kGlowPoints * kGlowPoints));
    const glm::dvec3 point = body.FrameFromUnit((cell + 0.5) / static_cast<double>(kGlowPoints));
    const double density = body.DensityAt(point);
    if (density == 0.0) continue;
    for (std::size_t band = 0; band < bands; ++band) {
      if (optics.emission_per_m[band] == 0.0) continue;
      const double absorption_per_m = optics.extinction_per_m[band] - optics.scattering_per_m[band];
      glow.intensity[band] += static_cast<float>(part_m3 * density * optics.emission_per_m[band] *
                                                 EscapingFrom(body, point, absorption_per_m));
    }
  }
  return glow;
}

}  // namespace alpenglow::renderer
