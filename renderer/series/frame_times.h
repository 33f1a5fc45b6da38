// SPDX-License-Identifier: MIT
// Frames of a series: their instants from text (time_text.h) or along a camera path, and their file
// names "DIR/frame.%04d.exr".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/astronomy/time_text.h"
#include "atmosphere/time_place/time.h"
#include "renderer/camera/camera_path.h"
#include "renderer/picture/render.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// A file name pattern with at most one integer conversion: %d, or %4d and %04d, which pad with
/// zeros as in ffmpeg; %% is a per cent sign.
class FrameName {
 public:
  /// Throws OptionError for other conversions, for more than one, and for names that do not end in
  /// the extension.
  explicit FrameName(const std::string& pattern, std::string_view extension = ".exr");

  /// Returns whether frames with different numbers have different names.
  [[nodiscard]] bool HasNumber() const { return has_number_; }
  [[nodiscard]] std::filesystem::path Picture(int number) const;
  /// Returns the name of Picture() with the extension .png.
  [[nodiscard]] std::filesystem::path Png(int number) const;
  /// Returns the name of the list of frames, in their folder: "DIR/frame.manifest.csv".
  [[nodiscard]] std::filesystem::path Manifest() const;
  /// Returns the name of the list as JSON: "DIR/frame.manifest.json".
  [[nodiscard]] std::filesystem::path JsonManifest() const;
  [[nodiscard]] std::filesystem::path Folder() const;

 private:
  std::string before_, after_;  // text before and after the number
  bool has_number_ = false;
  int width_ = 0;
};

/// One picture of a series. Numbers start at 0.
struct Frame {
  int number;
  UtcTime instant;
  double path_s = 0.0;  // position on the camera path, if there is one
};

/// Largest number of frames in a series.
inline constexpr int kMostFrames = kMostInstants;

/// Returns the frames at InstantsFromTimes, in their order.
[[nodiscard]] std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day);

/// Returns the frames whose numbers are in "A-B,C"; throws InputError for numbers outside the
/// series and for other texts.
[[nodiscard]] std::vector<Frame> SelectFrames(const std::vector<Frame>& frames,
                                              std::string_view ranges);

/// The frame rate as given on the command line: `every` (a duration of the path) or `count` (both
/// ends of the path included), else `per_second`.
struct PathRate {
  std::optional<std::string> every;
  std::optional<int> count;
  double per_second = 25.0;
};

/// Returns the seconds of the path between two frames. Throws InputError for an `every` that is not
/// positive, a `count` below 1 and a rate that is not positive.
[[nodiscard]] double FrameInterval(const CameraPath& path, const PathRate& rate);

/// Returns frames from the first point of the path on. Their instants are those of the path; if it
/// has none, `start` is the instant of its first point. Throws InputError like FrameInterval, and
/// for more than kMostFrames.
[[nodiscard]] std::vector<Frame> FramesAlong(const CameraPath& path, const PathRate& rate,
                                             const UtcTime& start);

/// Returns the camera of a frame; with an open shutter, its motion during the exposure, which is
/// centred on the frame.
[[nodiscard]] CameraSample CameraSampleOf(const Frame& frame, const CameraPath& path,
                                          double shutter_s);

}  // namespace alpenglow::renderer
