// SPDX-License-Identifier: MIT
// The light of the night sky: airglow, zodiacal light and faint stars behind the atmosphere, their
// scattered light, and their light on the ground. It is the renderer's NightLight as a map of the
// sky, made on a worker thread, and used where sun and moon contribute less than 10 lux, over towns
// less than 1000 lux.
#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/camera_tables/air_tables.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/layer.h"
#include "viewer/passes/painted_view.h"

namespace alpenglow::viewer {

/// Sky radiance and irradiance by night, one value per band.
struct NightSkyMap {
  /// Columns are azimuths from north through east, rows are elevations from the nadir upwards, at
  /// texel centres.
  static constexpr int kColumns = 256, kRows = 128;

  std::vector<glm::vec4> above;  // radiance above the atmosphere, row by row [W m^-2 sr^-1 nm^-1]
  glm::vec4 scattered;           // NightLight::scattered
  glm::vec4 level;               // irradiance of level ground [W m^-2 nm^-1]
};

/// Light pollution of the scene.
struct SceneSkyglow {
  std::optional<double> zenith = std::nullopt;  // Scene::town_zenith
  double ground_m = 0.0;                        // height of that ground over the ellipsoid, >= 0
};

[[nodiscard]] NightSkyMap NightSkyMapOver(const Place& eye, const UtcTime& now,
                                          const Medium& medium, const BandColour& colour,
                                          const SceneSkyglow& towns = {});

/// Keeps the map up to date. Must be used on the thread whose OpenGL context is current at
/// construction.
class NightSkyMapFollower {
 public:
  explicit NightSkyMapFollower(const SceneSkyglow& towns);

  /// Takes over a finished map and requests a new one if needed. Call it once per frame.
  /// @param waits  whether to wait for the map of exactly this instant.
  void Follow(const PaintedView& view, const std::shared_ptr<const SolvedAir>& air, bool waits);
  [[nodiscard]] bool HasAny() const { return has_map_; }
  /// Binds the map to a texture unit.
  void Bind(int unit) const { BindTexture(unit, GL_TEXTURE_2D, map_); }
  /// Returns NightSkyMap::scattered and level of the map.
  [[nodiscard]] const glm::vec4& scattered() const { return scattered_; }
  [[nodiscard]] const glm::vec4& level() const { return level_; }

 private:
  struct Request {
    Place place;
    UtcTime now;
    std::shared_ptr<const SolvedAir> air;
  };

  [[nodiscard]] static bool Suits(const Request& requested, const Request& wanted);
  void Poll(int unit);

  GlTexture map_;
  glm::vec4 scattered_{0.0F}, level_{0.0F};
  bool has_map_ = false;
  AsyncValue<Request, NightSkyMap> maker_;
};

}  // namespace alpenglow::viewer
