// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/base/text_file.h"
#include "atmosphere/base/toml_table.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_fields.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/scene/volume_file.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

double Radians(double degrees) { return degrees * kRadiansPerDegree; }

/// Returns the section, all of whose values are accepted by its keys.
template <typename Object>
std::optional<TomlSection> SectionOf(const TomlTable& document, const TomlFields<Object>& fields) {
  const std::optional<TomlTable> table = document.Table(fields.name);
  if (!table) return std::nullopt;
  return TomlSection(*table, fields.Keys());
}

void Require(const TomlTable& table, const std::string& key) {
  if (!table.Has(key)) table.Fail(key, table.FullName(key) + " is missing");
}

double Required(const TomlSection& table, const std::string& key) {
  Require(table, key);
  return *table.Number(key);
}

/// Calls `read` and prefixes the message of its InputError with file and line of `key`.
template <typename Read>
auto At(const TomlTable& table, const std::string& key, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    table.Fail(key, fmt::format("{}: {}", table.FullName(key), error.what()));
  }
}

Height HeightOf(const TomlSection& table, const Height& fallback) {
  const std::optional<double> height = table.Number("height_m");
  const std::optional<double> above = table.Number("above_ground_m");
  if (height && above) {
    table.Fail("above_ground_m",
               fmt::format("{} and {} are both given; give one", table.FullName("height_m"),
                           table.FullName("above_ground_m")));
  }
  if (height) return {*height, false};
  if (above) return {*above, true};
  return fallback;
}

void ReadPlace(const TomlTable& document, Scene& scene) {
  const std::optional<TomlSection> table = SectionOf(document, PlaceFields());
  if (!table) document.Fail("place", "[place] with latitude and longitude is missing");
  const double latitude = Required(*table, "latitude");
  const double longitude = Required(*table, "longitude");
  PlaceFields().Read(*table, scene);
  if (scene.zone) At(*table, "zone", [&] { return FormatInZone(UtcTime{}, *scene.zone); });
  scene.place = CheckedPlace({latitude, longitude, 0.0});
}

std::optional<UtcTime> TimeOf(const TomlTable& document, const std::optional<std::string>& zone) {
  const std::optional<TomlSection> table = SectionOf(document, TimeFields());
  if (!table) return std::nullopt;
  const std::optional<std::string> utc = table->Text("utc");
  const std::optional<std::string> local = table->Text("local");
  if (utc && local) table->Fail("local", "time.utc and time.local are both given; give one");
  if (utc) return At(*table, "utc", [&] { return ParseInstant(*utc); });
  if (!local) table->Fail("utc", "time.utc is missing");
  if (!zone) table->Fail("local", "time.local needs place.zone");
  return At(*table, "local", [&] { return ParseInstant(*local, zone); });
}

int BladesOf(const TomlSection& table) {
  const double blades = table.Number("blades").value_or(0.0);
  if (blades != std::floor(blades) || blades == 1.0 || blades == 2.0) {
    table.Fail("blades", fmt::format("{} is {}; it must be 0, a round iris, or 3 to 64",
                                     table.FullName("blades"), blades));
  }
  return static_cast<int>(blades);
}

/// The smallest accepted f-number. Lenses in air end at 0.5 (the sine condition); a fifth of that
/// leaves room for exaggerated effects.
constexpr double kWidestLens = 0.1;

std::optional<ThinLens> LensOf(const TomlSection& table) {
  const double f_number = table.Number("f_number").value_or(0.0);
  const std::optional<double> focal_length_mm = table.Number("focal_length_mm");
  const std::optional<double> focus_m = table.Number("focus_m");
  const int blades = BladesOf(table);
  const double rotation = table.Number("blade_rotation").value_or(0.0);
  if (f_number == 0.0) return std::nullopt;
  if (f_number < kWidestLens) {
    table.Fail("f_number", fmt::format("{} is {}; it must be 0, a pinhole, or from {} to 1000",
                                       table.FullName("f_number"), f_number, kWidestLens));
  }
  for (const auto& [key, value] :
       {std::pair{"focal_length_mm", focal_length_mm}, std::pair{"focus_m", focus_m}}) {
    if (!value) {
      table.Fail(
          key, fmt::format("{} is missing; a lens with an f_number needs it", table.FullName(key)));
    }
  }
  if (!(*focus_m > 1e-3 * *focal_length_mm)) {
    table.Fail("focus_m",
               fmt::format("camera.focus_m is {}; it must be beyond the focal length", *focus_m));
  }
  return ThinLens{f_number, 1e-3 * *focal_length_mm, *focus_m, blades, Radians(rotation)};
}

/// Returns the field of view [degrees] of a sensor of `camera.sensor_width_mm`: it is f s / (s - f)
/// behind the lens, where objects at the focus distance s are sharp, or f behind it without a focus
/// distance. No value if no sensor is given.
std::optional<double> FovOfSensor(const TomlSection& table, const std::optional<ThinLens>& lens) {
  const std::optional<double> width_mm = table.Number("sensor_width_mm");
  if (!width_mm) return std::nullopt;
  const double f = Required(table, "focal_length_mm");
  const double v = lens ? f / (1.0 - 1e-3 * f / lens->focus_m) : f;
  return 2.0 * std::atan(0.5 * *width_mm / v) / kRadiansPerDegree;
}

/// Returns the field of view: the given one, that of sensor and focal length, or 60 degrees. If
/// both are given, they may differ by as much as focusing and rounding change it.
double FovOf(const TomlSection& table, const std::optional<ThinLens>& lens) {
  constexpr double kSame = 0.05;
  const std::optional<double> given = table.Number("fov");
  const std::optional<double> of_sensor = FovOfSensor(table, lens);
  if (given && of_sensor && !(std::abs(*given / *of_sensor - 1.0) <= kSame)) {
    table.Fail("fov",
               fmt::format("camera.fov is {}, but focal length and sensor make it {:.4g}; give one",
                           *given, *of_sensor));
  }
  if (lens && given == 360.0) table.Fail("f_number", "camera.f_number: a panorama has no lens");
  return given ? *given : of_sensor.value_or(60.0);
}

Camera CameraOf(const TomlTable& document) {
  const std::optional<TomlSection> table = SectionOf(document, CameraFields());
  if (!table) return {};
  const std::optional<ThinLens> lens = LensOf(*table);
  const double fov = FovOf(*table, lens);
  const Height height = HeightOf(*table, Height{});
  Camera camera = At(*table, "fov", [&] { return CameraFromDegrees(height, 0.0, 0.0, 0.0, fov); });
  camera.lens = lens;
  CameraFields().Read(*table, camera);
  return camera;
}

Medium MediumOf(const TomlTable& document, const fs::path& folder, const MediumUse& use) {
  const std::optional<TomlSection> table = SectionOf(document, AtmosphereFields());
  if (!table) return MediumPreset("earth");
  const std::optional<std::string> file = table->Text("file");
  const std::optional<std::string> preset = table->Text("preset");
  if (file && preset) {
    table->Fail("preset", "atmosphere.file and atmosphere.preset are both given; give one");
  }
  if (preset) return At(*table, "preset", [&] { return MediumPreset(*preset); });
  if (!file) table->Fail("file", "atmosphere.file is missing");
  return MediumFromChoice(*file, use, folder);
}

/// Returns the file that a key names relative to the folder of the scene.
std::optional<fs::path> FileNamedBy(const TomlSection& table, const std::string& key,
                                    const fs::path& folder) {
  const std::optional<std::string> name = table.Text(key);
  if (!name) return std::nullopt;
  if (name->empty())
    table.Fail(key, table.FullName(key) + " is empty; it must be the name of a file");
  return folder / *name;
}

/// Refuses tables of the file that give what its report gives.
void RequireNoSecondWeather(const TomlTable& document, const MetarReport& report) {
  if (report.states_clouds && document.Has("cloud"))
    throw InputError("the report and [[cloud]] both give clouds; give one");
  if (IsInFog(report) && document.Has("fog"))
    throw InputError("the report and [fog] both give fog; give one");
}

/// Returns the scene in the weather of its file, if it gives one.
Scene InWeatherOfFile(Scene scene, const TomlTable& document) {
  const std::optional<TomlSection> table = SectionOf(document, WeatherFields());
  if (!table) return scene;
  WeatherFields().Read(*table, scene.weather);
  Require(*table, "metar");
  scene.weather.metar = table->Text("metar");
  return At(*table, "metar", [&] {
    RequireNoSecondWeather(document, ReadMetar(*scene.weather.metar));
    return InWeather(scene, "weather.metar");
  });
}

TerrainSource TerrainOf(const TomlTable& document, const fs::path& folder) {
  const std::optional<TomlSection> table = SectionOf(document, TerrainFields());
  if (!table) return {};
  const std::optional<fs::path> dem = FileNamedBy(*table, "dem", folder);
  const std::optional<fs::path> mesh = FileNamedBy(*table, "mesh", folder);
  const bool none = table->Truth("none").value_or(false);
  const bool range = table->Truth("range").value_or(false);
  if (int{dem.has_value()} + int{mesh.has_value()} + int{none} + int{range} > 1) {
    table->Fail(mesh   ? "mesh"
                : none ? "none"
                       : "range",
                "give one of terrain.dem, terrain.mesh, terrain.none and terrain.range");
  }
  if (table->Has("voids") && !dem) table->Fail("voids", "terrain.voids needs terrain.dem");
  if (table->Has("up") && !mesh) table->Fail("up", "terrain.up needs terrain.mesh");
  const std::optional<fs::path> colour = FileNamedBy(*table, "colour", folder);
  if (colour && none)
    table->Fail("colour", "terrain.colour lies over terrain; terrain.none is set");
  const std::optional<fs::path> land_cover = FileNamedBy(*table, "land_cover", folder);
  if (land_cover && (none || colour)) {
    table->Fail("land_cover", none ? "terrain.land_cover lies over terrain; terrain.none is set"
                                   : "give one of terrain.colour and terrain.land_cover");
  }
  TerrainSource source;
  source.is_default = !dem && !mesh && !none && !range;
  if (colour) source.colour = *colour;
  if (land_cover) source.land_cover = *land_cover;
  TerrainFields().Read(*table, source);
  if (none) source.kind = TerrainSource::Kind::kNone;
  if (dem) {
    source.kind = TerrainSource::Kind::kElevationModel;
    source.file = *dem;
  }
  if (mesh) {
    source.kind = TerrainSource::Kind::kMesh;
    source.file = *mesh;
  }
  return source;
}

/// Rejects keys of [ground] that have no effect with the chosen cover.
void RequireCover(const TomlTable& table, const char* key, bool has_effect, const char* covers) {
  if (table.Has(key) && !has_effect)
    table.Fail(key, fmt::format("ground.{} is for {}; this is another cover", key, covers));
}

GroundCover GroundOf(const TomlTable& document) {
  using Kind = GroundCover::Kind;
  const std::optional<TomlSection> table = SectionOf(document, GroundFields());
  if (!table) return {};
  const std::size_t albedos = table->Numbers("albedo").value_or(std::vector{0.0}).size();
  if (albedos != 1 && albedos != 3)
    table->Fail("albedo", "ground.albedo must be one value, or red, green and blue (linear)");
  GroundCover ground;
  GroundFields().Read(*table, ground);
  const bool has_water = ground.kind == Kind::kWater || ground.sea_level_m;
  const bool is_rough = ground.kind == Kind::kOrenNayar || ground.kind == Kind::kBlinnPhong;
  RequireCover(*table, "albedo", is_rough || ground.kind == Kind::kLambert,
               "lambert, oren-nayar and blinn-phong");
  RequireCover(*table, "roughness", is_rough, "oren-nayar and blinn-phong");
  RequireCover(*table, "reflectance", ground.kind == Kind::kBlinnPhong, "blinn-phong");
  RequireCover(*table, "wind_m_per_s", has_water, "water, or ground with a sea_level_m");
  RequireCover(*table, "wetness",
               ground.kind == Kind::kMountain || ground.kind == Kind::kLambert ||
                   ground.kind == Kind::kOrenNayar,
               "mountain, lambert and oren-nayar");
  RequireCover(*table, "grain_diameter_mm", ground.kind == Kind::kSnow, "snow");
  constexpr double kSmoothestPhong = 0.1;
  if (ground.kind == Kind::kBlinnPhong && ground.roughness < kSmoothestPhong)
    (void)table->TomlTable::Number("roughness", kSmoothestPhong, 1.0);
  return ground;
}

void ReadCone(const TomlSection& table, Light& light) {
  const std::optional<std::vector<double>> cone = table.Numbers("cone");
  if (!cone || cone->size() != 2 || !((*cone)[0] < (*cone)[1])) {
    table.Fail("cone", fmt::format("{} must be two half angles, the smaller one first",
                                   table.FullName("cone")));
  }
  light.inner_rad = Radians((*cone)[0]);
  light.outer_rad = Radians((*cone)[1]);
}

void RefuseKeys(const TomlTable& table, std::initializer_list<const char*> keys,
                const std::string& why) {
  for (const char* key : keys) {
    if (table.Has(key)) table.Fail(key, fmt::format("{} {}", table.FullName(key), why));
  }
}

void ReadDistribution(const TomlSection& table, const fs::path& folder, Light& light) {
  light.ies = FileNamedBy(table, "ies", folder);
  if (light.type == Light::Type::kSpot) {
    RefuseKeys(table, {"ies"}, "is for a point; this is a spot");
    ReadCone(table, light);
    return;
  }
  RefuseKeys(table, {"cone"}, "is for a spot; this is a point");
  if (!light.ies) RefuseKeys(table, {"heading", "pitch"}, "is for a spot; this is a point");
  if (light.ies && !table.Has("pitch")) light.pitch_rad = Radians(-90.0);
}

Light LightOf(const TomlTable& entry, const fs::path& folder) {
  const TomlSection table(entry, LightFields().Keys());
  for (const char* key : {"latitude", "longitude"}) Require(table, key);
  Light light;
  LightFields().Read(table, light);
  light.height = HeightOf(table, Height{});
  ReadDistribution(table, folder, light);
  if (!light.ies) Require(table, "intensity_cd");
  return light;
}

std::optional<double> TownZenithOf(const TomlTable& document) {
  const std::optional<TomlSection> table = SectionOf(document, NightFields());
  if (!table) return std::nullopt;
  const std::optional<double> bortle = table->Number("bortle");
  const std::optional<double> zenith = table->Number("zenith_mag_per_arcsec2");
  if (bortle.has_value() == zenith.has_value())
    table->Fail("bortle", "give one of night.bortle and night.zenith_mag_per_arcsec2");
  if (!bortle) return zenith;
  if (*bortle != std::floor(*bortle))
    table->Fail("bortle", fmt::format("night.bortle is {}; it must be a class, 1 to 9", *bortle));
  return ZenithOfBortleClass(static_cast<int>(*bortle));
}

// Returns the phase function; by default that of droplets.
PhaseFunction DropletPhaseOf(const TomlSection& table) {
  const std::optional<double> g = table.Number("g");
  const std::optional<double> droplet = table.Number("droplet_diameter_um");
  if (g && droplet) {
    table.Fail("g", fmt::format("{} and {} are both given; give one", table.FullName("g"),
                                table.FullName("droplet_diameter_um")));
  }
  if (!g) return DropletPhase(droplet.value_or(15.0));
  PhaseFunction phase;
  phase.kind = PhaseKind::kHenyeyGreenstein;
  phase.g = *g;
  return phase;
}

std::vector<MediumLayer> LayersOf(const TomlTable& document) {
  const std::optional<TomlSection> table = SectionOf(document, LayerFields());
  if (!table) return {};
  const std::optional<double> visibility = table->Number("visibility_m");
  const std::optional<double> extinction = table->Number("extinction_per_m");
  if (visibility.has_value() == extinction.has_value()) {
    table->Fail("visibility_m",
                fmt::format("give one of {} and {}", table->FullName("visibility_m"),
                            table->FullName("extinction_per_m")));
  }
  MediumLayer layer;
  layer.extinction_per_m = extinction ? *extinction : kOpticalDepthOfVisibility / *visibility;
  layer.scale_height_m = std::numeric_limits<double>::infinity();
  LayerFields().Read(*table, layer);
  layer.phase = DropletPhaseOf(*table);
  return {layer};
}

/// Refuses a list that has neither one value nor one per wavelength.
void RequirePerBand(const TomlSection& table, const std::string& key, std::size_t bands) {
  const std::optional<std::vector<double>> values = table.Numbers(key);
  if (!values || values->size() == 1 || values->size() == bands) return;
  table.Fail(key, fmt::format("{} has {} values; give one, or {}: one per wavelength",
                              table.FullName(key), values->size(), bands));
}

std::vector<double> RequireThree(const TomlSection& table, const std::string& key) {
  Require(table, key);
  std::vector<double> values = *table.Numbers(key);
  if (values.size() == 3) return values;
  table.Fail(
      key, fmt::format("{} has {} values; it must have three", table.FullName(key), values.size()));
}

std::array<int, 3> GridSizeOf(const TomlSection& table) {
  const std::vector<double> sides = RequireThree(table, "grid_size");
  std::array<int, 3> size{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (sides[i] != std::floor(sides[i])) {
      table.Fail("grid_size", fmt::format("{} has {}; samples are counted in whole numbers",
                                          table.FullName("grid_size"), sides[i]));
    }
    size[i] = static_cast<int>(sides[i]);
  }
  return size;
}

void ReadDensity(const TomlSection& table, const fs::path& folder, Volume& volume) {
  const std::optional<fs::path> grid = FileNamedBy(table, "grid", folder);
  if (!grid) {
    RefuseKeys(table, {"grid_size"}, "needs a grid");
    return;
  }
  RefuseKeys(table, {"scale_height_m"}, "is for a volume without a grid");
  volume.grid = *grid;
  if (HasExtension(volume.grid, ".nrrd") || HasExtension(volume.grid, ".nhdr")) {
    RefuseKeys(table, {"grid_size"}, "is for a raw grid; an NRRD file says its own");
    return;
  }
  if (!table.Has("grid_size"))
    At(table, "grid", [&] { RefuseKnownFormats(volume.grid, kVolumesWanted); });
  volume.grid_size = GridSizeOf(table);
}

/// Returns the extinction: the given one, or that of a visibility.
std::vector<double> ExtinctionOf(const TomlSection& table) {
  const std::optional<double> visibility = table.Number("visibility_m");
  if (visibility.has_value() == table.Has("extinction_per_m")) {
    table.Fail("visibility_m", fmt::format("give one of {} and {}", table.FullName("visibility_m"),
                                           table.FullName("extinction_per_m")));
  }
  if (visibility) return {kOpticalDepthOfVisibility / *visibility};
  return *table.Numbers("extinction_per_m");
}

/// Checks the transfer function of a volume and what else the table says.
void CheckTransfer(const TomlSection& table, const Volume& volume) {
  RefuseKeys(table,
             {"extinction_per_m", "visibility_m", "albedo", "emission_per_m", "temperature_k"},
             "is for a volume without transfer, whose rows have it");
  const std::string name = table.FullName("transfer");
  if (!table.Has("grid")) table.Fail("transfer", name + " needs a grid");
  const std::vector<TransferNode>& nodes = volume.transfer;
  if (nodes.size() < 2)
    table.Fail("transfer",
               fmt::format("{} has {} rows; it must have two or more", name, nodes.size()));
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].value > nodes[i - 1].value) continue;
    table.FailInRow("transfer", i,
                    fmt::format("{}[{}] has the value {} after {}; values must "
                                "increase",
                                name, i, nodes[i].value, nodes[i - 1].value));
  }
}

Volume VolumeOf(const TomlTable& entry, const fs::path& folder, std::size_t bands) {
  const TomlSection table(entry, VolumeFields().Keys());
  for (const char* key : {"latitude", "longitude"}) Require(table, key);
  (void)RequireThree(table, "size_m");
  for (const char* key : {"extinction_per_m", "albedo", "emission_per_m"})
    RequirePerBand(table, key, bands);
  Volume volume;
  VolumeFields().Read(table, volume);
  volume.height = HeightOf(table, Height{0.0, true});
  ReadDensity(table, folder, volume);
  volume.phase = DropletPhaseOf(table);
  if (table.Has("transfer")) {
    CheckTransfer(table, volume);
    return volume;
  }
  volume.extinction_per_m = ExtinctionOf(table);
  if (volume.temperature_k && table.Has("emission_per_m")) {
    table.Fail("temperature_k",
               fmt::format("give one of {} and {}", table.FullName("emission_per_m"),
                           table.FullName("temperature_k")));
  }
  const bool absorbs = std::any_of(volume.albedo.begin(), volume.albedo.end(),
                                   [](double albedo) { return albedo < 1.0; });
  if (volume.temperature_k && !absorbs) {
    table.Fail("temperature_k",
               fmt::format("{} has no effect: what absorbs nothing does not glow; set {} below 1",
                           table.FullName("temperature_k"), table.FullName("albedo")));
  }
  return volume;
}

/// @param name  in messages. @param before  objects of earlier tables.
SceneObject ObjectOf(const TomlTable& entry, const std::string& name,
                     const std::vector<SceneObject>& before) {
  const TomlSection table(entry, ObjectFields().Keys());
  for (const char* key : {"latitude", "longitude"}) Require(table, key);
  SceneObject object;
  object.name = name;
  ObjectFields().Read(table, object);
  object.height = HeightOf(table, object.height);
  if (object.material == SphereMaterial::kMirror)
    RefuseKeys(table, {"index"}, "is for glass; this is a mirror");
  if (object.photons != std::floor(object.photons)) {
    table.Fail("photons", fmt::format("{} is {}; it must be a whole number",
                                      table.FullName("photons"), object.photons));
  }
  if (!before.empty() && object.photon_map != before.front().photon_map) {
    table.Fail(
        "photon_map",
        fmt::format("{} is \"{}\"; that of object[0] is \"{}\"", table.FullName("photon_map"),
                    kPhotonMaps.Of(object.photon_map), kPhotonMaps.Of(before.front().photon_map)));
  }
  return object;
}

/// Refuses values of a cloud that their ranges alone allow.
void CheckCloudKeys(const TomlSection& table) {
  const std::optional<double> seed = table.Number("seed");
  if (seed && *seed != std::floor(*seed)) {
    table.Fail("seed",
               fmt::format("{} is {}; it must be a whole number", table.FullName("seed"), *seed));
  }
  const std::optional<std::vector<double>> wind = table.Numbers("wind_m_per_s");
  if (wind && wind->size() != 2) {
    table.Fail("wind_m_per_s",
               fmt::format("{} has {} values; it must have two, to the east and to the north",
                           table.FullName("wind_m_per_s"), wind->size()));
  }
  if (table.Has("latitude") != table.Has("longitude")) {
    const std::string missing = table.Has("latitude") ? "longitude" : "latitude";
    table.Fail(missing, fmt::format("{} is missing; the middle of a grid has both",
                                    table.FullName(missing)));
  }
}

/// Refuses what a genus that is the same at every place excludes, and what others do.
void CheckPlaneParallelKeys(const TomlSection& table, const CloudOptions& options) {
  const std::string genus = kCloudGenusNames.Of(options.genus);
  if (!IsPlaneParallel(options.genus)) {
    RefuseKeys(table, {"optical_depth"},
               fmt::format("is for stratus and cirrostratus; the genus is {}", genus));
    return;
  }
  RefuseKeys(table, {"seed", "period_m"}, fmt::format("is not for {}, which has no gaps", genus));
  if (options.cover != 1.0) {
    table.Fail("cover", fmt::format("{} is {}; {} covers the whole sky", table.FullName("cover"),
                                    options.cover, genus));
  }
  if (options.optical_depth) {
    RefuseKeys(table, {"droplets_per_cm3", "ice_mg_per_m3"},
               "is what optical_depth replaces; give one of them");
  }
}

/// Refuses what the genus of a layer of clouds excludes.
void CheckGenusKeys(const TomlSection& table, const CloudOptions& options) {
  const std::string genus = kCloudGenusNames.Of(options.genus);
  if (IsOfIce(options.genus)) {
    RefuseKeys(table, {"droplets_per_cm3"},
               fmt::format("is for clouds of droplets; {} is of ice", genus));
  } else {
    RefuseKeys(table, {"ice_mg_per_m3", "crystal_radius_um"},
               fmt::format("is for clouds of ice; {} is of droplets", genus));
  }
  CheckPlaneParallelKeys(table, options);
  if (options.genus == CloudGenus::kCumulus && options.cover > kMostCumulusCover) {
    table.Fail("cover", fmt::format("{} is {}; cumulus cover {} at most, and stratocumulus more",
                                    table.FullName("cover"), options.cover, kMostCumulusCover));
  }
  if (!IsOfIce(options.genus) && options.base_altitude_m > kHighestWaterBase_m) {
    table.Fail("base_height_m",
               fmt::format("{} is {}; that of {} is at most {}", table.FullName("base_height_m"),
                           options.base_altitude_m, genus, kHighestWaterBase_m));
  }
  if (std::fmod(options.period_m, kPeriodStep_m) != 0.0) {
    table.Fail("period_m",
               fmt::format("{} is {}; it must be a multiple of {}", table.FullName("period_m"),
                           options.period_m, kPeriodStep_m));
  }
}

using Keys = std::vector<const char*>;

/// Returns whether a key is in a list.
bool IsIn(const Keys& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// The keys that a format of cloud grids needs, and those that it may have.
struct CloudFormat {
  const char* name;
  Keys endings, needed, allowed;
};

const std::vector<CloudFormat>& CloudFormats() {
  static const std::vector<CloudFormat> formats{
      {"text", {".txt", ".dat"}, {}, {}},
      {"OpenVDB",
       {".vdb"},
       {},
       {"base_height_m", "spacing_m", "extinction_per_m", "effective_radius_um", "vdb_grid", "up"}},
      {"NRRD",
       {".nrrd", ".nhdr"},
       {"base_height_m", "spacing_m"},
       {"extinction_per_m", "effective_radius_um"}},
      {"raw",
       {".raw"},
       {"base_height_m", "spacing_m", "grid_size"},
       {"extinction_per_m", "effective_radius_um"}}};
  return formats;
}

/// The keys of a grid that depend on its format.
const Keys kFormatKeys{"base_height_m",       "spacing_m", "grid_size", "extinction_per_m",
                       "effective_radius_um", "vdb_grid",  "up"};

const CloudFormat& CloudFormatOf(const TomlSection& table, const fs::path& grid) {
  Keys endings;
  for (const CloudFormat& format : CloudFormats()) {
    for (const char* ending : format.endings) {
      if (HasExtension(grid, ending)) return format;
      endings.push_back(ending);
    }
  }
  table.Fail("grid",
             fmt::format("{} is \"{}\"; its ending must be one of {}", table.FullName("grid"),
                         Printable(grid.filename().string()), fmt::join(endings, ", ")));
}

/// Returns the names of the formats that have a key: "OpenVDB, raw".
std::string CloudFormatsWith(std::string_view key) {
  Keys names;
  for (const CloudFormat& format : CloudFormats()) {
    if (IsIn(format.needed, key) || IsIn(format.allowed, key)) names.push_back(format.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Refuses keys that the format of a grid does not have, and a grid without those that it needs.
void CheckFormatKeys(const TomlSection& table, const CloudFormat& format) {
  for (const char* key : kFormatKeys) {
    const std::string name = table.FullName(key);
    if (IsIn(format.needed, key) && !table.Has(key))
      table.Fail(key, fmt::format("{} is missing; {} needs it", name, format.name));
    if (table.Has(key) && !IsIn(format.needed, key) && !IsIn(format.allowed, key)) {
      table.Fail(key, fmt::format("{} is for grids of {}; this is {}", name, CloudFormatsWith(key),
                                  format.name));
    }
  }
}

std::optional<glm::dvec3> SpacingOf(const TomlSection& table) {
  const std::optional<std::vector<double>> list = table.Numbers("spacing_m");
  if (!list) return std::nullopt;
  if (list->size() == 1) return glm::dvec3(list->front());
  if (list->size() == 3) return glm::dvec3((*list)[0], (*list)[1], (*list)[2]);
  table.Fail("spacing_m", fmt::format("{} has {} values; it must have one, or three along x, y, z",
                                      table.FullName("spacing_m"), list->size()));
}

/// Reads the keys of a layer with a grid.
void ReadGridKeys(const TomlSection& table, SceneCloud& cloud) {
  RefuseKeys(table,
             {"cover", "depth_m", "droplets_per_cm3", "ice_mg_per_m3", "crystal_radius_um", "seed",
              "period_m"},
             "is for clouds without a grid");
  CheckFormatKeys(table, CloudFormatOf(table, cloud.grid));
  cloud.file.spacing_m = SpacingOf(table);
  if (table.Has("grid_size")) cloud.file.samples = GridSizeOf(table);
  cloud.file.grid = table.Text("vdb_grid").value_or("");
  if (const auto latitude = table.Number("latitude"))
    cloud.middle = CheckedPlace({*latitude, *table.Number("longitude"), 0.0});
}

/// @param number  of the table, from 0.
SceneCloud CloudOf(const TomlTable& entry, const fs::path& folder, std::size_t number) {
  const TomlSection table(entry, CloudFields().Keys());
  const std::optional<fs::path> grid = FileNamedBy(table, "grid", folder);
  if (!grid) Require(table, "genus");
  CheckCloudKeys(table);
  SceneCloud cloud;
  if (const auto genus = table.Text("genus"))
    cloud.options = DefaultCloudOptions(*kCloudGenusNames.Find(*genus));
  cloud.options.seed = static_cast<std::uint32_t>(number) + 1U;
  if (grid) {
    cloud.options.wind_m_per_s = {0.0, 0.0};
    cloud.options.base_altitude_m = 0.0;
  }
  CloudFields().Read(table, cloud);
  if (!grid) {
    RefuseKeys(table,
               {"repeats", "latitude", "longitude", "spacing_m", "grid_size", "extinction_per_m",
                "effective_radius_um", "vdb_grid", "up"},
               "is for a grid");
    CheckGenusKeys(table, cloud.options);
    cloud.is_over_ground = FollowsGround(cloud.options.genus) && !table.Has("base_height_m");
    return cloud;
  }
  cloud.grid = *grid;
  ReadGridKeys(table, cloud);
  return cloud;
}

/// Returns the clouds with their names in messages.
std::vector<SceneCloud> CloudsOf(const TomlTable& document, const fs::path& folder,
                                 const std::string& origin) {
  std::vector<SceneCloud> clouds;
  for (const TomlTable& entry : document.Tables("cloud")) {
    SceneCloud cloud = CloudOf(entry, folder, clouds.size());
    cloud.name = fmt::format("{}: cloud[{}]", origin, clouds.size());
    clouds.push_back(std::move(cloud));
  }
  RequireCloudsFit(clouds, MemoryOfMachine());
  return clouds;
}

}  // namespace

bool Camera::IsPanorama() const { return fov_rad > kPi; }

Camera CameraFromDegrees(const Height& height, double heading, double pitch, double roll,
                         double fov, const std::string& prefix) {
  Camera camera;
  camera.height = height;
  camera.heading_rad = Radians(RequireInRange(heading, -360.0, 360.0, prefix + "heading"));
  camera.pitch_rad = Radians(RequireInRange(pitch, -90.0, 90.0, prefix + "pitch"));
  camera.roll_rad = Radians(RequireInRange(roll, -180.0, 180.0, prefix + "roll"));
  if (fov != 360.0 && !(fov >= 0.1 && fov <= 179.0)) {
    throw InputError(
        fmt::format("{}fov is {}; it must lie in [0.1, 179] or be 360, a panorama", prefix, fov));
  }
  camera.fov_rad = Radians(fov);
  return camera;
}

Scene SceneFromToml(std::string_view text, const std::string& origin, const fs::path& folder,
                    const MediumUse& use, const SceneWeather& weather) {
  const TomlTable document(text, origin);
  std::vector<std::string> sections;
  ForEachTable([&](const auto& fields, const auto&) { sections.push_back(fields.name); });
  document.AllowOnly(sections);
  Scene scene;
  ReadPlace(document, scene);
  scene.time = TimeOf(document, scene.zone);
  scene.camera = CameraOf(document);
  scene.medium = MediumOf(document, folder, use);
  scene.terrain = TerrainOf(document, folder);
  scene.ground = GroundOf(document);
  if (!scene.terrain.land_cover.empty() && scene.ground.kind != GroundCover::Kind::kMountain) {
    document.Table("terrain")->Fail(
        "land_cover", "terrain.land_cover is for the cover mountain; ground.cover is another");
  }
  for (const TomlTable& light : document.Tables(LightFields().name)) {
    scene.lights.push_back(LightOf(light, folder));
  }
  scene.layers = LayersOf(document);
  scene.town_zenith = TownZenithOf(document);
  for (const TomlTable& volume : document.Tables(VolumeFields().name)) {
    scene.volumes.push_back(VolumeOf(volume, folder, scene.medium.wavelengths_nm.size()));
  }
  for (const TomlTable& object : document.Tables(ObjectFields().name)) {
    scene.objects.push_back(ObjectOf(
        object, fmt::format("{}: object[{}]", origin, scene.objects.size()), scene.objects));
  }
  scene.clouds = CloudsOf(document, folder, origin);
  if (!weather.metar) return InWeatherOfFile(std::move(scene), document);
  static_cast<void>(SectionOf(document, WeatherFields()));  // refuses its keys
  return InTypedWeather(std::move(scene), weather);
}

Scene ReadScene(const fs::path& file, const MediumUse& use, const SceneWeather& weather) {
  const fs::path folder = FolderOf(file);  // before a pipe ends
  return SceneFromToml(ReadTextFile(file), file.string(), folder, use, weather);
}

}  // namespace alpenglow::renderer
