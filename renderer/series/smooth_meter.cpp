// SPDX-License-Identifier: MIT
#include "renderer/series/smooth_meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace alpenglow::renderer {
namespace {

double SecondsAfter(const Frame& first, const Frame& frame, bool on_path) {
  if (on_path) return frame.path_s - first.path_s;
  return SecondsBetween(first.instant, frame.instant);
}

/// Returns the weights of the uniform cubic B-spline, `t` in [0, 1] of the way from the second node
/// to the third.
std::array<double, 4> WeightsAt(double t) {
  const double u = 1.0 - t;
  return {u * u * u / 6.0, 2.0 / 3.0 - t * t * (1.0 - 0.5 * t), 2.0 / 3.0 - u * u * (1.0 - 0.5 * u),
          t * t * t / 6.0};
}

}  // namespace

std::optional<int> FramesPerNode(const std::vector<Frame>& frames, bool on_path) {
  constexpr double kDay_s = 120.0, kPath_s = 0.5, kEven_s = 1e-3, kMostNodesApart = 5.0;
  const double apart = on_path ? kPath_s : kDay_s;
  if (frames.size() < 3) return std::nullopt;
  const double length = SecondsAfter(frames.front(), frames.back(), on_path);
  const double step = length / static_cast<double>(frames.size() - 1);
  if (!(step > 0.0 && step <= kMostNodesApart * apart + kEven_s)) return std::nullopt;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double at = SecondsAfter(frames.front(), frames[i], on_path);
    if (std::abs(at - step * static_cast<double>(i)) > kEven_s) return std::nullopt;
  }
  return std::max(static_cast<int>(std::lround(apart / step)), 1);
}

SmoothMeter::SmoothMeter(const std::vector<Frame>& frames, int frames_per_node,
                         std::function<double(const Frame&)> metered)
    : frames_(frames),
      frames_per_node_(frames_per_node),
      last_node_((static_cast<int>(frames.size()) - 1) / frames_per_node),
      metered_(std::move(metered)) {}

double SmoothMeter::Node(int node) {
  if (last_node_ == 0) node = 0;
  if (node < 0) return 2.0 * Node(0) - Node(-node);
  if (node > last_node_) return 2.0 * Node(last_node_) - Node(2 * last_node_ - node);
  const auto known = nodes_.find(node);
  if (known != nodes_.end()) return known->second;
  const auto frame = static_cast<std::size_t>(node) * static_cast<std::size_t>(frames_per_node_);
  return nodes_[node] = metered_(frames_[frame]);
}

double SmoothMeter::At(const Frame& frame) {
  const int index = frame.number - frames_.front().number;
  const int node = index / frames_per_node_;
  const std::array<double, 4> weights =
      WeightsAt(static_cast<double>(index % frames_per_node_) / frames_per_node_);
  double value = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double weight = weights[static_cast<std::size_t>(i)];
    if (weight > 0.0) value += weight * Node(node - 1 + i);
  }
  return std::round(1e4 * value) / 1e4;
}

std::string SmoothMeter::InWords() const {
  return fmt::format(
      "smoothed by a B-spline over frames 0, {}, {} ... of {} until {}, metered small",
      frames_per_node_, 2 * frames_per_node_, frames_.size(), FormatUtc(frames_.back().instant));
}

}  // namespace alpenglow::renderer
