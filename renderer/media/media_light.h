// SPDX-License-Identifier: MIT
// Light of sun and sky in local media, and what they leave of it.
//
// In volumes light is scattered once: that of the sun, through the air (BentBeam), terrain's shadow, and every
// volume and the fog on its way; that of the sky by its moments (DiffuseLight) with the phase
// function, dimmed by the mean over 26 directions of what volumes leave of it. Light that a volume
// scatters again is left out. Columns towards the sun through a gridded volume
// are taken from a grid of at most 64 samples a side: 2 % of the sun's light, of turbulent smoke
// with as many samples itself.
//
// Of the scene's lamps the eight that are brightest at a volume light it, through air, fog and
// volumes (optical depths from a grid of at most 24 samples a side), shadowed by terrain.
//
// Fog is lit by sun and sky to all orders as a level layer (EddingtonSlab) over the lowest ground:
// the first order of the sun exact along the ray, its glow in fog only where terrain lets the sun
// in. Air, though it scatters in fog too, gets light as if there were no media; they cast no shafts
// of shade into it.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "renderer/lamp/lamp_light.h"
#include "renderer/light/lighting.h"
#include "renderer/media/local_media.h"
#include "renderer/media/media_march.h"
#include "renderer/shadow/sunlit_path.h"

namespace alpenglow::renderer {

/// Sky light on a surface within or over fog.
struct SkyThroughFog {
  BandLight left;   // of the irradiance that a clear sky would bring
  BandLight added;  // by the fog, per unit solar irradiance [1]
};

/// For one position of the sun. Immutable, safe to ask from many threads. Refers to geometry, air
/// diffuse light and lamps.
class MediaLight {
 public:
  /// @param lamps  that light volumes; null: none.
  MediaLight(LocalMedia media, const SceneGeometry& geometry, const SunlitAir& air,
             const Lighting& light, const LampLight* lamps = nullptr);
  ~MediaLight();

  [[nodiscard]] const LocalMedia& media() const;

  /// What media on a ray send to its origin, through the air.
  /// @param sunlit  where terrain lets the sun in; null: everywhere.
  [[nodiscard]] MarchedLight Along(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double length_m, const SunlitPath* sunlit,
                                   double tolerance = kMarchTolerance) const;

  /// What media leave of the sunlight that comes to a point from a direction.
  [[nodiscard]] BandLight SunLeft(const glm::dvec3& point, const glm::dvec3& to_sun) const;

  /// @param cos_up  between the surface's normal and the vertical.
  [[nodiscard]] SkyThroughFog SkyOnSurface(double altitude_m, double cos_up) const;

  struct State;  // of this file's own

 private:
  std::unique_ptr<State> state_;
};

/// What light from behind is dimmed by.
enum class Behind { kAll, kVolumes };

/// What of light from the air itself arrives, which is
/// scattered in front of media, in them, behind them.
///
/// @param upto  light of the air up to a distance, rising; @param whole  of the whole ray.
/// Exact in front and behind. Within stretches of media over which transmittance falls by 0.15 at
/// most, light is taken to rise evenly.
[[nodiscard]] BandLight DimmedByMedia(const std::vector<MarchedPiece>& pieces,
                                      const std::function<BandLight(double)>& upto,
                                      const BandLight& whole, Behind behind);

/// What volumes leave of light from a distance, to the ends of pieces.
[[nodiscard]] BandLight LeftByVolumes(const std::vector<MarchedPiece>& pieces, double distance_m,
                                      std::size_t bands);

}  // namespace alpenglow::renderer
