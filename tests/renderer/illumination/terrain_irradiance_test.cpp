// SPDX-License-Identifier: MIT
#include "renderer/illumination/terrain_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/sky/sky_view.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/material/reflectance.h"
#include "renderer/terrain/terrain.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/rough_land.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/solved_media.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

using tests::ThreeBandAir;

glm::dvec3 SunAtElevation(double degrees) {
  return EnuFromAngles(degrees * kRadiansPerDegree, 200.0 * kRadiansPerDegree).xyz;
}

const glm::dvec3 kUp(0.0, 0.0, 1.0);

Horizons OpenTo(float sine) {
  Horizons horizons;
  horizons.fill(sine);
  return horizons;
}

glm::dvec3 Leaning(double degrees, double azimuth_degrees) {
  const double lean = degrees * kRadiansPerDegree, azimuth = azimuth_degrees * kRadiansPerDegree;
  return {std::sin(lean) * std::cos(azimuth), std::sin(lean) * std::sin(azimuth), std::cos(lean)};
}

OccludedSkyIrradiance OccludedSkyOf(const glm::dvec3& to_sun) {
  return {ThreeBandAir().single_scattering(),
          ThreeBandAir().multiple_scattering(),
          to_sun,
          {0.0, 3000.0, 5e4}};
}

/// Returns the sky's irradiance by midpoints in azimuth and in the sine of the elevation.
double IrradianceByQuadrature(const glm::dvec3& to_sun, double altitude_m, const glm::dvec3& normal,
                              double from_sine) {
  constexpr int kSines = 200, kAzimuths = 144;
  const SkyView view(ThreeBandAir().single_scattering(), ThreeBandAir().multiple_scattering(),
                     altitude_m, to_sun.z);
  const double sun = std::atan2(to_sun.y, to_sun.x);
  double sum = 0.0;
  for (int i = 0; i < kSines; ++i) {
    const double share = (i + 0.5) / kSines;
    const double sine = from_sine + (1.0 - from_sine) * share * share;  // dense low down
    const double width = (1.0 - from_sine) * 2.0 * share / kSines;
    const double cosine = std::sqrt(1.0 - sine * sine);
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * kPi * (k + 0.5) / kAzimuths;
      const glm::dvec3 d(cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine);
      const double facing = glm::dot(normal, d);
      if (facing > 0.0)
        sum +=
            static_cast<double>(view.Radiance(std::acos(sine), azimuth - sun)[1]) * facing * width;
    }
  }
  return sum * 2.0 * kPi / kAzimuths;
}

TEST(OccludedSkyIrradiance, OnAPlainEqualsTheIrradianceFromAbove) {
  for (const double elevation : {60.0, 20.0, 3.0, -4.0}) {
    const glm::dvec3 to_sun = SunAtElevation(elevation);
    const OccludedSkyIrradiance sky = OccludedSkyOf(to_sun);
    for (const double lean : {0.0, 60.0}) {
      EXPECT_EQ(sky.Irradiance(500.0, to_sun.z, SectorsOf(Leaning(lean, 45.0)), OpenTo(1.0F))[0],
                0.0F)
          << "behind a closed horizon";
    }
    const auto open = sky.Irradiance(0.0, to_sun.z, SectorsOf(kUp), OpenTo(0.0F));
    const auto known = ThreeBandAir().multiple_scattering().SkyIrradiance(0.0, to_sun.z);
    for (std::size_t band = 0; band < open.size(); ++band) {
      EXPECT_NEAR(open[band] / known[band], 1.0F, 0.02F)
          << "sun at " << elevation << "; the two integrate in different nodes";
    }
  }
}

TEST(OccludedSkyIrradiance, OnSlopesIsTheIntegralOverTheVisibleSky) {
  for (const double elevation : {40.0, 5.0}) {
    const glm::dvec3 to_sun = SunAtElevation(elevation);
    const OccludedSkyIrradiance sky = OccludedSkyOf(to_sun);
    for (const double lean : {0.0, 30.0, 70.0}) {
      for (const double azimuth : {10.0, 130.0, 260.0}) {
        for (const double horizon : {0.0, 0.3}) {
          const glm::dvec3 normal = Leaning(lean, azimuth);
          const double expected = IrradianceByQuadrature(to_sun, 1500.0, normal, horizon);
          const auto open = sky.Irradiance(1500.0, to_sun.z, SectorsOf(normal),
                                           OpenTo(static_cast<float>(horizon)));
          EXPECT_NEAR(static_cast<double>(open[1]) / expected, 1.0, 0.02)
              << "sun " << elevation << ", leaning " << lean << " to " << azimuth << ", horizon "
              << horizon << ": sectors of 22.5 degrees";
        }
      }
    }
  }
}

TEST(OccludedSkyIrradiance, RadianceIsThatOfTheSky) {
  const glm::dvec3 to_sun = SunAtElevation(40.0);
  const OccludedSkyIrradiance sky = OccludedSkyOf(to_sun);
  const SkyView view(ThreeBandAir().single_scattering(), ThreeBandAir().multiple_scattering(), 0.0,
                     to_sun.z);
  for (const double sine : {0.05, 0.2, 0.5, 0.9}) {
    for (const double azimuth : {0.3, 1.4, 2.9}) {  // away from the aureole
      const double cosine = std::sqrt(1.0 - sine * sine);
      const glm::dvec3 d(cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine);
      const double known = static_cast<double>(
          view.Radiance(std::acos(sine), azimuth - std::atan2(to_sun.y, to_sun.x))[1]);
      EXPECT_NEAR(static_cast<double>(sky.Radiance(0.0, to_sun.z, d)[1]) / known, 1.0, 0.05)
          << "linear over sectors of 22.5 degrees";
    }
  }
}

TEST(SectorIntegral, IsTheIntegralOverAPartOfASector) {
  for (const double low : {-0.9, -0.2, 0.0, 0.4}) {
    for (const double high : {0.5, 0.97, 1.0}) {
      double up = 0.0, along = 0.0;
      for (int i = 0; i < 20000; ++i) {
        const double s = low + (high - low) * (i + 0.5) / 20000;
        up += s * (high - low) / 20000;
        along += std::sqrt(1.0 - s * s) * (high - low) / 20000;
      }
      EXPECT_NEAR(static_cast<double>(SectorIntegral(0.6F, 0.8F, static_cast<float>(low),
                                                     static_cast<float>(high))),
                  0.6 * up + 0.8 * along, 1e-4);
    }
  }
}

/// Mountains with grey ground, lit by sun and sky, and their light by rays, which are slow.
class Mountains {
 public:
  Mountains(double sun_degrees, float albedo, int side = 129)
      : to_sun_(SunAtElevation(sun_degrees)),
        albedo_(albedo),
        terrain_(LandMesh(RoughLand, side, 60.0 * 128 / (side - 1))),
        horizons_(
            std::make_shared<const TerrainHorizons>(terrain_.mesh(), ThreeBandAir().medium())),
        light_(horizons_, ThreeBandAir().single_scattering(), ThreeBandAir().multiple_scattering(),
               to_sun_),
        view_(ThreeBandAir().single_scattering(), ThreeBandAir().multiple_scattering(), 1500.0,
              to_sun_.z),
        aerial_(ThreeBandAir().single_scattering(), ThreeBandAir().multiple_scattering()) {
    light_.AddSlopes(
        ThreeBandAir().medium(),
        [this](const SlopePlace& place) {
          const glm::dvec3 point = place.point + 2.0 * place.normal;
          return Sent(Direct(point, place.normal, place.normal) +
                      light_.Irradiance(At(point, place.normal)));
        },
        to_sun_.z);
  }

  [[nodiscard]] static SlopePoint At(const glm::dvec3& point, const glm::dvec3& normal,
                                     double mu_s) {
    return {point, normal, kUp, point.z, mu_s};
  }
  [[nodiscard]] SlopePoint At(const glm::dvec3& point, const glm::dvec3& normal) const {
    return At(point, normal, to_sun_.z);
  }
  [[nodiscard]] const TerrainIrradiance& light() const { return light_; }
  [[nodiscard]] const glm::dvec3& to_sun() const { return to_sun_; }

  [[nodiscard]] TerrainHit Ground(double x, double y) const {
    return *terrain_.Intersect({x, y, 9000.0}, {0.0, 0.0, -1.0});
  }

  /// Irradiance by the sky, and by the visible ground, which sky and sun light.
  struct ByRays {
    double sky = 0.0, slopes = 0.0;
  };
  [[nodiscard]] ByRays IrradianceByRays(const TerrainHit& at, int rays, bool slopes) const {
    const glm::dvec3 side = glm::normalize(glm::cross(at.normal, glm::dvec3(0.3, 0.5, 0.7)));
    const glm::dvec3 other = glm::cross(at.normal, side);
    ByRays sum;
    for (int i = 0; i < rays; ++i) {
      const double u = (i + 0.5) / rays, angle = 2.0 * kPi * Halton(i + 1, 2);
      const glm::dvec3 d = std::sqrt(u) * (std::cos(angle) * side + std::sin(angle) * other) +
                           std::sqrt(1.0 - u) * at.normal;
      if (glm::dot(d, at.geometric_normal) <= 0.0) continue;
      const glm::dvec3 from = at.smooth_point + 0.2 * at.geometric_normal;
      const auto hit = terrain_.Intersect(from, d);
      if (!hit) {
        const double azimuth = std::atan2(d.y, d.x) - std::atan2(to_sun_.y, to_sun_.x);
        const auto sky = view_.Radiance(std::acos(std::clamp(d.z, -1.0, 1.0)), azimuth);
        sum.sky += kPi / rays * static_cast<double>(sky[1]);
      } else if (slopes) {
        Spectrum irradiance = Direct(hit->smooth_point, hit->normal, hit->geometric_normal);
        irradiance[1] += static_cast<float>(IrradianceByRays(*hit, 16, false).sky);
        ViewRay ray{from.z, d.z, to_sun_.z, glm::dot(d, to_sun_)};
        ray.length_m = hit->distance_m;
        const AirAlongRay air = aerial_.Along(ray, AerialPerspective::Nodes{});
        sum.slopes +=
            kPi / rays *
            static_cast<double>(air.inscatter[1] + air.transmittance[1] * Sent(irradiance)[1]);
      }
    }
    return sum;
  }

 private:
  [[nodiscard]] Spectrum Direct(const glm::dvec3& point, const glm::dvec3& normal,
                                const glm::dvec3& geometric) const {
    const double cosine = glm::dot(normal, to_sun_);
    if (cosine <= 0.0 ||
        terrain_.Occluded(point, geometric, to_sun_, std::numeric_limits<double>::infinity()))
      return Spectrum(ThreeBandAir().single_scattering().bands());
    return static_cast<float>(cosine) *
           ThreeBandAir().single_scattering().TransmittanceToSpace(point.z, to_sun_.z);
  }
  [[nodiscard]] Spectrum Sent(const Spectrum& irradiance) const {
    return static_cast<float>(static_cast<double>(albedo_) / kPi) * irradiance;
  }

  glm::dvec3 to_sun_;
  float albedo_;
  Terrain terrain_;
  std::shared_ptr<const TerrainHorizons> horizons_;
  TerrainIrradiance light_;
  SkyView view_;
  AerialPerspective aerial_;
};

const Mountains& DarkMountains() {
  static const Mountains mountains(30.0, 0.15F);
  return mountains;
}

TEST(TerrainIrradiance, EqualsASumOverRaysToSkyAndSlopes) {
  // The bounds are the error that TerrainIrradiance states. Without horizons it would be larger.
  const Mountains snowy(30.0, 0.8F);
  for (const auto& [of, bound] : {std::pair{&DarkMountains(), 0.04}, {&snowy, 0.09}}) {
    const Mountains& mountains = *of;
    double sum2 = 0.0, sum = 0.0, plain2 = 0.0;
    constexpr int kPlaces = tests::ScaledDown(24, 6);
    for (int i = 1; i <= kPlaces; ++i) {
      const TerrainHit hit =
          mountains.Ground(5000.0 * (Halton(i, 2) - 0.5), 5000.0 * (Halton(i, 3) - 0.5));
      const Mountains::ByRays rays = mountains.IrradianceByRays(hit, 192, true);
      const SlopePoint at = mountains.At(hit.smooth_point, hit.normal);
      const double error =
          static_cast<double>(mountains.light().Irradiance(at)[1]) / (rays.sky + rays.slopes) - 1.0;
      const glm::dvec3 flat(hit.normal.x, hit.normal.y, 0.0);
      const double azimuth =
          glm::dot(glm::normalize(flat),
                   glm::normalize(glm::dvec3(mountains.to_sun().x, mountains.to_sun().y, 0.0)));
      const double plain =
          static_cast<double>(ThreeBandAir().multiple_scattering().Irradiance(
              hit.smooth_point.z, mountains.to_sun().z, hit.normal.z, azimuth)[1]) /
              (rays.sky + rays.slopes) -
          1.0;
      sum += error / kPlaces;
      sum2 += error * error / kPlaces;
      plain2 += plain * plain / kPlaces;
    }
    EXPECT_LT(std::sqrt(sum2), bound) << (of == &snowy ? "snowy" : "dark");
    EXPECT_LT(std::abs(sum), 0.5 * bound) << (of == &snowy ? "snowy" : "dark");
    EXPECT_GT(std::sqrt(plain2), 3.0 * std::sqrt(sum2)) << "what horizons are for";
  }
}

// In such air the depth divided by the extinction is 0/0.
TEST(TerrainIrradiance, SlopesLightEachOtherWithoutAir) {
  const Medium medium = tests::WithoutAir(ThreeBandAir().medium());
  const SingleScattering<float> air(medium);
  const MultipleScattering multiple_scattering(medium,
                                               {.altitudes = 4, .sun_angles = 8, .degree = 2});
  const Terrain terrain(LandMesh(RoughLand, 17, 480.0));
  const auto horizons = std::make_shared<const TerrainHorizons>(terrain.mesh(), medium);
  const glm::dvec3 to_sun = SunAtElevation(30.0);
  TerrainIrradiance light(horizons, air, multiple_scattering, to_sun);
  const auto one = [&](const SlopePlace&) {
    Spectrum sent(air.bands());
    std::ranges::fill(sent.values(), 1.0F);
    return sent;
  };
  light.AddSlopes(medium, one, to_sun.z);
  float most = 0.0F;
  for (int i = 0; i < 16; ++i) {
    const auto hit =
        terrain.Intersect({450.0 * (i - 8), 170.0 * (i - 8), 9000.0}, {0.0, 0.0, -1.0});
    if (!hit) continue;
    const Spectrum irradiance =
        light.Irradiance({hit->smooth_point, hit->normal, kUp, hit->smooth_point.z, to_sun.z});
    for (std::size_t band = 0; band < irradiance.size(); ++band) {
      ASSERT_TRUE(std::isfinite(irradiance[band])) << i;
      most = std::max(most, irradiance[band]);
    }
  }
  EXPECT_GT(most, 0.0F) << "slopes must have been in view";
}

TEST(TerrainIrradiance, IsTheSameForAnyNumberOfThreads) {
  static_cast<void>(tests::EqualForAnyNumberOfThreads([] {
    const Mountains mountains(20.0, 0.5F, 33);
    const TerrainHit hit = mountains.Ground(321.0, -543.0);
    return mountains.light().Irradiance(mountains.At(hit.smooth_point, hit.normal))[1];
  }));
}

TEST(TerrainIrradiance, ShowsSkyAboveTheHorizonAndGroundBelow) {
  const Mountains& mountains = DarkMountains();
  const TerrainHit hit = mountains.Ground(200.0, 100.0);
  const SlopePoint at = mountains.At(hit.smooth_point, hit.normal);
  const glm::dvec3 steep = glm::normalize(glm::dvec3(0.0, 0.3, 1.0));
  const float sky = mountains.light().Radiance(at, steep)[2];
  EXPECT_FLOAT_EQ(sky, mountains.light().sky().Radiance(at.altitude_m, at.mu_s, steep)[2]);
  const glm::dvec3 below = glm::normalize(glm::dvec3(0.0, 1.0, -0.08));
  EXPECT_GT(mountains.light().Radiance(at, below)[2], 0.0F);
}

// Returns the height of a sea of 32 km with a coast 300 m high, 10 km away in the east-north-east,
// that ends half-way between two azimuths of the horizons.
double SeaBeforeACoast(double x_m, double y_m) {
  const bool is_coast = x_m > 10e3 && y_m > 0.2 * x_m && y_m < 0.9 * x_m;
  return is_coast ? 300.0 : 0.0;
}

TEST(TerrainIrradiance, ASeaMirrorsAFarCoastWithoutEdges) {
  constexpr double kEye_m = 60.0;
  const Terrain terrain(LandMesh(SeaBeforeACoast, 129, 250.0));
  const auto horizons =
      std::make_shared<const TerrainHorizons>(terrain.mesh(), ThreeBandAir().medium());
  const glm::dvec3 to_sun = SunAtElevation(30.0);
  TerrainIrradiance light(horizons, ThreeBandAir().single_scattering(),
                          ThreeBandAir().multiple_scattering(), to_sun);
  light.AddSlopes(
      ThreeBandAir().medium(),
      [](const SlopePlace&) {
        Spectrum dark(ThreeBandAir().single_scattering().bands());
        std::ranges::fill(dark.values(), 0.002F);
        return dark;
      },
      to_sun.z);
  const Water water(5.0, ThreeBandAir().medium().wavelengths_nm);
  // Returns the light that the water mirrors, relative to that of a free sky.
  const auto share_of_sky = [&](double azimuth_deg, double distance_m) {
    const double azimuth = azimuth_deg * kRadiansPerDegree;
    const glm::dvec3 point(distance_m * std::cos(azimuth), distance_m * std::sin(azimuth), 0.0);
    const glm::dvec3 to_eye = glm::normalize(glm::dvec3(0.0, 0.0, kEye_m) - point);
    const SlopePoint at = Mountains::At(point, kUp, to_sun.z);
    double shown = 0.0, sky = 0.0;
    const MirroredRays mirrored = water.Mirrored(kUp, to_eye);
    for (const MirroredRay& ray : mirrored.All()) {
      shown += ray.weight * static_cast<double>(light.Radiance(at, ray.direction, ray.spread)[1]);
      sky += ray.weight * static_cast<double>(light.SkyRadiance(at, ray.direction)[1]);
    }
    return shown / sky;
  };
  constexpr double kEdge = 0.02;  // what an eye sees in an even surface
  for (double distance = 200.0; distance < 2000.0; distance *= tests::ScaledDown(1.03, 1.3)) {
    for (double azimuth = -10.0; azimuth < 60.0; azimuth += 0.5) {
      const double here = share_of_sky(azimuth, distance);
      EXPECT_NEAR(share_of_sky(azimuth + 0.5, distance), here, kEdge)
          << "azimuth " << azimuth << ", " << distance << " m away";
      EXPECT_NEAR(share_of_sky(azimuth, 1.01 * distance), here, kEdge)
          << "azimuth " << azimuth << ", " << distance << " m away";
    }
  }
  EXPECT_LT(share_of_sky(22.5, 600.0), 0.9) << "the coast is dark";
  EXPECT_NEAR(share_of_sky(-45.0, 600.0), 1.0, 0.01) << "and there is none";
}

}  // namespace
}  // namespace alpenglow::renderer
