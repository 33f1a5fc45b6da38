// SPDX-License-Identifier: MIT
#include "renderer/series/manifest_json.h"

#include <fmt/format.h>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/moon.h"
#include "atmosphere/sun/sun.h"
#include "lut/program/json_text.h"
#include "lut/program/program.h"

namespace alpenglow::renderer {
namespace {

std::string StringOrNull(const std::string& text) {
  return text.empty() ? "null" : JsonString(text);
}

std::string NumberOrNull(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "null";
}

std::string PoseOf(const ManifestEntry& entry) {
  if (!entry.pose) return "";
  const CameraPose& pose = *entry.pose;
  return fmt::format(
      ",\"t_s\":{:.6f},\"latitude\":{:.8f},\"longitude\":{:.8f},\"height_m\":{:.3f},"
      "\"heading\":{:.6f},\"pitch\":{:.6f},\"roll\":{:.6f},\"fov\":{:.6f}",
      entry.frame.path_s, pose.place.latitude_rad / kRadiansPerDegree,
      pose.place.longitude_rad / kRadiansPerDegree, pose.place.height_m,
      pose.heading_rad / kRadiansPerDegree, pose.pitch_rad / kRadiansPerDegree,
      pose.roll_rad / kRadiansPerDegree, pose.fov_rad / kRadiansPerDegree);
}

std::string ObjectOf(const ManifestEntry& entry) {
  const SunPosition sun = SunAt(entry.place, entry.frame.instant);
  const MoonPosition moon = MoonAt(entry.place, entry.frame.instant);
  return fmt::format(
      "{{\"frame\":{},\"file\":{},\"utc\":{},\"local_time\":{},\"sun_azimuth_deg\":{:.4f},"
      "\"sun_elevation_deg\":{:.4f},\"sun_covered\":{:.6f},\"moon_azimuth_deg\":{:.4f},\"moon_"
      "elevation_deg\":{:.4f},"
      "\"moon_illuminated\":{:.4f},\"illuminance_lx\":{},\"ev100\":{},\"exposure\":{}{}}}",
      entry.frame.number, JsonString(entry.file), JsonString(FormatUtc(entry.frame.instant)),
      StringOrNull(entry.local_time), sun.azimuth_rad / kRadiansPerDegree,
      sun.elevation_rad / kRadiansPerDegree, entry.sun_covered,
      moon.azimuth_rad / kRadiansPerDegree, moon.elevation_rad / kRadiansPerDegree,
      moon.IlluminatedFraction(), NumberOrNull(entry.illuminance_lx), NumberOrNull(entry.ev100),
      StringOrNull(entry.exposure), PoseOf(entry));
}

}  // namespace

std::string JsonOfManifest(const std::vector<ManifestEntry>& entries, const Metadata& settings) {
  std::string text = fmt::format("{{\"program\":{},\n\"settings\":{{", JsonString(ProducerText()));
  const char* between = "";
  for (const auto& [name, value] : settings) {
    text += fmt::format("{}\n{}:{}", between, JsonString(name), JsonString(value));
    between = ",";
  }
  text += "},\n\"frames\":[";
  between = "";
  for (const ManifestEntry& entry : entries) {
    text += fmt::format("{}\n{}", between, ObjectOf(entry));
    between = ",";
  }
  return text + "]}\n";
}

}  // namespace alpenglow::renderer
