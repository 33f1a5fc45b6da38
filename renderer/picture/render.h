// SPDX-License-Identifier: MIT
// Pictures of a scene: terrain, sky, sun disk, lamps, and the air in front of everything.
//
// Frame: ENU at the foot of the eye on the ellipsoid. The atmosphere is a shell on the sphere that
// osculates the ellipsoid there, so the altitude of a point is its distance from that sphere. The
// sun stands where refraction shows it: disk, light on the ground and light in the air use the
// same, apparent direction. Where the effect of refraction shows, the disk and the horizon of a sea
// without terrain are those of bent rays instead (BentSight).
//
// Per pixel: rays against the terrain, spread as PixelFilter and PixelSamples say (a single one
// goes through the middle; with RenderSettings::noise, as many as pixel_noise.h says), then the air
// along the mean of those that meet the same surface (AerialPerspective): single scattering where
// terrain and planet let the sun in, light of higher orders everywhere. Terrain behind the planet's
// own horizon is not seen.
#pragma once

#include <memory>
#include <string>

#include "atmosphere/sun/sun.h"
#include "lut/picture/image.h"
#include "renderer/effect/effect_choice.h"
#include "renderer/picture/pixel_writer.h"
#include "renderer/picture/render_settings.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

struct SceneGround;
struct SceneState;

/// A picture, and the rays that it took.
struct CountedPicture {
  Image image;
  RayCount rays;
};

/// A picture of what a scene needs.
struct ChosenPicture {
  Image image;
  RayCount rays;
  EffectChoice choice;
};

/// A scene ready to be rendered at any time: terrain
/// loaded, light of higher orders solved. Immutable.
class SceneRenderer {
 public:
  /// Throws InputError for what the scene names and cannot be read, or an eye below the ground.
  /// @param progress  told what is prepared, if not null; not kept.
  explicit SceneRenderer(const Scene& scene, Progress* progress = nullptr);
  /// On ground that is there already, in the frame of the scene's place, instead of the scene's own.
  SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground);
  ~SceneRenderer();

  /// Linear sRGB in cd/m^2. The same bytes for any number of threads. Throws InputError for a size
  /// out of [1, 16384] and an eye that cannot be where it is, RenderingStopped when
  /// settings.stop asks for it; stops early when Interrupted().
  [[nodiscard]] Image Render(const Shot& shot, const RenderSettings& settings) const;
  [[nodiscard]] CountedPicture RenderCounted(const Shot& shot,
                                             const RenderSettings& settings) const;

  /// Render() with those of settings.effects that the picture needs (effect_choice.h). The choice
  /// is the same for any number of threads; the times in it are this run's.
  [[nodiscard]] ChosenPicture RenderWithin(const Shot& shot, const RenderSettings& settings,
                                           const EffectBudget& budget) const;

  /// Of sun and sky on a horizontal plane at the eye, terrain aside [lux].
  [[nodiscard]] double Illuminance(const Shot& shot) const;

  /// The sun from the eye with refraction: where the picture shows it.
  [[nodiscard]] SunPosition ApparentSun(const Shot& shot) const;

  /// The medium on the osculating sphere.
  [[nodiscard]] const Medium& medium() const;
  /// Height of the eye over the ellipsoid [m].
  [[nodiscard]] double eye_height_m() const;
  /// What loading the terrain has to tell (voids found and filled), empty if nothing.
  [[nodiscard]] const std::string& terrain_message() const;

 private:
  std::unique_ptr<SceneState> state_;
};

}  // namespace alpenglow::renderer
