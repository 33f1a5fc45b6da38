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

#include "renderer/series/frame_times.h"

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

}  // namespace alpenglow::renderer
