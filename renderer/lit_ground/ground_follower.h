// SPDX-License-Identifier: MIT
// GroundFollower updates the light on the land (LitGround) for a moving sun and for an eye that
// reaches other land. All of it is computed on a thread beside drawing.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "atmosphere/base/async_value.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/gloss_mirror.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/sky_irradiance_gradient.h"
#include "renderer/lit_ground/lit_ground.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/colour_drape.h"
#include "renderer/terrain/land_chunk.h"
#include "renderer/terrain/loaded_heights.h"

namespace alpenglow::renderer {

/// Extent of the land whose light is computed. It contains the land that rises above its own
/// valleys and, for a high eye, the land that is clearly visible.
struct GroundExtent {
  double half_width_m = 40e3;
  int samples = 1024;  // maximum per side

  /// Returns the half width [m] for an eye at a height above the ellipsoid: at least 7 times the
  /// height, which includes land that is seen 8 degrees below the horizon, but at most four times
  /// half_width_m, so that samples are not too far apart. The width is doubled in steps, so that a
  /// climbing eye needs other land only twice.
  [[nodiscard]] double HalfWidthUnder(double height_m) const;
};

class GroundFollower {
 public:
  /// @param cover, drape  material of the land.
  GroundFollower(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                 const GroundExtent& extent);

  /// Removes the land and its light.
  void ForgetLand();
  /// Sets other or additional land, as ShadeFollower does. An empty function removes it.
  void SetGround(GroundSampler sampler);

  struct View {
    Place eye;
    UtcTime now;
    DistantLight by;  // that casts the shadows; in the frame east, north, up of the eye
    std::optional<DistantLight> other = std::nullopt;  // if it is significant
  };
  /// Takes finished light and requests missing light. Call it once a frame. After each computation
  /// it pauses for four times the computation time to keep the CPU free for drawing. While the sun
  /// moves, light is computed for the position of the sun in the middle of its display period, and
  /// is blended from one state to the next. Returns whether there is new light.
  /// @param seconds  since the last call.
  bool Follow(const std::shared_ptr<const SolvedAir>& air, const View& view, double seconds);
  /// Waits until the final light of Follow is available.
  bool WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const View& view);

  /// Returns the light of the shadow-casting source on the surrounding land; null without land and
  /// before the first light is complete.
  [[nodiscard]] const std::shared_ptr<const LitGround>& lit() const { return made_.lit; }
  /// Returns the source that casts the shadows of lit().
  [[nodiscard]] LightSource casts() const { return made_.casts; }
  /// The sky of a source over the land of lit(), and the light of the open sky for which it was
  /// computed. SkyOf returns nullopt without lit() and for a source that was not significant.
  struct SkyOfSource {
    std::shared_ptr<const GroundSky> sky;
    SkyIrradianceGradient open;
  };
  [[nodiscard]] std::optional<SkyOfSource> SkyOf(LightSource source) const;
  /// Returns a function for the light of vertices in the frame of any anchor; nullopt without
  /// lit().
  [[nodiscard]] std::optional<LightOfVertices> Light() const;
  /// Returns the sky of a source as mirrored by waves and land; empty if nothing mirrors and for a
  /// source that was not significant.
  [[nodiscard]] const GlossMirror& gloss_mirror(LightSource source) const {
    return made_.gloss_mirrors[IndexOf(source)];
  }
  /// Returns the altitude of the open sky to which the light of vertices is relative: half the
  /// height of the land.
  [[nodiscard]] double open_altitude_m() const { return made_.open_altitude_m; }
  /// Returns the computation time of the light, without the horizons of the land; 0 before the
  /// first.
  [[nodiscard]] double making_s() const { return made_.making_s; }

 private:
  struct Request {
    std::shared_ptr<const SolvedAir> air;
    std::shared_ptr<const GroundSampler> ground;
    View view;
    int land;  // incremented when land is removed
  };
  struct Made {
    LightSource casts = LightSource::kSun;
    std::shared_ptr<const LitGround> lit;
    std::shared_ptr<const GroundSky> other;                 // null: it is not significant
    std::optional<SkyIrradianceGradient> open, other_open;  // light of the open sky of each source
    std::array<GlossMirror, kLightSources> gloss_mirrors;
    double open_altitude_m = 0.0;
    double making_s = 0.0;
    int land = 0;
  };
  class Maker;
  [[nodiscard]] static bool Suits(const GroundExtent& extent, const Request& requested,
                                  const Request& wanted);
  [[nodiscard]] View WhenShown(const View& view, double seconds) const;
  bool Poll();

  std::shared_ptr<const GroundSampler> ground_;
  int land_ = 0;
  std::optional<View> last_view_;
  Made made_;
  AsyncValue<Request, Made> maker_;
};

/// Returns the view with the sources of light moved on by `steps` times their motion from `before`
/// to `now`, at most 10 degrees. After a jump of time it returns `now`.
[[nodiscard]] GroundFollower::View Ahead(const GroundFollower::View& before,
                                         const GroundFollower::View& now, double steps);

}  // namespace alpenglow::renderer
