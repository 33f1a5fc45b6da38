// SPDX-License-Identifier: MIT
// This header computes the light of sun, sky and lamps in local media (volumes and fog), and the
// transmittance of local media.
//
// Volumes scatter light once. Sunlight arrives through the air (RefractedBeam), the terrain's
// shadow, and every volume and the fog on its path. Skylight is given by its moments
// (MultipleScattering) and the phase function, and attenuated by the mean transmittance of the
// volumes over 26 directions. Light that a volume scatters again is neglected. Columns towards the
// sun through a gridded volume are taken from a grid of at most 64 samples per side; the error is 2
// % of the sun's light in turbulent smoke with as many samples itself.
//
// The eight lamps of the scene that are brightest at a volume light it, through air, fog and
// volumes (optical depths are from a grid of at most 24 samples per side), shadowed by terrain.
//
// Fog is lit by sun and sky to all orders as a level layer (EddingtonSlab) over the lowest ground.
// The first order of the sun is exact along the ray; its glow in fog is present only where terrain
// lets the sun in. Air scatters inside fog too, but is lit as if there were no media; media cast no
// shafts of shadow into the air.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "renderer/illumination/lighting.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/media/local_media.h"
#include "renderer/media/media_march.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

/// Skylight on a surface inside or above fog.
struct SkyThroughFog {
  BandLight left;   // fraction of the irradiance from a clear sky
  BandLight added;  // irradiance from the fog, per unit solar irradiance [1]
};

/// Light in local media for one position of the sun. Immutable, safe to use from many threads.
/// Refers to geometry, air, multiply scattered light and lamps.
class MediaLight {
 public:
  /// @param lamps  light volumes; null: none.
  MediaLight(LocalMedia media, const SceneGeometry& geometry, const SunlitAir& air,
             const Lighting& light, const LampLight* lamps = nullptr);
  ~MediaLight();

  [[nodiscard]] const LocalMedia& media() const;

  /// Returns the light that media on a ray send to its origin, through the air.
  /// @param sunlit  stretches that terrain does not shade; null: the whole ray.
  [[nodiscard]] MarchedLight Along(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double length_m, const SunlitPath* sunlit,
                                   double tolerance = kMarchTolerance) const;

  /// Returns the transmittance of media for sunlight that arrives at a point from a direction.
  [[nodiscard]] BandLight SunLeft(const glm::dvec3& point, const glm::dvec3& to_sun) const;

  /// Returns the skylight on a surface.
  /// @param cos_up  between the surface's normal and the vertical.
  [[nodiscard]] SkyThroughFog SkyOnSurface(double altitude_m, double cos_up) const;

  struct State;  // defined in the source file

 private:
  std::unique_ptr<State> state_;
};

/// Media that attenuate light from behind them.
enum class Behind { kAll, kVolumes };

/// Returns the light of the air itself that arrives through media; it is scattered in front of
/// them, inside and behind them. The result is exact in front of and behind media. Within stretches
/// of media over which transmittance falls by 0.15 at most, light is assumed to increase linearly.
/// @param upto  light of the air up to a distance, increasing.
/// @param whole  of the whole ray.
[[nodiscard]] BandLight DimmedByMedia(const std::vector<MarchedPiece>& pieces,
                                      const std::function<BandLight(double)>& upto,
                                      const BandLight& whole, Behind behind);

/// Returns the transmittance of volumes over a distance, up to the ends of pieces.
[[nodiscard]] BandLight LeftByVolumes(const std::vector<MarchedPiece>& pieces, double distance_m,
                                      std::size_t bands);

}  // namespace alpenglow::renderer
