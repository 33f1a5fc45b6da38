// SPDX-License-Identifier: MIT
#include "renderer/series/time_axis.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "atmosphere/astronomy/time_text.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

TimeAxis::TimeAxis(const UtcTime& first, const UtcTime& last,
                   const std::optional<std::string>& zone)
    : first_(first), zone_(zone), span_s_(std::max(SecondsBetween(first, last), 1.0)) {}

std::string TimeAxis::Local(const UtcTime& instant) const {
  return zone_ ? FormatInZone(instant, *zone_) : FormatUtc(instant);
}

std::vector<TimeTick> TimeAxis::Ticks(int most) const {
  const double step_s = Step_s(most);
  const std::string local = Local(first_);
  const auto digits = [&](std::size_t at) {
    return ParseWholeNumber(std::string_view(local).substr(at, 2)).value();
  };
  const double clock_s = 3600.0 * digits(11) + 60.0 * digits(14) + digits(17);
  std::vector<TimeTick> ticks;
  const double before_s = std::fmod(clock_s, std::min(step_s, kSecondsPerDay));
  for (double at_s = before_s > 0.0 ? std::min(step_s, kSecondsPerDay) - before_s : 0.0;
       at_s <= span_s_; at_s += step_s) {
    // Add half a second, because the text truncates seconds.
    const std::string text = Local(AddSeconds(first_, at_s + 0.5));
    ticks.push_back({AddSeconds(first_, at_s),
                     step_s < kSecondsPerDay ? text.substr(11, 5) : text.substr(5, 5)});
  }
  return ticks;
}

double TimeAxis::Step_s(int most) const {
  for (const double step_s :
       {10.0, 60.0, 300.0, 600.0, 1800.0, 3600.0, 7200.0, 10800.0, 21600.0, 43200.0, kSecondsPerDay,
        2.0 * kSecondsPerDay, 7.0 * kSecondsPerDay}) {
    if (span_s_ <= most * step_s) return step_s;
  }
  return kSecondsPerDay * std::ceil(span_s_ / kSecondsPerDay / most);
}

}  // namespace alpenglow::renderer
