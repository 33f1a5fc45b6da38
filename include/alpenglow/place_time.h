// SPDX-License-Identifier: MIT
/// @file
/// Places on the earth and instants of UTC.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// A place in geodetic coordinates (WGS84).
struct Place {
  double latitude_deg = 0.0;   ///< in [-90, 90], north is positive
  double longitude_deg = 0.0;  ///< in [-180, 360], east is positive
  double height_m = 0.0;       ///< above the ellipsoid, at least -12000
};

/// An instant of UTC, as a count without leap seconds.
using UtcTime = std::chrono::sys_time<std::chrono::microseconds>;

/// Reads ISO 8601, such as "2026-06-21T04:00:00Z" or "2026-06-21T13:00:00+09:00", years 1900 to
/// 2100. Throws InputError for other texts, for an unknown zone, and for a local time that exists
/// twice or not at all. A leap second becomes the first second of the next day.
/// @param text  the time.
/// @param zone  IANA name of the zone of a text without an offset, such as "Asia/Tokyo".
[[nodiscard]] UtcTime TimeFromText(std::string_view text, const std::string& zone = "");

/// Returns a text such as "2026-06-21T04:00:00Z", rounded to seconds. Throws InputError for a year
/// outside [1900, 2100].
[[nodiscard]] std::string TextFromTime(UtcTime time);

}  // namespace alpenglow
