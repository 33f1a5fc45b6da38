// SPDX-License-Identifier: MIT
#include "renderer/illumination/gloss_mirror.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/illumination/terrain_irradiance.h"

namespace alpenglow::renderer {
namespace {

const glm::dvec3 kUp(0.0, 0.0, 1.0);

BandTexel TexelOf(const Spectrum& light) {
  BandTexel texel{};
  std::ranges::copy(light.values(), texel.begin());
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
  MirrorTable(const OccludedSkyIrradiance& sky, const Spectrum& level, double mu_s,
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
        const Spectrum sky = sky_.Radiance(altitudes_m_[altitude], mu_s_, ray.direction);
        for (std::size_t i = 0; i < kHorizons; ++i) {
          const auto open = static_cast<float>(
              0.5 * ray.weight * (1.0 - GroundShare(ray.direction.z, ray.spread, horizons_[i])));
          BandTexel& into = texels_[(altitude * kHorizons + i) * kSide * kSide + texel];
          for (std::size_t band = 0; band < sky.size(); ++band)
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
  const Spectrum& level_;
  double mu_s_;
  std::array<double, GlossMirror::kAltitudes> altitudes_m_;
  std::array<double, kHorizons> horizons_{};
  std::vector<BandTexel> texels_;
};

}  // namespace

Spectrum LevelSky::Under(const MultipleScattering& multiple_scattering, double sun_elevation_rad) {
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
  const Spectrum level = multiple_scattering.SkyIrradiance(0.0, mu_s);
  const double flat = std::hypot(to_light.x, to_light.y);
  const glm::dvec3 sunward =
      flat > 1e-9 ? glm::dvec3(to_light.x, to_light.y, 0.0) / flat : glm::dvec3(1.0, 0.0, 0.0);
  MirrorTable table(sky, level, mu_s, {lower_altitude_m, higher_altitude_m});
  GlossMirror mirror{{}, {}, lower_altitude_m, higher_altitude_m};
  if (surfaces.water != nullptr) mirror.waves = table.Of(WaveRays(*surfaces.water), sunward);
  if (surfaces.land != nullptr) mirror.land = table.Of(LobeRays(*surfaces.land), sunward);
  return mirror;
}

}  // namespace alpenglow::renderer
