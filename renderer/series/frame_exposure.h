// SPDX-License-Identifier: MIT
// Exposure and white balance of a series: smooth from frame to frame, and independent of which
// frames are rendered.
//
// Frames 0, n, 2n ... are the nodes of a uniform cubic B-spline. Its coefficients are the meter
// readings of a small picture of each node. Nodes are extrapolated linearly beyond the ends, so
// that evenly fading light is followed without a lag; otherwise the spline is off by a sixth of the
// second difference of the nodes. A step of s between two nodes is never more than 3 s / (4 n)
// between two frames. De Boor (1978), "A practical guide to splines", chapter IX.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lut/image/image.h"
#include "lut/image/look.h"
#include "renderer/series/frame_times.h"
#include "renderer/series/series.h"

namespace alpenglow::renderer {

/// Returns the number of frames from a node to the next: those of two minutes of a day or,
/// `on_path`, of half a second of the path, and at least one. No value for fewer than three frames,
/// for unevenly spaced frames, and for frames farther apart than five times that time: each of
/// these is metered by itself.
[[nodiscard]] std::optional<int> FramesPerNode(const std::vector<Frame>& frames, bool on_path);

class SmoothMeter {
 public:
  /// @param frames  the whole series; outlives this.
  /// @param metered  EV100 of a frame by itself, or mireds of its white; called once for each node
  ///     that is needed.
  SmoothMeter(const std::vector<Frame>& frames, int frames_per_node,
              std::function<double(const Frame&)> metered);

  /// Returns the smoothed value for a frame of the series, to four decimal places.
  [[nodiscard]] double At(const Frame& frame);

  /// Returns the text for the files: "smoothed by a B-spline over frames 0, 4, 8 ... of 97 until
  /// 2026-06-21T04:00:00Z, metered small".
  [[nodiscard]] std::string InWords() const;

 private:
  double Node(int node);

  const std::vector<Frame>& frames_;
  int frames_per_node_, last_node_;
  std::function<double(const Frame&)> metered_;
  std::map<int, double> nodes_;
};

/// Key of the EV100 of a frame in its header.
inline constexpr char kEv100Key[] = "alpenglow.ev100";

/// Returns the metadata of a development in the header of its frame.
[[nodiscard]] Metadata HeaderOfDevelopment(const SeriesOutput& output,
                                           const Development& development);

/// Exposure and look of the frames of a series, each by itself or smooth over the series.
class SeriesExposure {
 public:
  /// The arguments outlive this.
  SeriesExposure(const SeriesSource& source, const std::vector<Frame>& frames,
                 const SeriesOutput& output);
  SeriesExposure(const SeriesExposure&) = delete;
  SeriesExposure& operator=(const SeriesExposure&) = delete;

  /// Returns the development of a frame.
  /// @param rendered  false: its file existed before, and the values that it stores are used if
  ///   this run would develop it in the same way.
  [[nodiscard]] Development DevelopmentOf(const Frame& frame, const HdrImage& image, bool rendered);

  /// Returns the picture before tone mapping: with the eye's glare if requested, white-balanced,
  /// and at night as the eye perceives it.
  [[nodiscard]] HdrImage Seen(const Frame& frame, const HdrImage& image, const Look& look) const;

 private:
  /// Meter reading of a small picture of a frame.
  struct Reading {
    double ev100;
    std::optional<double> white_mired;  // for the white balances auto and camera
  };

  [[nodiscard]] PictureView ViewOf(const Frame& frame, const HdrImage& image) const;
  /// Returns the reading of a spline node. Its small picture is rendered once for both splines.
  [[nodiscard]] const Reading& ReadingOf(const Frame& frame);
  /// Returns the EV to which the eye is adapted. It depends only on the nodes within the preceding
  /// time in which an eye forgets the light of a whole day, not on which frames are rendered.
  [[nodiscard]] double AdaptedEv100(const Frame& frame, int frames_per_node);
  /// Returns the look with its white balance resolved: from the picture itself or, in a film, from
  /// the spline over mireds, in which equal steps look equal. An existing frame stores its white
  /// balance and needs no small picture.
  [[nodiscard]] Look LookOf(const Frame& frame, const HdrImage& image, bool rendered);
  [[nodiscard]] std::optional<double> KeptWhite(const Frame& frame) const;
  [[nodiscard]] double Metered(const Frame& frame, const HdrImage& image, const Look& look) const;
  /// Returns the EV100 stored in an existing frame if this run would expose and develop it in the
  /// same way; it needs no small picture.
  [[nodiscard]] std::optional<double> KeptEv100(const Frame& frame, const Look& look,
                                                const std::string& words) const;

  const SeriesSource& source_;
  const std::vector<Frame>& frames_;
  const SeriesOutput& output_;
  std::optional<SmoothMeter> smooth_ev100_, smooth_mired_;
  std::map<int, Reading> readings_;
};

}  // namespace alpenglow::renderer
