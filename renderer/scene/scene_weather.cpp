// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_weather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/scene/places.h"

namespace alpenglow::renderer {
namespace {

constexpr double kMiddleClouds_m = 2000.0, kHighClouds_m = 6000.0;
constexpr double kDepthOfToweringCumulus_m = 3000.0;
constexpr double kDepthOfCumulonimbus_m = CloudRanges::kDepth_m.second;

double CoverOf(CloudAmount amount) {
  constexpr double kOktas = 8.0;
  switch (amount) {
    case CloudAmount::kFew:
      return 1.5 / kOktas;
    case CloudAmount::kScattered:
      return 3.5 / kOktas;
    case CloudAmount::kBroken:
      return 6.0 / kOktas;
    case CloudAmount::kOvercast:
      return 1.0;
  }
  throw InternalError("unknown amount of clouds");
}

CloudGenus GenusOf(const ReportedCloud& cloud) {
  const bool is_overcast = cloud.amount == CloudAmount::kOvercast;
  if (cloud.convection != Convection::kUnstated) return CloudGenus::kCumulus;
  if (cloud.height_m >= kHighClouds_m)
    return is_overcast ? CloudGenus::kCirrostratus : CloudGenus::kCirrus;
  if (cloud.height_m >= kMiddleClouds_m) return CloudGenus::kAltocumulus;
  if (is_overcast) return CloudGenus::kStratus;
  return cloud.amount == CloudAmount::kBroken ? CloudGenus::kStratocumulus : CloudGenus::kCumulus;
}

/// Returns the drift of clouds to the east and to the north at a height above the station.
glm::dvec2 DriftAt(const ReportedWind& wind, double height_m) {
  constexpr double kAnemometer_m = 10.0, kBoundaryLayer_m = 600.0, kPower = 1.0 / 7.0;
  if (!wind.from_deg) return glm::dvec2(0.0);
  const double ratio = std::clamp(height_m, kAnemometer_m, kBoundaryLayer_m) / kAnemometer_m;
  const double speed_m_per_s = wind.speed_m_per_s * std::pow(ratio, kPower);
  const double from_rad = *wind.from_deg * kRadiansPerDegree;
  return -speed_m_per_s * glm::dvec2(std::sin(from_rad), std::cos(from_rad));
}

SceneCloud LayerOf(const ReportedCloud& reported, const MetarReport& report) {
  SceneCloud cloud;
  cloud.name = reported.group;
  cloud.options = DefaultCloudOptions(GenusOf(reported));
  cloud.options.cover = std::min(CoverOf(reported.amount), CoversOf(cloud.options.genus).second);
  cloud.options.base_altitude_m = reported.height_m;
  if (reported.convection == Convection::kToweringCumulus)
    cloud.options.depth_m = kDepthOfToweringCumulus_m;
  if (reported.convection == Convection::kCumulonimbus)
    cloud.options.depth_m = kDepthOfCumulonimbus_m;
  if (report.wind) cloud.options.wind_m_per_s = DriftAt(*report.wind, reported.height_m);
  return cloud;
}

/// Returns the cloud that hides the sky.
ReportedCloud HidingCloud(const ObscuredSky& sky, const MetarReport& report) {
  constexpr double kHighest_m = 300.0;
  const double visibility_m = report.visibility ? report.visibility->distance_m : kHighest_m;
  return {sky.group, CloudAmount::kOvercast,
          sky.vertical_visibility_m.value_or(std::min(visibility_m, kHighest_m)),
          Convection::kUnstated};
}

/// Returns the layers of a report in the order of their bases.
std::vector<ReportedCloud> LayersOfReport(const MetarReport& report) {
  std::vector<ReportedCloud> layers = report.clouds;
  if (report.obscured) layers.push_back(HidingCloud(*report.obscured, report));
  std::stable_sort(
      layers.begin(), layers.end(),
      [](const ReportedCloud& a, const ReportedCloud& b) { return a.height_m < b.height_m; });
  return layers;
}

/// Returns the depth of a layer that ends below the next one.
double DepthBelow(const SceneCloud& cloud, const ReportedCloud& next) {
  const double room_m = next.height_m - cloud.options.base_altitude_m;
  return std::clamp(room_m, CloudRanges::kDepth_m.first, cloud.options.depth_m);
}

/// Returns the height of the station above which the clouds of a scene are; nothing over the built-in
/// range, whose ground is not that of the station, unless the scene gives a height.
std::optional<double> CloudDatum_m(const Scene& scene, std::optional<double> station_m) {
  const bool is_made_up = scene.terrain.kind == TerrainSource::Kind::kProceduralMountains;
  return is_made_up ? scene.weather.station_height_m : station_m;
}

/// Returns clouds whose names begin with the origin of their report; refuses bases above all fields.
std::vector<SceneCloud> NamedClouds(std::vector<SceneCloud> clouds, const std::string& origin) {
  const auto [lowest_m, highest_m] = CloudRanges::kBase_m;
  for (SceneCloud& cloud : clouds) {
    RequireInRange(cloud.options.base_altitude_m, lowest_m, highest_m,
                   fmt::format("the base of {} in metres above the ellipsoid", cloud.name));
    cloud.name = fmt::format("{}: {}", origin, cloud.name);
  }
  return clouds;
}

MediumLayer FogOf(const MetarReport& report, const Medium& air, std::optional<double> station_m) {
  constexpr double kScaleHeight_m = 50.0, kDroplets_um = 15.0;
  const double of_air_per_m =
      kOpticalDepthOfVisibility / VisibilityAt(air, station_m.value_or(0.0), 0.0);
  MediumLayer fog;
  fog.extinction_per_m =
      std::max(kOpticalDepthOfVisibility / report.visibility->distance_m - of_air_per_m, 0.0);
  fog.scale_height_m = kScaleHeight_m;
  fog.base_height_m = station_m;
  fog.phase = DropletPhase(kDroplets_um);
  return fog;
}

/// Returns a message if the base of clouds that rise from the ground contradicts the temperatures.
std::optional<std::string> ContradictionOf(const ReportedCloud& cloud, const MetarReport& report) {
  // Temperatures are rounded to kelvins (125 m each), and air that mixes with its surroundings rises
  // higher than the rule.
  constexpr double kTolerance_m = 300.0, kRelative = 0.25;
  const std::optional<double> level_m = CondensationLevel_m(report);
  if (!level_m || GenusOf(cloud) != CloudGenus::kCumulus) return std::nullopt;
  if (std::abs(cloud.height_m - *level_m) <= kTolerance_m + kRelative * *level_m)
    return std::nullopt;
  return fmt::format(
      "{} has its base at {:.0f} m, and temperature {} with dew point {} forms clouds of rising "
      "air at {:.0f} m; the base is kept",
      cloud.group, cloud.height_m, *report.temperature.air_c, *report.temperature.dew_point_c,
      *level_m);
}

/// Returns a message if clouds of a group are drawn only in part.
std::optional<std::string> LimitOf(const ReportedCloud& cloud) {
  std::vector<std::string> limits;
  if (cloud.convection == Convection::kCumulonimbus)
    limits.push_back(fmt::format("as cumulus {:.0f} m deep without anvil", kDepthOfCumulonimbus_m));
  if (cloud.convection != Convection::kUnstated && cloud.amount == CloudAmount::kOvercast)
    limits.push_back(fmt::format("with a cover of {}", kMostCumulusCover));
  if (limits.empty()) return std::nullopt;
  return fmt::format("{} is drawn {}", cloud.group, fmt::join(limits, ", "));
}

/// Returns a message if water of a scene has less than the waves of a report.
std::optional<std::string> LimitOfWaves(const MetarReport& report, const Scene& scene) {
  const bool has_water = scene.ground.kind == GroundCover::Kind::kWater ||
                         scene.ground.sea_level_m || !scene.terrain.land_cover.empty();
  if (!report.wind || scene.ground.wind_m_per_s || !has_water) return std::nullopt;
  const double speed_m_per_s = report.wind->speed_m_per_s, most = kWindsOverWater_m_per_s.second;
  if (speed_m_per_s <= most) return std::nullopt;
  return fmt::format("water is drawn with the waves of a wind of {:.0f} m/s, not {:.0f}", most,
                     speed_m_per_s);
}

/// Returns the airport with a code, or null.
const NamedPlace* AirportNamed(std::string_view code) {
  const auto places = NamedPlaces();
  const auto found = std::find_if(places.begin(), places.end(),
                                  [&](const NamedPlace& place) { return place.code == code; });
  return found == places.end() ? nullptr : &*found;
}

/// Returns notes about the visibility and fog of a report.
std::vector<std::string> NotesOnFog(const MetarReport& report) {
  if (report.fog.empty()) return {};
  if (!report.visibility) return {fmt::format("{} without a visibility is not drawn", report.fog)};
  if (report.visibility->distance_m < kVisibilityOfFog_m) return {};
  return {fmt::format("{} has a visibility of {:.0f} m; fog has less than {:.0f} m", report.fog,
                      report.visibility->distance_m, kVisibilityOfFog_m)};
}

}  // namespace

std::optional<double> StationHeight_m(const Scene& scene, const MetarReport& report) {
  if (scene.weather.station_height_m) return scene.weather.station_height_m;
  const NamedPlace* airport = AirportNamed(report.station);
  return airport == nullptr ? std::nullopt : std::optional(airport->place.height_m);
}

std::vector<SceneCloud> CloudsOfReport(const MetarReport& report, std::optional<double> station_m) {
  const std::vector<ReportedCloud> layers = LayersOfReport(report);
  std::vector<SceneCloud> clouds;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    SceneCloud cloud = LayerOf(layers[i], report);
    if (i + 1 < layers.size() && layers[i].convection == Convection::kUnstated)
      cloud.options.depth_m = DepthBelow(cloud, layers[i + 1]);
    cloud.options.base_altitude_m = std::max(
        cloud.options.base_altitude_m + station_m.value_or(0.0), CloudRanges::kBase_m.first);
    cloud.options.seed = static_cast<std::uint32_t>(i) + 1U;
    cloud.is_over_ground = !station_m;
    clouds.push_back(std::move(cloud));
  }
  return clouds;
}

std::vector<std::string> NotesOnReport(const MetarReport& report) {
  std::vector<std::string> notes;
  if (!report.not_modelled.empty())
    notes.push_back(fmt::format("not modelled: {}", fmt::join(report.not_modelled, ", ")));
  for (const ReportedCloud& cloud : report.clouds) {
    if (auto note = ContradictionOf(cloud, report)) notes.push_back(std::move(*note));
    if (auto note = LimitOf(cloud)) notes.push_back(std::move(*note));
  }
  for (std::string& note : NotesOnFog(report)) notes.push_back(std::move(note));
  return notes;
}

UtcTime TimeOfReport(const MetarReport& report) {
  constexpr int kDaysInJune = 30;
  const auto& [day, hour, minute] = report.time;
  return ParseInstant(fmt::format("2026-{}-{:02}T{:02}:{:02}:00Z", day <= kDaysInJune ? "06" : "07",
                                  day, hour, minute));
}

Scene InWeather(Scene scene, const std::string& origin) {
  if (!scene.weather.metar) return scene;
  const MetarReport report = ReadMetar(*scene.weather.metar);
  const std::optional<double> station_m = StationHeight_m(scene, report);
  std::vector<std::string> notes = NotesOnReport(report);
  if (!station_m) {
    notes.push_back(
        fmt::format("the station {} is no named airport; its height is taken as 0 m, "
                    "and clouds are above the ground of the scene",
                    report.station));
  }
  scene.medium = InReportedAir(std::move(scene.medium), report, station_m.value_or(0.0));
  const std::optional<double> datum_m = CloudDatum_m(scene, station_m);
  if (IsInFog(report) && report.visibility) scene.layers = {FogOf(report, scene.medium, datum_m)};
  if (report.states_clouds) scene.clouds = NamedClouds(CloudsOfReport(report, datum_m), origin);
  if (!scene.time) scene.time = TimeOfReport(report);
  if (auto note = LimitOfWaves(report, scene)) notes.push_back(std::move(*note));
  if (report.wind && !scene.ground.wind_m_per_s) {
    scene.ground.wind_m_per_s =
        std::min(report.wind->speed_m_per_s, kWindsOverWater_m_per_s.second);
  }
  scene.weather.metar = report.text;
  for (const std::string& note : notes)
    scene.weather.notes.push_back(fmt::format("{}: {}", origin, note));
  return scene;
}

Scene InTypedWeather(Scene scene, const SceneWeather& weather) {
  constexpr char kOption[] = "--metar";
  scene.weather = weather;
  try {
    return InWeather(std::move(scene), kOption);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", kOption, error.what()));
  }
}

std::optional<std::string> AirportOf(const SceneWeather& weather) {
  if (!weather.metar) return std::nullopt;
  const NamedPlace* airport = AirportNamed(ReadMetar(*weather.metar).station);
  return airport == nullptr ? std::nullopt : std::optional(airport->code);
}

}  // namespace alpenglow::renderer
