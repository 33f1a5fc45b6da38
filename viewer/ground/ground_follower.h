// SPDX-License-Identifier: MIT
// Keeps the light on the land up with a sun that moves and an eye that comes to other land: all of it
// is made on a thread beside drawing.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "viewer/air/solved_air.h"
#include "viewer/ground/lit_ground.h"
#include "viewer/ground/sky_on_ground.h"
#include "viewer/job/latest_job.h"
#include "viewer/land/land_chunk.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

/// The land whose light is made: as much as stands over its own valleys, and from high up as far as
/// an eye sees it well.
struct GroundExtent {
  double half_width_m = 40e3;
  int samples = 1024;  // a side, at most

  /// [m] Under an eye at a height over the ellipsoid: at least 7 heights, as far as land that is seen
  /// 8 degrees under the horizon, but at most four times the least, lest samples be too far apart.
  /// In doublings, so that an eye that climbs needs other land but twice.
  [[nodiscard]] double HalfWidthUnder(double height_m) const;
};

class GroundFollower {
 public:
  /// @param cover, drape  what the land is made of.
  GroundFollower(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                 const GroundExtent& extent);

  /// The land is gone, and its light.
  void ForgetLand();
  /// Other land, or more of it, as ShadeFollower has it. An empty function: none.
  void SetGround(GroundSampler sampler);

  struct View {
    GeodeticPosition eye;
    UtcInstant now;
    LightSource casts;                                // what throws shadows
    SunPosition by;                                   // that, apparent, seen from the eye
    std::optional<SunPosition> other = std::nullopt;  // the other source, where it counts
  };
  /// Once a frame: asks for what is missing, but leaves the processor to the drawing four times as
  /// long as light takes to make. Under a sun that runs, light is made for where the sun will stand in
  /// the middle of the time for which it is shown, and fades from one to the next. True when new light
  /// is there.
  /// @param seconds  since the last call.
  bool Follow(const std::shared_ptr<const SolvedAir>& air, const View& view, double seconds);
  /// The same, but what Follow would have in the end is there when it returns.
  bool Settle(const std::shared_ptr<const SolvedAir>& air, const View& view);

  /// Light on the land around, of what throws shadows; null without land and before the first is there.
  [[nodiscard]] const std::shared_ptr<const LitGround>& lit() const { return made_.lit; }
  /// What throws the shadows of that.
  [[nodiscard]] LightSource casts() const { return made_.casts; }
  /// The sky of a source over that land, and the open sky's light that belongs to it; nothing without lit(), or
  /// of a source that did not count.
  struct SkyOfSource {
    std::shared_ptr<const GroundSky> sky;
    SkyTilt open;
  };
  [[nodiscard]] std::optional<SkyOfSource> SkyOf(LightSource source) const;
  /// The light of vertices in the frame of any anchor; empty without lit().
  [[nodiscard]] std::optional<LightOfVertices> Light() const;
  /// What waves show of the sky of a source over it (SeaMirror); empty where nothing mirrors and for one
  /// that did not count.
  [[nodiscard]] const std::vector<BandTexel>& sea_mirror(LightSource source) const {
    return made_.sea_mirrors[IndexOf(source)];
  }
  /// Altitude of the open sky that the light of vertices is a share of: half the height of the land.
  [[nodiscard]] double open_altitude_m() const { return made_.open_altitude_m; }
  /// Time that the light took to make, without the land's horizons; 0 before the first.
  [[nodiscard]] double making_s() const { return made_.making_s; }

 private:
  struct Request {
    std::shared_ptr<const SolvedAir> air;
    std::shared_ptr<const GroundSampler> ground;
    View view;
    int land;  // counts up when land is gone
  };
  struct Made {
    LightSource casts = LightSource::kSun;
    std::shared_ptr<const LitGround> lit;
    std::shared_ptr<const GroundSky> other;   // null: it does not count
    std::optional<SkyTilt> open, other_open;  // the open sky of either
    std::array<std::vector<BandTexel>, kLightSources> sea_mirrors;
    double open_altitude_m = 0.0;
    double making_s = 0.0;
    int land = 0;
  };
  class Maker;
  [[nodiscard]] bool Suits(const Request& asked, const Request& wanted) const;
  [[nodiscard]] View WhenShown(const View& view, double seconds) const;
  bool Ask(const Request& wanted);
  bool Take();

  GroundExtent extent_;
  std::shared_ptr<const GroundSampler> ground_;
  int land_ = 0;
  std::optional<Request> asked_;
  std::optional<View> last_view_;
  Made made_;
  std::chrono::steady_clock::time_point rests_until_{};
  LatestJob<Request, Made> maker_;
};

/// Where the sources of light will stand after as many steps more as the one from `before` to `now`, but at
/// most 10 degrees further on; those of `now` after a jump of time.
[[nodiscard]] GroundFollower::View Ahead(const GroundFollower::View& before,
                                         const GroundFollower::View& now, double steps);

}  // namespace alpenglow::viewer
