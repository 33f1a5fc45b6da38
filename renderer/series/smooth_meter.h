// SPDX-License-Identifier: MIT
// Exposure and white balance of a series: smooth from frame to frame, and the same whichever frames
// are rendered.
//
// Frames 0, n, 2n ... are the nodes of a uniform cubic B-spline, whose coefficients are what the
// meter says of a small picture of each. Beyond the ends nodes go on in a straight line, so that light
// that fades evenly is followed without a lag; else the spline is off by a sixth of the second
// difference of the nodes. A step of s between two nodes is never more than 3 s / (4 n) between two
// frames. De Boor (1978), "A practical guide to splines", chapter IX.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// Frames from a node to the next: as many as two minutes of a day have, or, `on_path`, half a second
/// of the path, and one at least. Nothing for less than three frames, those that are not evenly spaced,
/// and those farther apart than five times that: each is metered by itself.
[[nodiscard]] std::optional<int> FramesPerNode(const std::vector<Frame>& frames, bool on_path);

class SmoothMeter {
 public:
  /// @param frames  of the whole series; outlives this.
  /// @param metered  EV100 of a frame by itself, or mireds of its white; asked once for each node that
  /// is needed.
  SmoothMeter(const std::vector<Frame>& frames, int frames_per_node,
              std::function<double(const Frame&)> metered);

  /// The same of a frame of the series, to four digits behind the point.
  [[nodiscard]] double At(const Frame& frame);

  /// For the files: "smoothed by a B-spline over frames 0, 4, 8 ... of 97 until
  /// 2026-06-21T04:00:00Z, metered small".
  [[nodiscard]] std::string InWords() const;

 private:
  double Node(int node);

  const std::vector<Frame>& frames_;
  int frames_per_node_, last_node_;
  std::function<double(const Frame&)> metered_;
  std::map<int, double> nodes_;
};

}  // namespace alpenglow::renderer
