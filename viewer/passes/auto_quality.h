// SPDX-License-Identifier: MIT
// Quality of a picture: what each quality means for the parts of a picture, and the automatic
// choice of a quality from frame times.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "lut/camera_tables/air_tables.h"
#include "renderer/media/layer_map.h"
#include "viewer/clouds/cloud_quality.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

/// Sizes of tables, meshes and passes, smallest first. kReference is the renderer's own picture,
/// made on a worker thread while the eye does not move.
enum class Quality { kLow, kMedium, kHigh, kReference };

[[nodiscard]] std::string NameOf(Quality quality);

/// The user's choice: a fixed quality, or automatic choice by frame time.
struct QualityRule {
  std::optional<Quality> fixed;  // empty: automatic

  bool operator==(const QualityRule&) const = default;
};
/// Parses "auto", "low", "medium", "high" or "reference". Throws InputError for another text.
[[nodiscard]] QualityRule QualityRuleFromText(const std::string& text);
/// Returns the texts that QualityRuleFromText parses.
[[nodiscard]] std::vector<std::string> QualityRuleTexts();

/// Features that are omitted from a picture of half the window's resolution before its resolution
/// is reduced further. Each value includes the values before it.
enum class Saving { kNone, kCoarseShafts, kFewLamps, kNearLand };

/// A quality, and the scale of the window's width and height at which lighting is rendered. Edges
/// of land, stars and disks are drawn at full resolution (display_pass.h).
struct PaintedQuality {
  Quality quality = Quality::kHigh;
  double scale = 1.0;
  Saving saving = Saving::kNone;

  bool operator==(const PaintedQuality&) const = default;
};
/// Returns how a fixed quality is rendered: kLow computes lighting for every second pixel in both
/// directions.
[[nodiscard]] PaintedQuality PaintedAlways(Quality quality);
/// Returns a description: "high", or "low, light at 0.5x, coarse shafts, few lamps".
[[nodiscard]] std::string TextOf(const PaintedQuality& painted);

/// Chooses among steps of decreasing cost, from kHigh at full resolution to kLow at a quarter of it
/// with every Saving, so that frames take about the wanted time. It starts with kLow at half the
/// resolution.
///
/// The median of the last nine frame times is used, since single frames in which a driver compiles
/// a program are not representative. The cost is lowered if frames take more than 1.15 times the
/// wanted time for half a second and at least three frames, by several steps if they take much
/// longer. After two seconds it is raised to the best step that is expected to take less than 0.85
/// of the wanted time. If a raised step turns out too slow, the waiting time before the next
/// attempt doubles.
class AutoQuality {
 public:
  /// @param wanted_frame_s  > 0
  explicit AutoQuality(double wanted_frame_s);

  /// Records a frame.
  /// @param frame_s  time of the work for the last frame, without waiting for the screen.
  void Record(double frame_s);
  [[nodiscard]] const PaintedQuality& painted() const;

 private:
  double wanted_s_;
  int step_;
  std::deque<double> frames_s_;  // most recent frame times since the last change
  double since_change_s_ = 0.0;
  double wait_up_s_ = 2.0;
};

/// The quality of a flight: the rule of the user, and what it is painted with at the moment.
class QualityChoice {
 public:
  /// @param frame_rate  target of automatic quality, frames a second, > 0.
  QualityChoice(const QualityRule& rule, double frame_rate)
      : rule_(rule), auto_(1.0 / frame_rate) {}

  void Use(const QualityRule& rule) { rule_ = rule; }
  [[nodiscard]] const QualityRule& rule() const { return rule_; }
  /// Records the time that a frame took. Automatic quality uses it.
  void Record(double frame_s) {
    if (!rule_.fixed) auto_.Record(frame_s);
  }
  [[nodiscard]] PaintedQuality painted() const {
    return rule_.fixed ? PaintedAlways(*rule_.fixed) : auto_.painted();
  }

 private:
  QualityRule rule_;
  AutoQuality auto_;
};

struct PaintSizes {
  AirQuality air = AirQuality::kMedium;
  double land_detail = 96.0;  // LandSize::detail
  double land_growth = 4.0;   // LandSize::most_growth
  bool has_shafts = true;
  ShadeQuality shade = kMediumShade;
  LampQuality lamps = kMediumLamps;
  std::size_t most_lamps = kMostGpuLamps;
  LayerMapSize layer_map;
  CloudQuality clouds = kMediumClouds;
  int dropped_octaves = 0;    // omitted octaves of the ground's detail
  bool sky_by_pixel = false;  // SkyByPixel instead of vertex light, once it is ready
};

/// Returns the sizes of a quality. kReference has the sizes of kHigh, which is shown until the
/// renderer's picture is ready.
[[nodiscard]] PaintSizes SizesOf(Quality quality);
/// Returns the sizes of a quality with its savings. The rays of shafts and of lamp light keep their
/// spacing on the screen at any scale of the lighting.
[[nodiscard]] PaintSizes SizesOf(const PaintedQuality& painted);

}  // namespace alpenglow::viewer
