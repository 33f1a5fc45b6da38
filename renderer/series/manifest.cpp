// SPDX-License-Identifier: MIT
#include "renderer/series/manifest.h"

#include <fmt/format.h>

#include <array>
#include <type_traits>
#include <utility>

#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/messages.h"
#include "lut/cli/program.h"
#include "lut/cli/terminal.h"

namespace alpenglow::renderer {
namespace {

constexpr std::array<RecordField, 8> kPoseFields{{{"t_s", "{:.6f}"},
                                                  {"latitude", "{:.8f}"},
                                                  {"longitude", "{:.8f}"},
                                                  {"height_m", "{:.3f}"},
                                                  {"heading", "", 6},
                                                  {"pitch", "{:.6f}"},
                                                  {"roll", "{:.6f}"},
                                                  {"fov", "{:.6f}"}}};

/// Returns the fields that begin every manifest, and `more` after them.
std::vector<RecordField> FirstFields(const std::vector<RecordField>& more) {
  std::vector<RecordField> fields{{"frame"},
                                  {"file"},
                                  {"utc"},
                                  {"local_time"},
                                  {"sun_azimuth_deg", "", 4},
                                  {"sun_elevation_deg", "{:.4f}"},
                                  {"sun_covered", "{:.6f}"}};
  fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

/// Returns the fields of both manifests.
std::vector<RecordField> ManifestFields(bool on_path) {
  std::vector<RecordField> fields = FirstFields({{"moon_azimuth_deg", "", 4},
                                                 {"moon_elevation_deg", "{:.4f}"},
                                                 {"moon_illuminated", "{:.4f}"},
                                                 {"illuminance_lx", "{:.6g}"},
                                                 {"ev100", "{:.6g}"},
                                                 {"exposure"}});
  if (on_path) fields.insert(fields.end(), kPoseFields.begin(), kPoseFields.end());
  return fields;
}

const std::vector<RecordField>& ListFields() {
  static const std::vector<RecordField> kFields{{"frame"},
                                                {"utc"},
                                                {"local_time"},
                                                {"sun_azimuth_deg", "", 3},
                                                {"sun_elevation_deg", "{:.3f}"},
                                                {"sun_covered", "{:.4f}"},
                                                {"moon_azimuth_deg", "", 3},
                                                {"moon_elevation_deg", "{:.3f}"},
                                                {"moon_illuminated", "{:.3f}"},
                                                {"file"}};
  return kFields;
}

/// Returns the value as text; empty if it is not known.
std::string TextOf(const FrameRecord& record, const RecordField& field) {
  return std::visit(
      [&](const auto& value) -> std::string {
        using Type = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Type, std::monostate>) return "";
        if constexpr (std::is_same_v<Type, double>) {
          if (field.decimals_of_direction)
            return DirectionText(value, *field.decimals_of_direction);
        }
        if constexpr (!std::is_same_v<Type, std::monostate>)
          return fmt::format(fmt::runtime(field.format), value);
      },
      record.At(field.key));
}

template <typename Cell>
std::string CsvLine(const std::vector<RecordField>& fields, const Cell& cell) {
  std::string text;
  for (const RecordField& field : fields)
    text += cell(field) + (&field == &fields.back() ? "\n" : ",");
  return text;
}

std::string CsvHeader(const std::vector<RecordField>& fields) {
  return CsvLine(fields, [](const RecordField& field) { return std::string(field.key); });
}

std::string CsvLineOf(const FrameRecord& record, const std::vector<RecordField>& fields) {
  return CsvLine(fields, [&](const RecordField& field) { return TextOf(record, field); });
}

std::string JsonObject(const FrameRecord& record, const std::vector<RecordField>& fields) {
  std::string text;
  for (const RecordField& field : fields) {
    const bool is_text = std::holds_alternative<std::string>(record.At(field.key));
    const std::string value = TextOf(record, field);
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", JsonString(field.key),
                        is_text         ? JsonString(value)
                        : value.empty() ? "null"
                                        : value);
  }
  return "{" + text + "}";
}

}  // namespace

void FrameRecord::Set(std::string_view key, Value value) {
  const auto* const text = std::get_if<std::string>(&value);
  if (text != nullptr && text->empty()) value = std::monostate();
  for (auto& [known, old] : values_) {
    if (known != key) continue;
    old = std::move(value);
    return;
  }
  values_.emplace_back(key, std::move(value));
}

const FrameRecord::Value& FrameRecord::At(std::string_view key) const {
  static const Value kUnknown;
  for (const auto& [known, value] : values_) {
    if (known == key) return value;
  }
  return kUnknown;
}

std::optional<double> FrameRecord::Number(std::string_view key) const {
  const auto* const number = std::get_if<double>(&At(key));
  return number != nullptr ? std::optional(*number) : std::nullopt;
}

FrameRecord RecordOf(const Frame& frame, const Place& place, const std::optional<std::string>& zone,
                     bool has_moon) {
  const SkyBodies bodies = SkyBodiesAt(place, frame.instant);
  FrameRecord record;
  record.Set("frame", frame.number);
  record.Set("utc", FormatUtc(frame.instant));
  record.Set("local_time", zone ? FormatInZone(frame.instant, *zone) : "");
  record.Set("sun_azimuth_deg", bodies.sun.azimuth_deg);
  record.Set("sun_elevation_deg", bodies.sun.elevation_deg);
  record.Set("sun_covered", has_moon ? bodies.CoveredLight() : 0.0);
  record.Set("moon_azimuth_deg", bodies.moon.azimuth_deg);
  record.Set("moon_elevation_deg", bodies.moon.elevation_deg);
  record.Set("moon_illuminated", bodies.moon.illuminated_fraction);
  return record;
}

void AddPose(const Frame& frame, const CameraPose& pose, FrameRecord& record) {
  record.Set("t_s", frame.path_s);
  record.Set("latitude", pose.place.latitude_deg);
  record.Set("longitude", pose.place.longitude_deg);
  record.Set("height_m", pose.place.height_m);
  record.Set("heading", pose.heading_rad / kRadiansPerDegree);
  record.Set("pitch", pose.pitch_rad / kRadiansPerDegree);
  record.Set("roll", pose.roll_rad / kRadiansPerDegree);
  record.Set("fov", pose.fov_rad / kRadiansPerDegree);
}

Metadata HeaderOf(const FrameRecord& record) {
  Metadata metadata;
  const auto add = [&](const RecordField& field) {
    const std::string text = TextOf(record, field);
    if (!text.empty()) metadata[fmt::format("alpenglow.{}", field.key)] = text;
  };
  for (const RecordField& field :
       {RecordField{"frame"}, RecordField{"sun_azimuth_deg", "", 6},
        RecordField{"sun_elevation_deg", "{:.6f}"}, RecordField{"local_time"}})
    add(field);
  if (record.Number("sun_covered").value_or(0.0) > 0.0) add({"sun_covered", "{:.6f}"});
  return metadata;
}

std::string HeaderOfList() { return CsvHeader(ListFields()); }

std::string ListLineOf(const FrameRecord& record) { return CsvLineOf(record, ListFields()); }

std::string CsvOfManifest(const std::vector<FrameRecord>& records, bool on_path) {
  const std::vector<RecordField> fields = ManifestFields(on_path);
  std::string text = CsvHeader(fields);
  for (const FrameRecord& record : records) text += CsvLineOf(record, fields);
  return text;
}

std::string JsonOfManifest(const std::vector<FrameRecord>& records, const Metadata& settings,
                           bool on_path) {
  std::string text = fmt::format("{{\"program\":{},\n\"settings\":{{", JsonString(ProducerText()));
  const char* between = "";
  for (const auto& [name, value] : settings) {
    text += fmt::format("{}\n{}:{}", between, JsonString(name), JsonString(value));
    between = ",";
  }
  text += "},\n\"frames\":[";
  between = "";
  const std::vector<RecordField> fields = ManifestFields(on_path);
  for (const FrameRecord& record : records) {
    text += fmt::format("{}\n{}", between, JsonObject(record, fields));
    between = ",";
  }
  return text + "]}\n";
}

}  // namespace alpenglow::renderer
