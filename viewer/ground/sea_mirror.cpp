// SPDX-License-Identifier: MIT
#include "viewer/ground/sea_mirror.h"

#include <algorithm>
#include <cmath>

#include "renderer/ground/band_light.h"

namespace alpenglow::viewer {
namespace {

const glm::dvec3 kUp(0.0, 0.0, 1.0);

BandTexel TexelOf(const BandLight& light) {
  BandTexel texel{};
  std::copy_n(light.value.begin(), light.count, texel.begin());
  return texel;
}

BandLight Shown(const OpenSky& sky, const Water& water, double mu_s, const glm::dvec3& to_eye) {
  BandLight sum(sky.bands());
  const MirroredRays mirrored = water.Mirrored(kUp, to_eye);
  for (const MirroredRay& ray : mirrored.All())
    sum = sum + static_cast<float>(ray.weight) * sky.Radiance(0.0, mu_s, ray.direction);
  return sum;
}

}  // namespace

BandLight LevelSky::Under(const DiffuseLight& diffuse, double sun_elevation_rad) {
  return diffuse.SkyIrradiance(0.0, std::sin(std::max(sun_elevation_rad, kLowest_rad)));
}

std::vector<BandTexel> LevelSky::Of(const DiffuseLight& diffuse) {
  std::vector<BandTexel> texels;
  texels.reserve(kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double elevation_rad =
        kLowest_rad + kRange_rad * static_cast<double>(i) / static_cast<double>(kNodes - 1);
    texels.push_back(TexelOf(Under(diffuse, elevation_rad)));
  }
  return texels;
}

// The sky's sectors do not lie symmetrically about the sun: the mean of both sides does.
std::vector<BandTexel> SeaMirror::Of(const OpenSky& sky, const DiffuseLight& diffuse,
                                     const Water& water, const glm::dvec3& to_sun) {
  const double mu_s = std::clamp(to_sun.z, -1.0, 1.0);
  const BandLight level = diffuse.SkyIrradiance(0.0, mu_s);
  const double flat = std::hypot(to_sun.x, to_sun.y);
  const glm::dvec3 sunward =
      flat > 1e-9 ? glm::dvec3(to_sun.x, to_sun.y, 0.0) / flat : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 aside(-sunward.y, sunward.x, 0.0);
  std::vector<BandTexel> texels;
  texels.reserve(kSide * kSide);
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    const double row = static_cast<double>(i / kSide) / static_cast<double>(kSide - 1);
    const double column = static_cast<double>(i % kSide) / static_cast<double>(kSide - 1);
    const double mu = std::max(row * row, 1e-6), sine = std::sqrt(1.0 - std::min(mu * mu, 1.0));
    const double along = 2.0 * column * column - 1.0;
    const double across = std::sqrt(std::max(1.0 - along * along, 0.0));
    const auto seen_from = [&](double side) {
      return Shown(sky, water, mu_s, sine * (along * sunward + side * across * aside) + mu * kUp);
    };
    BandLight both = 0.5F * (seen_from(1.0) + seen_from(-1.0));
    for (std::size_t band = 0; band < both.count; ++band)
      both[band] /= std::max(level[band], 1e-30F);
    texels.push_back(TexelOf(both));
  }
  return texels;
}

}  // namespace alpenglow::viewer
