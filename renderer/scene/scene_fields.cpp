// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_fields.h"

#include <array>
#include <limits>
#include <utility>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/scene/volume_file.h"

namespace alpenglow::renderer {
namespace {

constexpr EnumNames kUpAxes{{std::pair{UpAxis::kY, "y"}, {UpAxis::kZ, "z"}}};
constexpr EnumNames kVoidPolicies{
    {std::pair{VoidPolicy::kFill, "fill"}, {VoidPolicy::kLeaveOpen, "open"}}};
constexpr EnumNames kCovers{{std::pair{GroundCover::Kind::kMountain, "mountain"},
                             {GroundCover::Kind::kLambert, "lambert"},
                             {GroundCover::Kind::kOrenNayar, "oren-nayar"},
                             {GroundCover::Kind::kBlinnPhong, "blinn-phong"},
                             {GroundCover::Kind::kWater, "water"},
                             {GroundCover::Kind::kSnow, "snow"}}};
constexpr EnumNames kLightTypes{
    {std::pair{Light::Type::kPoint, "point"}, {Light::Type::kSpot, "spot"}}};
constexpr EnumNames kVolumeShapes{{std::pair{VolumePlacement::Shape::kBox, "box"},
                                   {VolumePlacement::Shape::kEllipsoid, "ellipsoid"}}};
constexpr EnumNames kScatteringOrders{
    {std::pair{ScatteringOrders::kAll, "all"}, {ScatteringOrders::kSingle, "single"}}};

constexpr EnumNames kSphereMaterials{
    {std::pair{SphereMaterial::kGlass, "glass"}, {SphereMaterial::kMirror, "mirror"}}};

const std::vector<std::string> kObjectShapes{"sphere"};

constexpr std::pair kLatitudes{-90.0, 90.0};
constexpr std::pair kLongitudes{-180.0, 360.0};
constexpr std::pair kHeadings{-360.0, 360.0};
constexpr std::pair kPitches{-90.0, 90.0};

/// A number in degrees in the file, and in radians in the object.
template <typename Object, typename Angle>
TomlMember<Object> Degrees(Angle Object::*member, std::pair<double, double> range) {
  return Number(member, range, kRadiansPerDegree);
}

/// A list of three numbers; the file may have one for all of them if `one_for_all` is set.
template <typename Object>
TomlMember<Object> Three(std::array<double, 3> Object::*member, std::pair<double, double> range) {
  TomlMember<Object> three = Numbers<Object>(range);
  three.set = [=](const TomlValue& value, Object& object) {
    const auto& list = std::get<std::vector<double>>(value);
    for (std::size_t i = 0; i < 3; ++i) (object.*member)[i] = list[list.size() == 1 ? 0 : i];
  };
  three.get = [=](const Object& object) {
    const std::array<double, 3>& values = object.*member;
    return TomlValue(std::vector<double>(values.begin(), values.end()));
  };
  return three;
}

/// The nodes of a transfer function as rows.
TomlMember<Volume> Transfer() {
  constexpr std::size_t kRequired = 5;
  TomlMember<Volume> transfer{{.kind = TomlType::Kind::kRows,
                               .columns = {{"value", -1e12, 1e12},
                                           {"extinction_per_m", 0.0, 1e4},
                                           {"red", 0.0, 1.0},
                                           {"green", 0.0, 1.0},
                                           {"blue", 0.0, 1.0},
                                           {"temperature_k", 0.0, 50000.0}},
                               .required_columns = kRequired}};
  transfer.set = [](const TomlValue& value, Volume& volume) {
    volume.transfer.clear();
    for (const std::vector<double>& row : std::get<TomlRows>(value))
      volume.transfer.push_back({row[0],
                                 row[1],
                                 {row[2], row[3], row[4]},
                                 row.size() > kRequired ? row[kRequired] : 0.0});
  };
  transfer.get = [](const Volume& volume) -> std::optional<TomlValue> {
    if (volume.transfer.empty()) return std::nullopt;
    TomlRows rows;
    for (const TransferNode& node : volume.transfer)
      rows.push_back({node.value, node.extinction_per_m, node.albedo[0], node.albedo[1],
                      node.albedo[2], node.temperature_k});
    return TomlValue(rows);
  };
  return transfer;
}

/// A whole number as the seed of clouds.
TomlMember<SceneCloud> CloudSeed() {
  TomlMember<SceneCloud> seed =
      Number<SceneCloud>({0.0, static_cast<double>(std::numeric_limits<std::uint32_t>::max())});
  seed.set = [](const TomlValue& value, SceneCloud& cloud) {
    cloud.options.seed = static_cast<std::uint32_t>(std::get<double>(value));
  };
  seed.get = [](const SceneCloud& cloud) {
    return TomlValue(static_cast<double>(cloud.options.seed));
  };
  return seed;
}

/// A list of two numbers, to the east and to the north.
TomlMember<SceneCloud> CloudWind() {
  TomlMember<SceneCloud> wind = Numbers<SceneCloud>(CloudRanges::kWind_m_per_s);
  wind.set = [](const TomlValue& value, SceneCloud& cloud) {
    const auto& list = std::get<std::vector<double>>(value);
    cloud.options.wind_m_per_s = {list.front(), list.back()};
  };
  wind.get = [](const SceneCloud& cloud) {
    const glm::dvec2& velocity = cloud.options.wind_m_per_s;
    return TomlValue(std::vector<double>{velocity.x, velocity.y});
  };
  return wind;
}

/// The member of a part of the object.
template <typename Object, typename Part>
TomlMember<Object> OfPart(Part Object::*part, const TomlMember<Part>& member) {
  return {member.type,
          [=](const TomlValue& value, Object& object) { member.set(value, object.*part); },
          [=](const Object& object) { return member.get(object.*part); }};
}

/// One or three numbers; the reader of the file takes them itself.
TomlMember<CloudFileOptions> GridSpacing() {
  TomlMember<CloudFileOptions> spacing = Numbers<CloudFileOptions>(CloudFileRanges::kSpacing_m);
  spacing.get = [](const CloudFileOptions& file) -> std::optional<TomlValue> {
    if (!file.spacing_m) return std::nullopt;
    return TomlValue(std::vector{file.spacing_m->x, file.spacing_m->y, file.spacing_m->z});
  };
  return spacing;
}

/// Three whole numbers; the reader of the file takes them itself.
TomlMember<CloudFileOptions> GridSamples() {
  TomlMember<CloudFileOptions> samples = Numbers<CloudFileOptions>({2.0, kMostGridSamples});
  samples.get = [](const CloudFileOptions& file) -> std::optional<TomlValue> {
    if (!file.samples) return std::nullopt;
    return TomlValue(std::vector<double>(file.samples->begin(), file.samples->end()));
  };
  return samples;
}

/// A text; the reader of the file takes it itself.
TomlMember<CloudFileOptions> VdbGridName() {
  TomlMember<CloudFileOptions> name = Text<CloudFileOptions>();
  name.get = [](const CloudFileOptions& file) { return TomlValue(file.grid); };
  return name;
}

TomlMember<CloudFileOptions> GridUp() {
  return {{.names = kUpAxes.All(), .expected = OneOfQuoted(kUpAxes.All())},
          [](const TomlValue& value, CloudFileOptions& file) {
            file.is_y_up = kUpAxes.Find(std::get<std::string>(value)) == UpAxis::kY;
          },
          [](const CloudFileOptions& file) {
            return TomlValue(std::string(kUpAxes.Of(file.is_y_up ? UpAxis::kY : UpAxis::kZ)));
          }};
}

template <typename Object>
TomlField<Object> HeightRow(const char* example) {
  return {"height_m", Number<Object>({kDeepestPlace_m, kHighestPlace_m}), "m",
          "",         "above the ellipsoid, instead of above_ground_m",   example};
}

template <typename Object>
TomlField<Object> AboveGroundRow(const char* text, const char* example) {
  return {"above_ground_m", Number<Object>({0.0, kHighestPlace_m}), "m", "", text, example};
}

}  // namespace

const TomlFields<Scene>& PlaceFields() {
  static const TomlFields<Scene> fields{
      "place",
      {{"latitude", Number<Scene>(kLatitudes), "degrees north", "required", "", "46.5"},
       {"longitude", Number<Scene>(kLongitudes), "degrees east", "required", "", "8.0"},
       {"zone", Text(&Scene::zone), "", "", "IANA name; local times need it", "\"Europe/Zurich\""}},
      "of the camera"};
  return fields;
}

const TomlFields<Scene>& TimeFields() {
  static const TomlFields<Scene> fields{
      "time",
      {{"utc", Text<Scene>(), "", "", "date and time", "\"2026-06-21T04:00:00Z\""},
       {"local", Text<Scene>(), "", "", "in place.zone, instead of utc",
        "# \"2026-06-21T06:00:00\""}},
      "used if the command line gives no time"};
  return fields;
}

const TomlFields<Camera>& CameraFields() {
  static const TomlFields<Camera> fields{
      "camera",
      {HeightRow<Camera>("# 2500.0"),
       AboveGroundRow<Camera>("", "2.0"),
       {"heading", Degrees(&Camera::heading_rad, kHeadings), "degrees", "", "clockwise from north",
        "0.0"},
       {"pitch", Degrees(&Camera::pitch_rad, kPitches), "degrees", "", "above the horizontal",
        "0.0"},
       {"roll", Degrees(&Camera::roll_rad, {-180.0, 180.0}), "degrees", "",
        "clockwise as seen from behind", "0.0"},
       {"fov", Number<Camera>({0.1, 360.0}), "degrees", "",
        "horizontal, at most 179, or 360 for a panorama", "60.0"},
       {"f_number", Number<Camera>({0.0, 1000.0}), "", "",
        "0 is a pinhole, for which the lens has no effect; a lens has at least 0.1", "0.0"},
       {"focal_length_mm", Number<Camera>({0.1, 10000.0}), "mm", "required with an f_number", "",
        "50.0"},
       {"focus_m", Number<Camera>({0.01, 1e9}), "m", "required with an f_number",
        "distance of sharp objects", "10.0"},
       {"sensor_width_mm", Number<Camera>({0.1, 1e5}), "mm", "",
        "with focal_length_mm, instead of fov", "# 36.0"},
       {"blades", Number<Camera>({0.0, 64.0}), "", "",
        "of the iris, 0 or at least 3; 0 is a round iris", "0"},
       {"blade_rotation", Number<Camera>({-360.0, 360.0}), "degrees", "", "", "0.0"},
       {"polariser_deg", Degrees(&Camera::polariser_rad, {-180.0, 180.0}), "degrees", "",
        "a linear polariser, its axis clockwise from the vertical", "# 0.0", true},
       {"shutter_s", Number(&Camera::shutter_s, {0.0, 43200.0}), "s", "",
        "stars, planets and the moon draw trails", "0.0", true}}};
  return fields;
}

const TomlFields<Scene>& AtmosphereFields() {
  static const TomlFields<Scene> fields{
      "atmosphere",
      {{"file", Text<Scene>(), "", "", "atmosphere/ATMOSPHERE_FILE.md, instead of a preset",
        "# \"atmosphere.toml\""},
       {"preset", Text<Scene>(), "", "", "the presets of atmosphere/ATMOSPHERE_FILE.md",
        "\"earth\""}}};
  return fields;
}

const TomlFields<SceneWeather>& WeatherFields() {
  static const TomlFields<SceneWeather> fields{
      "weather",
      {{"metar", ReadApart(Text(&SceneWeather::metar)), "", "",
        "METAR or SPECI (Weather by report)", "# \"LSZH 211350Z 24008KT 9999 FEW040 22/12 Q1018\"",
        true},
       {"station_height_m", Number(&SceneWeather::station_height_m, kStationHeights_m), "m", "",
        "above the ellipsoid; the default is that of a named airport, or 0", "# 423.0", true}}};
  return fields;
}

const TomlFields<TerrainSource>& TerrainFields() {
  static const TomlFields<TerrainSource> fields{
      "terrain",
      {{"dem", Text<TerrainSource>(), "", "", "GeoTIFF, SRTM, USGS DEM or a folder",
        "\"N46E008.hgt\""},
       {"mesh", Text<TerrainSource>(), "", "", "in metres from the place", "# \"x.obj\""},
       {"up", Name(&TerrainSource::up, kUpAxes, OneOfQuoted), "", "",
        "of a mesh: \"z\" (x east, y north, z up) or \"y\" (x east, y up, z south)", "# \"z\""},
       {"none", Truth<TerrainSource>(), "", "", "the ellipsoid alone", "# true"},
       {"range", Truth<TerrainSource>(), "", "", "the built-in mountain range", "# true"},
       {"voids", Name(&TerrainSource::voids, kVoidPolicies, OneOfQuoted), "", "",
        "holes where an elevation model has no data (nodata, mask or alpha)", "\"fill\""},
       {"colour", Text<TerrainSource>(), "", "",
        "draped over the terrain by its georeference, or over the terrain's extent; where it is "
        "more than half transparent, the ground has its own cover",
        "\"colour.tif\""},
       {"land_cover", Text<TerrainSource>(), "", "",
        "instead of colour: classes of ESA WorldCover, for the cover \"mountain\"",
        "# \"worldcover.tif\""}},
      "one of dem, mesh, none and range; without them range, with a warning"};
  return fields;
}

const TomlFields<GroundCover>& GroundFields() {
  static const TomlFields<GroundCover> fields{
      "ground",
      {{"cover", Name(&GroundCover::kind, kCovers, OneOfQuoted), "", "",
        "the mountain is covered by altitude, slope, place and season", "\"mountain\""},
       {"albedo", Three(&GroundCover::albedo, {0.0, 1.0}), "", "",
        "of lambert, oren-nayar, blinn-phong: one value, or linear sRGB", "# [0.2, 0.2, 0.2]"},
       {"roughness", Number(&GroundCover::roughness, {0.0, 1.0}), "", "",
        "of oren-nayar, and at least 0.1 of blinn-phong", "# 0.5"},
       {"reflectance", Number(&GroundCover::reflectance, {0.0, 1.0}), "", "",
        "of the coat of blinn-phong", "# 0.04"},
       {"wind_m_per_s", Number(&GroundCover::wind_m_per_s, kWindsOverWater_m_per_s), "m/s", "",
        "above water; the default is that of the report, or 5", "5.0"},
       {"grain_diameter_mm", Number(&GroundCover::grain_diameter_m, {0.05, 5.0}, 1e-3), "mm", "",
        "of snow", "# 0.5"},
       {"sea_level_m", Number(&GroundCover::sea_level_m, {kDeepestPlace_m, 9000.0}), "m", "",
        "lower ground is water; without the key there is no sea", "0.0"},
       {"wetness", Number(&GroundCover::wetness, {0.0, 1.0}), "", "",
        "rock, grass, colour and one albedo after rain; not wood and snow", "0.0"}}};
  return fields;
}

const TomlFields<Light>& LightFields() {
  static const TomlFields<Light> fields{
      "light",
      {{"type", Name(&Light::type, kLightTypes, OneOfQuoted), "", "", "the default is \"point\"",
        "\"spot\""},
       {"latitude", Number(&Light::place, &Place::latitude_deg, kLatitudes), "degrees north",
        "required", "", "46.51"},
       {"longitude", Number(&Light::place, &Place::longitude_deg, kLongitudes), "degrees east",
        "required", "", "8.0"},
       HeightRow<Light>("# 700.0"),
       AboveGroundRow<Light>("", "2.0"),
       {"intensity_cd", Number(&Light::intensity_cd, {0.0, 1e12}), "cd",
        "required without an IES file", "the largest intensity", "20000.0"},
       {"temperature_k", Number(&Light::temperature_k, {500.0, 50000.0}), "K", "", "", "3000.0"},
       {"radius_m", Number(&Light::radius_m, {0.001, 100.0}), "m", "",
        "of the luminous sphere; a camera inside sees its luminance", "0.1"},
       {"ies", Text<Light>(), "", "",
        "of a point: IES LM-63 of 1986 to 2019, types A, B and C (Measured lamps)",
        "# \"lamp.ies\""},
       {"heading", Degrees(&Light::heading_rad, kHeadings), "degrees", "",
        "of a spot, or of the C 0 plane of an IES file", "180.0"},
       {"pitch", Degrees(&Light::pitch_rad, kPitches), "degrees", "",
        "for an IES file the default is -90, straight down", "0.0"},
       {"cone", Numbers<Light>({0.0, 180.0}), "degrees", "",
        "half angles of a spot: full inside the first, none outside the second", "[10.0, 25.0]"}},
      "a lamp; any number",
      /*is_list=*/true};
  return fields;
}

const TomlFields<MediumLayer>& LayerFields() {
  static const TomlFields<MediumLayer> fields{
      "fog",
      {{"visibility_m", Number<MediumLayer>({1.0, 1e6}), "m", "", "", "900.0"},
       {"extinction_per_m", ReadApart(Number(&MediumLayer::extinction_per_m, {0.0, 10.0})), "1/m",
        "", "instead of visibility_m", "# 0.004"},
       {"scale_height_m", Number(&MediumLayer::scale_height_m, {1.0, 1e5}), "m", "",
        "without the key the density is the same at every height", "25.0"},
       {"base_height_m", Number(&MediumLayer::base_height_m, {kDeepestPlace_m, 1e5}), "m", "",
        "above the ellipsoid, of this visibility; fog below is denser. Default: the ground under "
        "the camera",
        "400.0"},
       {"albedo", Number(&MediumLayer::albedo, {0.0, 1.0}), "", "", "", "1.0"},
       {"droplet_diameter_um", Number<MediumLayer>({kSmallestDroplet_um, kLargestDroplet_um}),
        "micrometres", "", "", "15.0"},
       {"g", Number<MediumLayer>({-0.99, 0.99}), "", "",
        "of Henyey and Greenstein, instead of droplet_diameter_um", "# 0.85"}},
      "over the whole scene"};
  return fields;
}

const TomlFields<Scene>& NightFields() {
  static const TomlFields<Scene> fields{
      "night",
      {{"bortle", Number<Scene>({1.0, 9.0}), "", "", "class of the sky", "# 4"},
       {"zenith_mag_per_arcsec2", Number<Scene>({14.0, kNaturalZenith}), "", "",
        "brightness of the zenith, instead of bortle", "# 20.5"}},
      "light of towns in the air"};
  return fields;
}

const TomlFields<Volume>& VolumeFields() {
  static const TomlFields<Volume> fields{
      "volume",
      {{"shape", Name(&Volume::shape, kVolumeShapes, OneOfQuoted), "", "", "", "\"box\""},
       {"latitude", Number(&Volume::place, &Place::latitude_deg, kLatitudes), "degrees north",
        "required", "", "46.52"},
       {"longitude", Number(&Volume::place, &Place::longitude_deg, kLongitudes), "degrees east",
        "required", "", "8.0"},
       HeightRow<Volume>("# 700.0"),
       AboveGroundRow<Volume>("of its underside", "0.0"),
       {"size_m", Three(&Volume::size_m, {0.01, 2e5}), "m", "required",
        "across its heading, along it, up", "[400.0, 200.0, 80.0]"},
       {"heading", Degrees(&Volume::heading_rad, kHeadings), "degrees", "", "clockwise from north",
        "0.0"},
       {"scale_height_m", Number(&Volume::scale_height_m, {0.1, 1e5}), "m", "",
        "without the key the density is the same throughout", "30.0"},
       {"grid", Text<Volume>(), "", "", "densities on a grid: NRRD (Grids of densities), or raw",
        "# \"smoke.nrrd\""},
       {"grid_size", Numbers<Volume>({2.0, kMostGridSamples}), "", "required for a raw grid",
        "samples along x, y and z", "# [64, 64, 32]"},
       {"transfer", Transfer(), "", "", "instead of the next five keys (Transfer functions)",
        "# [[0.2, 0.0, 1, 1, 1], [0.6, 0.05, 0.9, 0.4, 0.1]]"},
       {"extinction_per_m", ReadApart(OneForAll(Numbers(&Volume::extinction_per_m, {0.0, 1e4}))),
        "1/m", "", "one value, or one per wavelength", "0.01"},
       {"visibility_m", Number<Volume>({0.1, 1e6}), "m", "", "instead of extinction_per_m",
        "# 400.0"},
       {"albedo", OneForAll(Numbers(&Volume::albedo, {0.0, 1.0})), "", "",
        "one value, or one per wavelength", "1.0"},
       {"emission_per_m", OneForAll(Numbers(&Volume::emission_per_m, {0.0, 1e12})),
        "W m^-2 sr^-1 nm^-1 per m", "", "one value, or one per wavelength", "0.0"},
       {"temperature_k", Number(&Volume::temperature_k, {100.0, 50000.0}), "K", "",
        "emission of a black body, instead of emission_per_m; needs an albedo below 1, because "
        "what absorbs nothing does not glow",
        "# 1500.0"},
       {"droplet_diameter_um", Number<Volume>({kSmallestDroplet_um, kLargestDroplet_um}),
        "micrometres", "", "instead of g", "# 15.0"},
       {"g", Number<Volume>({-0.99, 0.99}), "", "", "of Henyey and Greenstein", "0.5"},
       {"orders", Name(&Volume::orders, kScatteringOrders, OneOfQuoted), "", "",
        "of scattering; all: see Limits", "\"all\""}},
      "smoke, a bank of fog, a glowing gas; any number",
      /*is_list=*/true};
  return fields;
}

const TomlFields<SceneObject>& ObjectFields() {
  static const TomlFields<SceneObject> fields{
      "object",
      {{"shape",
        {{.names = kObjectShapes, .expected = OneOfQuoted(kObjectShapes)}},
        "",
        "",
        "",
        "\"sphere\""},
       {"latitude", Number(&SceneObject::place, &Place::latitude_deg, kLatitudes), "degrees north",
        "required", "", "46.501"},
       {"longitude", Number(&SceneObject::place, &Place::longitude_deg, kLongitudes),
        "degrees east", "required", "", "8.0"},
       HeightRow<SceneObject>("# 700.0"),
       AboveGroundRow<SceneObject>("of its underside", "0.0"),
       {"radius_m", Number(&SceneObject::radius_m, {0.01, 1000.0}), "m", "", "", "1.0"},
       {"material", Name(&SceneObject::material, kSphereMaterials, OneOfQuoted), "", "", "",
        "\"glass\""},
       {"index", Number(&SceneObject::index, {kLeastRefractiveIndex, kMostRefractiveIndex}), "", "",
        "of refraction, of glass", "1.5"},
       {"photons", Number(&SceneObject::photons, {1.0, 1e7}), "", "",
        "a whole number: for the light that the object sends into fog and volumes", "100000"},
       {"photon_map", Name(&SceneObject::photon_map, kPhotonMaps, OneOfQuoted), "", "",
        "of this light, the same for all objects", "\"beams\""}},
      "a sphere of glass or a mirror; any number",
      /*is_list=*/true};
  return fields;
}

const TomlFields<SceneCloud>& CloudFields() {
  using Ranges = CloudRanges;
  using File = CloudFileOptions;
  constexpr auto kOptions = &SceneCloud::options;
  constexpr auto kFile = &SceneCloud::file;
  static const TomlFields<SceneCloud> fields{
      "cloud",
      {{"genus", Name(kOptions, &CloudOptions::genus, kCloudGenusNames, OneOfQuoted), "", "",
        "required without a grid, which is of ice if its genus is, else of droplets",
        "\"cumulus\""},
       {"cover", Number(kOptions, &CloudOptions::cover, Ranges::kCover), "", "",
        "fraction of the sky, seen vertically; of cumulus at most 0.8, of stratus and cirrostratus "
        "1",
        "0.3"},
       {"base_height_m", Number(kOptions, &CloudOptions::base_altitude_m, Ranges::kBase_m), "m", "",
        "above the ellipsoid; except for clouds of ice at most 11000. The default of cumulus, "
        "stratocumulus and stratus is above the ground at the place of the scene. Of a grid: see "
        "Fields of clouds",
        "# 1200.0"},
       {"depth_m", Number(kOptions, &CloudOptions::depth_m, Ranges::kDepth_m), "m", "",
        "from the base to the highest tops", "1500.0"},
       {"droplets_per_cm3",
        Number(kOptions, &CloudOptions::droplet_number_per_cm3, Ranges::kDroplets_per_cm3), "1/cm3",
        "", "not of clouds of ice", "250.0"},
       {"ice_mg_per_m3", Number(kOptions, &CloudOptions::ice_mg_per_m3, Ranges::kIce_mg_per_m3),
        "mg/m3", "", "of cirrus and cirrostratus", "# 40.0"},
       {"crystal_radius_um",
        Number(kOptions, &CloudOptions::crystal_radius_um, Ranges::kCrystalRadius_um),
        "micrometres", "", "effective; of cirrus and cirrostratus", "# 35.0"},
       {"optical_depth", Number(kOptions, &CloudOptions::optical_depth, Ranges::kOpticalDepth), "",
        "", "vertical, of stratus and cirrostratus; the default is that of their water or ice",
        "# 30.0"},
       {"seed", CloudSeed(), "", "", "a whole number; the default is the number of the table", "1"},
       {"wind_m_per_s", CloudWind(), "m/s", "",
        "to the east and to the north; a grid is at its place at the time of the scene, and has no "
        "wind by default",
        "[6.0, 0.0]"},
       {"period_m", Number(kOptions, &CloudOptions::period_m, Ranges::kPeriod_m), "m", "",
        "clouds repeat after it to the east and to the north; a multiple of 2560", "20480.0"},
       {"grid", Text<SceneCloud>(), "", "",
        "a file with a field (Fields of clouds), instead of cover to seed and period_m",
        "# \"field.txt\""},
       {"repeats", OfPart(kFile, Truth(&File::is_periodic)), "", "",
        "a grid repeats beyond its sides", "# true"},
       {"spacing_m", ReadApart(OfPart(kFile, GridSpacing())), "m", "required for NRRD and raw",
        "of the samples of a grid; one value, or [x, y, z]", "# [50.0, 50.0, 25.0]"},
       {"grid_size", ReadApart(OfPart(kFile, GridSamples())), "", "required for a raw grid",
        "samples along x, y and z", "# [64, 64, 32]"},
       {"extinction_per_m",
        Number(kFile, &File::extinction_per_m, CloudFileRanges::kExtinction_per_m), "1/m", "",
        "of the density 1 of a grid; the default is 1", "# 0.05"},
       {"effective_radius_um",
        Number(kFile, &File::effective_radius_um, CloudFileRanges::kRadius_um), "micrometres", "",
        "of the droplets or crystals of a grid", "# 10.0"},
       {"vdb_grid", ReadApart(OfPart(kFile, VdbGridName())), "", "",
        "the name of a grid in an OpenVDB file; the default is density, or else the first grid of "
        "floats",
        "# \"density\""},
       {"up", OfPart(kFile, GridUp()), "", "", "of OpenVDB, as for a mesh", "# \"z\""},
       {"latitude", Number<SceneCloud>(kLatitudes), "degrees north", "",
        "of the middle of a grid; the default is the place of the scene", "# 46.5"},
       {"longitude", Number<SceneCloud>(kLongitudes), "degrees east", "", "", "# 8.0"}},
      "a layer over the whole scene, with defaults of its genus; any number",
      /*is_list=*/true};
  return fields;
}

std::string NameOf(Light::Type type) { return kLightTypes.Of(type); }

}  // namespace alpenglow::renderer
