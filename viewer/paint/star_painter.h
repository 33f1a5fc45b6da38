// SPDX-License-Identifier: MIT
// Stars and planets over the picture, as the renderer has them (star_lights.h, star_pixels.h):
// points whose lux does not depend on the size of the picture, through the air and behind land and
// moon. Their list is made on a thread beside drawing and turns with the sky until the next; by day
// there is none.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/sun/moon_disk.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/scissor.h"
#include "viewer/gl/shader.h"
#include "viewer/job/latest_job.h"
#include "viewer/lamps/scene_fog.h"
#include "viewer/paint/key_light.h"
#include "viewer/paint/star_points.h"

namespace alpenglow::viewer {

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
