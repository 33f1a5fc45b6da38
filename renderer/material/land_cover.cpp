// SPDX-License-Identifier: MIT
#include "renderer/material/land_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

std::optional<std::array<double, 3>> CoverOfClass(int number) {
  switch (number) {
    case 0:  // no data
      return {{0.0, 1.0, 1.0}};
    case 10:  // trees
    case 95:  // mangroves
      return {{1.0, 0.0, 0.0}};
    case 20:  // shrubs
      return {{0.5, 0.1, 0.0}};
    case 30:  // grass
      return {{0.0, 0.0, 0.0}};
    case 40:  // crops, part of which is open soil
      return {{0.0, 0.15, 0.0}};
    case 50:  // built-up
      return {{0.1, 0.5, 0.0}};
    case 60:  // bare, or sparsely grown
      return {{0.0, 1.0, 0.0}};
    case 70:  // snow and ice
      return {{0.0, 0.0, 1.0}};
    case 80:  // water
      return {{1.0, 1.0, 0.0}};
    case 90:  // herbaceous wetland
      return {{0.2, 0.0, 0.0}};
    case 100:  // moss and lichen
      return {{0.0, 0.4, 0.0}};
    default:
      return std::nullopt;
  }
}

namespace {

// An altitude below all ground.
constexpr double kNowhere_m = -1000.0;

/// Lines of mountains at a moderate distance from the sea, by latitude.
struct ZonalNode {
  double latitude;  // degrees
  MountainClimate climate;
};
constexpr std::array<ZonalNode, 27> kZones{{
    {-90.0, {kNowhere_m, kNowhere_m, kNowhere_m}},
    {-75.0, {kNowhere_m, -600.0, kNowhere_m}},
    {-62.0, {kNowhere_m, 250.0, -700.0}},
    {-55.0, {550.0, 1000.0, 200.0}},
    {-50.0, {1000.0, 1300.0, 450.0}},
    {-43.0, {1300.0, 2000.0, 1000.0}},
    {-38.0, {1700.0, 2800.0, 1500.0}},
    {-33.0, {2300.0, 4300.0, 2200.0}},
    {-25.0, {3300.0, 5700.0, 4500.0}},
    {-16.0, {4000.0, 5300.0, 5000.0}},
    {-8.0, {3900.0, 4950.0, 4800.0}},
    {0.0, {3700.0, 4800.0, 4650.0}},
    {10.0, {3700.0, 4850.0, 4650.0}},
    {20.0, {3900.0, 5150.0, 4500.0}},
    {28.0, {3900.0, 5300.0, 3900.0}},
    {33.0, {3300.0, 4800.0, 2300.0}},
    {37.0, {2900.0, 4100.0, 1500.0}},
    {42.0, {2500.0, 3400.0, 1000.0}},
    {47.0, {2050.0, 2850.0, 600.0}},
    {52.0, {1700.0, 2300.0, 250.0}},
    {57.0, {1200.0, 1850.0, -100.0}},
    {62.0, {950.0, 1600.0, -400.0}},
    {68.0, {600.0, 1250.0, -800.0}},
    {72.0, {0.0, 900.0, kNowhere_m}},
    {76.0, {kNowhere_m, 800.0, kNowhere_m}},
    {82.0, {kNowhere_m, 700.0, kNowhere_m}},
    {90.0, {kNowhere_m, 300.0, kNowhere_m}},
}};

struct Massif {
  double latitude, longitude;  // degrees
  MountainClimate climate;
};
constexpr std::array<Massif, 28> kMassifs{{
    {46.9, 10.9, {2150.0, 3000.0, 640.0}},          // Alps
    {42.7, 0.6, {2300.0, 2950.0, 1100.0}},          // Pyrenees
    {43.3, 42.5, {2450.0, 3400.0, 900.0}},          // Caucasus
    {57.0, -4.0, {600.0, 1650.0, 600.0}},           // Scotland
    {61.6, 8.3, {1100.0, 1750.0, -200.0}},          // southern Norway
    {67.9, 18.6, {700.0, 1450.0, -800.0}},          // Kebnekaise
    {64.6, -17.0, {350.0, 1150.0, -100.0}},         // Iceland
    {78.5, 16.0, {kNowhere_m, 450.0, kNowhere_m}},  // Svalbard
    {46.9, -121.8, {1850.0, 2250.0, 700.0}},        // Cascades
    {40.3, -105.6, {3450.0, 3800.0, 2200.0}},       // Rocky Mountains of Colorado
    {37.7, -119.3, {3200.0, 3900.0, 1700.0}},       // Sierra Nevada of California
    {51.5, -116.8, {2250.0, 2650.0, 400.0}},        // Rocky Mountains of Canada
    {63.0, -150.0, {800.0, 1750.0, -500.0}},        // Alaska Range
    {35.6, 138.5, {2500.0, 4050.0, 1200.0}},        // Fuji and the Japanese Alps
    {27.9, 86.9, {4100.0, 5700.0, 4300.0}},         // Khumbu
    {35.8, 76.5, {3800.0, 5200.0, 2300.0}},         // Karakoram
    {42.0, 80.0, {2800.0, 3950.0, 1500.0}},         // Tien Shan
    {49.5, 88.0, {2300.0, 3000.0, 600.0}},          // Altai
    {19.1, -98.0, {4000.0, 5000.0, 4600.0}},        // volcanoes of Mexico
    {-1.5, 37.0, {3500.0, 4900.0, 4800.0}},         // Mount Kenya, Kilimanjaro
    {-0.7, -78.4, {3700.0, 4850.0, 4700.0}},        // Andes of Ecuador
    {-16.0, -68.0, {4100.0, 5250.0, 5000.0}},       // Cordillera Real
    {-33.0, -70.0, {2200.0, 4400.0, 2200.0}},       // Andes of Santiago
    {-43.6, 170.1, {1250.0, 1950.0, 1000.0}},       // Southern Alps
    {-36.4, 148.3, {1850.0, 2700.0, 1500.0}},       // Snowy Mountains
    {-49.3, -73.1, {1150.0, 1300.0, 450.0}},        // Patagonian ice
    {-54.8, -68.5, {600.0, 1050.0, 250.0}},         // Tierra del Fuego
    {-54.4, -36.7, {kNowhere_m, 500.0, -100.0}},    // South Georgia
}};

MountainClimate Mixed(const MountainClimate& a, const MountainClimate& b, double share) {
  return {a.tree_line_m + share * (b.tree_line_m - a.tree_line_m),
          a.ice_line_m + share * (b.ice_line_m - a.ice_line_m),
          a.winter_line_m + share * (b.winter_line_m - a.winter_line_m)};
}

MountainClimate OfLatitude(double latitude) {
  const auto above = std::find_if(kZones.begin() + 1, kZones.end() - 1,
                                  [&](const ZonalNode& node) { return node.latitude >= latitude; });
  const ZonalNode& low = *(above - 1);
  return Mixed(low.climate, above->climate,
               (latitude - low.latitude) / (above->latitude - low.latitude));
}

/// Returns the unit vector from the centre of the sphere to a place.
glm::dvec3 OnUnitSphere(double latitude_rad, double longitude_rad) {
  const double flat = std::cos(latitude_rad);
  return {flat * std::cos(longitude_rad), flat * std::sin(longitude_rad), std::sin(latitude_rad)};
}

// Winter shares at the middles of the months of a northern year. Fresh snow descends quickly with
// the cold of autumn, and melts more slowly in spring: in the Alps the snow line is at 1700 m in
// mid-November, 1500 m in mid-April and 2600 m in mid-June.
constexpr std::array<double, 12> kWinterShare{0.98, 1.0, 0.87, 0.62, 0.40, 0.18,
                                              0.07, 0.0, 0.02, 0.24, 0.56, 0.85};

// Returns the elapsed fraction of a northern year.
double YearShare(double latitude_rad, int modified_julian_day) {
  // Day 58849 is 2020-01-01.
  const double years = (modified_julian_day - 58849) / 365.2425 + (latitude_rad < 0.0 ? 0.5 : 0.0);
  return years - std::floor(years);
}

// Days of the year at 500 m in the Alps; see the header.
constexpr double kLeavesOut = 115.0, kLeavesTurn = 285.0, kLeavesFallen = 308.0;
constexpr double kGrassGrows = 85.0, kGrassEnds = 330.0;

}  // namespace

MountainClimate MountainClimateAt(const Place& place) {
  constexpr double kReach = 0.06;   // 380 km
  constexpr double kOfZone = 0.02;  // weight of the zonal mean; a massif on the spot has weight 1
  const MountainClimate zone = OfLatitude(place.latitude_deg);
  double weights = kOfZone;
  MountainClimate sum{0.0, 0.0, 0.0};
  const glm::dvec3 here = OnUnitSphere(place.latitude_rad(), place.longitude_rad());
  for (const Massif& massif : kMassifs) {
    const glm::dvec3 middle =
        OnUnitSphere(massif.latitude * kRadiansPerDegree, massif.longitude * kRadiansPerDegree);
    const double away = AngleBetween(here, middle) / kReach;
    const double weight = std::exp(-away * away);
    if (weight < 1e-4) continue;
    const MountainClimate there = OfLatitude(massif.latitude);
    weights += weight;
    sum.tree_line_m += weight * (massif.climate.tree_line_m - there.tree_line_m);
    sum.ice_line_m += weight * (massif.climate.ice_line_m - there.ice_line_m);
    sum.winter_line_m += weight * (massif.climate.winter_line_m - there.winter_line_m);
  }
  return {zone.tree_line_m + sum.tree_line_m / weights, zone.ice_line_m + sum.ice_line_m / weights,
          zone.winter_line_m + sum.winter_line_m / weights};
}

double WinterShare(double latitude_rad, int modified_julian_day) {
  const double at =
      12.0 * YearShare(latitude_rad, modified_julian_day) + 11.5;  // 0.5 is the middle of January
  const auto month = static_cast<std::size_t>(at);
  const double share = at - std::floor(at);
  return kWinterShare[month % 12] * (1.0 - share) + kWinterShare[(month + 1) % 12] * share;
}

double GreenLine(double latitude_rad, int modified_julian_day, double from_day, double until_day) {
  constexpr double kMetresPerDay = 122.0 / 4.0, kMetresPerDegree = 122.0;
  const double day = 365.2425 * YearShare(latitude_rad, modified_julian_day);
  const double of_latitude =
      500.0 - kMetresPerDegree * (std::abs(latitude_rad) / kRadiansPerDegree - 46.5);
  constexpr double kYear = 365.2425;  // for the previous autumn and the next spring
  const double days = std::max(
      {std::min(day - from_day, until_day - day), until_day - kYear - day, day - from_day - kYear});
  return of_latitude + kMetresPerDay * days;
}

MountainCover CoverInSeason(const Place& place, int modified_julian_day) {
  const MountainClimate climate = MountainClimateAt(place);
  const double latitude_rad = place.latitude_rad();
  const double winter = WinterShare(latitude_rad, modified_julian_day);
  constexpr double kUnderTreeLine_m = 800.0, kTropic_rad = 23.4 * kRadiansPerDegree;
  return {climate.tree_line_m,
          climate.ice_line_m - winter * (climate.ice_line_m - climate.winter_line_m),
          GreenLine(latitude_rad, modified_julian_day, kLeavesOut, kLeavesTurn),
          GreenLine(latitude_rad, modified_julian_day, kLeavesOut, kLeavesFallen),
          GreenLine(latitude_rad, modified_julian_day, kGrassGrows, kGrassEnds),
          climate.tree_line_m - kUnderTreeLine_m,
          std::clamp(latitude_rad / kTropic_rad, -1.0, 1.0)};
}

}  // namespace alpenglow::renderer
