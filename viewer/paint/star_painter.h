// SPDX-License-Identifier: MIT
// Stars and planets of a view as the squares of pixels that their light falls on: the renderer's
// bell (sky_pixels.h), which brings the same lux at every size.
//
// Stars and planets over the picture, as the renderer has them (night_light.h, sky_pixels.h):
// points whose lux does not depend on the size of the picture, through the air and behind land and
// moon. Their list is made on a thread beside drawing and turns with the sky until the next; by day
// there is none.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/sun/moon.h"
#include "renderer/light/night_light.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/job/latest_job.h"
#include "viewer/lamps/fog.h"
#include "viewer/paint/key_light.h"
#include "viewer/paint/painted_view.h"

namespace alpenglow::viewer {

/// As star.vert.glsl reads it, once a star.
struct StarPoint {
  glm::vec4 corner;      // lowest pixel, from the left and from below; the pixel of its middle
  glm::vec4 towards;     // unit, east, north, up at the eye
  glm::vec4 light;       // irradiance above the air by the solid angle of a pixel, one value a band
                         // [W m^-2 sr^-1 nm^-1]
  glm::vec4 across, up;  // shares of the first four columns and rows
  glm::vec4 last;        // and of the fifth of each
};

/// The stars as they stand over an eye.
struct StarrySky {
  const std::vector<StarLight>& lights;
  glm::dmat3 turn;      // from the directions of the lights to where they are now
  double faintest_lux;  // that is painted
  glm::dvec3 to_moon;   // unit, before what it hides
  double moon_radius_rad;
  const BentView* bent =
      nullptr;  // the air that lifted the lights; null: they are where they stand
};

/// Where a star of such a sky is seen, unit: its true direction turns, and where it is now the air
/// lifts it otherwise.
[[nodiscard]] glm::dvec3 TowardsStar(const StarLight& light, const StarrySky& sky);

/// Those that fall into the picture.
[[nodiscard]] std::vector<StarPoint> StarPointsIn(const PaintedView& view, const StarrySky& sky);

/// How the sky turns in a time: of directions east, north, up at a latitude.
[[nodiscard]] glm::dmat3 TurnOfSky(double latitude_rad, double seconds);

/// To be used on the thread of the context that is current when it is made.
class StarPainter {
 public:
  StarPainter();

  /// Once a frame: takes over what is ready and asks for what is missing. Never waits.
  void Follow(const PaintedView& view, const LightsOfSky& lights, const SolvedAir& air);
  /// The same, but the list of the very instant is there when it returns.
  void Settle(const PaintedView& view, const LightsOfSky& lights, const SolvedAir& air);

  /// Of the sky that they stand in, on a level plane; 0 by day.
  [[nodiscard]] double sky_lux() const { return sky_lux_; }
  /// Whether it is dark enough, and they are known.
  [[nodiscard]] bool HasAny() const { return sky_lux_ > 0.0 && made_; }
  /// Draws with their program, if nothing has yet: drivers finish it then, which takes tenths of a
  /// second.
  void MakeReady(const PaintedView& view, const SceneFog* fog, std::optional<PhaseKind> fog_phase);
  /// Pixels that they reach in a picture of a view.
  [[nodiscard]] std::vector<PixelBox> Seen(const PaintedView& view, const MoonDisk& moon) const;
  /// What tells where land hides them: the surface map, which has the size of the target, the pixel of a
  /// star's middle; or the depth of the target, whose test is on, each pixel.
  enum class Land { kBySurface, kByDepth };
  /// Adds them to the target that is bound. Surface map, air and blocks are bound.
  /// @param fog  null: none.
  void Paint(const PaintedView& view, const MoonDisk& moon, Land land, const SceneFog* fog,
             std::optional<PhaseKind> fog_phase);

 private:
  struct Request {
    GeodeticPosition place;
    UtcInstant now;
    std::shared_ptr<const BandColour> colour;
    Medium medium;  // that bends their light
  };
  struct Made {
    Request request;
    BentView bent;
    std::vector<StarLight> lights;
  };

  [[nodiscard]] bool IsNight(const PaintedView& view, const LightsOfSky& lights,
                             const SolvedAir& air);
  void Ask(const PaintedView& view, const Medium& medium);
  void Connect(const SceneFog* fog, std::optional<PhaseKind> fog_phase);
  [[nodiscard]] std::vector<StarPoint> PointsIn(const PaintedView& view,
                                                const MoonDisk& moon) const;
  void Draw(const std::vector<StarPoint>& points, const PaintedView& view, Land land) const;

  GlBuffer buffer_;
  GlVertexArray vertices_;
  std::optional<ShaderProgram> program_;  // made when it is drawn with first
  std::shared_ptr<const BandColour> colour_;
  double sky_lux_ = 0.0;  // of the sky that they stand in; 0: day
  std::optional<Request> asked_;
  std::optional<Made> made_;
  LatestJob<Request, Made> maker_;
};

}  // namespace alpenglow::viewer
