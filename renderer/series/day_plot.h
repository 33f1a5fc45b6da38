// SPDX-License-Identifier: MIT
// An SVG plot of sun, moon, light and exposure of a series over its time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Values of a frame in the plot.
struct PlottedMoment {
  UtcTime instant;
  double sun_elevation_deg = 0.0, moon_elevation_deg = 0.0;  // without refraction
  std::optional<double> illuminance_lx = {};                 // of sky and lights on level ground
  std::optional<double> ev100 = {};
};

/// A published illuminance, drawn across its panel.
struct LightLevel {
  const char* name;
  double low_lx, high_lx;
};

/// Returns illuminances of level ground under clear skies. Full moon, high: Kyba, Mohar, Posch
/// (2017), Astronomy & Geophysics 58, 1.31; ends of twilights and the night without moon: RCA
/// Electro-Optics Handbook (1974), section 6.
[[nodiscard]] const std::vector<LightLevel>& PublishedLightLevels();

/// The place and the zone of a plot.
struct PlotTitle {
  std::string place;                     // as PlaceText() has it
  std::optional<std::string> zone = {};  // of times; nothing: UTC
};

/// Returns the latitude and longitude of a place as text, to 1e-4 degrees: "46.5 N, 8 E".
[[nodiscard]] std::string PlaceText(const Place& place);

/// Returns three panels over one time axis, in the zone or in UTC: elevations, with twilight bands
/// in the background; illuminance on a logarithmic axis (values below 1e-5 lx are omitted); EV100.
/// Curves have gaps where frames have no value. Moments must be in time order. Throws InternalError
/// if there are none.
[[nodiscard]] std::string SvgOfDay(const std::vector<PlottedMoment>& moments,
                                   const PlotTitle& title,
                                   const std::vector<LightLevel>& levels = {});

}  // namespace alpenglow::renderer
