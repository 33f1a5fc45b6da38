// SPDX-License-Identifier: MIT
// Classes of maps of land cover: those of ESA WorldCover (Zanaga et al. 2022, WorldCover 10 m 2021
// v200, doi 10.5281/zenodo.7254221, product user manual, table 3).
//
// Altitudes at which forest, rock and snow give way to one another, by place and season.
//
//   snow line = ice line - w(day) (ice line - winter line),   w from 0 at the end of the melt to 1
//
// The ice line is where snow outlasts the summer: on glaciers the equilibrium line. Ice, winter and
// tree line are those of a curve over latitude, moved to what is observed in some thirty massifs as
// far as these are near: the sea and dry air shift them by a kilometre at one latitude.
//
// Altitudes of massifs are rounded, of: tree lines, Hermes (1955), Koelner geographische Arbeiten
// 5, and Koerner (1998), Oecologia 115, 445; equilibrium lines, Hermes (1955) and Ohmura, Kasser,
// Funk (1992), J. Glaciology 38, 397; winter in the Alps, 641 m, Hantel, Maurer (2011), Meteorol.
// Z. 20, 267. The winter line of other massifs is of no publication but estimated, as far under the
// ice line as its seasons differ: 1600 to 2900 m where winters are of the continent (the Alps have
// 2360 m), 600 to 1250 m at cool seas, 100 to 400 m in the tropics. Tests hold tree lines to the
// rule of Koerner (1998), ice lines to glaciers of the World Glacier Monitoring Service.
//
// Leaves come out and grass grows green by Hopkins (1920), Monthly Weather Review Supplement 9: four
// days later per degree of latitude and per 122 m, in autumn as much earlier, which broad-leaved
// woods follow (Richardson et al. 2019, Applications in Plant Sciences 7, e01228). So at any day
// there is an altitude below which it is green. Beeches of the Alps at 500 m are in leaf from the
// end of April and bare by the first days of November; grass there is green a month longer on both
// sides. Woods are broad-leaved up to 800 m under the tree line, as in the Alps beech ends at 1300
// m and conifers at 2100 m.
//
// This header also reads the shared text ground_cover.glsl as C++.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "atmosphere/dialect/shared_math.h"
#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/ground/ground_cover.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// What a class is made of, as ground_cover.glsl takes it: shares of wood, stone and lasting snow,
/// or the corners for water and for nothing known. Built-up land is half stone: gardens are between
/// the houses. Nothing for a number that is no class.
[[nodiscard]] std::optional<std::array<double, 3>> CoverOfClass(int number);

/// Where the materials of a mountain give way to one another.
struct MountainCover {
  double tree_line_m = 1900.0;  // no trees above; below sea level where none grow
  double snow_line_m = 2700.0;  // about half of level ground is white there; below sea level where
                                // all of it is
  double leaf_line_m = kEverywhere_m;        // below it broad-leaved trees are in green leaf
  double bare_line_m = kEverywhere_m;        // above it they are bare; between, in autumn, yellow
  double grass_line_m = kEverywhere_m;       // below it grass is green
  double broadleaf_line_m = -kEverywhere_m;  // below it woods are broad-leaved
  double sun_in_south = 0.0;                 // 1 north of the tropics, -1 south of them

  static constexpr double kEverywhere_m = 1e5;
};

/// What a map says of a place, in shares; see ground_cover.glsl.
struct MappedCover {
  float wood, stone, snow;
};

/// What does not change with the season.
struct MountainClimate {
  double tree_line_m;
  double ice_line_m;     // lowest snow line of a late summer; above the summits where no snow lasts
  double winter_line_m;  // of the snow in late winter
};

/// In a massif that was observed to 60 m of it, elsewhere to about 400 m: slopes to the sun and to
/// the wind differ as much.
[[nodiscard]] MountainClimate MountainClimateAt(const GeodeticPosition& place);

/// The share w of the way from the ice line down to the winter line: that of the Alps, half a year
/// later south of the equator.
[[nodiscard]] double WinterShare(double latitude_rad, int modified_julian_day);

/// Altitude below which it is green that day [m].
/// @param from_day, until_day  of the northern year, 0 to 365, at 500 m and a latitude of 46.5
/// degrees.
[[nodiscard]] double GreenLine(double latitude_rad, int modified_julian_day, double from_day,
                               double until_day);

[[nodiscard]] MountainCover CoverInSeason(const GeodeticPosition& place, int modified_julian_day);

}  // namespace alpenglow::renderer
