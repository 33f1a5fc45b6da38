// SPDX-License-Identifier: MIT
#include "renderer/media/body_glow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr int kGlowPoints = 16;  // along each side

constexpr std::size_t kWaysOut = 6;

/// Returns the columns of a body from a point to the outside, in six directions [m].
std::array<double, kWaysOut> ColumnsToOutside(const LocalBody& body, const glm::dvec3& point) {
  const VolumePlacement& place = body.placement();
  const std::array<glm::dvec3, kWaysOut> ways{place.across, -place.across, place.ahead,
                                              -place.ahead, place.up,      -place.up};
  std::array<double, kWaysOut> columns_m{};
  for (std::size_t i = 0; i < kWaysOut; ++i)
    columns_m[i] = body.Column(point, ways[i], std::numeric_limits<double>::infinity());
  return columns_m;
}

/// Returns the mean transmittance of these columns.
double MeanLeft(const std::array<double, kWaysOut>& columns_m, double absorption_per_m) {
  double sum = 0.0;
  for (const double column_m : columns_m) sum += std::exp(-absorption_per_m * column_m);
  return sum / kWaysOut;
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
  if (std::ranges::all_of(optics.emission_per_m.values(), [](double e) { return e == 0.0; }))
    return glow;
  const double part_m3 = volume_m3 / std::pow(kGlowPoints, 3);
  for (int i = 0; i < kGlowPoints * kGlowPoints * kGlowPoints; ++i) {
    const glm::dvec3 cell(i % kGlowPoints, i / kGlowPoints % kGlowPoints,
                          i / (kGlowPoints * kGlowPoints));
    const glm::dvec3 point = body.FrameFromUnit((cell + 0.5) / static_cast<double>(kGlowPoints));
    const double density = body.DensityAt(point);
    if (density == 0.0) continue;
    const std::array<double, kWaysOut> columns_m = ColumnsToOutside(body, point);
    const std::optional<BodyColour> colour = body.ColourAt(point);
    const SpectrumOf<double>& emission_per_m =
        colour ? colour->emission_per_m : optics.emission_per_m;
    for (std::size_t band = 0; band < bands; ++band) {
      const double absorption_per_m = optics.extinction_per_m[band] - optics.scattering_per_m[band];
      glow.intensity[band] += static_cast<float>(part_m3 * density * emission_per_m[band] *
                                                 MeanLeft(columns_m, absorption_per_m));
    }
  }
  return glow;
}

}  // namespace alpenglow::renderer
