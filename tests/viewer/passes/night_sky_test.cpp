// SPDX-License-Identifier: MIT
// Stars and the light of the night sky.
#include "viewer/passes/star_painter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <map>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "lut/sky/sky_view.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/illumination/night_light.h"
#include "renderer/picture/star_pixels.h"
#include "tests/fixtures/bare_scene.h"
#include "viewer/gl/render_target.h"
#include "viewer/passes/night_sky_map.h"

namespace alpenglow::viewer {
namespace {

PaintedView ViewOf(const Scene& scene, int width, int height) {
  return {{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, scene.camera.roll_rad,
           scene.camera.fov_rad},
          {61058, 73800.0},
          width,
          height};
}

Scene SkyScene() { return BareScene(2000.0, 150.0, 20.0, 60.0); }

StarLight StarAt(double elevation_deg, double azimuth_deg, double lux) {
  Spectrum light(4);
  for (std::size_t band = 0; band < 4; ++band)
    light[band] = static_cast<float>(lux * static_cast<double>(1 + band));
  return {EnuFromAngles(elevation_deg * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree).xyz,
          light, lux};
}

std::vector<StarPoint> PointsOf(const PaintedView& view, const std::vector<StarLight>& lights,
                                double faintest_lux = 0.0) {
  const glm::dvec3 nadir(0.0, 0.0, -1.0);
  return StarPointsIn(view, {lights, glm::dmat3(1.0), faintest_lux, nadir, 0.005});
}

double ShareOfColumn(const StarPoint& star, int i) {
  return static_cast<double>(i < 4 ? star.across[i] : star.last.x);
}
double ShareOfRow(const StarPoint& star, int i) {
  return static_cast<double>(i < 4 ? star.up[i] : star.last.y);
}

TEST(StarPoints, HaveTheRenderersPixelsAndRadianceAtEverySize) {
  const Scene scene = SkyScene();
  const std::vector<StarLight> lights{StarAt(31.3, 128.7, 2e-6), StarAt(20.0, 150.0, 1e-6),
                                      StarAt(9.1, 172.4, 5e-7)};
  for (const auto& [width, height] : {std::pair{160, 90}, {640, 360}, {1280, 720}}) {
    const StarPixels reference(
        CameraRays(scene.camera, width, height), width, height, lights,
        [](double, double) {
          Spectrum all(4);
          for (std::size_t band = 0; band < 4; ++band) all[band] = 1.0F;
          return all;
        },
        [](double, double) { return false; });
    std::map<std::pair<int, int>, double> painted;
    for (const StarPoint& star : PointsOf(ViewOf(scene, width, height), lights))
      for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 5; ++column)
          painted[{static_cast<int>(star.corner.x) + column,
                   height - 1 - (static_cast<int>(star.corner.y) + row)}] +=
              ShareOfColumn(star, column) * ShareOfRow(star, row) *
              static_cast<double>(star.light.x);
    EXPECT_EQ(painted.size(), 75U);
    double brightest = 0.0;
    for (const auto& [place, light] : painted) brightest = std::max(brightest, light);
    for (const auto& [place, light] : painted) {
      const Spectrum* there = reference.At(place.first, place.second);
      ASSERT_NE(there, nullptr) << place.first << ' ' << place.second;
      EXPECT_NEAR(light, static_cast<double>((*there)[0]), 1e-4 * brightest)
          << "solid angle of a pixel by its middle or by its sides: its width squared, 5e-5";
    }
  }
}

TEST(StarPoints, OmitFaintAndHiddenStars) {
  const PaintedView view = ViewOf(SkyScene(), 320, 180);
  EXPECT_EQ(PointsOf(view, {StarAt(20.0, 150.0, 1e-8)}, 2e-8).size(), 0U);
  EXPECT_EQ(PointsOf(view, {StarAt(-20.0, 330.0, 1e-6)}).size(), 0U);
  const StarLight star = StarAt(20.0, 150.0, 1e-6);
  EXPECT_EQ(StarPointsIn(view, {StarList({star}), glm::dmat3(1.0), 0.0,
                                StarAt(20.1, 150.1, 1.0).direction, 0.0045})
                .size(),
            0U);
}

// Tiles at the corners are seen obliquely.
TEST(StarPoints, TilesTogetherHaveAllStarsOfTheView) {
  const PaintedView whole = ViewOf(SkyScene(), 320, 180);
  const ViewAxes axes = AxesOf(whole);
  std::vector<StarLight> stars;
  int seen = 0;
  for (int elevation_deg = -89; elevation_deg < 90; ++elevation_deg) {
    for (int azimuth_deg = 0; azimuth_deg < 360; ++azimuth_deg) {
      stars.push_back(StarAt(elevation_deg, azimuth_deg, 1e-6));
      const glm::dvec3& to = stars.back().direction;
      const auto is_between = [&](const glm::dvec3& axis) {
        return std::abs(glm::dot(to, axis)) < glm::dot(axis, axis) * glm::dot(to, axes.forward);
      };
      seen += is_between(axes.right) && is_between(axes.up) ? 1 : 0;
    }
  }
  const auto count = [&](const PaintedView& view) {
    const std::vector<StarPoint> points = PointsOf(view, stars);
    return std::count_if(points.begin(), points.end(), [&](const StarPoint& star) {
      const auto column = static_cast<int>(star.corner.z), row = static_cast<int>(star.corner.w);
      return column >= 0 && column < view.width && row >= 0 && row < view.height;
    });
  };
  EXPECT_GT(seen, 1000);
  EXPECT_EQ(count(whole), seen);
  std::ptrdiff_t in_tiles = 0;
  for (const PictureTile& tile : TilesOf(whole.width, whole.height, 100)) {
    PaintedView part = whole;
    part.width = tile.width;
    part.height = tile.height;
    part.part = ViewOfTile(tile, whole.width, whole.height);
    in_tiles += count(part);
  }
  EXPECT_EQ(in_tiles, seen);
}

TEST(StarPoints, SkyTurnsWestwardsOncePerSiderealDay) {
  const double latitude = 46.5 * kRadiansPerDegree;
  const glm::dvec3 pole(0.0, std::cos(latitude), std::sin(latitude));
  EXPECT_NEAR(glm::length(TurnOfSky(latitude, 7000.0) * pole - pole), 0.0, 1e-14);
  const glm::dvec3 south = EnuFromAngles(30.0 * kRadiansPerDegree, 180.0 * kRadiansPerDegree).xyz;
  EXPECT_LT((TurnOfSky(latitude, 600.0) * south).x, 0.0) << "west of the meridian later on";
  EXPECT_NEAR(glm::length(TurnOfSky(latitude, 86164.0905) * south - south), 0.0, 1e-12);
}

TEST(StarPoints, RotatedListAgreesWithTheNextList) {
  const Place place{46.5, 8.0, 2000.0};
  const BandColour colour({440.0, 490.0, 550.0, 630.0});
  const RefractedView view(MediumPreset("earth"), place.height_m);
  const auto before = StarLightsOver(place, {61058, 73800.0}, view, colour, 1.5);
  const auto now = StarLightsOver(place, {61058, 73830.0}, view, colour, 1.5);
  const glm::dmat3 turn = TurnOfSky(place.latitude_rad(), 30.0);
  ASSERT_EQ(before.size(), now.size());
  int seen = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i].direction.z < 0.05) continue;
    ++seen;
    EXPECT_LT(glm::length(turn * before[i].direction - now[i].direction), 1e-4)
        << "refraction changes by a tenth of how far a star rises, 7.5 minutes of arc, at 3 "
           "degrees";
  }
  EXPECT_GT(seen, 5);
}

TEST(StarPoints, LowStarsOfARotatedListAgreeWithTheNextList) {
  const BandColour colour({440.0, 490.0, 550.0, 630.0});
  for (const double height_m : {2.0, 10e3}) {
    const Place place = CheckedPlace({46.5, 8.0, height_m});
    const RefractedView view(MediumPreset("earth"), place.height_m);
    const auto before = StarLightsOver(place, {61058, 73800.0}, view, colour, 5.0);
    const auto now = StarLightsOver(place, {61058, 73830.0}, view, colour, 5.0);
    const StarList stars(before, &view), later(now);
    const glm::dmat3 turn = TurnOfSky(place.latitude_rad(), 30.0);
    int low = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double over_rad = std::asin(later.directions()[i].z) - view.horizon_rad();
      if (over_rad < 0.0 || over_rad > 10.0 * kRadiansPerDegree) continue;
      ++low;
      EXPECT_LT(glm::length(stars.Towards(i, turn) - later.directions()[i]),
                0.1 / 60.0 * kRadiansPerDegree)
          << "a tenth of a minute of arc, as RefractedView; " << height_m << " m";
    }
    EXPECT_GT(low, 20);
  }
}

// --- the night sky ---

TEST(NightSkyMap, SkyglowOfTownsEqualsTheRenderers) {
  const Place eye{46.5, 8.0, 500.0};
  const UtcTime now{61058, 73800.0};
  const Medium medium = MediumPreset("earth");
  const BandColour colour(medium.wavelengths_nm);
  const SingleScattering<float> air(OnOsculatingSphere(medium, eye.latitude_rad()));
  const NightSkyMap dark = NightSkyMapOver(eye, now, medium, colour);
  const NightSkyMap city = NightSkyMapOver(eye, now, medium, colour, {18.0, 400.0});
  const Spectrum towns = Skyglow(18.0, 400.0, air, colour);
  for (int band = 0; band < 4; ++band) {
    const auto at = static_cast<std::size_t>(band);
    EXPECT_FLOAT_EQ(city.scattered[band], dark.scattered[band] + towns[at]);
  }
  EXPECT_GT(city.level.y, 10.0F * dark.level.y);
}

TEST(NightSkyMap, InterpolatedSkyEqualsTheRenderers) {
  const Place eye{46.5, 8.0, 3000.0};
  const UtcTime now{61058, 73800.0};
  const Medium medium = MediumPreset("earth");
  const BandColour colour(medium.wavelengths_nm);
  const NightSkyMap floor = NightSkyMapOver(eye, now, medium, colour);
  const NightLight reference(
      NightSky(eye, now), SingleScattering<float>(OnOsculatingSphere(medium, eye.latitude_rad())),
      colour, {0.0, 0.0, 1.0}, eye.height_m);
  EXPECT_EQ(floor.scattered.x, reference.scattered()[0]);
  EXPECT_EQ(floor.level.x, reference.OnSurface(1.0)[0]);
  double sum = 0.0;
  int count = 0;
  for (int row = NightSkyMap::kRows / 2; row + 1 < NightSkyMap::kRows; row += 3) {
    for (int column = 0; column + 1 < NightSkyMap::kColumns; column += 5) {
      const auto texel = [&](int x, int y) {
        return static_cast<double>(
            floor.above[static_cast<std::size_t>((row + y) * NightSkyMap::kColumns + column + x)]
                .y);
      };
      const double between = 0.25 * (texel(0, 0) + texel(1, 0) + texel(0, 1) + texel(1, 1));
      const double elevation = kPi * ((row + 1.0) / NightSkyMap::kRows - 0.5);
      const double azimuth = 2.0 * kPi * (column + 1.0) / NightSkyMap::kColumns;
      const auto is =
          static_cast<double>(reference.Above(EnuFromAngles(elevation, azimuth).xyz)[1]);
      EXPECT_NEAR(between, is, 0.08 * is) << "the lane of dust has edges within a texel";
      sum += std::abs(between / is - 1.0);
      ++count;
    }
  }
  EXPECT_LT(sum / count, 0.005) << "texels of 1.4 degrees";
}

// --- the lights of the sky ---

double SunElevationAt(const Place& eye, const UtcTime& now) {
  return ApparentSunAt(eye, now).elevation_rad();
}

// Returns the instant of the evening at which the sun has sunk to an elevation.
UtcTime WhenTheSunIsAt(double elevation_rad, const Place& eye, const UtcTime& noon) {
  double before_s = 0.0, after_s = 43200.0;
  while (after_s - before_s > 1.0) {
    const double middle_s = 0.5 * (before_s + after_s);
    const bool is_higher = SunElevationAt(eye, AddSeconds(noon, middle_s)) > elevation_rad;
    (is_higher ? before_s : after_s) = middle_s;
  }
  return AddSeconds(noon, after_s);
}

// Returns the illuminance of a surface that faces a light, without the sky [lux].
double BeamIlluminance(const DistantLight& light, const AirOfSky& air, double altitude_m) {
  const double mu = light.direction.seen.z;
  return air.colour.Xyz(air.air->BeamLeft(altitude_m, mu) * light.irradiance)[1];
}

TEST(LightsOfSky, ShadowsOfTheSecondLightAreInvisibleEveryEvening) {
  const Place eye{46.5, 8.0, 2000.0};
  const AirOfSky air(std::make_shared<const SolvedAir>(
      OnOsculatingSphere(MediumPreset("earth"), eye.latitude_rad()), AirSolution::kDraft));
  double most = 0.0;
  int moonlit = 0;
  for (int day = 0; day < 30; ++day) {
    for (const double elevation_deg : {0.5, -1.0, -2.5, -3.49}) {
      const UtcTime now =
          WhenTheSunIsAt(elevation_deg * kRadiansPerDegree, eye, UtcTime{61058 + day, 41400.0});
      const LightsOfSky lights = FrameSkyAt(eye, now, air).lights;
      ASSERT_EQ(lights.front().body, LightSource::kSun) << day << ' ' << elevation_deg;
      if (lights.size() == 1) continue;
      ++moonlit;
      most = std::max(most, BeamIlluminance(lights.back(), air, eye.height_m) /
                                LevelIlluminance(lights.front(), air, eye.height_m));
    }
  }
  EXPECT_GT(moonlit, 10);
  EXPECT_LT(most, 0.004) << "the most in a year is 0.0033; seen from the equator it is 0.0032";
}

DistantLight LightAt(double elevation_rad) {
  return {LightSource::kSun, Unrefracted(EnuFromAngles(elevation_rad, 0.0).xyz),
          0.27 * kRadiansPerDegree, Spectrum(4)};
}

// Ground is lit if the upper limb is above its horizon, which the height lowers.
TEST(HasSetOnGround, IsTrueIfNoGroundInViewSeesTheLimb) {
  constexpr double kEarth_m = 6.37e6, kSummit_m = 8849.0;
  const auto dip = [](double height_m) { return std::acos(kEarth_m / (kEarth_m + height_m)); };
  int set = 0, risen = 0;
  for (double elevation_deg = -9.0; elevation_deg < 1.0; elevation_deg += 0.25) {
    for (const double reach_deg : {0.0, 0.5, 2.0, 5.0}) {
      const double elevation = elevation_deg * kRadiansPerDegree;
      const double reach = reach_deg * kRadiansPerDegree;
      const DistantLight light = LightAt(elevation);
      const double limb = elevation + reach + light.radius_rad;
      const bool is_lit_land = limb > -dip(kSummit_m), is_lit_planet = limb > 0.0;
      EXPECT_FALSE(HasSetOnGround(light, {reach, 0.0}) && is_lit_land) << elevation_deg;
      EXPECT_FALSE(HasSetOnGround(light, {0.0, reach}) && is_lit_planet) << elevation_deg;
      set += HasSetOnGround(light, {reach, reach}) ? 1 : 0;
      risen += is_lit_land || is_lit_planet ? 1 : 0;
    }
  }
  EXPECT_GT(set, 40) << "of 160 cases, so that the omission is worth something";
  EXPECT_GT(risen, 40);
}

TEST(LightsOfSky, TheSunLightsNoSummitWhenTheMoonIsFirst) {
  constexpr double kHighestSummit_m = 8849.0, kRadius_m = 6371e3;
  const double dip = std::acos(kRadius_m / (kRadius_m + kHighestSummit_m));
  const Place eye{46.5, 8.0, 2000.0};
  const AirOfSky air(std::make_shared<const SolvedAir>(MediumPreset("earth"), AirSolution::kDraft));
  // The moon is full on the 3rd of January 2026 and rises before the sun has set.
  const UtcTime now = WhenTheSunIsAt(-3.51 * kRadiansPerDegree, eye, UtcTime{61043, 41400.0});
  const LightsOfSky lights = FrameSkyAt(eye, now, air).lights;
  ASSERT_EQ(lights.size(), 2U);
  EXPECT_EQ(lights.front().body, LightSource::kMoon);
  const DistantLight& sun = lights.back();
  EXPECT_LT(std::asin(sun.direction.seen.z) + sun.radius_rad, -dip);
}

// Radiance by one light in the band nearest to 555 nm.
double GreenRadiance(const DistantLight& light, const SkyView& sky, const glm::dvec3& towards) {
  constexpr std::size_t kGreen = 2;
  const glm::dvec3& to = light.direction.seen;
  const double azimuth = std::atan2(towards.x, towards.y) - std::atan2(to.x, to.y);
  return double{light.irradiance[kGreen]} *
         double{sky.Radiance(std::acos(towards.z), azimuth)[kGreen]};
}

TEST(LightsOfSky, ShareOfTheKeyLightInTheSkyIsBounded) {
  const Place eye{46.5, 8.0, 2000.0};
  const AirOfSky air(std::make_shared<const SolvedAir>(
      OnOsculatingSphere(MediumPreset("earth"), eye.latitude_rad())));
  int moonlit = 0;
  double most = 0.0;
  for (const int day : {0, 1, 2, 28, 29}) {
    for (const double elevation_deg : {-4.0, -5.0, -6.5, -8.0}) {
      const UtcTime now =
          WhenTheSunIsAt(elevation_deg * kRadiansPerDegree, eye, UtcTime{61043 + day, 41400.0});
      const FrameSky sky = FrameSkyAt(eye, now, air);
      if (sky.lights.size() == 1) continue;
      ++moonlit;
      std::vector<SkyView> views;
      for (const DistantLight& light : sky.lights)
        views.emplace_back(air.air->single_scattering(), air.air->multiple_scattering(),
                           eye.height_m, light.direction.for_air.z);
      for (double up = 0.5; up < 90.0; up += up < 10.0 ? 1.0 : 5.0) {
        for (double azimuth = 0.0; azimuth < 360.0; azimuth += 5.0) {
          const glm::dvec3 towards =
              EnuFromAngles(up * kRadiansPerDegree, azimuth * kRadiansPerDegree).xyz;
          const double key = GreenRadiance(sky.lights[0], views[0], towards);
          const double share = key / (key + GreenRadiance(sky.lights[1], views[1], towards));
          most = std::max(most, share / sky.key_share);
          EXPECT_LE(share, MostShareOfKeyLight(sky)) << day << ' ' << elevation_deg << ' ' << up;
        }
      }
    }
  }
  EXPECT_GT(moonlit, 5);
  EXPECT_GT(most, 30.0) << "so that the factor of 60 is no waste";
}

}  // namespace
}  // namespace alpenglow::viewer
