// SPDX-License-Identifier: MIT
// Round local times over the time of a series, for the axes of its plot and its keogram.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// An instant at a round local time: "06:30", or "06-21" for axes of many days.
struct TimeTick {
  UtcTime instant;
  std::string label;
};

class TimeAxis {
 public:
  /// @param last  at or after `first`.
  /// @param zone  of local times; nothing: UTC.
  TimeAxis(const UtcTime& first, const UtcTime& last, const std::optional<std::string>& zone);

  [[nodiscard]] const UtcTime& first() const { return first_; }
  /// Returns the length of the axis, at least 1 s.
  [[nodiscard]] double span_s() const { return span_s_; }
  [[nodiscard]] std::string Local(const UtcTime& instant) const;
  /// Returns instants at round local times, in order.
  /// @param most  of steps between them, >= 1.
  [[nodiscard]] std::vector<TimeTick> Ticks(int most) const;

 private:
  [[nodiscard]] double Step_s(int most) const;

  UtcTime first_;
  std::optional<std::string> zone_;
  double span_s_;
};

}  // namespace alpenglow::renderer
