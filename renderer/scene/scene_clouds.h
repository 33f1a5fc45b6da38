// SPDX-License-Identifier: MIT
// The clouds of a scene: their fields at a time, the time of their motion, the text of --clouds, and
// the checks of what several layers, the ground and the memory say together.
//
// Presets of --clouds name usual skies by their cover in eighths (oktas) of the code of aviation
// weather reports (World Meteorological Organization, Manual on Codes, WMO-No. 306, FM 15 METAR: few
// 1 to 2, scattered 3 to 4, broken 5 to 7, overcast 8):
//
//   none     no clouds
//   fair     cumulus, 2 of 8
//   broken   stratocumulus, 6 of 8
//   high     cirrus, 4 of 8
//   overcast stratus, 8 of 8
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/clouds/cloud_field.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// A field of clouds over a scene. Its frame is flat: x and y are metres to the east and to the
/// north of the scene's place, and z is the height above the ellipsoid. At the scene's time a grid is
/// at its own place; without a time of the scene, at 00:00 UTC of CloudDayOf.
struct SceneCloudField {
  CloudField field;
  bool is_of_ice;                // crystals; otherwise droplets
  glm::dvec2 wind_m_per_s{0.0};  // to the east and to the north
};

/// Returns the fields of a scene's clouds, ordered by their bases, the lowest first. Throws
/// InputError "NAME.KEY ..." with the name of SceneCloud: for files of grids that cannot be read,
/// and as RequireCloudsFit and CheckCloudOptions do.
/// @param time_s  see CloudTime_s.
[[nodiscard]] std::vector<SceneCloudField> CloudFieldsOf(const Scene& scene, double time_s);

/// Returns the time of the clouds at an instant [s], in [0, 1e7]. Differences of times are those of
/// instants (SecondsBetween) from 50 days before CloudDayOf to 50 days after it, or 65 days if
/// Scene::cloud_day is set. Beyond, the same times return every 100 days.
[[nodiscard]] double CloudTime_s(const Scene& scene, const UtcTime& instant);

/// Returns the day (UTC) from which the clouds of a scene count their time, as a modified Julian day:
/// Scene::cloud_day, or the day of the scene's time. Clouds at an instant depend on it. A scene
/// without a time has the day of SceneFromOptions, 2026-06-21.
[[nodiscard]] int CloudDayOf(const Scene& scene);

/// Returns the day that lies a multiple of 100 days from CloudDayOf, and whose 50 days before and
/// after it contain an instant. With this day the times of a series that begins at the instant are
/// continuous for 15 days at least, and those up to 50 days after it are the same as before.
[[nodiscard]] int CloudDayNear(const Scene& scene, const UtcTime& begin);

/// Reads "none", or layers separated by commas: a preset ("fair", "broken", "high", "overcast"), or a genus with
/// or without its cover: "cumulus 0.3, cirrus". Other options are those of the genus; seeds count
/// the layers from 1. Throws InputError that names what is wrong, and the nearest known word.
[[nodiscard]] std::vector<SceneCloud> CloudsFromText(std::string_view text);

/// Throws InputError if the fields of the layers, made one after the other, may need more memory
/// than there is [bytes].
void RequireCloudsFit(const std::vector<SceneCloud>& clouds, double memory);

/// Returns the memory of this machine [bytes].
[[nodiscard]] double MemoryOfMachine();

/// Returns the layers with their bases above the ellipsoid.
/// @param ground_m  height of the ground at the scene's place above the ellipsoid.
[[nodiscard]] std::vector<SceneCloud> OverEllipsoid(std::vector<SceneCloud> clouds,
                                                    double ground_m);

/// Throws InputError for a layer whose base above the ellipsoid is below all ground of the scene.
/// @param lowest_m  height of the lowest ground above the ellipsoid.
void RequireCloudsOverGround(const std::vector<SceneCloud>& clouds, double lowest_m);

}  // namespace alpenglow::renderer
