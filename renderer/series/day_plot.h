// SPDX-License-Identifier: MIT
// Sun, moon, light and exposure of a series over its time, as a plot (SVG).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// What a plot says of a frame.
struct PlottedMoment {
  UtcInstant instant;
  double sun_elevation_deg = 0.0, moon_elevation_deg = 0.0;  // without refraction
  std::optional<double> illuminance_lx = {};                 // of sky and lights on level ground
  std::optional<double> ev100 = {};
};

/// An illuminance that others published, drawn across its panel.
struct LightLevel {
  const char* name;
  double low_lx, high_lx;
};

/// Of level ground under clear skies. Full moon, high: Kyba, Mohar, Posch (2017), Astronomy &
/// Geophysics 58, 1.31; ends of twilights and the night without moon: RCA Electro-Optics Handbook
/// (1974), section 6.
[[nodiscard]] const std::vector<LightLevel>& PublishedLightLevels();

/// Three panels over one axis of time, of the zone or of UTC: elevations, with bands of twilight
/// behind them; illuminance by its logarithm (what is under 1e-5 lx is left out); EV100. Curves have
/// gaps where frames have no value. Throws InternalError for no moments; they must not go back in
/// time.
[[nodiscard]] std::string SvgOfDay(const std::vector<PlottedMoment>& moments,
                                   const std::optional<std::string>& zone,
                                   const std::vector<LightLevel>& levels = {});

}  // namespace alpenglow::renderer
