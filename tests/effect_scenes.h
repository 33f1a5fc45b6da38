// SPDX-License-Identifier: MIT
// Scenes that need different effects: what one can do without is the whole of another.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "atmosphere/constants.h"
#include "atmosphere/error.h"
#include "renderer/render.h"
#include "tests/bare_scene.h"

namespace alpenglow {

struct EffectScene {
  std::string name;
  Scene scene;
  UtcInstant instant;
};

/// Crests 700 m over valley floors, 4 to 7 km apart, around the place of BareScene: 40 km of
/// elevation model, 120 m between samples.
inline void WriteRidges(const std::string& file) {
  constexpr int kSide = 330;
  constexpr double kStep_deg = 0.0011;
  GDALRegister_GTiff();
  GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), kSide, kSide, 1, GDT_Float32, nullptr);
  std::array<double, 6> transform{8.0 - 0.5 * kSide * kStep_deg,  kStep_deg, 0.0,
                                  46.5 + 0.5 * kSide * kStep_deg, 0.0,       -kStep_deg};
  dataset->SetGeoTransform(transform.data());
  OGRSpatialReference degrees;
  degrees.importFromEPSG(4326);
  dataset->SetSpatialRef(&degrees);
  std::vector<float> heights;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double chain = std::abs(std::sin(0.055 * row + 0.5 * std::sin(0.06 * column)));
      const double spur = std::abs(std::sin(0.10 * column + 0.04 * row));
      heights.push_back(static_cast<float>(1900.0 - 550.0 * chain - 150.0 * spur));
    }
  }
  const CPLErr fault = dataset->GetRasterBand(1)->RasterIO(
      GF_Write, 0, 0, kSide, kSide, heights.data(), kSide, kSide, GDT_Float32, 0, 0, nullptr);
  GDALClose(dataset);
  if (fault != CE_None) throw OutputError(file + ": cannot be written");
}

inline Scene RidgeScene(const std::string& file, const Height& height, double heading, double pitch,
                        double fov) {
  Scene scene = BareScene(0.0, heading, pitch, fov);
  scene.camera.height = height;
  scene.terrain.kind = TerrainSource::Kind::kElevationModel;
  scene.terrain.file = file;
  return scene;
}

inline Scene WithAir(Scene scene, const char* preset) {
  scene.medium = MediumPreset(preset);
  return scene;
}

/// Walls of 120 m around a floor of 80 m by 500 m, as a mesh in `file`.
inline Scene ValleyScene(const std::string& file) {
  std::ofstream(file) << "v -40 -60 0\nv 40 -60 0\nv 40 440 0\nv -40 440 0\n"
                         "v -90 -60 120\nv 90 -60 120\nv 90 490 120\nv -90 490 120\n"
                         "f 1 2 3 4\nf 4 8 5 1\nf 2 6 7 3\nf 3 7 8 4\n";
  Scene scene = BareScene(0.0, 5.0, -2.0, 30.0);
  scene.camera.height = {2.0, true};
  scene.terrain.kind = TerrainSource::Kind::kMesh;
  scene.terrain.file = file;
  return scene;
}

/// Lamps ahead of the eye, 60 m apart in two rows.
inline Scene LampScene(double visibility_m) {
  Scene scene = BareScene(8.0, 90.0, -2.0, 50.0);
  for (int i = 0; i < 12; ++i) {
    Light lamp;
    lamp.latitude_rad = scene.place.latitude_rad + (i % 2 == 0 ? 1.0 : -1.0) * 15.0 / 6.37e6;
    lamp.longitude_rad = scene.place.longitude_rad + (80.0 + 60.0 * (i / 2)) / (6.37e6 * 0.69);
    lamp.height = {4.0, false};
    lamp.intensity_cd = 500.0;
    scene.lights.push_back(lamp);
  }
  scene.fog = Fog{};
  scene.fog->extinction_per_m = 3.0 / visibility_m;
  scene.fog->scale_height_m = 30.0;
  scene.fog->base_height_m = 0.0;
  return scene;
}

/// @param folder  where terrain may be written.
inline std::vector<EffectScene> EffectScenes(const std::string& folder) {
  const auto at = [](const char* utc) { return ParseInstant(utc); };
  const Height hill{300.0, true};
  const std::string ridges = folder + "/ridges.tif";
  WriteRidges(ridges);
  return {
      {"noon clear", WithAir(RidgeScene(ridges, hill, 180.0, -2.0, 60.0), "clear-mountain"),
       at("2026-06-21T11:30:00Z")},
      {"noon haze", WithAir(RidgeScene(ridges, hill, 180.0, -2.0, 60.0), "hazy"),
       at("2026-06-21T11:30:00Z")},
      {"sunset", RidgeScene(ridges, hill, 300.0, 0.0, 40.0), at("2026-06-21T18:45:00Z")},
      {"twilight", RidgeScene(ridges, hill, 310.0, 3.0, 60.0), at("2026-06-21T19:55:00Z")},
      {"from 10 km", RidgeScene(ridges, {10000.0, false}, 180.0, -8.0, 60.0),
       at("2026-06-21T09:00:00Z")},
      {"from space", BareScene(400000.0, 90.0, -20.0, 50.0), at("2026-06-21T09:00:00Z")},
      {"lamps in fog", LampScene(400.0), at("2026-01-15T23:00:00Z")},
      {"lamps at noon", LampScene(20000.0), at("2026-06-21T11:30:00Z")},
      {"valley", ValleyScene(folder + "/valley.obj"), at("2026-06-21T11:30:00Z")},
  };
}

}  // namespace alpenglow
