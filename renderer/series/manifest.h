// SPDX-License-Identifier: MIT
// Records of frames: the values of a frame, which the header of its picture, the list of frames
// (`skyseries --list`) and the manifests of a series write, each with its own keys and formats.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "lut/image/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// The values of a frame, as a list of keys and values in the order in which they were set. Keys:
/// frame, file, utc, local_time; sun_azimuth_deg, sun_elevation_deg, moon_azimuth_deg,
/// moon_elevation_deg (without refraction), moon_illuminated ([0, 1]), sun_covered (fraction of the
/// sun's light at 550 nm behind the moon, [0, 1]); illuminance_lx, ev100, exposure (its rule); on a
/// path t_s, latitude, longitude, height_m, heading, pitch, roll and fov (degrees).
class FrameRecord {
 public:
  /// Empty: not known.
  using Value = std::variant<std::monostate, int, double, std::string>;

  /// Replaces the value of the key, a literal. An empty text is not known.
  void Set(std::string_view key, Value value);
  /// Returns a value that is not known for a key that was not set.
  [[nodiscard]] const Value& At(std::string_view key) const;
  /// Returns the value of a key if it is a number with a fraction.
  [[nodiscard]] std::optional<double> Number(std::string_view key) const;

 private:
  std::vector<std::pair<std::string_view, Value>> values_;
};

/// Returns the record of what is known before a frame is rendered, except its file: number, times,
/// sun and moon.
/// @param has_moon  false: no moon covers the sun.
[[nodiscard]] FrameRecord RecordOf(const Frame& frame, const Place& place,
                                   const std::optional<std::string>& zone, bool has_moon = true);
/// Adds the position of a frame on a path, and its pose.
void AddPose(const Frame& frame, const CameraPose& pose, FrameRecord& record);

/// A value that an output of records has, and its format (that of fmt). Directions in degrees are
/// written in [0, 360) after rounding.
struct RecordField {
  const char* key;
  const char* format = "{}";
  std::optional<int> decimals_of_direction = {};  // instead of the format
};

/// Returns the values for the header of a picture that RecordOf knows.
[[nodiscard]] Metadata HeaderOf(const FrameRecord& record);

/// Returns the header of a CSV, and the line of a frame: frame, utc, local_time (empty without a
/// zone), sun_azimuth_deg, sun_elevation_deg, sun_covered, moon_azimuth_deg, moon_elevation_deg,
/// moon_illuminated, file (empty if it is not known).
[[nodiscard]] std::string HeaderOfList();
[[nodiscard]] std::string ListLineOf(const FrameRecord& record);

/// Returns CSV with a header: frame, file, utc, local_time, sun_azimuth_deg, sun_elevation_deg,
/// sun_covered, ev100; on a path also t_s and the pose; exposure. Unknown values are empty.
[[nodiscard]] std::string CsvOfManifest(const std::vector<FrameRecord>& records, bool on_path);

/// Returns one JSON object: "program", "settings" (everything that affects the pixels except time
/// and pose), "frames", a list of objects with all keys of FrameRecord. Unknown values are null.
[[nodiscard]] std::string JsonOfManifest(const std::vector<FrameRecord>& records,
                                         const Metadata& settings, bool on_path);

}  // namespace alpenglow::renderer
