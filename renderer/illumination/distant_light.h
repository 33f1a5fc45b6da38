// SPDX-License-Identifier: MIT
// A light so distant that it shines everywhere from one direction: the sun or the moon, in the frame
// of its direction. Whatever lights something from afar is a list of these lights or is derived from
// one of them:
//
//   LocalLight   what one point receives of it, without shadows of terrain
//   Lighting     one of them with the scene that it lights (lighting.h)
//   EclipsedSun  what the moon leaves of the sun (lighting.h)
//   FrameLight   one of them with its shadows and its light in media, for one picture
//                (frame_context.h)
//
// Tables, terrain and media serve each of them alike, because the radiance of air lit from a direction
// is linear in the irradiance.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "atmosphere/astronomy/light_direction.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "renderer/layer.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

/// The distant sources of light.
enum class LightSource : std::size_t { kSun, kMoon };
inline constexpr std::size_t kLightSources = 2;

[[nodiscard]] constexpr std::size_t IndexOf(LightSource source) {
  return static_cast<std::size_t>(source);
}

struct DistantLight {
  LightSource body;
  LightDirection direction;  // of the visible centre of its disk
  double radius_rad;         // of the disk
  Spectrum irradiance;       // above the air, W m^-2 nm^-1
};

/// Returns the light of the sun in the frame east, north, up of the place that sees it.
[[nodiscard]] DistantLight SunlightOf(const SunInSky& apparent, const Medium& medium);

/// A distant light at a point, without shadows of terrain.
struct LocalLight {
  double altitude_m;
  glm::dvec3 up;
  double mu_s_for_air;      // zenith cosine of LightDirection::for_air: for skylight
  double visible_fraction;  // of the disk above the planet's horizon
  double mu_s_effective;    // zenith cosine of the visible part
};

/// Returns a direction to a point of a light's disk, drawn from the limb-darkened distribution of its
/// light. @param to_light  to its centre. @param sample  uniform in the unit square.
[[nodiscard]] glm::dvec3 TowardsDisk(const glm::dvec3& to_light, double radius_rad,
                                     std::array<double, 2> sample);

[[nodiscard]] LocalLight LocalLightAt(const SceneGeometry& geometry, const glm::dvec3& point,
                                      const DistantLight& light);

}  // namespace alpenglow::renderer
