// SPDX-License-Identifier: MIT
// This header provides the materials of mountain ground: the classes of land cover maps, the
// altitudes that separate forest, rock and snow by place and season, and the functions of the
// shared text ground_cover.glsl in C++.
//
// The classes are those of ESA WorldCover (Zanaga et al. 2022, WorldCover 10 m 2021 v200, doi
// 10.5281/zenodo.7254221, product user manual, table 3).
//
// The snow line moves between an ice line and a winter line:
//
//   snow line = ice line - w(day) (ice line - winter line),   w from 0 at the end of the melt to 1
//
// Above the ice line, snow outlasts the summer; on glaciers it is the equilibrium line. Ice, winter
// and tree line follow a curve over latitude. Near the thirty or so massifs of a table they move to
// the observed altitudes, because the sea and dry air shift them by a kilometre at one latitude.
//
// Altitudes of massifs are rounded. Tree lines are from Hermes (1955), Koelner geographische
// Arbeiten 5, and Koerner (1998), Oecologia 115, 445; equilibrium lines from Hermes (1955) and
// Ohmura, Kasser, Funk (1992), J. Glaciology 38, 397; the winter line of the Alps, 641 m, from
// Hantel, Maurer (2011), Meteorol. Z. 20, 267. The winter lines of other massifs are unpublished
// estimates. They lie below the ice line by an amount that depends on the contrast of the seasons:
// 1600 to 2900 m in continental climates (2360 m in the Alps), 600 to 1250 m at cool seas, 100 to
// 400 m in the tropics. Tests compare tree lines with the rule of Koerner (1998), and ice lines
// with glaciers of the World Glacier Monitoring Service.
//
// Leaves and grass follow the law of Hopkins (1920), Monthly Weather Review Supplement 9: spring
// comes four days later per degree of latitude and per 122 m, and autumn as much earlier.
// Broad-leaved woods follow it (Richardson et al. 2019, Applications in Plant Sciences 7, e01228).
// On any day there is therefore an altitude below which vegetation is green. Beeches of the Alps at
// 500 m are in leaf from the end of April and bare by the first days of November; grass there is
// green for a month longer at both ends. Woods are broad-leaved up to 800 m below the tree line, as
// in the Alps, where beech ends at 1300 m and conifers at 2100 m.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "atmosphere/shared_glsl/shared_math.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/material/ground_cover.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// Returns the composition of a class for ground_cover.glsl: shares of wood, stone and lasting
/// snow, or the codes for water and for unknown. Built-up land is half stone, because it includes
/// gardens. Empty for a number that is not a class.
[[nodiscard]] std::optional<std::array<double, 3>> CoverOfClass(int number);

/// Altitudes that separate the materials of a mountain on a given day.
struct MountainCover {
  double tree_line_m = 1900.0;  // no trees above; below sea level where no trees grow
  double snow_line_m = 2700.0;  // about half of level ground is white there; below sea level where
                                // all ground is white
  double leaf_line_m = kEverywhere_m;        // below it broad-leaved trees are in green leaf
  double bare_line_m = kEverywhere_m;        // above it they are bare; yellow in between, in autumn
  double grass_line_m = kEverywhere_m;       // below it grass is green
  double broadleaf_line_m = -kEverywhere_m;  // below it woods are broad-leaved
  double sun_in_south = 0.0;                 // 1 north of the tropics, -1 south of them

  static constexpr double kEverywhere_m = 1e5;
};

/// Shares of materials at a place of a map; see ground_cover.glsl.
struct MappedCover {
  float wood, stone, snow;
};

/// Altitudes that do not change with the season.
struct MountainClimate {
  double tree_line_m;
  double ice_line_m;     // lowest snow line of a late summer; above the summits where no snow lasts
  double winter_line_m;  // of the snow in late winter
};

/// Returns the climate of a place. It is accurate to 60 m in an observed massif and to about 400 m
/// elsewhere; slopes facing the sun or the wind differ from others by similar amounts.
[[nodiscard]] MountainClimate MountainClimateAt(const Place& place);

/// Returns the fraction w of the way from the ice line down to the winter line: that of the Alps,
/// shifted by half a year south of the equator.
[[nodiscard]] double WinterShare(double latitude_rad, int modified_julian_day);

/// Returns the altitude below which vegetation is green on a day [m].
/// @param from_day, until_day  of the northern year, 0 to 365, at 500 m and a latitude of 46.5
///     degrees.
[[nodiscard]] double GreenLine(double latitude_rad, int modified_julian_day, double from_day,
                               double until_day);

[[nodiscard]] MountainCover CoverInSeason(const Place& place, int modified_julian_day);

}  // namespace alpenglow::renderer
