// SPDX-License-Identifier: MIT
// A site of rough mountains under an earthly sky, for tests of the light on it.
#pragma once

#include <filesystem>
#include <memory>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/lit_ground/lit_ground.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/small_light.h"

namespace alpenglow::tests {

using namespace renderer;

inline constexpr Place kRoughPlace{46.5, 8.0, 0.0};

/// The medium without the molecules, which bend rays.
inline Medium Unbending(Medium medium) {
  medium.rayleigh_scattering_per_m.assign(medium.wavelengths_nm.size(), 0.0);
  return medium;
}

/// 7.7 km of RoughLand. The sun's beam on it comes along straight rays, as SunInClosedForm has it.
/// @param colours, land_cover  a picture over it, or nothing.
inline std::shared_ptr<const GroundSite> RoughSite(const GroundCover& cover = {},
                                                   const std::filesystem::path& colours = {},
                                                   const std::filesystem::path& land_cover = {}) {
  const Medium medium = OnOsculatingSphere(MediumPreset("earth"), kRoughPlace.latitude_rad());
  SolvedAir air(SingleScattering<float>(medium), RefractedBeam(Unbending(medium)),
                MultipleScattering(medium, kSmallLight));
  SceneGround ground{LocalFrame(kWgs84, kRoughPlace), Terrain(LandMesh(RoughLand, 129, 60.0)), 0.0,
                     "", true};
  Scene scene;
  scene.terrain.colour = colours;
  scene.terrain.land_cover = land_cover;
  auto drape = ColourDrape::Of(scene, ground);
  return std::make_shared<const GroundSite>(std::move(ground), cover, std::move(drape),
                                            std::move(air));
}

inline std::array<float, 3> InFloats(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

inline GroundVertex VertexAt(const GroundSite& site, const glm::dvec3& point,
                             const glm::dvec3& normal) {
  return site.Vertex(InFloats(point), InFloats(normal));
}

/// The sun in the south-west, in midsummer.
inline Lighting RoughSun(const GroundSite& site, double elevation_deg) {
  SunInSky sun{};
  sun.elevation_deg = elevation_deg;
  sun.azimuth_deg = 220.0;
  sun.angular_radius_deg = 0.00465 / kRadiansPerDegree;
  sun.distance_au = 1.0;
  return LightingOf(sun, ParseInstant("2026-06-21T12:00:00Z"), kRoughPlace, site.medium());
}

}  // namespace alpenglow::tests
