// SPDX-License-Identifier: MIT
// Keeps the irradiance of the unoccluded sky on slopes up to date while sun or moon move.
//
// A table takes milliseconds, so a thread beside drawing computes tables for elevations that are a
// step apart, and the next one in the direction of the motion. Drawing interpolates between them,
// geometrically, because the light of dusk decreases by a factor per degree.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/sky_irradiance_gradient.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// The values that the irradiance of an unoccluded sky depends on.
struct OpenSky {
  std::shared_ptr<const SolvedAir> air;
  double altitude_m,
      elevation_rad;  // of the ground; of the light whose straight rays light the air

  bool operator==(const OpenSky&) const = default;
};

class OpenSkyFollower {
 public:
  /// Step of the elevations for which tables are computed. Between them the irradiance of slopes
  /// is within 0.3 % of that of a table, while it is above a millionth of daylight
  /// (OpenSkyFollower.InterpolatedLightEqualsThatOfATable).
  static constexpr double kStep_rad = 3e-3;

  using Make = std::function<SkyIrradianceGradient(const OpenSky&)>;
  /// @param make  computes a table; called on the thread of this object too.
  explicit OpenSkyFollower(Make make = LightOf);

  /// Adapts the light to a sky. It computes a table on the calling thread only if the thread of
  /// this object has not finished the two tables around the elevation: at first, for another
  /// medium or altitude, and while the light rises or sinks by more than a step from call to call.
  void Follow(const OpenSky& sky);
  /// Computes the light of exactly this sky.
  void WaitUntilReady(const OpenSky& sky);

  /// Returns the light of the last call.
  [[nodiscard]] const SkyIrradianceGradient& light() const { return *light_; }

  [[nodiscard]] static SkyIrradianceGradient LightOf(const OpenSky& sky);

 private:
  struct Made {
    OpenSky sky;
    SkyIrradianceGradient light;
  };
  [[nodiscard]] const SkyIrradianceGradient* TableOf(const OpenSky& sky) const;
  void TakeOver(const OpenSky& sky);
  void RequestMissing(const OpenSky& sky, int below);
  void FollowExactly(const OpenSky& sky);

  Make make_;
  std::vector<Made> tables_;  // of one medium and altitude
  std::optional<OpenSky> shown_;
  std::optional<SkyIrradianceGradient> light_;
  bool is_exact_ = false;  // whether light_ is that of a table for shown_
  bool sinks_ = false;     // direction of the last motion of the light
  AsyncValue<OpenSky, Made> maker_;
};

}  // namespace alpenglow::viewer
