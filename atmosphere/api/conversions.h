// SPDX-License-Identifier: MIT
// Conversions between values of the public headers and those of this layer.
#pragma once

#include <alpenglow/place_time.h>
#include <alpenglow/sun_and_moon.h>

#include <string_view>

namespace alpenglow {

/// Returns the time. Throws InputError for a year outside [kFirstYear, kLastYear] and for a second
/// that its day does not have.
const UtcTime& RequireValid(const UtcTime& time);

/// Ranges of members of SunInSky.
inline constexpr double kNearestSun_au = 5e-3, kFarthestSun_au = 1e5;
inline constexpr double kSmallestSun_deg = 1e-6, kLargestSun_deg = 90.0;

/// Throws InputError that names the member out of range.
void RequireValid(const SunInSky& sun);

/// Throws InputError that names the value unless it is finite.
void RequireFinite(double value, std::string_view name);

}  // namespace alpenglow
