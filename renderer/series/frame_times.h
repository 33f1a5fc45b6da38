// SPDX-License-Identifier: MIT
// Names of the frames of a series: "DIR/frame.%04d.exr".
//
// Which instants a series shows, from what people type (time_text.h).
//
// Frames of a series along a camera's path.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/sun/time.h"
#include "renderer/camera/camera_path.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/picture/render.h"
#include "renderer/series/time_text.h"

namespace alpenglow::renderer {

/// A pattern with at most one integer conversion, %d, or %4d and %04d, which fill up with zeros as
/// ffmpeg does; %% is a per cent sign.
class FrameName {
 public:
  /// Throws InputError for other conversions, for more
  /// than one, and for names that do not end in .exr.
  explicit FrameName(const std::string& pattern);

  /// Whether frames of different numbers have different names.
  [[nodiscard]] bool HasNumber() const { return has_number_; }
  [[nodiscard]] std::filesystem::path Exr(int number) const;
  /// As Exr, with .png for .exr.
  [[nodiscard]] std::filesystem::path Png(int number) const;
  /// The list of the frames, in their folder: "DIR/frame.manifest.csv".
  [[nodiscard]] std::filesystem::path Manifest() const;
  /// The same for programs: "DIR/frame.manifest.json".
  [[nodiscard]] std::filesystem::path JsonManifest() const;
  [[nodiscard]] std::filesystem::path Folder() const;

 private:
  std::string before_, after_;  // of the number
  bool has_number_ = false;
  int width_ = 0;
};

/// One picture of a series. Numbers count from 0.
struct Frame {
  int number;
  UtcInstant instant;
  double path_s = 0.0;  // where on the path of the camera, if there is one
};

/// The times of a series as typed. Either `at`, or `from` and `to` with `every` or `count`.
struct TimesText {
  std::vector<std::string> at;
  std::optional<std::string> from, to;
  std::optional<std::string> every;  // duration: frames from `from` on, while not after `to`
  std::optional<int> count;          // frames from `from` to `to`, both included
};

/// Frames in a series, at most.
inline constexpr int kMostFrames = 1000000;

/// The frames. A `to` that is an event or a clock time and not after `from` is taken on the
/// following day, so that "sunset" to "sunrise" and "22:00" to "02:00" are nights; a day of an
/// `every` such as "1d" is one of the calendar, after which clocks of the zone show the same ("24h"
/// is 24 hours; clocks that skip the time or show it twice go on with the offset before); an
/// instant at one end says of which day the event at the other end is. Where `from` is an event and
/// `every` whole days, each frame is the event of its own day, from that of `from` to that of `to`,
/// which may be a day without a time; days without the event have no frame. Throws InputError for
/// what InstantFromText refuses, a `to` before `from`, an `every` that is not positive, a `count`
/// below 1, too many frames, no frame.
[[nodiscard]] std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day);

/// The frames whose numbers are in "A-B,C"; throws InputError for numbers that the series does not
/// have and for other texts.
[[nodiscard]] std::vector<Frame> SelectFrames(const std::vector<Frame>& frames,
                                              std::string_view ranges);

/// How many frames, as typed: `every` (a duration of the path) or `count` (the path's ends
/// included), else so many a second.
struct PathRate {
  std::optional<std::string> every;
  std::optional<int> count;
  double per_second = 25.0;
};

/// Seconds of the path between two frames. Throws InputError for an `every` that is not positive, a
/// `count` below 1 and a rate that is not positive.
[[nodiscard]] double FrameInterval(const CameraPath& path, const PathRate& rate);

/// Frames from the first point of the path on. Their instants are the
/// path's; where it has none, `start` is that of the first point.
/// Throws InputError as FrameInterval and for more than kMostFrames.
[[nodiscard]] std::vector<Frame> FramesAlong(const CameraPath& path, const PathRate& rate,
                                             const UtcInstant& start);

/// The camera of a frame; with a shutter that is open for a time around it, its way in that time.
[[nodiscard]] Shot ShotOf(const Frame& frame, const CameraPath& path, double shutter_s);

}  // namespace alpenglow::renderer
