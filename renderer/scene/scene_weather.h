// SPDX-License-Identifier: MIT
// The weather of a report as the content of a scene: clouds from its cloud groups and its wind, fog
// and haze from its visibility, and the density of the air (atmosphere/weather/reported_air.h).
//
// Amounts are the middle of their oktas: few 1.5/8, scattered 3.5/8, broken 6/8, overcast 8/8. The genus
// follows the height of the base above the station and the amount; the limits between low, middle and
// high clouds are those of middle latitudes (World Meteorological Organization, International Cloud Atlas, 2017):
//
//   below 2000 m   few and scattered cumulus, broken stratocumulus, overcast stratus; CB and TCU cumulus
//   below 6000 m   altocumulus
//   above          cirrus, overcast cirrostratus
//
// A sky that is hidden (VV) is a stratus whose base is at the vertical visibility or, if that is not
// known, at the visibility, at most 300 m high. Layers end below the next layer, except CB and TCU.
//
// Layers drift with the reported wind, increased by the power law (h / 10 m)^(1/7) up to 600 m above
// the station (Peterson and Hennessey 1978, J. Appl. Meteor. 17, 390); calm and variable winds move nothing.
// Without a wind group, the wind is that of the genus. Water has the waves of the reported speed, also
// of variable winds, at most those of 20 m/s.
//
// Fog has droplets of 15 micrometres, the reported visibility at the station, and a scale height of 50 m,
// through which clouds and sun can be seen in visibilities above about 100 m.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/weather/metar.h"
#include "atmosphere/weather/reported_air.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Least and greatest height of a station above the ellipsoid [m].
inline constexpr std::pair kStationHeights_m{-500.0, 6000.0};

/// Returns the height of the station of a report, [m] above the ellipsoid: that of the scene, that of a
/// named airport (places.h), or nothing.
[[nodiscard]] std::optional<double> StationHeight_m(const Scene& scene, const MetarReport& report);

/// Returns the layers of a report, the lowest first. Without a height of the station, bases are
/// above the ground at the place of the scene. Bases below the ellipsoid, of stations below it, are
/// raised to it.
[[nodiscard]] std::vector<SceneCloud> CloudsOfReport(const MetarReport& report,
                                                     std::optional<double> station_m);

/// Returns messages: one for all groups without effect on the scene, and one for each contradiction
/// and for each cloud group that is drawn only in part.
[[nodiscard]] std::vector<std::string> NotesOnReport(const MetarReport& report);

/// Returns the time of a report: its day and time in June 2026, or in July for the 31st.
[[nodiscard]] UtcTime TimeOfReport(const MetarReport& report);

/// Returns the scene in its weather (Scene::weather). A scene without a report is unchanged. Clouds and
/// fog are above the station (StationHeight_m). If its height is not known, and over the built-in
/// range, they are above the ground at the place of the scene, unless the scene gives a height. Clouds
/// replace those of the scene if the report states clouds, fog replaces its fog if the station is in fog, and
/// the time and the wind over water are set if the scene has none. Throws InputError as ReadMetar
/// and InReportedAir do.
/// @param origin  where the report was given, "--metar"; the notes and the names of the layers begin with it.
[[nodiscard]] Scene InWeather(Scene scene, const std::string& origin);

/// Returns the scene in the weather of the command line, like InWeather. Messages begin with --metar.
[[nodiscard]] Scene InTypedWeather(Scene scene, const SceneWeather& weather);

/// Returns the code of the station if it is a named airport.
[[nodiscard]] std::optional<std::string> AirportOf(const SceneWeather& weather);

}  // namespace alpenglow::renderer
