// SPDX-License-Identifier: MIT
// The options of skyseries and skyview for the weather of a scene. Only sources that parse a command
// line include this header (CLI11 is slow to compile).
#pragma once

#include <optional>
#include <string>

#include "lut/cli/command_line.h"
#include "lut/cli/metar_option.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_weather.h"

namespace alpenglow::renderer {

/// Adds --metar, --station-height and --clouds. `weather` and `clouds` must outlive the parsing.
inline void AddWeatherOptions(CLI::App& app, SceneWeather& weather,
                              std::optional<std::string>& clouds) {
  AddMetarOption(
      app, weather.metar,
      "Weather of a METAR or SPECI: \"LSZH 211350Z 24008KT 9999 FEW040 22/12 Q1018\". Visibility "
      "becomes haze or fog; cloud groups and wind become clouds; the wind roughens water; "
      "temperature, dew point and pressure set the density of the air. A warning names groups "
      "without effect");
  app.add_option("--station-height", weather.station_height_m,
                 "Height of the station of --metar in metres above the ellipsoid, -500 to 6000 "
                 "(default: that of a named airport, or 0)")
      ->check(InRange(kStationHeights_m.first, kStationHeights_m.second))
      ->needs("--metar");
  app.add_option(
         "--clouds", clouds,
         "Clouds, instead of those of the scene or of --metar: none, fair (cumulus 0.25), broken "
         "(stratocumulus 0.75), high (cirrus 0.5), overcast (stratus), or layers separated by "
         "commas, each a genus and its cover, 0 to 1: \"cumulus 0.3, cirrus 0.5\". Genera are "
         "cumulus (at most 0.8), stratocumulus, altocumulus, cirrus, stratus and cirrostratus")
      ->check(ReadableBy([](const std::string& text) { (void)CloudsFromText(text); }));
}

}  // namespace alpenglow::renderer
