// SPDX-License-Identifier: MIT
#include "viewer/passes/night_sky_map.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/illumination/night_light.h"
#include "viewer/passes/picture_programs.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {

namespace {

void Upload(const GlTexture& map, int unit, int columns, int rows,
            const std::vector<glm::vec4>& texels) {
  BindTexture(unit, GL_TEXTURE_2D, map);
  UploadTexture(GL_TEXTURE_2D, map,
                {GL_RGBA32F, columns, rows, 1, GL_RGBA, GL_FLOAT, texels.data()});
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
}

}  // namespace

NightSkyMap NightSkyMapOver(const Place& eye, const UtcTime& now, const Medium& medium,
                            const BandColour& colour, const SceneSkyglow& towns) {
  const SingleScattering<float> air(OnOsculatingSphere(medium, eye.latitude_rad()));
  std::optional<Spectrum> town_light;
  if (towns.zenith) town_light = Skyglow(*towns.zenith, towns.ground_m, air, colour);
  const NightLight night(NightSky(eye, now), air, colour, {0.0, 0.0, 1.0},
                         std::max(eye.height_m, 0.0), town_light);
  NightSkyMap map{{}, GpuBandsOf(night.scattered()), GpuBandsOf(night.OnSurface(1.0))};
  for (int row = 0; row < NightSkyMap::kRows; ++row) {
    const double elevation = kPi * ((row + 0.5) / NightSkyMap::kRows - 0.5);
    for (int column = 0; column < NightSkyMap::kColumns; ++column) {
      const double azimuth = 2.0 * kPi * (column + 0.5) / NightSkyMap::kColumns;
      map.above.push_back(GpuBandsOf(night.Above(EnuFromAngles(elevation, azimuth).xyz)));
    }
  }
  return map;
}

NightSkyMapFollower::NightSkyMapFollower(const SceneSkyglow& towns)
    : maker_(
          [towns](const Request& request) {
            const Medium& medium = request.air->medium();
            return NightSkyMapOver(request.place, request.now, medium,
                                   BandColour(medium.wavelengths_nm), towns);
          },
          Suits) {}

// Returns whether the requested map is close enough. The sky may rotate by an eighth of a degree, a
// tenth of a texel.
bool NightSkyMapFollower::Suits(const Request& requested, const Request& wanted) {
  constexpr double kMostTurn_s = 30.0, kMostWay_rad = 2e-3, kMostRise_m = 1000.0;
  return requested.air == wanted.air &&
         std::abs(SecondsBetween(requested.now, wanted.now)) < kMostTurn_s &&
         std::abs(requested.place.latitude_rad() - wanted.place.latitude_rad()) < kMostWay_rad &&
         std::abs(requested.place.longitude_rad() - wanted.place.longitude_rad()) < kMostWay_rad &&
         std::abs(requested.place.height_m - wanted.place.height_m) < kMostRise_m;
}

void NightSkyMapFollower::Poll(int unit) {
  const std::optional<NightSkyMap> made = maker_.Poll();
  if (!made) return;
  scattered_ = made->scattered;
  level_ = made->level;
  has_map_ = true;
  Upload(map_, unit, NightSkyMap::kColumns, NightSkyMap::kRows, made->above);
}

void NightSkyMapFollower::Follow(const PaintedView& view,
                                 const std::shared_ptr<const SolvedAir>& air, bool waits) {
  const Request wanted{view.eye.place, view.now, air};
  if (waits) {
    maker_.Forget();
    maker_.WaitUntilReady(wanted);
  }
  Poll(kNightUnit);
  maker_.RequestWhenIdle(wanted);
}

}  // namespace alpenglow::viewer
