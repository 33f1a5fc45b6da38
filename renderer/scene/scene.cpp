// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "renderer/scene/volume_file.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

constexpr double kHighestEye_m = 1e9;
constexpr double kDeepestPlace_m = -12000.0;  // the limit of PlaceFromDegrees
constexpr double kLongestExposure_s = 43200.0;

double Radians(double degrees) { return degrees * kRadiansPerDegree; }

double Required(const TomlTable& table, const std::string& key, double low, double high) {
  const std::optional<double> value = table.Number(key, low, high);
  if (!value) table.Fail(key, table.FullName(key) + " is missing");
  return *value;
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

Height HeightOf(const TomlTable& table, const Height& fallback) {
  const std::optional<double> height = table.Number("height_m", kDeepestPlace_m, kHighestEye_m);
  const std::optional<double> above = table.Number("above_ground_m", 0.0, kHighestEye_m);
  if (height && above) {
    table.Fail("above_ground_m",
               fmt::format("{} and {} are both given; give one", table.FullName("height_m"),
                           table.FullName("above_ground_m")));
  }
  if (height) return {*height, false};
  if (above) return {*above, true};
  return fallback;
}

struct Place {
  GeodeticPosition position;
  std::optional<std::string> zone;
};

Place PlaceOf(const TomlTable& document) {
  const std::optional<TomlTable> table = document.Table("place");
  if (!table) document.Fail("place", "[place] with latitude and longitude is missing");
  table->AllowOnly({"latitude", "longitude", "zone"});
  const double latitude = Required(*table, "latitude", -90.0, 90.0);
  const double longitude = Required(*table, "longitude", -180.0, 360.0);
  const std::optional<std::string> zone = table->Text("zone");
  if (zone) At(*table, "zone", [&] { return FormatInZone(UtcInstant{}, *zone); });
  return {PlaceFromDegrees(latitude, longitude, 0.0), zone};
}

std::optional<UtcInstant> TimeOf(const TomlTable& document,
                                 const std::optional<std::string>& zone) {
  const std::optional<TomlTable> table = document.Table("time");
  if (!table) return std::nullopt;
  table->AllowOnly({"utc", "local"});
  const std::optional<std::string> utc = table->Text("utc");
  const std::optional<std::string> local = table->Text("local");
  if (utc && local) table->Fail("local", "time.utc and time.local are both given; give one");
  if (utc) return At(*table, "utc", [&] { return ParseInstant(*utc); });
  if (!local) table->Fail("utc", "time.utc is missing");
  if (!zone) table->Fail("local", "time.local needs place.zone");
  return At(*table, "local", [&] { return ParseInstant(*local, zone); });
}

int BladesOf(const TomlTable& table) {
  const double blades = table.Number("blades", 0.0, 64.0).value_or(0.0);
  if (blades != std::floor(blades) || blades == 1.0 || blades == 2.0) {
    table.Fail("blades", fmt::format("{} is {}; it must be 0, a round iris, or 3 to 64",
                                     table.FullName("blades"), blades));
  }
  return static_cast<int>(blades);
}

/// The smallest accepted f-number. Lenses in air end at 0.5 (the sine condition); a fifth of that
/// leaves room for exaggerated effects.
constexpr double kWidestLens = 0.1;

std::optional<ThinLens> LensOf(const TomlTable& table) {
  const double f_number = table.Number("f_number", 0.0, 1000.0).value_or(0.0);
  const std::optional<double> focal_length_mm = table.Number("focal_length_mm", 0.1, 10000.0);
  const std::optional<double> focus_m = table.Number("focus_m", 0.01, 1e9);
  const int blades = BladesOf(table);
  const double rotation = table.Number("blade_rotation", -360.0, 360.0).value_or(0.0);
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
std::optional<double> FovOfSensor(const TomlTable& table, const std::optional<ThinLens>& lens) {
  const std::optional<double> width_mm = table.Number("sensor_width_mm", 0.1, 1e5);
  if (!width_mm) return std::nullopt;
  const double f = Required(table, "focal_length_mm", 0.1, 10000.0);
  const double v = lens ? f / (1.0 - 1e-3 * f / lens->focus_m) : f;
  return 2.0 * std::atan(0.5 * *width_mm / v) / kRadiansPerDegree;
}

/// Returns the field of view: the given one, that of sensor and focal length, or 60 degrees. If
/// both are given, they may differ by as much as focusing and rounding change it.
double FovOf(const TomlTable& table, const std::optional<ThinLens>& lens) {
  constexpr double kSame = 0.05;
  const std::optional<double> given = table.Number("fov", 0.1, 360.0);
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
  const std::optional<TomlTable> table = document.Table("camera");
  if (!table) return {};
  table->AllowOnly({"height_m", "above_ground_m", "heading", "pitch", "roll", "fov", "f_number",
                    "focal_length_mm", "focus_m", "sensor_width_mm", "blades", "blade_rotation",
                    "polariser_deg", "shutter_s"});
  const double heading = table->Number("heading", -360.0, 360.0).value_or(0.0);
  const double pitch = table->Number("pitch", -90.0, 90.0).value_or(0.0);
  const double roll = table->Number("roll", -180.0, 180.0).value_or(0.0);
  const std::optional<ThinLens> lens = LensOf(*table);
  const double fov = FovOf(*table, lens);
  const Height height = HeightOf(*table, Height{});
  Camera camera =
      At(*table, "fov", [&] { return CameraFromDegrees(height, heading, pitch, roll, fov); });
  camera.lens = lens;
  camera.shutter_s = table->Number("shutter_s", 0.0, kLongestExposure_s).value_or(0.0);
  if (const auto polariser = table->Number("polariser_deg", -180.0, 180.0))
    camera.polariser_rad = Radians(*polariser);
  return camera;
}

Medium MediumOf(const TomlTable& document, const fs::path& folder, const MediumUse& use) {
  const std::optional<TomlTable> table = document.Table("atmosphere");
  if (!table) return MediumPreset("earth");
  table->AllowOnly({"file", "preset"});
  const std::optional<std::string> file = table->Text("file");
  const std::optional<std::string> preset = table->Text("preset");
  if (file && preset) {
    table->Fail("preset", "atmosphere.file and atmosphere.preset are both given; give one");
  }
  if (preset) return At(*table, "preset", [&] { return MediumPreset(*preset); });
  if (!file) table->Fail("file", "atmosphere.file is missing");
  return MediumFromChoice(*file, use, folder);
}

UpAxis UpAxisOf(const TomlTable& terrain) {
  const std::string up = terrain.Text("up").value_or("z");
  if (up != "y" && up != "z")
    terrain.Fail("up", fmt::format("terrain.up is \"{}\"; it must be \"y\" or \"z\"", up));
  if (terrain.Has("up") && !terrain.Has("mesh"))
    terrain.Fail("up", "terrain.up needs terrain.mesh");
  return up == "y" ? UpAxis::kY : UpAxis::kZ;
}

/// Returns the file that a key names relative to the folder of the scene.
std::optional<fs::path> FileNamedBy(const TomlTable& table, const std::string& key,
                                    const fs::path& folder) {
  const std::optional<std::string> name = table.Text(key);
  if (!name) return std::nullopt;
  if (name->empty())
    table.Fail(key, table.FullName(key) + " is empty; it must be the name of a file");
  return folder / *name;
}

TerrainSource TerrainOf(const TomlTable& document, const fs::path& folder) {
  const std::optional<TomlTable> table = document.Table("terrain");
  if (!table) return {};
  table->AllowOnly({"dem", "mesh", "up", "none", "range", "voids", "colour", "land_cover"});
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
  const std::string voids = table->Text("voids").value_or("fill");
  if (voids != "fill" && voids != "open") {
    table->Fail("voids",
                fmt::format("terrain.voids is \"{}\"; it must be \"fill\" or \"open\"", voids));
  }
  if (table->Has("voids") && !dem) table->Fail("voids", "terrain.voids needs terrain.dem");
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
  source.up = UpAxisOf(*table);
  source.voids = voids == "fill" ? VoidPolicy::kFill : VoidPolicy::kLeaveOpen;
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

GroundCover::Kind CoverOf(const TomlTable& table) {
  static const std::pair<const char*, GroundCover::Kind> kKinds[] = {
      {"mountain", GroundCover::Kind::kMountain},
      {"lambert", GroundCover::Kind::kLambert},
      {"oren-nayar", GroundCover::Kind::kOrenNayar},
      {"blinn-phong", GroundCover::Kind::kBlinnPhong},
      {"water", GroundCover::Kind::kWater},
      {"snow", GroundCover::Kind::kSnow}};
  const std::string cover = table.Text("cover").value_or("mountain");
  std::vector<std::string> names;
  for (const auto& [name, kind] : kKinds) {
    if (cover == name) return kind;
    names.push_back(fmt::format("\"{}\"", name));
  }
  table.Fail("cover", fmt::format("ground.cover is \"{}\"; it must be one of {}", cover,
                                  fmt::join(names, ", ")));
}

/// Rejects keys of [ground] that have no effect with the chosen cover.
void RequireCover(const TomlTable& table, const char* key, bool has_effect, const char* covers) {
  if (table.Has(key) && !has_effect)
    table.Fail(key, fmt::format("ground.{} is for {}; this is another cover", key, covers));
}

GroundCover GroundOf(const TomlTable& document) {
  using Kind = GroundCover::Kind;
  const std::optional<TomlTable> table = document.Table("ground");
  if (!table) return {};
  table->AllowOnly({"cover", "albedo", "roughness", "reflectance", "wind_m_per_s",
                    "grain_diameter_mm", "sea_level_m", "wetness"});
  GroundCover ground;
  ground.kind = CoverOf(*table);
  ground.sea_level_m = table->Number("sea_level_m", kDeepestPlace_m, 9000.0);
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
  if (const auto albedo = table->Numbers("albedo", 0.0, 1.0)) {
    if (albedo->size() != 1 && albedo->size() != 3)
      table->Fail("albedo", "ground.albedo must be one value, or red, green and blue (linear)");
    for (std::size_t c = 0; c < 3; ++c) ground.albedo[c] = (*albedo)[albedo->size() == 1 ? 0 : c];
  }
  const double smoothest = ground.kind == Kind::kBlinnPhong ? 0.1 : 0.0;
  ground.roughness = table->Number("roughness", smoothest, 1.0).value_or(ground.roughness);
  ground.reflectance = table->Number("reflectance", 0.0, 1.0).value_or(ground.reflectance);
  ground.wind_m_per_s = table->Number("wind_m_per_s", 0.0, 20.0).value_or(ground.wind_m_per_s);
  ground.wetness = table->Number("wetness", 0.0, 1.0).value_or(ground.wetness);
  if (const auto grain = table->Number("grain_diameter_mm", 0.05, 5.0))
    ground.grain_diameter_m = 1e-3 * *grain;
  return ground;
}

Light::Type LightTypeOf(const TomlTable& table) {
  const std::string type = table.Text("type").value_or("point");
  if (type == "point") return Light::Type::kPoint;
  if (type == "spot") return Light::Type::kSpot;
  table.Fail("type", fmt::format("{} is \"{}\"; it must be \"point\" or \"spot\"",
                                 table.FullName("type"), type));
}

void ReadAxis(const TomlTable& table, double pitch_default_deg, Light& light) {
  light.heading_rad = Radians(table.Number("heading", -360.0, 360.0).value_or(0.0));
  light.pitch_rad = Radians(table.Number("pitch", -90.0, 90.0).value_or(pitch_default_deg));
}

void ReadCone(const TomlTable& table, Light& light) {
  const std::optional<std::vector<double>> cone = table.Numbers("cone", 0.0, 180.0);
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

void ReadDistribution(const TomlTable& table, const fs::path& folder, Light& light) {
  const std::optional<fs::path> ies = FileNamedBy(table, "ies", folder);
  if (light.type == Light::Type::kSpot) {
    RefuseKeys(table, {"ies"}, "is for a point; this is a spot");
    ReadAxis(table, 0.0, light);
    ReadCone(table, light);
    return;
  }
  if (!ies) {
    RefuseKeys(table, {"heading", "pitch", "cone"}, "is for a spot; this is a point");
    return;
  }
  RefuseKeys(table, {"cone"}, "is for a spot; this is a point");
  light.ies = *ies;
  ReadAxis(table, -90.0, light);
}

Light LightOf(const TomlTable& table, const fs::path& folder) {
  table.AllowOnly({"type", "latitude", "longitude", "height_m", "above_ground_m", "intensity_cd",
                   "temperature_k", "radius_m", "ies", "heading", "pitch", "cone"});
  Light light;
  light.type = LightTypeOf(table);
  light.latitude_rad = Radians(Required(table, "latitude", -90.0, 90.0));
  light.longitude_rad = Radians(Required(table, "longitude", -180.0, 360.0));
  light.height = HeightOf(table, Height{});
  light.temperature_k = table.Number("temperature_k", 500.0, 50000.0).value_or(3000.0);
  light.radius_m = table.Number("radius_m", 0.001, 100.0).value_or(0.1);
  ReadDistribution(table, folder, light);
  light.intensity_cd = table.Number("intensity_cd", 0.0, 1e12);
  if (!light.intensity_cd && !light.ies) (void)Required(table, "intensity_cd", 0.0, 1e12);
  return light;
}

std::optional<double> TownZenithOf(const TomlTable& document) {
  const std::optional<TomlTable> table = document.Table("night");
  if (!table) return std::nullopt;
  table->AllowOnly({"bortle", "zenith_mag_per_arcsec2"});
  const std::optional<double> bortle = table->Number("bortle", 1.0, 9.0);
  const std::optional<double> zenith =
      table->Number("zenith_mag_per_arcsec2", 14.0, kNaturalZenith);
  if (bortle.has_value() == zenith.has_value())
    table->Fail("bortle", "give one of night.bortle and night.zenith_mag_per_arcsec2");
  if (!bortle) return zenith;
  if (*bortle != std::floor(*bortle))
    table->Fail("bortle", fmt::format("night.bortle is {}; it must be a class, 1 to 9", *bortle));
  return ZenithOfBortleClass(static_cast<int>(*bortle));
}

// Returns the phase function; by default that of droplets.
PhaseFunction DropletPhaseOf(const TomlTable& table) {
  const std::optional<double> g = table.Number("g", -0.99, 0.99);
  const std::optional<double> droplet =
      table.Number("droplet_diameter_um", kSmallestDroplet_um, kLargestDroplet_um);
  if (g && droplet) {
    table.Fail("g", fmt::format("{} and {} are both given; give one", table.FullName("g"),
                                table.FullName("droplet_diameter_um")));
  }
  if (!g) return FogPhase(droplet.value_or(15.0));
  PhaseFunction phase;
  phase.kind = PhaseKind::kHenyeyGreenstein;
  phase.g = *g;
  return phase;
}

std::optional<Fog> FogOf(const TomlTable& document) {
  const std::optional<TomlTable> table = document.Table("fog");
  if (!table) return std::nullopt;
  table->AllowOnly({"visibility_m", "extinction_per_m", "scale_height_m", "base_height_m", "albedo",
                    "droplet_diameter_um", "g"});
  const std::optional<double> visibility = table->Number("visibility_m", 1.0, 1e6);
  const std::optional<double> extinction = table->Number("extinction_per_m", 0.0, 10.0);
  if (visibility.has_value() == extinction.has_value()) {
    table->Fail("visibility_m", "give one of fog.visibility_m and fog.extinction_per_m");
  }
  Fog fog;
  fog.extinction_per_m = extinction ? *extinction : kOpticalDepthOfVisibility / *visibility;
  fog.scale_height_m =
      table->Number("scale_height_m", 1.0, 1e5).value_or(std::numeric_limits<double>::infinity());
  fog.base_height_m = table->Number("base_height_m", kDeepestPlace_m, 1e5);
  fog.albedo = table->Number("albedo", 0.0, 1.0).value_or(1.0);
  fog.phase = DropletPhaseOf(*table);
  return fog;
}

// Returns one value for every wavelength, from one value or a full list.
std::vector<double> PerBand(const TomlTable& table, const std::string& key, double high,
                            std::size_t bands, double fallback) {
  const std::optional<std::vector<double>> values = table.Numbers(key, 0.0, high);
  if (!values) return {fallback};
  if (values->size() != 1 && values->size() != bands) {
    table.Fail(key, fmt::format("{} has {} values; give one, or {}: one per wavelength",
                                table.FullName(key), values->size(), bands));
  }
  return *values;
}

std::array<double, 3> ThreeOf(const TomlTable& table, const std::string& key, double low,
                              double high) {
  const std::optional<std::vector<double>> values = table.Numbers(key, low, high);
  if (!values) table.Fail(key, table.FullName(key) + " is missing");
  if (values->size() != 3) {
    table.Fail(key, fmt::format("{} has {} values; it must have three", table.FullName(key),
                                values->size()));
  }
  return {(*values)[0], (*values)[1], (*values)[2]};
}

VolumePlacement::Shape ShapeOf(const TomlTable& table) {
  const std::string shape = table.Text("shape").value_or("box");
  if (shape == "box") return VolumePlacement::Shape::kBox;
  if (shape == "ellipsoid") return VolumePlacement::Shape::kEllipsoid;
  table.Fail("shape", fmt::format("{} is \"{}\"; it must be \"box\" or \"ellipsoid\"",
                                  table.FullName("shape"), shape));
}

void ReadDensity(const TomlTable& table, const fs::path& folder, Volume& volume) {
  volume.scale_height_m = table.Number("scale_height_m", 0.1, 1e5);
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
  const std::array<double, 3> sides = ThreeOf(table, "grid_size", 2.0, kMostGridSamples);
  volume.grid_size.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    if (sides[i] != std::floor(sides[i])) {
      table.Fail("grid_size", fmt::format("{} has {}; samples are counted in whole numbers",
                                          table.FullName("grid_size"), sides[i]));
    }
    (*volume.grid_size)[i] = static_cast<int>(sides[i]);
  }
}

Volume VolumeOf(const TomlTable& table, const fs::path& folder, std::size_t bands) {
  table.AllowOnly({"shape", "latitude", "longitude", "height_m", "above_ground_m", "size_m",
                   "heading", "scale_height_m", "grid", "grid_size", "extinction_per_m",
                   "visibility_m", "albedo", "emission_per_m", "temperature_k",
                   "droplet_diameter_um", "g"});
  Volume volume;
  volume.shape = ShapeOf(table);
  volume.latitude_rad = Radians(Required(table, "latitude", -90.0, 90.0));
  volume.longitude_rad = Radians(Required(table, "longitude", -180.0, 360.0));
  volume.height = HeightOf(table, Height{0.0, true});
  volume.size_m = ThreeOf(table, "size_m", 0.01, 2e5);
  volume.heading_rad = Radians(table.Number("heading", -360.0, 360.0).value_or(0.0));
  ReadDensity(table, folder, volume);
  const std::optional<double> visibility = table.Number("visibility_m", 0.1, 1e6);
  if (visibility.has_value() == table.Has("extinction_per_m")) {
    table.Fail("visibility_m", fmt::format("give one of {} and {}", table.FullName("visibility_m"),
                                           table.FullName("extinction_per_m")));
  }
  volume.extinction_per_m = visibility
                                ? std::vector<double>{kOpticalDepthOfVisibility / *visibility}
                                : PerBand(table, "extinction_per_m", 1e4, bands, 0.0);
  volume.albedo = PerBand(table, "albedo", 1.0, bands, 1.0);
  volume.emission_per_m = PerBand(table, "emission_per_m", 1e12, bands, 0.0);
  volume.temperature_k = table.Number("temperature_k", 100.0, 50000.0);
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
  volume.phase = DropletPhaseOf(table);
  return volume;
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
                    const MediumUse& use) {
  const TomlTable document(text, origin);
  document.AllowOnly({"place", "time", "camera", "atmosphere", "terrain", "ground", "light", "fog",
                      "volume", "night"});
  const Place place = PlaceOf(document);
  Scene scene;
  scene.place = place.position;
  scene.zone = place.zone;
  scene.time = TimeOf(document, place.zone);
  scene.camera = CameraOf(document);
  scene.medium = MediumOf(document, folder, use);
  scene.terrain = TerrainOf(document, folder);
  scene.ground = GroundOf(document);
  if (!scene.terrain.land_cover.empty() && scene.ground.kind != GroundCover::Kind::kMountain) {
    document.Table("terrain")->Fail(
        "land_cover", "terrain.land_cover is for the cover mountain; ground.cover is another");
  }
  for (const TomlTable& light : document.Tables("light")) {
    scene.lights.push_back(LightOf(light, folder));
  }
  scene.fog = FogOf(document);
  scene.town_zenith = TownZenithOf(document);
  for (const TomlTable& volume : document.Tables("volume")) {
    scene.volumes.push_back(VolumeOf(volume, folder, scene.medium.wavelengths_nm.size()));
  }
  return scene;
}

Scene ReadScene(const fs::path& file, const MediumUse& use) {
  const fs::path folder = FolderOf(file);  // before a pipe ends
  return SceneFromToml(ReadTextFile(file), file.string(), folder, use);
}

}  // namespace alpenglow::renderer
