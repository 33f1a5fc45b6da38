// SPDX-License-Identifier: MIT
// The fog of a scene on the graphics card: a FogMap that is made beside drawing, for other air and
// other sizes by a job of its own.
#pragma once

#include <memory>
#include <optional>

#include "atmosphere/sun/sun.h"
#include "renderer/media/local_media.h"
#include "viewer/air/solved_air.h"
#include "viewer/flight/flight.h"
#include "viewer/lamps/fog_follower.h"
#include "viewer/lamps/fog_painter.h"

namespace alpenglow::viewer {

class SceneFog {
 public:
  /// @param media  the last of which is fog.
  SceneFog(LocalMedia media, const FogMapSize& size, const FogUnits& units);

  /// Of maps from the next Follow or Settle on.
  void SetSize(const FogMapSize& size);

  /// Once a frame: takes over what is ready and asks for what is missing. Waits only for the first
  /// map in an air.
  /// @param sun  apparent, seen from the eye.
  void Follow(const std::shared_ptr<const SolvedAir>& air, const Eye& eye, const SunPosition& sun);
  /// Waits for what the view needs.
  void Settle(const std::shared_ptr<const SolvedAir>& air, const Eye& eye, const SunPosition& sun);

  /// At an altitude [1/m].
  [[nodiscard]] double ExtinctionAt(double altitude_m) const;

  /// Ties a program of FogTexts() to what it reads.
  void Connect(const ShaderProgram& program) const { painter_.Connect(program); }
  /// For the next draw of such a program. After Follow or Settle.
  void Bind(const Eye& eye, const SunPosition& sun) const;

 private:
  void BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad);

  std::shared_ptr<const LocalMedia> media_;
  FogMapSize size_;
  FogPainter painter_;
  std::shared_ptr<const SolvedAir> air_;  // that maps are made in; null: none yet of this size
  std::optional<FogFollower> follower_;
};

}  // namespace alpenglow::viewer
