// SPDX-License-Identifier: MIT
// Airglow, zodiacal light and faint stars behind the air, what the air scatters of them, and their
// light on the ground: the renderer's NightLight as a map of the sky, made on a thread beside drawing.
// Where sun and moon bring less than 10 lux.
#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/job/latest_job.h"
#include "viewer/paint/painted_view.h"

namespace alpenglow::viewer {

/// One value a band.
struct NightFloor {
  /// Columns of azimuth from north over east, rows of elevation from the nadir up, in the middle of
  /// texels.
  static constexpr int kColumns = 256, kRows = 128;

  std::vector<glm::vec4> above;  // from above the air, row by row [W m^-2 sr^-1 nm^-1]
  glm::vec4 scattered;           // NightLight::scattered
  glm::vec4 level;               // on level ground [W m^-2 nm^-1]
};

/// Lamps of towns, as the scene has them.
struct TownsOfScene {
  std::optional<double> zenith = std::nullopt;  // Scene::town_zenith
  double ground_m = 0.0;                        // where that is, over the ellipsoid, >= 0
};

[[nodiscard]] NightFloor NightFloorOver(const GeodeticPosition& eye, const UtcInstant& now,
                                        const Medium& medium, const BandColour& colour,
                                        const TownsOfScene& towns = {});

/// To be used on the thread of the context that is current when it is made.
class NightFloorFollower {
 public:
  explicit NightFloorFollower(const TownsOfScene& towns);

  /// Once a frame: takes over what is ready and asks for what is missing.
  /// @param waits   until the map of the very instant is there.
  void Follow(const PaintedView& view, const std::shared_ptr<const SolvedAir>& air, bool waits);
  [[nodiscard]] bool HasAny() const { return has_map_; }
  /// For the next draw of a program of the night pass of picture.frag.glsl.
  void Bind(const ShaderProgram& program, int unit) const;

 private:
  struct Request {
    GeodeticPosition place;
    UtcInstant now;
    std::shared_ptr<const SolvedAir> air;
  };

  [[nodiscard]] bool Suits(const Request& wanted) const;
  void Take(int unit);

  GlTexture map_;
  glm::vec4 scattered_{0.0F}, level_{0.0F};
  bool has_map_ = false;
  std::optional<Request> asked_;
  LatestJob<Request, NightFloor> maker_;
};

}  // namespace alpenglow::viewer
