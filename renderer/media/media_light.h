// SPDX-License-Identifier: MIT
// The light of sun, sky and lamps in all media of a scene, and the transmittance of the media.
//
// Each medium finds its own light (LitMedium). They share what reaches a point: sunlight through the
// air, the terrain's shadow, and every other medium on its path.
//
// Air scatters inside media too, but is lit as if there were none; media cast no shafts of shadow
// into the air.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/media/lit_medium.h"
#include "renderer/media/local_media.h"
#include "renderer/media/media_march.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

/// Light in local media for one position of the sun. Immutable, safe to use from many threads.
/// Refers to geometry, air, multiply scattered light and lamps.
class MediaLight {
 public:
  /// @param lamps, clouds  null: none.
  MediaLight(LocalMedia media, const SceneGeometry& geometry, const SolvedAir& air,
             const Lighting& light, const LampLight* lamps = nullptr,
             MediaEmission emission = MediaEmission::kOn, CloudsOverMedia clouds = nullptr);
  ~MediaLight();

  [[nodiscard]] const LocalMedia& media() const;

  /// Returns the light that media on a ray send to its origin, through the air.
  /// @param sunlit  stretches that terrain does not shade; null: the whole ray.
  [[nodiscard]] MarchedLight Along(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double length_m, const SunlitPath* sunlit,
                                   double tolerance = kMarchTolerance) const;

  /// Returns the transmittance of all media for sunlight that arrives at a point of the ground or the
  /// air: their shadow there. @param to_disk  as in LitMedium::AddDepthToLight.
  [[nodiscard]] Spectrum BeamLeft(const glm::dvec3& point, const glm::dvec3& to_disk) const;

  /// Returns the skylight on a surface.
  /// @param cos_up  between the surface's normal and the vertical. @param above  what arrives from
  ///     above all media.
  [[nodiscard]] SkyThroughMedia SkyOnSurface(double altitude_m, double cos_up,
                                             SkyThroughMedia above) const;

  /// Returns the irradiance that bodies that glow cause on a surface, through air and the other media
  /// [W m^-2 nm^-1]. @param normal, sees  see GlowField::On.
  [[nodiscard]] Spectrum GlowOnSurface(
      const glm::dvec3& point, const glm::dvec3& normal,
      const std::function<bool(const glm::dvec3& place)>& sees) const;
  /// Returns the middles of the bodies that glow.
  [[nodiscard]] std::vector<glm::dvec3> PlacesThatGlow() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::renderer
