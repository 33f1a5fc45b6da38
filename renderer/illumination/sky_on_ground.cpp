// SPDX-License-Identifier: MIT
#include "renderer/illumination/sky_on_ground.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/sky/sky_view.h"
#include "renderer/illumination/terrain_irradiance.h"
#include "renderer/material/band_light.h"

namespace alpenglow::renderer {
namespace {

const glm::dvec3 kUp(0.0, 0.0, 1.0);

BandTexel TexelOf(const BandLight& light) {
  BandTexel texel{};
  std::copy_n(light.value.begin(), light.count, texel.begin());
  return texel;
}

// Returns the rays that belong to a mirrored direction.
using Rays = std::function<MirroredRays(const glm::dvec3& direction)>;

// Returns the rays of waves whose mean surface mirrors a direction to the eye.
Rays WaveRays(const Water& water) {
  return [&water](const glm::dvec3& direction) {
    return water.Mirrored(kUp, {-direction.x, -direction.y, direction.z});
  };
}

// Returns the rays around a mirrored direction, with weights that add up to 1. The eye sees the
// surface at 45 degrees, in the vertical plane of the direction.
Rays LobeRays(const Glossy& glossy) {
  return [&glossy](const glm::dvec3& direction) {
    const glm::dvec3 across = std::hypot(direction.x, direction.y) > 1e-6
                                  ? glm::normalize(glm::dvec3(-direction.y, direction.x, 0.0))
                                  : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 to_eye = glm::cross(across, direction);
    MirroredRays rays = glossy.Mirrored(glm::normalize(direction + to_eye), to_eye);
    const double total = rays.TotalWeight();
    for (std::size_t i = 0; i < rays.count; ++i) rays.rays[i].weight /= std::max(total, 1e-12);
    return rays;
  };
}

/// Tabulates the rays of one surface.
class MirrorTable {
 public:
  MirrorTable(const OccludedSkyIrradiance& sky, const BandLight& level, double mu_s,
              std::array<double, GlossMirror::kAltitudes> altitudes_m)
      : sky_(sky), level_(level), mu_s_(mu_s), altitudes_m_(altitudes_m) {
    for (std::size_t i = 0; i < kHorizons; ++i)
      horizons_[i] = GlossMirror::HorizonAt(static_cast<double>(i) / (kHorizons - 1));
  }

  // The sectors of the sky are not symmetric about the sun, so the mean of both sides is used.
  [[nodiscard]] std::vector<BandTexel> Of(const Rays& rays, const glm::dvec3& sunward) {
    texels_.assign(GlossMirror::kLayers * kSide * kSide, {});
    const glm::dvec3 aside(-sunward.y, sunward.x, 0.0);
    for (std::size_t row = 0; row < kSide; ++row) {
      const double root = static_cast<double>(row) / (kSide - 1);
      const double mu = std::max(root * root, 1e-6), sine = std::sqrt(1.0 - std::min(mu * mu, 1.0));
      for (std::size_t column = 0; column < kSide; ++column) {
        const double place = static_cast<double>(column) / (kSide - 1);
        const double along = 1.0 - 2.0 * place * place;
        const double across = std::sqrt(std::max(1.0 - along * along, 0.0));
        for (const double side : {across, -across})
          AddSky(rays(sine * (along * sunward + side * aside) + mu * kUp), row * kSide + column);
      }
      AddBlocked(rays(sine * sunward + mu * kUp), row * kSide);
    }
    return std::move(texels_);
  }

 private:
  static constexpr std::size_t kSide = GlossMirror::kSide, kHorizons = GlossMirror::kHorizons;

  // Adds half of the sky above each horizon.
  void AddSky(const MirroredRays& rays, std::size_t texel) {
    for (const MirroredRay& ray : rays.All()) {
      for (std::size_t altitude = 0; altitude < altitudes_m_.size(); ++altitude) {
        const BandLight sky = sky_.Radiance(altitudes_m_[altitude], mu_s_, ray.direction);
        for (std::size_t i = 0; i < kHorizons; ++i) {
          const auto open = static_cast<float>(
              0.5 * ray.weight * (1.0 - GroundShare(ray.direction.z, ray.spread, horizons_[i])));
          BandTexel& into = texels_[(altitude * kHorizons + i) * kSide * kSide + texel];
          for (std::size_t band = 0; band < sky.count; ++band)
            into[band] += open * sky[band] / std::max(level_[band], 1e-30F);
        }
      }
    }
  }

  void AddBlocked(const MirroredRays& rays, std::size_t row) {
    BandTexel* const into = &texels_[(GlossMirror::kLayers - 1) * kSide * kSide + row];
    for (std::size_t i = 0; i < kSide; ++i) {
      const double horizon = GlossMirror::HorizonAt(static_cast<double>(i) / (kSide - 1));
      for (const MirroredRay& ray : rays.All())
        into[i][0] +=
            static_cast<float>(ray.weight * GroundShare(ray.direction.z, ray.spread, horizon));
    }
  }

  const OccludedSkyIrradiance& sky_;
  const BandLight& level_;
  double mu_s_;
  std::array<double, GlossMirror::kAltitudes> altitudes_m_;
  std::array<double, kHorizons> horizons_{};
  std::vector<BandTexel> texels_;
};

}  // namespace

BandLight LevelSky::Under(const MultipleScattering& multiple_scattering, double sun_elevation_rad) {
  return multiple_scattering.SkyIrradiance(0.0, std::sin(std::max(sun_elevation_rad, kLowest_rad)));
}

std::vector<BandTexel> LevelSky::Of(const MultipleScattering& multiple_scattering) {
  std::vector<BandTexel> texels;
  texels.reserve(kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double elevation_rad =
        kLowest_rad + kRange_rad * static_cast<double>(i) / static_cast<double>(kNodes - 1);
    texels.push_back(TexelOf(Under(multiple_scattering, elevation_rad)));
  }
  return texels;
}

double GlossMirror::HorizonAt(double share) {
  const auto lowest = static_cast<double>(HorizonMap::kLowest);
  return lowest + (1.0 - lowest) * share * share;
}

GlossMirror GlossMirror::Of(const OccludedSkyIrradiance& sky,
                            const MultipleScattering& multiple_scattering, const Surfaces& surfaces,
                            const glm::dvec3& to_light, double lower_altitude_m,
                            double higher_altitude_m) {
  const double mu_s = std::clamp(to_light.z, -1.0, 1.0);
  const BandLight level = multiple_scattering.SkyIrradiance(0.0, mu_s);
  const double flat = std::hypot(to_light.x, to_light.y);
  const glm::dvec3 sunward =
      flat > 1e-9 ? glm::dvec3(to_light.x, to_light.y, 0.0) / flat : glm::dvec3(1.0, 0.0, 0.0);
  MirrorTable table(sky, level, mu_s, {lower_altitude_m, higher_altitude_m});
  GlossMirror mirror{{}, {}, lower_altitude_m, higher_altitude_m};
  if (surfaces.water != nullptr) mirror.waves = table.Of(WaveRays(*surfaces.water), sunward);
  if (surfaces.land != nullptr) mirror.land = table.Of(LobeRays(*surfaces.land), sunward);
  return mirror;
}

namespace {

// A coarse table of the sky is sufficient, because only means over half of the sky are computed
// from it.
constexpr SkyViewSize kCoarseSky{.sky_rows = 20, .ground_rows = 5, .azimuths = 9, .ray_nodes = 8};
constexpr std::size_t kSkyRows = 48;     // equal steps in the sine of the elevation
constexpr std::size_t kSkyColumns = 24;  // over half a turn from the azimuth of the sun

/// A part of the sky on one side of the sun, and its mirror image on the other side.
struct SkyPart {
  glm::vec3 towards, mirrored;  // unit: towards the sun, to its side, upwards
  std::array<float, 4> light;   // radiance times solid angle
};

std::vector<SkyPart> PartsOf(const SkyView& sky) {
  constexpr auto kSolidAngle = static_cast<float>(kPi / (kSkyRows * kSkyColumns));
  std::vector<double> azimuths;
  for (std::size_t i = 0; i < kSkyColumns; ++i)
    azimuths.push_back(kPi * (static_cast<double>(i) + 0.5) / kSkyColumns);
  const SkyAzimuths columns(sky, azimuths);
  std::vector<float> radiance(kSkyColumns * sky.stride());
  std::vector<SkyPart> parts;
  for (std::size_t row = 0; row < kSkyRows; ++row) {
    const double z = (static_cast<double>(row) + 0.5) / kSkyRows, flat = std::sqrt(1.0 - z * z);
    sky.FillRow(std::acos(z), columns, radiance);
    for (std::size_t column = 0; column < kSkyColumns; ++column) {
      const double x = flat * std::cos(azimuths[column]), y = flat * std::sin(azimuths[column]);
      SkyPart part{{x, y, z}, {x, -y, z}, {}};
      for (std::size_t band = 0; band < sky.bands(); ++band)
        part.light[band] = kSolidAngle * radiance[column * sky.stride() + band];
      parts.push_back(part);
    }
  }
  return parts;
}

std::array<float, 4> IrradianceOn(const std::vector<SkyPart>& parts, const glm::vec3& normal) {
  std::array<float, 4> sum{};
  for (const SkyPart& part : parts) {
    const float falls = std::max(glm::dot(normal, part.towards), 0.0F) +
                        std::max(glm::dot(normal, part.mirrored), 0.0F);
    for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += falls * part.light[band];
  }
  return sum;
}

// Returns the irradiance on the slope with these components of the normal. Beyond all slopes it
// extrapolates the trend at the rim.
std::array<float, 4> NodeAt(const std::vector<SkyPart>& parts, float sunward, float up) {
  const float radius = std::hypot(sunward, up);
  const auto at = [&](float share) {
    const float x = share * sunward, z = share * up;
    return IrradianceOn(parts, {x, std::sqrt(std::max(1.0F - x * x - z * z, 0.0F)), z});
  };
  if (radius <= 1.0F) return at(1.0F);
  constexpr float kInside = 0.9F, kLeast = 0.1F;
  const std::array<float, 4> rim = at(1.0F / radius), inside = at(kInside / radius);
  std::array<float, 4> beyond{};
  for (std::size_t band = 0; band < beyond.size(); ++band)
    beyond[band] =
        std::max(rim[band] + (radius - 1.0F) / (1.0F - kInside) * (rim[band] - inside[band]),
                 kLeast * rim[band]);
  return beyond;
}

}  // namespace

SkyIrradianceGradient::SkyIrradianceGradient(const SingleScattering<float>& air,
                                             const MultipleScattering& multiple_scattering,
                                             double altitude_m, double mu_s) {
  ALPENGLOW_ENSURE(air.bands(), <=, std::size_t{4});
  const std::vector<SkyPart> parts =
      PartsOf(SkyView(air, multiple_scattering, altitude_m, mu_s, kCoarseSky));
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const float sunward = static_cast<float>(column) / 4.0F - 1.0F;
      nodes[row * kColumns + column] = NodeAt(parts, sunward, static_cast<float>(row) / 4.0F);
    }
  }
}

std::array<float, 4> SkyIrradianceGradient::On(double n_up, double n_sunward) const {
  const auto u = static_cast<float>(shared::UnoccludedSkyColumn(n_sunward));
  const auto v = static_cast<float>(shared::UnoccludedSkyRow(n_up));
  const auto column = std::min(static_cast<std::size_t>(u), kColumns - 2);
  const auto row = std::min(static_cast<std::size_t>(v), kRows - 2);
  const float right = u - static_cast<float>(column), above = v - static_cast<float>(row);
  const auto* low = &nodes[row * kColumns + column];
  const auto* high = low + kColumns;
  std::array<float, 4> light{};
  for (std::size_t band = 0; band < light.size(); ++band)
    light[band] = std::lerp(std::lerp(low[0][band], low[1][band], right),
                            std::lerp(high[0][band], high[1][band], right), above);
  return light;
}

}  // namespace alpenglow::renderer
