// SPDX-License-Identifier: MIT
#include "renderer/series/scene_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <type_traits>
#include <utility>
#include <variant>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/medium_fields.h"
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/time_place/time.h"
#include "lut/cli/program.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_fields.h"
#include "renderer/scene/scene_options.h"
#include "renderer/terrain/land_source.h"

namespace alpenglow::renderer {
namespace {

std::string TextOf(const Fnv1a& hash) { return fmt::format("{:016x}", hash.hash()); }

std::string HashOfFile(const std::filesystem::path& file, const std::stop_token& stop) {
  std::ifstream stream(file, std::ios::binary);
  Fnv1a hash;
  std::vector<char> block(1U << 20U);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
         stream.gcount() > 0) {
    hash.AddBytes({block.data(), static_cast<std::size_t>(stream.gcount())});
    if (stop.stop_requested())
      throw InputError(fmt::format("{}: is not read to its end", file.string()));
  }
  if (!stream.eof()) throw InputError(fmt::format("{}: cannot be read", file.string()));
  return TextOf(hash);
}

std::string DegreesText(double radians) { return fmt::format("{}", radians / kRadiansPerDegree); }

std::string HeightText(const Height& height) {
  return fmt::format("{} m above the {}", height.value_m,
                     height.above_ground ? "ground" : "ellipsoid");
}

/// Returns a value in the units of scene.toml.
std::string ValueText(const TomlValue& value) {
  if (const auto* const list = std::get_if<std::vector<double>>(&value))
    return fmt::format("{}", fmt::join(*list, " "));
  if (const auto* const rows = std::get_if<TomlRows>(&value)) {
    std::string text;
    for (const std::vector<double>& row : *rows)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", fmt::join(row, " "));
    return text;
  }
  return std::visit(
      [](const auto& one) -> std::string {
        using Type = std::decay_t<decltype(one)>;
        constexpr bool kIsList =
            std::is_same_v<Type, std::vector<double>> || std::is_same_v<Type, TomlRows>;
        if constexpr (kIsList) return "";
        if constexpr (!kIsList) return fmt::format("{}", one);
      },
      value);
}

/// Returns the values of all members in a table of fields.
template <typename Object>
Metadata ValuesOf(const TomlFields<Object>& fields, const Object& object) {
  Metadata values;
  for (const TomlField<Object>& field : fields.fields) {
    if (!field.member.get) continue;
    if (const auto value = field.member.get(object)) values[field.key] = ValueText(*value);
  }
  return values;
}

/// Returns the values that are recorded by name, except defaults.
template <typename Object>
Metadata NamedValuesOf(const TomlFields<Object>& fields, const Object& object) {
  Metadata values;
  for (const TomlField<Object>& field : fields.fields) {
    if (!field.is_recorded_by_name) continue;
    const auto value = field.member.get(object);
    if (value && value != field.member.get(Object{})) values[field.key] = ValueText(*value);
  }
  return values;
}

/// Returns the values that are recorded by name, under their own keys.
template <typename Object>
Metadata NamedRecordsOf(const TomlFields<Object>& fields, const Object& object) {
  Metadata records;
  for (const auto& [key, value] : NamedValuesOf(fields, object))
    records["alpenglow." + key] = value;
  return records;
}

template <typename Object>
std::string NamedText(const TomlFields<Object>& fields, const Object& object) {
  std::string text;
  for (const auto& [key, value] : NamedValuesOf(fields, object))
    text += fmt::format(", {} {}", key, value);
  return text;
}

/// Returns the number of the elevation models, and a hash of their names and contents in their
/// order.
std::string TextOfModels(const Scene& scene, const std::stop_token& stop) {
  const LandTiles tiles(LandSourceOf(scene));
  Metadata files;
  std::filesystem::path last;
  for (const LandTile& tile : tiles.tiles()) {
    if (std::exchange(last, tile.file) == tile.file) continue;  // another part of a large file
    files[fmt::format("{:06} {}", files.size(), tile.file.filename().string())] =
        HashOfFile(tile.file, stop);
  }
  return fmt::format("{} elevation models, hash {}", files.size(), Fingerprint(files));
}

std::string TerrainText(const TerrainSource& terrain, const FileHashes& hashes) {
  switch (terrain.kind) {
    case TerrainSource::Kind::kProceduralMountains:
      return !terrain.centre
                 ? "built-in range"
                 : fmt::format("{} around {}, {}",
                               terrain.range_seed == 0
                                   ? "built-in range"
                                   : fmt::format("built-in range {}", terrain.range_seed),
                               terrain.centre->latitude_deg, terrain.centre->longitude_deg);
    case TerrainSource::Kind::kElevationModel:
      return fmt::format(
          "{}, voids {}",
          hashes.models.empty() ? hashes.names_and_hashes.at(terrain.file) : hashes.models,
          terrain.voids == VoidPolicy::kFill ? "filled" : "open");
    case TerrainSource::Kind::kMesh:
      return hashes.names_and_hashes.at(terrain.file) + (terrain.up == UpAxis::kY ? ", y up" : "");
    case TerrainSource::Kind::kNone:
      return "none";
  }
  throw InternalError("unknown kind of terrain");
}

std::string LightText(const Light& light, const FileHashes& hashes) {
  std::string text =
      fmt::format("{} at {}, {}, {}: {} cd, {} K, radius {} m", NameOf(light.type),
                  light.place.latitude_deg, light.place.longitude_deg, HeightText(light.height),
                  light.intensity_cd ? fmt::format("{}", *light.intensity_cd) : "as measured",
                  light.temperature_k, light.radius_m);
  if (light.ies) {
    text += ", " + hashes.names_and_hashes.at(*light.ies);
  } else if (light.type == Light::Type::kPoint) {
    return text;
  }
  text += fmt::format(", heading {}, pitch {}", DegreesText(light.heading_rad),
                      DegreesText(light.pitch_rad));
  if (light.ies) return text;
  return text +
         fmt::format(", cone {} to {}", DegreesText(light.inner_rad), DegreesText(light.outer_rad));
}

/// Returns kind and all parameters; the parameters of droplets follow from their diameter.
std::string PhaseText(const PhaseFunction& phase) {
  std::string text = NameOf(phase.kind);
  for (const PhaseParameter& parameter : FormOf(phase.kind).parameters)
    text += fmt::format(" {} {}", parameter.key, phase.*parameter.member);
  if (phase.table) text += fmt::format(" {:016x}", phase.table->hash());
  return text;
}

std::string LayerText(const MediumLayer& layer) {
  return fmt::format("extinction {} per m at {}, scale height {} m, albedo {}, {}",
                     layer.extinction_per_m,
                     layer.base_height_m ? fmt::format("{} m", *layer.base_height_m) : "the ground",
                     layer.scale_height_m, layer.albedo, PhaseText(layer.phase));
}

// RecordOf returns the record of an object of a table of scene.toml. Each table of ForEachTable has
// one: SceneMetadata does not compile without it. `number` counts the objects of a table.

Metadata RecordOf(const TomlFields<Scene>& fields, const Scene& scene, std::size_t /*number*/,
                  const FileHashes& /*hashes*/) {
  return NamedRecordsOf(fields, scene);
}

Metadata RecordOf(const TomlFields<Camera>& fields, const Camera& camera, std::size_t /*number*/,
                  const FileHashes& /*hashes*/) {
  Metadata records = NamedRecordsOf(fields, camera);
  records["alpenglow.camera_height"] = HeightText(camera.height);
  records["alpenglow.heading_deg"] = DegreesText(camera.heading_rad);
  records["alpenglow.pitch_deg"] = DegreesText(camera.pitch_rad);
  records["alpenglow.roll_deg"] = DegreesText(camera.roll_rad);
  records["alpenglow.fov_deg"] = DegreesText(camera.fov_rad);
  if (!camera.lens) return records;
  const ThinLens& lens = *camera.lens;
  records["alpenglow.lens"] =
      fmt::format("f/{}, {} m, focus {} m, {} blades from {}", lens.f_number, lens.focal_length_m,
                  lens.focus_m, lens.blades, DegreesText(lens.blade_rotation_rad));
  return records;
}

Metadata RecordOf(const TomlFields<SceneWeather>& fields, const SceneWeather& weather,
                  std::size_t /*number*/, const FileHashes& /*hashes*/) {
  return NamedRecordsOf(fields, weather);
}

Metadata RecordOf(const TomlFields<TerrainSource>& fields, const TerrainSource& terrain,
                  std::size_t /*number*/, const FileHashes& hashes) {
  Metadata records{
      {"alpenglow.terrain", TerrainText(terrain, hashes) + NamedText(fields, terrain)}};
  if (!terrain.colour.empty())
    records["alpenglow.terrain_colour"] = hashes.names_and_hashes.at(terrain.colour);
  if (!terrain.land_cover.empty())
    records["alpenglow.land_cover"] = hashes.names_and_hashes.at(terrain.land_cover);
  return records;
}

Metadata RecordOf(const TomlFields<GroundCover>& fields, const GroundCover& ground,
                  std::size_t /*number*/, const FileHashes& /*hashes*/) {
  Metadata values = ValuesOf(fields, ground);
  values["cover"] = fmt::format("{}", static_cast<int>(ground.kind));
  values.erase("grain_diameter_mm");
  values["wind_m_per_s"] = fmt::format("{}", ground.wind_m_per_s.value_or(kUsualWind_m_per_s));
  values["grain_diameter_m"] = fmt::format("{}", ground.grain_diameter_m);
  return {{"alpenglow.ground_hash", Fingerprint(values)}};
}

Metadata RecordOf(const TomlFields<Light>& fields, const Light& light, std::size_t number,
                  const FileHashes& hashes) {
  return {{fmt::format("alpenglow.light_{}", number),
           LightText(light, hashes) + NamedText(fields, light)}};
}

Metadata RecordOf(const TomlFields<MediumLayer>& fields, const MediumLayer& layer,
                  std::size_t /*number*/, const FileHashes& /*hashes*/) {
  return {{"alpenglow." + fields.name, LayerText(layer) + NamedText(fields, layer)}};
}

Metadata RecordOf(const TomlFields<Volume>& fields, const Volume& volume, std::size_t number,
                  const FileHashes& hashes) {
  Metadata values = ValuesOf(fields, volume);
  values["height"] = HeightText(volume.height);
  values["phase"] = PhaseText(volume.phase);
  if (volume.grid_size) values["grid_size"] = fmt::format("{}", fmt::join(*volume.grid_size, " "));
  values["grid"] = hashes.grids.at(number);
  return {{fmt::format("alpenglow.volume_{}_hash", number), Fingerprint(values)}};
}

Metadata RecordOf(const TomlFields<SceneObject>& fields, const SceneObject& object,
                  std::size_t number, const FileHashes& /*hashes*/) {
  std::string text = "underside " + HeightText(object.height);
  for (const auto& [key, value] : ValuesOf(fields, object))
    text += fmt::format(", {} {}", key, value);
  return {{fmt::format("alpenglow.object_{}", number), text}};
}

Metadata RecordOf(const TomlFields<SceneCloud>& fields, const SceneCloud& cloud, std::size_t number,
                  const FileHashes& hashes) {
  std::string text;
  for (const auto& [key, value] : ValuesOf(fields, cloud))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value);
  if (cloud.is_over_ground) text += ", base over the ground";
  if (!cloud.grid.empty()) text += ", " + hashes.cloud_grids.at(number);
  if (cloud.middle)
    text += fmt::format(" at {}, {}", cloud.middle->latitude_deg, cloud.middle->longitude_deg);
  return {{fmt::format("alpenglow.cloud_{}", number), text}};
}

/// Returns the time on which the motion of clouds depends: the scene's day, and of grids in the wind
/// also its time.
std::string CloudTimeText(const Scene& scene) {
  const bool has_moving_grid =
      std::any_of(scene.clouds.begin(), scene.clouds.end(), [](const SceneCloud& cloud) {
        return !cloud.grid.empty() && cloud.options.wind_m_per_s != glm::dvec2(0.0);
      });
  const UtcTime midnight(CloudDayOf(scene), 0.0);
  return FormatUtc(has_moving_grid ? scene.time.value_or(midnight) : midnight, 9);
}

/// Returns the records of the scene's own members: place, air, light pollution and time of clouds.
Metadata OwnRecordsOf(const Scene& scene) {
  const Medium& medium = scene.medium;
  Metadata records{{"alpenglow.latitude_deg", fmt::format("{}", scene.place.latitude_deg)},
                   {"alpenglow.longitude_deg", fmt::format("{}", scene.place.longitude_deg)},
                   {"alpenglow.atmosphere", medium.name},
                   {"alpenglow.atmosphere_hash", fmt::format("{:016x}", MediumHash(medium))},
                   {"alpenglow.refraction", NameOf(medium.refraction)}};
  if (scene.town_zenith)
    records["alpenglow.town_zenith_mag_per_arcsec2"] = fmt::format("{}", *scene.town_zenith);
  if (!scene.clouds.empty()) records["alpenglow.cloud_time"] = CloudTimeText(scene);
  return records;
}

}  // namespace

FileHashes HashFilesOf(const Scene& scene, const std::stop_token& stop) {
  FileHashes hashes;
  std::vector<std::filesystem::path> models;
  if (scene.terrain.HasManyModels()) {
    models = LandSourceOf(scene).files;
    hashes.models = TextOfModels(scene, stop);
  }
  for (const NamedFile& named : FilesOf(scene)) {
    if (std::find(models.begin(), models.end(), named.file) != models.end()) continue;
    const auto [known, is_new] = hashes.names_and_hashes.try_emplace(named.file);
    if (is_new)
      known->second =
          fmt::format("{}, hash {}", named.file.filename().string(), HashOfFile(named.file, stop));
  }
  const auto text_of = [&](const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> texts;
    for (const std::filesystem::path& file : files)
      texts.push_back(hashes.names_and_hashes.at(file));
    return fmt::format("{}", fmt::join(texts, "; "));
  };
  for (const Volume& volume : scene.volumes) hashes.grids.push_back(text_of(FilesOf(volume)));
  for (const SceneCloud& cloud : scene.clouds)
    hashes.cloud_grids.push_back(text_of(FilesOf(cloud)));
  return hashes;
}

Metadata SceneMetadata(const Scene& scene, const FileHashes& hashes) {
  Metadata metadata{{"Software", ProducerText()},
                    {"alpenglow.unit", "cd/m^2, linear sRGB (Rec. 709 primaries, D65)"}};
  metadata.merge(OwnRecordsOf(scene));
  ForEachTable([&](const auto& fields, const auto& objects_of) {
    std::size_t number = 0;
    for (const auto& object : objects_of(scene))
      metadata.merge(RecordOf(fields, object, number++, hashes));
  });
  return metadata;
}

Metadata PoseMetadata(const CameraPose& pose) {
  return {{"alpenglow.latitude_deg", fmt::format("{}", pose.place.latitude_deg)},
          {"alpenglow.longitude_deg", fmt::format("{}", pose.place.longitude_deg)},
          {"alpenglow.camera_height", HeightText({pose.place.height_m, false})},
          {"alpenglow.heading_deg", DegreesText(pose.heading_rad)},
          {"alpenglow.pitch_deg", DegreesText(pose.pitch_rad)},
          {"alpenglow.roll_deg", DegreesText(pose.roll_rad)},
          {"alpenglow.fov_deg", DegreesText(pose.fov_rad)}};
}

Metadata PictureMetadata(const Scene& scene, const FileHashes& hashes,
                         const RenderSettings& settings) {
  Metadata metadata = SceneMetadata(scene, hashes);
  metadata["alpenglow.size"] = fmt::format("{}x{}", settings.width, settings.height);
  metadata["alpenglow.samples"] = fmt::format("{}", settings.samples_per_pixel);
  if (settings.noise) metadata["alpenglow.noise"] = fmt::format("{}", *settings.noise);
  if (settings.paths) metadata["alpenglow.paths"] = fmt::format("{}", *settings.paths);
  if (!scene.clouds.empty()) metadata["alpenglow.cloud_light"] = NameOf(settings.cloud_light);
  metadata["alpenglow.filter"] = NameOf(settings.filter);
  metadata["alpenglow.air_nodes"] = fmt::format("{}", settings.air_nodes);
  metadata["alpenglow.effects"] = NameOf(settings.effects);
  std::vector<std::string> layers;
  for (const PictureLayer layer : settings.layers) layers.push_back(NameOf(layer));
  metadata["alpenglow.layers"] = fmt::format("{}", fmt::join(layers, ","));
  return metadata;
}

Metadata NotesOn(const RayCount& rays, const RenderSettings& settings) {
  const double pixels = static_cast<double>(settings.width) * settings.height;
  Metadata notes{{"alpenglow.note.rays",
                  fmt::format("{:.3f} a pixel, {} to {}", static_cast<double>(rays.rays) / pixels,
                              rays.least, rays.most)}};
  if (rays.path_error) notes["alpenglow.note.path_error"] = fmt::format("{:.4f}", *rays.path_error);
  return notes;
}

std::string Fingerprint(const Metadata& metadata) {
  Fnv1a hash;
  for (const auto& [name, value] : metadata) {
    hash.AddBytes(name);
    hash.AddBytes({"\0", 1});
    hash.AddBytes(value);
    hash.AddBytes({"\0", 1});
  }
  return TextOf(hash);
}

}  // namespace alpenglow::renderer
