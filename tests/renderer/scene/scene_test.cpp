// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/text_file.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "lut/image/look.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_fields.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/toml_keys.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using SceneFile = TemporaryFolder;

const std::string kPlace = "[place]\nlatitude = 35.3606\nlongitude = 138.7274\n";

Scene Read(const std::string& text) { return SceneFromToml(text, "s.toml", "folder"); }

std::string FaultOf(const std::string& text) {
  return tests::FaultOf([&] { return Read(text); });
}

TEST(Scene, SensorAndFocalLengthDefineTheFieldOfView) {
  const auto fov = [](const std::string& camera) {
    return Read(kPlace + "[camera]\n" + camera).camera.fov_rad;
  };
  const std::string sensor = "sensor_width_mm = 36\nfocal_length_mm = 50\n";
  EXPECT_NEAR(fov(sensor), 2.0 * std::atan(18.0 / 50.0), 1e-12);
  EXPECT_NEAR(fov(sensor + "f_number = 2\nfocus_m = 1\n"), 2.0 * std::atan(18.0 * 0.95 / 50.0),
              1e-12)
      << "for a focus at 1 m the sensor is at 50 / 0.95 mm";
  EXPECT_NEAR(fov(sensor + "fov = 39.6\n"), 39.6 * kRadiansPerDegree, 1e-12)
      << "given twice, and rounded";
  const Camera bladed = Read(kPlace +
                             "[camera]\nf_number = 2\nfocal_length_mm = 50\nfocus_m = 1\n"
                             "blades = 7\nblade_rotation = 10\n")
                            .camera;
  EXPECT_EQ(bladed.lens->blades, 7);
  EXPECT_NEAR(bladed.lens->blade_rotation_rad, 10.0 * kRadiansPerDegree, 1e-12);
}

/// Returns the block of TOML in the manual of scene.toml.
std::string Manual() {
  const std::string all =
      ReadTextFile(std::filesystem::path(tests::kSourceFolder) / "renderer" / "MANUAL.md");
  const std::size_t begin = all.find("```toml\n") + 8;
  return all.substr(begin, all.find("```", begin) - begin);
}

TEST(Scene, TheManualsSceneHasTheDefaults) {
  const Scene manual = Read(Manual());
  const Scene bare = Read("[place]\nlatitude = 46.5\nlongitude = 8.0\n");
  EXPECT_EQ(manual.camera.height, bare.camera.height);
  EXPECT_EQ(manual.camera.fov_rad, bare.camera.fov_rad);
  EXPECT_EQ(manual.camera.lens.has_value(), bare.camera.lens.has_value());
  EXPECT_EQ(manual.medium, bare.medium);
  EXPECT_EQ(manual.terrain.voids, bare.terrain.voids);
  EXPECT_EQ(manual.ground.kind, bare.ground.kind);
  EXPECT_EQ(manual.ground.wind_m_per_s, kUsualWind_m_per_s);
  EXPECT_EQ(manual.lights.size() + manual.volumes.size(), 2U);
  ASSERT_EQ(manual.objects.size(), 1U);
  EXPECT_EQ(manual.objects[0].radius_m, SceneObject{}.radius_m);
  EXPECT_EQ(manual.objects[0].index, SceneObject{}.index);
  EXPECT_EQ(manual.objects[0].photons, SceneObject{}.photons);
  EXPECT_EQ(manual.lights.at(0).temperature_k, Light{}.temperature_k);
  EXPECT_EQ(manual.lights.at(0).radius_m, Light{}.radius_m);
  EXPECT_EQ(manual.volumes.at(0).albedo, Volume{}.albedo);
  ASSERT_EQ(manual.clouds.size(), 1U);
  EXPECT_EQ(manual.clouds[0].options, DefaultCloudOptions(CloudGenus::kCumulus));
}

TEST(Scene, EveryKeyOfTheFileIsRead) {
  const Scene scene = Read(R"(
[place]
latitude = 35.3606
longitude = 138.7274
zone = "Asia/Tokyo"
[time]
utc = "2026-06-21T04:00:00Z"
[camera]
height_m = 2500.0
heading = 270.0
pitch = -2.0
roll = 1.5
polariser_deg = -30.0
shutter_s = 30.0
fov = 45.0
f_number = 2.8
focal_length_mm = 50.0
focus_m = 1000.0
[atmosphere]
preset = "hazy"
[night]
bortle = 5
[terrain]
dem = "N35E138.hgt"
voids = "open"
[[light]]
type = "spot"
latitude = 35.36
longitude = 138.73
above_ground_m = 20.0
intensity_cd = 20000.0
temperature_k = 2700.0
heading = 90.0
pitch = -5.0
cone = [10.0, 25.0]
[[light]]
latitude = 35.37
longitude = 138.73
height_m = 700.0
intensity_cd = 0
)");
  EXPECT_DOUBLE_EQ(scene.place.latitude_rad(), 35.3606 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(scene.place.longitude_rad(), 138.7274 * kRadiansPerDegree);
  EXPECT_EQ(scene.zone, "Asia/Tokyo");
  EXPECT_EQ(FormatUtc(scene.time.value()), "2026-06-21T04:00:00Z");
  EXPECT_EQ(scene.camera.height, (Height{2500.0, false}));
  EXPECT_DOUBLE_EQ(scene.camera.heading_rad, 1.5 * kPi);
  EXPECT_DOUBLE_EQ(scene.camera.pitch_rad, -2.0 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(scene.camera.roll_rad, 1.5 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(scene.camera.polariser_rad.value(), -30.0 * kRadiansPerDegree);
  EXPECT_EQ(scene.camera.shutter_s, 30.0);
  EXPECT_EQ(scene.town_zenith, ZenithOfBortleClass(5));
  EXPECT_DOUBLE_EQ(scene.camera.fov_rad, 0.25 * kPi);
  ASSERT_TRUE(scene.camera.lens.has_value());
  EXPECT_DOUBLE_EQ(scene.camera.lens->focal_length_m, 0.05);
  EXPECT_EQ(scene.medium.name, "hazy");
  EXPECT_EQ(scene.terrain.kind, TerrainSource::Kind::kElevationModel);
  EXPECT_EQ(scene.terrain.file, "folder/N35E138.hgt");
  EXPECT_EQ(scene.terrain.voids, VoidPolicy::kLeaveOpen);
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_EQ(scene.lights[0].type, Light::Type::kSpot);
  EXPECT_DOUBLE_EQ(scene.lights[0].outer_rad, 25.0 * kRadiansPerDegree);
  EXPECT_EQ(scene.lights[1].type, Light::Type::kPoint);
  EXPECT_EQ(scene.lights[1].height, (Height{700.0, false}));
}

TEST(Scene, MeasuredLampsAndFogAreRead) {
  const Scene scene = Read(kPlace + R"(
[fog]
visibility_m = 391.2
scale_height_m = 30.0
base_height_m = 100.0
droplet_diameter_um = 10.0
[[light]]
latitude = 35.37
longitude = 138.73
ies = "lamp.ies"
heading = 10.0
radius_m = 0.2
)");
  ASSERT_EQ(scene.layers.size(), 1U);
  EXPECT_DOUBLE_EQ(scene.layers[0].extinction_per_m, 0.01)
      << "3.912 optical depths are the visibility";
  EXPECT_DOUBLE_EQ(scene.layers[0].scale_height_m, 30.0);
  EXPECT_EQ(scene.layers[0].phase, DropletPhase(10.0));
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].ies, "folder/lamp.ies");
  EXPECT_EQ(scene.lights[0].intensity_cd, std::nullopt) << "the file says it";
  EXPECT_DOUBLE_EQ(scene.lights[0].pitch_rad, -0.5 * kPi) << "down, as lamps are measured";
  EXPECT_EQ(scene.lights[0].radius_m, 0.2);
}

TEST(Scene, VolumesOfAirAreRead) {
  const Scene scene = Read(kPlace + R"(
[[volume]]
shape = "ellipsoid"
latitude = 35.37
longitude = 138.73
above_ground_m = 4.0
size_m = [400, 900, 60]
heading = 90
scale_height_m = 25
visibility_m = 391.2
[[volume]]
latitude = 35.37
longitude = 138.73
height_m = 1200
size_m = [50, 60, 200]
grid = "smoke.raw"
grid_size = [32, 48, 64]
extinction_per_m = [0.1, 0.2, 0.3, 0.4]
albedo = 0.6
temperature_k = 900
g = 0.3
orders = "single"
[[volume]]
latitude = 35.37
longitude = 138.73
size_m = [50, 60, 200]
grid = "smoke.nrrd"
extinction_per_m = 0.1
)");
  ASSERT_EQ(scene.volumes.size(), 3U);
  const Volume& bank = scene.volumes[0];
  EXPECT_EQ(bank.shape, VolumePlacement::Shape::kEllipsoid);
  EXPECT_EQ(bank.height, (Height{4.0, true}));
  EXPECT_EQ(bank.orders, ScatteringOrders::kAll);
  EXPECT_EQ(scene.volumes[1].orders, ScatteringOrders::kSingle);
  EXPECT_DOUBLE_EQ(bank.scale_height_m.value(), 25.0);
  EXPECT_NEAR(bank.extinction_per_m.at(0), 0.01, 1e-12) << "3.912 optical depths";
  EXPECT_EQ(bank.phase, DropletPhase(15.0)) << "drops when nothing is said";
  const Volume& plume = scene.volumes[1];
  EXPECT_EQ(plume.height, (Height{1200.0, false}));
  EXPECT_EQ(plume.grid, std::filesystem::path("folder/smoke.raw"));
  EXPECT_EQ(plume.grid_size.value(), (std::array<int, 3>{32, 48, 64}));
  EXPECT_EQ(plume.extinction_per_m, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(plume.temperature_k.value(), 900.0);
  EXPECT_EQ(plume.phase.g, 0.3);
  EXPECT_FALSE(scene.volumes[2].grid_size.has_value());
  EXPECT_EQ(scene.volumes[2].height, (Height{0.0, true})) << "it stands on the ground";
}

TEST(Scene, CloudsOfTheFileAreRead) {
  const Scene scene = Read(kPlace + R"(
[[cloud]]
genus = "stratocumulus"
cover = 0.9
base_height_m = 1500
depth_m = 400
droplets_per_cm3 = 150
seed = 7
wind_m_per_s = [-3.0, 5.0]
period_m = 10240
[[cloud]]
genus = "cirrus"
ice_mg_per_m3 = 60
crystal_radius_um = 40
[[cloud]]
grid = "field.txt"
repeats = true
latitude = 35.5
longitude = 138.5
)");
  ASSERT_EQ(scene.clouds.size(), 3U);
  const CloudOptions& deck = scene.clouds[0].options;
  EXPECT_EQ(deck, (CloudOptions{.genus = CloudGenus::kStratocumulus,
                                .cover = 0.9,
                                .base_altitude_m = 1500.0,
                                .depth_m = 400.0,
                                .droplet_number_per_cm3 = 150.0,
                                .seed = 7U,
                                .wind_m_per_s = {-3.0, 5.0},
                                .period_m = 10240.0}));
  CloudOptions cirrus = DefaultCloudOptions(CloudGenus::kCirrus);
  cirrus.ice_mg_per_m3 = 60.0;
  cirrus.crystal_radius_um = 40.0;
  cirrus.seed = 2;
  EXPECT_EQ(scene.clouds[1].options, cirrus) << "other keys are those of the genus";
  EXPECT_FALSE(scene.clouds[0].is_over_ground);
  EXPECT_FALSE(scene.clouds[1].is_over_ground);
  EXPECT_TRUE(Read(kPlace + "[[cloud]]\ngenus = \"cumulus\"\n").clouds[0].is_over_ground);
  EXPECT_EQ(scene.clouds[1].name, "s.toml: cloud[1]");
  const SceneCloud& grid = scene.clouds[2];
  EXPECT_EQ(grid.grid, "folder/field.txt");
  EXPECT_TRUE(grid.file.is_periodic);
  EXPECT_EQ(grid.middle.value().latitude_deg, 35.5);
  EXPECT_EQ(grid.options.wind_m_per_s, glm::dvec2(0.0));
}

TEST(Scene, GridsOfCloudsHaveTheKeysOfTheirFormat) {
  const Scene scene = Read(kPlace + R"(
[[cloud]]
grid = "field.vdb"
vdb_grid = "smoke"
up = "y"
[[cloud]]
grid = "field.NHDR"
spacing_m = 50
base_height_m = 1500
[[cloud]]
grid = "field.raw"
grid_size = [8, 16, 4]
spacing_m = [100, 50, 25]
base_height_m = 2000
extinction_per_m = 0.05
effective_radius_um = 7
)");
  ASSERT_EQ(scene.clouds.size(), 3U);
  const CloudFileOptions& vdb = scene.clouds[0].file;
  EXPECT_EQ(vdb.grid, "smoke");
  EXPECT_TRUE(vdb.is_y_up);
  EXPECT_FALSE(vdb.spacing_m) << "the file has its own";
  EXPECT_EQ(scene.clouds[0].options.base_altitude_m, 0.0);
  EXPECT_EQ(scene.clouds[1].file.spacing_m.value(), glm::dvec3(50.0));
  EXPECT_EQ(scene.clouds[1].file.extinction_per_m, 1.0);
  EXPECT_EQ(scene.clouds[1].file.effective_radius_um, 10.0);
  EXPECT_FALSE(scene.clouds[1].is_over_ground);
  const CloudFileOptions& raw = scene.clouds[2].file;
  EXPECT_EQ(raw.samples.value(), (std::array<int, 3>{8, 16, 4}));
  EXPECT_EQ(raw.spacing_m.value(), glm::dvec3(100.0, 50.0, 25.0));
  EXPECT_EQ(scene.clouds[2].options.base_altitude_m, 2000.0);
  EXPECT_EQ(raw.extinction_per_m, 0.05);
  EXPECT_EQ(raw.effective_radius_um, 7.0);
}

TEST(Scene, GroundOfTheFileIsRead) {
  const Scene water = Read(kPlace + "[ground]\ncover = \"water\"\nwind_m_per_s = 8\n");
  EXPECT_EQ(water.ground.kind, GroundCover::Kind::kWater);
  EXPECT_EQ(water.ground.wind_m_per_s, 8.0);
  const Scene lake = Read(kPlace + "[ground]\nsea_level_m = 1.5\nwind_m_per_s = 2\n");
  EXPECT_EQ(lake.ground.kind, GroundCover::Kind::kMountain);
  EXPECT_EQ(lake.ground.sea_level_m, 1.5);
  const Scene gloss = Read(kPlace +
                           "[ground]\ncover = \"blinn-phong\"\nalbedo = [0.1, 0.2, 0.3]\n"
                           "roughness = 0.3\nreflectance = 0.05\n");
  EXPECT_EQ(gloss.ground.albedo, (std::array<double, 3>{0.1, 0.2, 0.3}));
  EXPECT_EQ(gloss.ground.roughness, 0.3);
  EXPECT_EQ(gloss.ground.reflectance, 0.05);
  EXPECT_EQ(Read(kPlace + "[ground]\ncover = \"lambert\"\nalbedo = 0.4\n").ground.albedo[2], 0.4);
  EXPECT_EQ(Read(kPlace + "[ground]\nwetness = 0.7\n").ground.wetness, 0.7);
  const Scene snow = Read(kPlace + "[ground]\ncover = \"snow\"\ngrain_diameter_mm = 0.2\n");
  EXPECT_NEAR(snow.ground.grain_diameter_m, 2e-4, 1e-18);
  const Scene draped = Read(kPlace + "[terrain]\ncolour = \"photo.tif\"\n");
  EXPECT_EQ(draped.terrain.colour, std::filesystem::path("folder") / "photo.tif");
  EXPECT_TRUE(Read(kPlace).terrain.colour.empty());
  EXPECT_EQ(Read(kPlace + "[terrain]\nland_cover = \"map.tif\"\n").terrain.Drape(),
            std::filesystem::path("folder") / "map.tif");
}

TEST(Scene, OnlyAPlaceIsRequired) {
  const Scene scene = Read(kPlace);
  EXPECT_EQ(scene.medium.name, "earth");
  EXPECT_EQ(scene.terrain.kind, TerrainSource::Kind::kProceduralMountains);
  EXPECT_TRUE(scene.terrain.is_default) << "the range stands in for terrain that nobody named";
  EXPECT_FALSE(Read(kPlace + "[terrain]\nrange = true\n").terrain.is_default);
  EXPECT_EQ(scene.time, std::nullopt);
  EXPECT_EQ(scene.camera.height, (Height{2.0, true})) << "eye level";
  EXPECT_FALSE(scene.camera.lens.has_value());
  EXPECT_TRUE(scene.lights.empty());
  const std::string mesh = kPlace + "[terrain]\nmesh = \"x.obj\"\n";
  EXPECT_EQ(Read(mesh).terrain.up, UpAxis::kZ);
  EXPECT_EQ(Read(mesh + "up = \"z\"\n").terrain.up, UpAxis::kZ);
  EXPECT_EQ(Read(mesh + "up = \"y\"\n").terrain.up, UpAxis::kY);
}

TEST(Scene, LocalTimeIsReadInTheZoneOfThePlace) {
  const std::string seconds =
      kPlace + "zone = \"Asia/Tokyo\"\n[time]\nlocal = \"2026-06-21T13:00:00\"\n";
  EXPECT_EQ(FormatUtc(Read(seconds).time.value()), "2026-06-21T04:00:00Z");
}

// Hard case 44.
TEST(Scene, PanoramasAndSteepRollsAreCameras) {
  EXPECT_TRUE(Read(kPlace + "[camera]\nfov = 360\nroll = 90\n").camera.IsPanorama());
  EXPECT_FALSE(Read(kPlace + "[camera]\nfov = 179\n").camera.IsPanorama());
  EXPECT_NO_THROW((void)Read(kPlace + "[camera]\nfov = 1\nheading = -90\n"));
}

// Hard case 27.
TEST(Scene, PolesAndTheDateLineArePlaces) {
  for (const char* place : {"latitude = 90\nlongitude = 0\n", "latitude = -90\nlongitude = -180\n",
                            "latitude = 0\nlongitude = 180\n"}) {
    EXPECT_EQ(FaultOf(std::string("[place]\n") + place), "no fault");
  }
}

/// Returns the example of the manual, which has every key.
std::string ExampleOfFields() {
  std::string example;
  ForEachTable([&](const auto& section, const auto&) {
    std::string lines;
    bool has_effect = false;
    for (const TomlKey& key : section.Keys()) {
      lines += tests::ExampleLine(key);
      has_effect = has_effect || !key.example.starts_with("# ");
    }
    const std::string name =
        fmt::format(fmt::runtime(section.is_list ? "[[{}]]" : "[{}]"), section.name);
    example += (example.empty() ? "" : "\n") +
               tests::CommentedLine((has_effect ? "" : "# ") + name, section.text) + lines;
  });
  return example;
}

TEST(Scene, TheManualHasTheExampleOfTheFields) { EXPECT_EQ(Manual(), ExampleOfFields()); }

TEST(Scene, EveryKeyRefusesValuesThatItDoesNotAccept) {
  ForEachTable([](const auto& section, const auto&) {
    const std::string head = section.name == "place" ? "" : kPlace;
    const std::string table =
        fmt::format(fmt::runtime(section.is_list ? "[[{}]]\n" : "[{}]\n"), section.name);
    const std::string path = section.name + (section.is_list ? "[0]." : ".");
    const int line = head.empty() ? 2 : 5;
    for (const TomlKey& key : section.Keys()) {
      for (const auto& [value, fault] : tests::RefusedValues(key, path + key.key)) {
        EXPECT_EQ(FaultOf(fmt::format("{}{}{} = {}\n", head, table, key.key, value)),
                  fmt::format("s.toml:{}: {}", line, fault));
      }
      EXPECT_EQ(FaultOf(fmt::format("{}{}{}q = 1\n", head, table, key.key)),
                fmt::format("s.toml:{}: unknown key {}{}q; did you mean {}?", line, path, key.key,
                            key.key));
    }
  });
}

/// Expects that each text is refused with one line that contains the message.
void ExpectFaults(const std::vector<std::pair<std::string, std::string>>& faults) {
  for (const auto& [text, message] : faults) {
    const std::string fault = FaultOf(text);
    EXPECT_THAT(fault, HasSubstr(message)) << text;
    EXPECT_EQ(fault.find('\n'), std::string::npos) << "one line: " << fault;
  }
}

const std::string kFog = kPlace + "[fog]\n", kGround = kPlace + "[ground]\n",
                  kMap = kPlace + "[terrain]\nland_cover = \"m.tif\"\n",
                  kLamp = kPlace + "[[light]]\nlatitude = 35\nlongitude = 138\n",
                  kVolume = kPlace + "[[volume]]\nlatitude = 35\nlongitude = 138\n",
                  kSmoke = kVolume + "size_m = [9, 9, 9]\nvisibility_m = 50\n";

TEST(Scene, SpheresAreRefusedByKey) {
  const std::string ball = kPlace + "[[object]]\nlatitude = 35\nlongitude = 138\n";
  EXPECT_EQ(FaultOf(ball), "no fault");
  EXPECT_EQ(FaultOf(ball + "material = \"mirror\"\nradius_m = 2\n"), "no fault");
  ExpectFaults({
      {kPlace + "[[object]]\nlatitude = 35\n", "object[0].longitude is missing"},
      {ball + "radius_m = 0\n", "object[0].radius_m is 0; it must lie in [0.01, 1000]"},
      {ball + "index = 0.9\n", "object[0].index is 0.9; it must lie in [1, 4]"},
      {ball + "photons = 0\n", "object[0].photons is 0; it must lie in [1, "},
      {ball + "photons = 1.5\n", "object[0].photons is 1.5; it must be a whole number"},
      {ball + "material = \"wood\"\n", "object[0].material is \"wood\""},
      {ball + "photon_map = \"rays\"\n", "object[0].photon_map is \"rays\""},
      {ball + ball.substr(kPlace.size()) + "photon_map = \"points\"\n",
       "object[1].photon_map is \"points\"; that of object[0] is \"beams\""},
      {ball + "material = \"mirror\"\nindex = 1.5\n", "object[0].index is for glass"},
      {ball + "height_m = 9\nabove_ground_m = 2\n", "give one"},
  });
}

const std::string kScan = kVolume + "size_m = [9, 9, 9]\ngrid = \"a.nrrd\"\n";

TEST(Scene, TransferFunctionsAreRead) {
  const Scene scene = Read(kScan +
                           "transfer = [\n  [-1000, 0, 1, 1, 1],  # air\n"
                           "  [40.5, 0.25, 0.9, 0.5, 0.1, 1200],\n]\n");
  const std::vector<TransferNode>& nodes = scene.volumes.at(0).transfer;
  ASSERT_EQ(nodes.size(), 2U);
  EXPECT_EQ(nodes[0], (TransferNode{-1000.0, 0.0, {1.0, 1.0, 1.0}, 0.0}));
  EXPECT_EQ(nodes[1], (TransferNode{40.5, 0.25, {0.9, 0.5, 0.1}, 1200.0}));
}

TEST(Scene, TransferFunctionsAreRefusedByRow) {
  const std::string two = "transfer = [[0, 0, 1, 1, 1], [1, 1, 1, 1, 1]]\n";
  EXPECT_EQ(FaultOf(kScan + two), "no fault");
  ExpectFaults({
      {kVolume + "size_m = [9, 9, 9]\n" + two, "s.toml:8: volume[0].transfer needs a grid"},
      {kScan + "transfer = []\n", "s.toml:9: volume[0].transfer has 0 rows; it must have two"},
      {kScan + "transfer = [[0, 1, 1, 1, 1]]\n", "volume[0].transfer has 1 rows"},
      {kScan + "transfer = [[0, 1, 1, 1, 1],\n[0, 1, 1, 1, 1]]\n",
       "s.toml:10: volume[0].transfer[1] has the value 0 after 0; values must increase"},
      {kScan + "transfer = [[0, 1, 1, 1, 1],\n[1, 1, 1, 1, 1],\n[0.5, 1, 1, 1, 1]]\n",
       "s.toml:11: volume[0].transfer[2] has the value 0.5 after 1"},
      {kScan + "transfer = [[0, 1, 1, 1, 1],\n[1, -1, 1, 1, 1]]\n",
       "s.toml:10: extinction_per_m of volume[0].transfer[1] is -1; it must lie in [0, 10000]"},
      {kScan + "transfer = [[0, 1, 1, 1],\n[1, 1, 1, 1]]\n", "transfer[0] has 4 numbers"},
      {kScan + "transfer = [0, 1, 1, 1, 1]\n", "volume[0].transfer[0] is 0; it must be a list"},
      {kScan + "transfer = [[0, 1, 1, 1, [1]], [1, 1, 1, 1, 1]]\n",
       "blue of volume[0].transfer[0] is a list"},
      {kScan + "[[volume.transfer]]\nvalue = 1\n", "volume[0].transfer[0] is a table"},
      {kScan + two + "extinction_per_m = 1\n",
       "volume[0].extinction_per_m is for a volume without"},
      {kScan + two + "visibility_m = 1\n",
       "volume[0].visibility_m is for a volume without transfer"},
      {kScan + two + "albedo = 1\n", "volume[0].albedo is for a volume without transfer"},
      {kScan + two + "emission_per_m = 1\n", "volume[0].emission_per_m is for a volume without"},
      {kScan + two + "temperature_k = 1000\n", "volume[0].temperature_k is for a volume without"},
      {kScan + two + "scale_height_m = 4\n", "is for a volume without a grid"},
  });
}

// Hard case 42.
TEST(Scene, FogLampsVolumesAndGroundAreRefusedByKey) {
  EXPECT_EQ(FaultOf(kLamp + "intensity_cd = 0\n"), "no fault");
  EXPECT_EQ(FaultOf(kSmoke), "no fault");
  ExpectFaults({
      {kFog + "scale_height_m = 30\n", "fog.visibility_m"},
      {kFog + "visibility_m = 300\nextinction_per_m = 0.1\n", "give one of"},
      {kFog + "visibility_m = 300\ng = 0.5\ndroplet_diameter_um = 9\n", "give one"},
      {kLamp, "light[0].intensity_cd is missing"},
      {kLamp + "ies = \"a\"\ncone = [1, 2]\n", "cone is for"},
      {kLamp + "intensity_cd = 1\ncone = [1, 2]\n", "is for a spot"},
      {kLamp + "type = \"spot\"\nies = \"a\"\n", "ies is for"},
      {kLamp + "type = \"spot\"\nintensity_cd = 1\n", "light[0].cone must be two half angles"},
      {kLamp + "type = \"spot\"\nintensity_cd = 1\ncone = [25, 10]\n", "s.toml:9: light[0].cone"},
      {kVolume + "visibility_m = 50\n", "volume[0].size_m is missing"},
      {kVolume + "size_m = [9, 9]\nvisibility_m = 50\n", "volume[0].size_m has 2 values"},
      {kVolume + "size_m = [9, 9, 9]\n", "give one of volume[0].visibility_m and"},
      {kSmoke + "extinction_per_m = 0.1\n", "give one of volume[0].visibility_m and"},
      {kSmoke + "albedo = [0.5, 0.5]\n", "volume[0].albedo has 2 values; give one, or 4"},
      {kSmoke + "temperature_k = 900\n", "volume[0].temperature_k has no effect"},
      {kSmoke + "albedo = 0.5\ntemperature_k = 900\nemission_per_m = 1\n",
       "give one of volume[0].emission_per_m and volume[0].temperature_k"},
      {kSmoke + "grid = \"\"\n", "volume[0].grid is empty"},
      {kSmoke + "grid_size = [4, 4, 4]\n", "volume[0].grid_size needs a grid"},
      {kSmoke + "grid = \"a.raw\"\n", "volume[0].grid_size is missing"},
      {kSmoke + "grid = \"a.raw\"\ngrid_size = [4, 4, 4.5]\n", "whole numbers"},
      {kSmoke + "grid = \"a.nrrd\"\ngrid_size = [4, 4, 4]\n", "is for a raw grid"},
      {kSmoke + "grid = \"a.NHDR\"\ngrid_size = [4, 4, 4]\n", "is for a raw grid"},
      {kSmoke + "grid = \"a.nrrd\"\nscale_height_m = 4\n", "is for a volume without a grid"},
      {kSmoke + "g = 0.5\ndroplet_diameter_um = 9\n", "both given"},
      {kGround + "colour = 1\n", "ground.colour"},
      {kGround + "albedo = 0.5\n", "ground.albedo is for lambert"},
      {kGround + "wind_m_per_s = 5\n", "ground.wind_m_per_s is for water"},
      {kGround + "cover = \"lambert\"\nalbedo = [0.1, 0.2]\n", "ground.albedo"},
      {kGround + "cover = \"lambert\"\nroughness = 0.5\n", "ground.roughness is for"},
      {kGround + "cover = \"blinn-phong\"\nroughness = 0.05\n", "[0.1, 1]"},
      {kGround + "cover = \"snow\"\nwetness = 1\n", "ground.wetness is for"},
      {kMap + "colour = \"a.tif\"\n", "give one of terrain.colour"},
      {kMap + "none = true\n", "terrain.land_cover lies over"},
      {kMap + "[ground]\ncover = \"snow\"\n", "terrain.land_cover is for"},
      {kPlace + "[terrain]\nnone = true\ncolour = \"a.tif\"\n", "terrain.colour"},
      {kPlace + "[terrain]\ndem = \"\"\n", "terrain.dem is empty"},
      {kPlace + "[terrain]\nmesh = \"\"\n", "terrain.mesh is empty"},
      {kPlace + "[terrain]\ncolour = \"\"\n", "terrain.colour is empty"},
      {kPlace + "[terrain]\nland_cover = \"\"\n", "terrain.land_cover is empty"},
  });
}

const std::string kCumulus = kPlace + "[[cloud]]\ngenus = \"cumulus\"\n",
                  kCirrus = kPlace + "[[cloud]]\ngenus = \"cirrus\"\n",
                  kStratus = kPlace + "[[cloud]]\ngenus = \"stratus\"\n",
                  kGrid = kPlace + "[[cloud]]\ngrid = \"field.txt\"\n";

TEST(Scene, CloudsAreRefusedByKey) {
  EXPECT_EQ(FaultOf(kCumulus + "cover = 0.8\nperiod_m = 81920\n"), "no fault");
  EXPECT_EQ(FaultOf(kCirrus + "cover = 1\nbase_height_m = 15000\n"), "no fault");
  EXPECT_EQ(FaultOf(kGrid + "genus = \"cirrus\"\nwind_m_per_s = [1, 2]\n"), "no fault");
  ExpectFaults({
      {kPlace + "[[cloud]]\ncover = 0.5\n", "s.toml:4: cloud[0].genus is missing"},
      {kPlace + "[[cloud]]\ngenus = \"cumulos\"\n",
       "s.toml:5: cloud[0].genus is \"cumulos\"; it must be one of \"cumulus\", "
       "\"stratocumulus\", \"altocumulus\", \"cirrus\", \"stratus\", \"cirrostratus\"; did you "
       "mean "
       "\"cumulus\"?"},
      {kCumulus + "cover = 1.2\n", "s.toml:6: cloud[0].cover is 1.2; it must lie in [0, 1]"},
      {kCumulus + "cover = 0.9\n",
       "s.toml:6: cloud[0].cover is 0.9; cumulus cover 0.8 at most, and stratocumulus more"},
      {kCumulus + "base_height_m = 12000\n",
       "cloud[0].base_height_m is 12000; that of cumulus is at most 11000"},
      {kCumulus + "base_height_m = -1\n", "cloud[0].base_height_m is -1; it must lie in"},
      {kCumulus + "period_m = 5000\n", "cloud[0].period_m is 5000; it must be a multiple of 2560"},
      {kCumulus + "seed = 1.5\n", "cloud[0].seed is 1.5; it must be a whole number"},
      {kCumulus + "wind_m_per_s = [1]\n", "cloud[0].wind_m_per_s has 1 values; it must have two"},
      {kCumulus + "wind_m_per_s = [1, 2, 3]\n", "cloud[0].wind_m_per_s has 3 values"},
      {kCumulus + "ice_mg_per_m3 = 40\n",
       "cloud[0].ice_mg_per_m3 is for clouds of ice; cumulus is of droplets"},
      {kCumulus + "crystal_radius_um = 40\n", "cloud[0].crystal_radius_um is for clouds of ice"},
      {kCirrus + "droplets_per_cm3 = 40\n",
       "cloud[0].droplets_per_cm3 is for clouds of droplets; cirrus is of ice"},
      {kCumulus + "optical_depth = 9\n",
       "cloud[0].optical_depth is for stratus and cirrostratus; the genus is cumulus"},
      {kStratus + "cover = 0.9\n", "s.toml:6: cloud[0].cover is 0.9; stratus covers the whole sky"},
      {kStratus + "optical_depth = -1\n",
       "s.toml:6: cloud[0].optical_depth is -1; it must lie in [0, 1000]"},
      {kStratus + "optical_depth = inf\n", "s.toml:6: cloud[0].optical_depth is inf"},
      {kStratus + "optical_depth = 9\ndroplets_per_cm3 = 100\n",
       "cloud[0].droplets_per_cm3 is what optical_depth replaces"},
      {kStratus + "seed = 2\n", "cloud[0].seed is not for stratus, which has no gaps"},
      {kStratus + "period_m = 5120\n", "cloud[0].period_m is not for stratus"},
      {kStratus + "depth_m = -10\n", "cloud[0].depth_m is -10; it must lie in"},
      {kCirrus + kCumulus.substr(kPlace.size()) + "cover = 0.81\n", "s.toml:8: cloud[1].cover"},
      {kCumulus + "repeats = true\n", "cloud[0].repeats is for a grid"},
      {kCumulus + "latitude = 3\nlongitude = 4\n", "cloud[0].latitude is for a grid"},
      {kGrid + "latitude = 3\n", "cloud[0].longitude is missing"},
      {kGrid + "longitude = 3\n", "cloud[0].latitude is missing"},
      {kGrid + "cover = 0.3\n", "cloud[0].cover is for clouds without a grid"},
      {kGrid + "depth_m = 300\n", "cloud[0].depth_m is for clouds without a grid"},
      {kGrid + "droplets_per_cm3 = 3\n", "cloud[0].droplets_per_cm3 is for clouds without"},
      {kGrid + "ice_mg_per_m3 = 3\n", "cloud[0].ice_mg_per_m3 is for clouds without a grid"},
      {kGrid + "crystal_radius_um = 9\n", "cloud[0].crystal_radius_um is for clouds without"},
      {kGrid + "seed = 3\n", "cloud[0].seed is for clouds without a grid"},
      {kGrid + "period_m = 5120\n", "cloud[0].period_m is for clouds without a grid"},
      {kPlace + "[[cloud]]\ngrid = \"\"\n", "cloud[0].grid is empty"},
      {kPlace + "[cloud]\ngenus = \"cumulus\"\n", "must be a list of tables"},
  });
}

TEST(Scene, KeysOfCloudGridsAreRefusedByTheirFormat) {
  const std::string cloud = kPlace + "[[cloud]]\n", vdb = cloud + "grid = \"a.vdb\"\n",
                    base = "base_height_m = 900\n", nrrd = cloud + "grid = \"a.nrrd\"\n" + base,
                    raw = cloud + "grid = \"a.raw\"\n" + base,
                    grid_size = "grid_size = [4, 4, 4]\n", spacing = "spacing_m = 50\n";
  EXPECT_EQ(FaultOf(nrrd + spacing), "no fault");
  EXPECT_EQ(FaultOf(raw + spacing + grid_size), "no fault");
  EXPECT_EQ(FaultOf(vdb + base + spacing), "no fault");
  ExpectFaults({
      {kGrid + base,
       "s.toml:6: cloud[0].base_height_m is for grids of OpenVDB, NRRD, raw; this is text"},
      {kGrid + spacing, "cloud[0].spacing_m is for grids of OpenVDB, NRRD, raw; this is text"},
      {kGrid + grid_size, "cloud[0].grid_size is for grids of raw; this is text"},
      {kGrid + "extinction_per_m = 2\n", "cloud[0].extinction_per_m is for grids of OpenVDB"},
      {kGrid + "effective_radius_um = 2\n", "cloud[0].effective_radius_um is for grids of"},
      {kGrid + "vdb_grid = \"a\"\n", "cloud[0].vdb_grid is for grids of OpenVDB; this is text"},
      {kGrid + "up = \"y\"\n", "cloud[0].up is for grids of OpenVDB; this is text"},
      {vdb + grid_size, "cloud[0].grid_size is for grids of raw; this is OpenVDB"},
      {nrrd, "s.toml:4: cloud[0].spacing_m is missing; NRRD needs it"},
      {nrrd + "spacing_m = [1, 2]\n", "s.toml:7: cloud[0].spacing_m has 2 values"},
      {nrrd + spacing + grid_size, "s.toml:8: cloud[0].grid_size is for grids of raw"},
      {nrrd + spacing + "up = \"y\"\n", "cloud[0].up is for grids of OpenVDB; this is NRRD"},
      {cloud + "grid = \"a.nrrd\"\n" + spacing, "cloud[0].base_height_m is missing; NRRD needs it"},
      {raw + grid_size, "s.toml:4: cloud[0].spacing_m is missing; raw needs it"},
      {raw + spacing, "s.toml:4: cloud[0].grid_size is missing; raw needs it"},
      {raw + spacing + "grid_size = [4, 4]\n", "cloud[0].grid_size has 2 values"},
      {raw + spacing + "grid_size = [4, 4, 4.5]\n", "counted in whole numbers"},
      {raw + spacing + grid_size + "vdb_grid = \"a\"\n", "cloud[0].vdb_grid is for grids of"},
      {cloud + "grid = \"a.bin\"\n",
       "s.toml:5: cloud[0].grid is \"a.bin\"; its ending must be one of .txt, .dat, .vdb, .nrrd"},
      {kCumulus + spacing, "s.toml:6: cloud[0].spacing_m is for a grid"},
      {kCumulus + grid_size, "cloud[0].grid_size is for a grid"},
      {kCumulus + "extinction_per_m = 2\n", "cloud[0].extinction_per_m is for a grid"},
      {kCumulus + "effective_radius_um = 2\n", "cloud[0].effective_radius_um is for a grid"},
      {kCumulus + "vdb_grid = \"a\"\n", "cloud[0].vdb_grid is for a grid"},
      {kCumulus + "up = \"y\"\n", "cloud[0].up is for a grid"},
  });
}

// The ranges of these numbers contain 0 or 1, and other keys limit them further; @ is the value.
TEST(Scene, AlmostZeroNumbersAreRefusedByKeyWhereAnotherKeyLimitsThem) {
  const std::pair<std::string, const char*> keys[] = {
      {kPlace + "[camera]\nf_number = @\nfocal_length_mm = 50\nfocus_m = 10\n", "camera.f_number"},
      {kPlace + "[camera]\nf_number = 2\nfocal_length_mm = 50\nfocus_m = 10\nblades = @\n",
       "camera.blades"},
      {kGround + "cover = \"blinn-phong\"\nroughness = @\n", "ground.roughness"}};
  for (const auto& [with_key, key] : keys) {
    for (const std::string value : {"5e-324", "1e-300", "1e-30", "1e300"}) {
      std::string text = with_key;
      text.replace(text.find('@'), 1, value);
      const std::string fault = FaultOf(text);
      EXPECT_THAT(fault, HasSubstr(key + std::string(" is "))) << text;
      EXPECT_THAT(fault, HasSubstr("; it must ")) << text;
    }
  }
}

TEST(Scene, BadInputIsReportedWithLineKeyValueAndRange) {
  ExpectFaults({
      {"", "s.toml:1: [place] with latitude and longitude is missing"},
      {"[place]\nlatitude = 3\n", "place.longitude is missing"},
      {kPlace + "zone = \"Asia/Tokio\"\n", "s.toml:4: place.zone"},
      {kPlace + "[camer]\n", "unknown key camer; did you mean camera?"},
      {kPlace + "[camera]\nfov = 200\n", "[0.1, 179] or be 360"},
      {kPlace + "[camera]\nheight_m = 1e999\n", "s.toml:5"},
      {kPlace + "[camera]\nheight_m = 1\nabove_ground_m = 1\n", "both given"},
      {kPlace + "[camera]\nf_number = 2\n", "camera.focal_length_mm is missing"},
      {kPlace + "[camera]\nf_number = 2\nfocal_length_mm = 50\nfocus_m = 0.05\n", "beyond the"},
      {kPlace + "[camera]\nf_number = 1e-300\nfocal_length_mm = 50\nfocus_m = 5\n",
       "camera.f_number is 1e-300; it must be 0, a pinhole, or from 0.1 to 1000"},
      {kPlace + "[camera]\nblades = 2\n", "camera.blades is 2"},
      {kPlace + "[night]\n", "give one of night.bortle"},
      {kPlace + "[night]\nbortle = 4.5\n", "night.bortle is 4.5; it must be a class"},
      {kPlace + "[night]\nbortle = 4\nzenith_mag_per_arcsec2 = 20\n", "give one of night.bortle"},
      {kPlace + "[camera]\nblades = 5.5\n", "camera.blades is 5.5"},
      {kPlace + "[camera]\nsensor_width_mm = 36\n", "camera.focal_length_mm is missing"},
      {kPlace + "[camera]\nfov = 60\nsensor_width_mm = 36\nfocal_length_mm = 50\n",
       "camera.fov is 60, but focal length and sensor make it 39.6; give one"},
      {kPlace + "[camera]\nfov = 360\nf_number = 2\nfocal_length_mm = 50\nfocus_m = 5\n",
       "a panorama has no lens"},
      {kPlace + "[camera]\nfov = 3\nfov = 4\n", "s.toml:6: not valid TOML"},
      {kPlace + "[time]\nutc = \"2024-02-30T00:00:00Z\"\n", "s.toml:5: time.utc"},
      {kPlace + "[time]\nutc = \"2026-06-21T04:00:00\"\n", "s.toml:5: time.utc"},
      {kPlace + "[time]\n", "time.utc is missing"},
      {kPlace + "[time]\nlocal = \"2026-06-21T13:00:00\"\n", "time.local needs place.zone"},
      {kPlace + "[terrain]\ndem = \"a\"\nmesh = \"b\"\n", "give one of"},
      {kPlace + "[terrain]\nvoids = \"fill\"\n", "terrain.voids needs terrain.dem"},
      {kPlace + "[terrain]\ndem = \"a\"\nup = \"y\"\n", "terrain.up needs terrain.mesh"},
      {kPlace + "[atmosphere]\npreset = \"venus\"\n", "s.toml:5: atmosphere.preset"},
      {kPlace + "[atmosphere]\nfile = \"none.toml\"\n", "folder/none.toml"},
      {kPlace + "light = 3\n", "unknown key place.light"},
      {"light = 3\n" + kPlace, "must be a list of tables"},
      {"place = 3\n", "place is 3; it must be a table"},
      {"not a scene", "s.toml:1: not valid TOML"},
  });
}

TEST(SceneOptions, WithoutAModelTheRangeIsSeenFromItsViewpoint) {
  const Scene scene = SceneFromOptions({});
  EXPECT_EQ(scene.terrain.kind, TerrainSource::Kind::kProceduralMountains);
  EXPECT_FALSE(scene.terrain.is_default) << "at home";
  SceneOptions elsewhere;
  elsewhere.longitude = 11.0;
  EXPECT_TRUE(SceneFromOptions(elsewhere).terrain.is_default) << "other mountains stand there";
  ASSERT_TRUE(scene.terrain.centre.has_value());
  EXPECT_DOUBLE_EQ(scene.terrain.centre->latitude_rad(), 46.5 * kRadiansPerDegree);
  EXPECT_NE(scene.place.latitude_rad(), scene.terrain.centre->latitude_rad());
  EXPECT_TRUE(scene.camera.height.above_ground);
  SceneOptions turned;
  turned.heading = 90.0;
  turned.height_m = 4000.0;
  EXPECT_DOUBLE_EQ(SceneFromOptions(turned).camera.heading_rad, 0.5 * kPi);
  EXPECT_EQ(SceneFromOptions(turned).camera.height, (Height{4000.0, false}));
  EXPECT_EQ(SceneFromOptions(turned).place.latitude_rad(), scene.place.latitude_rad());
}

// Returns the distance [m] between the built-in view of a scene's range and the scene's place.
double ViewOffPlace_m(const Scene& scene) {
  Place eye = ProceduralMountainsViewAboveGround(*scene.terrain.centre).place;
  eye.height_m = 0.0;
  return glm::length((EcefFromGeodetic(kWgs84, eye) - EcefFromGeodetic(kWgs84, scene.place)).xyz);
}
Scene SceneTypedAt(double latitude, double longitude) {
  SceneOptions options;
  options.latitude = latitude;
  options.longitude = longitude;
  return SceneFromOptions(options);
}

TEST(SceneOptions, TheRangeIsMovedToTheGivenPlace) {
  const std::vector<std::pair<double, double>> places = {
      {46.5, 8.0},    {69.65, 18.96},  {42.3439, -3.6969}, {-33.9, 151.2}, {0.0, 179.999},
      {10.0, -180.0}, {89.449, 20.0},  {89.44, 20.0},      {89.9, 120.0},  {89.98, -60.0},
      {-89.1, 10.0},  {-89.149, 10.0}, {-89.95, 33.0},     {-89.97, 200.0}};
  for (const auto& [latitude, longitude] : places) {
    const Scene scene = SceneTypedAt(latitude, longitude);
    EXPECT_EQ(scene.place.latitude_rad(), CheckedPlace({latitude, longitude, 0.0}).latitude_rad());
    EXPECT_EQ(scene.place.longitude_rad(),
              CheckedPlace({latitude, longitude, 0.0}).longitude_rad());
    EXPECT_LT(ViewOffPlace_m(scene), 1e-6) << latitude << " " << longitude;
  }
  for (const double pole : {-90.0, 90.0, -89.99, 89.99}) {
    EXPECT_LT(ViewOffPlace_m(SceneTypedAt(pole, 30.0)), 4000.0) << "the place stays anyway";
  }
}

TEST(SceneOptions, EveryPlaceHasItsOwnConstantMountains) {
  const auto seed_at = [](double latitude, double longitude) {
    return SceneTypedAt(latitude, longitude).terrain.range_seed;
  };
  const std::uint32_t tromso = seed_at(69.65, 18.96);
  EXPECT_NE(tromso, 0U);
  EXPECT_NE(tromso, seed_at(35.36, 138.73));
  EXPECT_EQ(tromso, seed_at(69.65, 18.96 - 1e-12)) << "as a computation of the place may have it";
  EXPECT_EQ(tromso, seed_at(69.65 + 1e-12, 18.96));
  EXPECT_EQ(seed_at(69.65, 181.0), seed_at(69.65, -179.0)) << "one place";
  EXPECT_EQ(SceneFromOptions({}).terrain.range_seed, 0U);
  EXPECT_EQ(seed_at(46.58, 8.01), 0U) << "on the range at home";
}

TEST(SceneOptions, WithAModelTheEyeIsAtTheGivenPlace) {
  SceneOptions options;
  options.dem = {"N35E138.hgt"};
  options.latitude = 35.5;
  options.longitude = 138.76;
  options.atmosphere = "hazy";
  const Scene scene = SceneFromOptions(options);
  EXPECT_DOUBLE_EQ(scene.place.latitude_rad(), 35.5 * kRadiansPerDegree);
  EXPECT_EQ(scene.terrain.file, "N35E138.hgt");
  EXPECT_EQ(scene.medium.name, "hazy");
  EXPECT_EQ(scene.camera.height, (Height{2.0, true}));
}

TEST(SceneOptions, ANamedPlaceStandsInForLatitudeAndLongitude) {
  SceneOptions options;
  options.place = "LSZH";
  options.dem = {"a.hgt", "b.hgt"};
  const Place& zurich = PlaceNamed("LSZH").place;
  Scene scene = SceneFromOptions(options);
  EXPECT_NEAR(scene.place.latitude_rad(), zurich.latitude_rad(), 1e-12);
  EXPECT_NEAR(scene.place.longitude_rad(), zurich.longitude_rad(), 1e-12);
  EXPECT_EQ(scene.terrain.more_files, std::vector<std::filesystem::path>{"b.hgt"});
  options.latitude = 47.0;
  scene = SceneFromOptions(options);
  EXPECT_DOUBLE_EQ(scene.place.latitude_rad(), 47.0 * kRadiansPerDegree);
  EXPECT_NEAR(scene.place.longitude_rad(), zurich.longitude_rad(), 1e-12);
  options.place = "Atlantis";
  EXPECT_THROW(static_cast<void>(SceneFromOptions(options)), InputError);
}

TEST(SceneOptions, SizesAndExposuresAreReadCompletely) {
  EXPECT_EQ(ImageSizeFromText("1x16384").height, 16384);
  for (const char* bad :
       {"", "5", "5x", "x5", "0x5", "5x16385", "5x5x5", "5.5x5", " 5x5", "-5x5"}) {
    EXPECT_THROW((void)ImageSizeFromText(bad), InputError) << bad;
  }
  EXPECT_EQ(Ev100FromText("auto"), std::nullopt);
  EXPECT_EQ(Ev100FromText("-3.5"), -3.5);
  for (const char* bad : {"", "bright", "nan", "inf", "1e3", "12,5", "5 "}) {
    EXPECT_THROW((void)Ev100FromText(bad), InputError) << bad;
  }
}

TEST_F(SceneFile, FileNamesAreRelativeToTheScene) {
  WriteText(folder_ / "air.toml", "preset = \"mars\"\n");
  WriteText(folder_ / "scene.toml",
            kPlace + "[atmosphere]\nfile = \"air.toml\"\n[terrain]\nmesh = \"x.obj\"\n");
  const Scene scene = ReadScene(folder_ / "scene.toml");
  EXPECT_EQ(scene.medium.name, "mars");
  EXPECT_EQ(scene.terrain.kind, TerrainSource::Kind::kMesh);
  EXPECT_EQ(scene.terrain.file, folder_ / "x.obj");
  EXPECT_THROW((void)ReadScene(folder_ / "missing.toml"), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
