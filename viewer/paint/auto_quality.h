// SPDX-License-Identifier: MIT
// How well a picture is drawn, and who chooses it by the time that frames take.
//
// What a quality means for each part of a picture.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "viewer/air/air_tables.h"
#include "viewer/lamps/fog.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

/// Sizes of tables, meshes and passes, smallest first; kReference is the renderer's own picture,
/// made beside drawing while the eye stands still.
enum class Quality { kLow, kMedium, kHigh, kReference };

[[nodiscard]] std::string NameOf(Quality quality);

/// What a user asks for: a quality, or to choose one by time.
struct QualityRule {
  std::optional<Quality> fixed;  // nothing: automatic

  bool operator==(const QualityRule&) const = default;
};
/// "low", "medium", "high", "reference" or "auto"; throws InputError for another text.
[[nodiscard]] QualityRule QualityRuleFromText(const std::string& text);

/// What is left out of a picture of half the window's resolution before it becomes smaller; each has
/// those before it.
enum class Saving { kNone, kCoarseShafts, kFewLamps, kNearLand };

/// A quality, and the share of the window's width and height at which light is painted; land has its
/// edges, and stars and disks their places, at all of it (darkroom.h).
struct PaintedQuality {
  Quality quality = Quality::kHigh;
  double scale = 1.0;
  Saving saving = Saving::kNone;

  bool operator==(const PaintedQuality&) const = default;
};
/// How a quality that was asked for is painted: kLow has light for every second pixel, across and
/// down.
[[nodiscard]] PaintedQuality PaintedAlways(Quality quality);
/// "high", or "low, light at 0.5x, coarse shafts, few lamps".
[[nodiscard]] std::string TextOf(const PaintedQuality& painted);

/// Chooses among steps of falling cost, from kHigh at full resolution to kLow at a quarter of it with
/// every Saving, so that frames take about as long as wanted; it begins with kLow at half the resolution.
/// What counts
/// is the median of the last nine frames: one in which a driver finished a program says nothing. It
/// goes down a step after half a second, and three frames, that take 1.15 times too long, several at
/// once if they take much longer, and up after two seconds to the best step that would still take
/// less than 0.85 of the time; a step that was too slow is not tried again before a time that
/// doubles with each failure.
class AutoQuality {
 public:
  /// @param wanted_frame_s  > 0
  explicit AutoQuality(double wanted_frame_s);

  /// @param frame_s  the work of the frame just drawn, without waiting for the screen.
  void Note(double frame_s);
  [[nodiscard]] const PaintedQuality& painted() const;

 private:
  double wanted_s_;
  int step_;
  std::deque<double> frames_s_;  // the last since the last change
  double since_change_s_ = 0.0;
  double wait_up_s_ = 2.0;
};

struct PaintSizes {
  AirQuality air = AirQuality::kMedium;
  double land_detail = 96.0;  // LandSize::detail
  double land_growth = 4.0;   // LandSize::most_growth
  bool has_shafts = true;
  ShadeQuality shade = kMediumShade;
  LampQuality lamps = kMediumLamps;
  std::size_t most_lamps = kMostGpuLamps;
  FogMapSize fog;
  int dropped_octaves = 0;    // of the ground's detail
  bool sky_by_pixel = false;  // SkyByPixel instead of light of vertices, once it is there
};

/// kReference is drawn as kHigh until the renderer's picture is there.
[[nodiscard]] PaintSizes SizesOf(Quality quality);
/// With what is left out. Rays of shafts and of the light of lamps are as far apart on the screen, at
/// whatever scale light is painted.
[[nodiscard]] PaintSizes SizesOf(const PaintedQuality& painted);

}  // namespace alpenglow::viewer
