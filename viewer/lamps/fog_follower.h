// SPDX-License-Identifier: MIT
// Keeps the map of a scene's fog up with eye and sun, made on a thread beside drawing.
#pragma once

#include <memory>
#include <optional>

#include "renderer/media/local_media.h"
#include "viewer/air/solved_air.h"
#include "viewer/lamps/fog_map.h"
#include "viewer/lamps/fog_painter.h"
#include "viewer/work/latest_job.h"

namespace alpenglow {

class FogFollower {
 public:
  /// @param media  with fog.
  FogFollower(LocalMedia media, const FogUnits& units);

  void Connect(const ShaderProgram& program) const { painter_.Connect(program); }
  /// Once a frame: takes a map that is ready, asks for one when the eye's height has changed by 2 %
  /// or 2 m, or the sun has moved by a twentieth of a degree. Waits for the first.
  void Follow(const std::shared_ptr<const SolvedAir>& air, double latitude_rad,
              const FogView& view);
  /// The same, but what Follow would show in the end is there when it returns.
  void Settle(const std::shared_ptr<const SolvedAir>& air, double latitude_rad,
              const FogView& view);
  /// For the next draw of a connected program.
  void Bind(double altitude_m) const { painter_.Bind(*map_, altitude_m); }

 private:
  struct Request {
    std::shared_ptr<const SolvedAir> air;
    double latitude_rad;
    FogView view;
  };
  void Take();

  FogPainter painter_;
  std::optional<Request> asked_;
  std::optional<FogMap> map_;
  LatestJob<Request, FogMap> maker_;
};

}  // namespace alpenglow
