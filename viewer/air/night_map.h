// SPDX-License-Identifier: MIT
// The sky of a night without moon (night_light.h) as a map around an eye, made beside drawing.
//
// Rows go by elevation, closer together towards the horizon, where airglow grows fast: row r of n
// has the elevation (pi/2) s |s|, s = 2 r / (n - 1) - 1. Columns go once around, the last is the
// first. The Milky Way and the zodiacal light are coarse (night_sky.h): between texels 1 % is lost.
#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "viewer/air/air_tables.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/sea_mirror.h"
#include "viewer/job/latest_job.h"

namespace alpenglow {

struct NightView {
  GeodeticPosition eye;
  UtcInstant now;
  std::shared_ptr<const SolvedAir> air;
};

struct NightMap {
  static constexpr int kColumns = 97, kRows = 96;
  NightView view;
  std::vector<BandTexel> above;  // row by row, W m^-2 sr^-1 nm^-1
  glm::vec4 scattered, level;    // NightLight::scattered, OnSurface(1)
};

[[nodiscard]] NightMap NightMapOf(const NightView& view);

/// Whether the sky of a view is that of the map: a minute of time, 20 km, a twentieth of the height.
[[nodiscard]] bool Serves(const NightMap& map, const NightView& view);

/// The map on the card, kept up with time and place.
class NightFollower {
 public:
  NightFollower() : job_(NightMapOf) {}

  /// Takes over what is finished, asks for what is needed. @param unit  where to bind the texture.
  void Follow(const NightView& view, int unit);
  /// The same, and waits for it.
  void Settle(const NightView& view, int unit);
  /// Null: none is there yet.
  [[nodiscard]] const NightMap* map() const { return map_ ? &*map_ : nullptr; }
  void Bind(int unit) const;

 private:
  void Take(int unit);

  std::optional<NightMap> map_;
  GlTexture texture_;
  LatestJob<NightView, NightMap> job_;
};

}  // namespace alpenglow
