// SPDX-License-Identifier: MIT
// Options of a layer of clouds, and their defaults for each genus.
//
// Bases and depths are those usual for the genus (World Meteorological Organization, International
// Cloud Atlas, 2017; https://cloudatlas.wmo.int). Droplet numbers: Miles, Verlinde and Clothiaux
// (2000), J. Atmos. Sci. 57, 295 (about 300 per cm3 in continental and 75 in marine low clouds).
// Content and size of the crystals of cirrus: Heymsfield and Platt (1984), J. Atmos. Sci. 41, 846;
// the extinction is about 1 per km.
//
// Winds are typical values that this project chose; they grow with height, as winds of middle latitudes
// usually do.
//
// The cover of a field is within 0.05 of that of its options for periods of 5.12 km and more. A field of
// 2.56 km has so few cumulus that their ages at one time matter: up to 0.06 is missing.
//
// Cover is the fraction of the sky, seen vertically, with an optical depth above 0.3; for cirrus
// above 0.03, where cirrus begins to be visible (Sassen and Cho 1992, J. Appl. Meteor. 31, 1275).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "atmosphere/base/names.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

enum class CloudGenus { kCumulus, kStratocumulus, kAltocumulus, kCirrus, kStratus, kCirrostratus };

inline constexpr EnumNames kCloudGenusNames{{std::pair{CloudGenus::kCumulus, "cumulus"},
                                             {CloudGenus::kStratocumulus, "stratocumulus"},
                                             {CloudGenus::kAltocumulus, "altocumulus"},
                                             {CloudGenus::kCirrus, "cirrus"},
                                             {CloudGenus::kStratus, "stratus"},
                                             {CloudGenus::kCirrostratus, "cirrostratus"}}};

/// Horizontal periods are multiples of this length, which the noise of the shapes divides.
inline constexpr double kPeriodStep_m = 2560.0;

/// Above this cover, cumulus merge to a deck, which is stratocumulus.
inline constexpr double kMostCumulusCover = 0.8;

/// Bases of clouds of droplets are at most this high: the standard air of their bases ends there.
inline constexpr double kHighestWaterBase_m = 11000.0;

/// Least and greatest values of CloudOptions.
struct CloudRanges {
  static constexpr std::pair kCover{0.0, 1.0};
  static constexpr std::pair kBase_m{0.0, 15000.0};
  static constexpr std::pair kDepth_m{100.0, 4000.0};
  static constexpr std::pair kDroplets_per_cm3{1.0, 5000.0};
  static constexpr std::pair kIce_mg_per_m3{1.0, 1000.0};
  static constexpr std::pair kCrystalRadius_um{5.0, 200.0};
  static constexpr std::pair kOpticalDepth{0.0, 1000.0};
  static constexpr std::pair kWind_m_per_s{-150.0, 150.0};
  static constexpr std::pair kPeriod_m{kPeriodStep_m, 32.0 * kPeriodStep_m};
};

/// A layer of clouds.
struct CloudOptions {
  CloudGenus genus = CloudGenus::kCumulus;
  double cover = 0.3;  // of cumulus at most kMostCumulusCover; of stratus and cirrostratus 1
  double base_altitude_m = 1200.0;        // of droplets at most kHighestWaterBase_m
  double depth_m = 1500.0;                // from the base to the highest tops
  double droplet_number_per_cm3 = 250.0;  // cirrus has none
  double ice_mg_per_m3 = 0.0;             // of genera of ice; others have none
  double crystal_radius_um = 35.0;        // effective; of genera of ice
  /// Vertical optical depth of stratus or cirrostratus; nothing: that of its water or ice.
  std::optional<double> optical_depth = {};
  std::uint32_t seed = 1;
  glm::dvec2 wind_m_per_s{0.0};  // to the east and to the north
  double period_m = 20480.0;     // a multiple of kPeriodStep_m

  bool operator==(const CloudOptions&) const = default;
};

/// Returns whether bases of a genus follow the ground: the air that forms its clouds rises from there.
[[nodiscard]] constexpr bool FollowsGround(CloudGenus genus) {
  return genus == CloudGenus::kCumulus || genus == CloudGenus::kStratocumulus ||
         genus == CloudGenus::kStratus;
}

/// Returns whether a genus consists of ice; the others consist of droplets.
[[nodiscard]] constexpr bool IsOfIce(CloudGenus genus) {
  return genus == CloudGenus::kCirrus || genus == CloudGenus::kCirrostratus;
}

/// Returns whether a genus covers the whole sky and is the same at every place. Seed and period have no
/// effect on it.
[[nodiscard]] constexpr bool IsPlaneParallel(CloudGenus genus) {
  return genus == CloudGenus::kStratus || genus == CloudGenus::kCirrostratus;
}

/// Returns the least and the greatest cover of a genus.
[[nodiscard]] std::pair<double, double> CoversOf(CloudGenus genus);

/// Returns the options of a genus that names nothing else.
[[nodiscard]] CloudOptions DefaultCloudOptions(CloudGenus genus);

/// Returns the genus with a name. Throws InputError that lists the names.
[[nodiscard]] CloudGenus CloudGenusNamed(std::string_view name);

/// Throws InputError "clouds.KEY is VALUE; ..." for the first value out of range.
void CheckCloudOptions(const CloudOptions& options);

/// Returns the vertical optical depth above which a column of the genus counts as covered.
[[nodiscard]] double CoveredOpticalDepth(CloudGenus genus);

}  // namespace alpenglow::renderer
