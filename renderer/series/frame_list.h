// SPDX-License-Identifier: MIT
// The frames that a series would have, without rendering them: `skyseries --list`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "renderer/series/frame_name.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// What a list of frames is made from.
struct FrameListing {
  std::function<GeodeticPosition(const Frame&)> place_of;
  std::optional<std::string> zone;
  std::optional<FrameName> name;  // of their files, if they have one already
};

/// CSV with a header: frame, utc, local_time (empty without a zone), sun_azimuth_deg,
/// sun_elevation_deg, sun_covered ([0, 1], of its light, by the moon), moon_azimuth_deg,
/// moon_elevation_deg (angles without refraction), moon_illuminated ([0, 1]), file (empty without a
/// name).
[[nodiscard]] std::string ListOf(const std::vector<Frame>& frames, const FrameListing& listing);

}  // namespace alpenglow::renderer
