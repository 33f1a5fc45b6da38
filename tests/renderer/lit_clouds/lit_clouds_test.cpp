// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/lit_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/solved_media.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Clouds over the bare planet in air of three bands, under a sun 40 degrees high.
struct CloudStage {
  explicit CloudStage(CloudField field)
      : clouds([&] {
          auto layers = std::make_shared<CloudLayers>();
          layers->push_back({std::move(field), false});
          auto solved = std::make_shared<SolvedClouds>();
          CloudLightOptions options;
          options.factor.rays = 0;
          solved->light.emplace_back(layers->front().field,
                                     CloudScatterers{CloudPhases(tests::LobeOf(0.8))},
                                     CloudSurroundings{.to_sun = sun.direction.seen}, options);
          solved->layers = layers;
          return solved;
        }()) {}

  const SolvedAir& air = tests::ThreeBandAir();
  Scene scene = [this] {
    Scene bare = QuickScene(2.0, 0.0, 0.0, 60.0);
    bare.medium = air.medium();
    return bare;
  }();
  SceneGround ground = LoadGround(scene);
  SceneGeometry geometry{ground, air.medium(), false};
  DistantLight sun = [this] {
    DistantLight light{LightSource::kSun,
                       Unrefracted(glm::normalize(glm::dvec3(0.766, 0.0, 0.643))), 0.00465,
                       Spectrum(air.bands())};
    std::ranges::fill(light.irradiance.values(), 1.0F);
    return light;
  }();
  std::shared_ptr<const SolvedClouds> clouds;

  [[nodiscard]] LitClouds Lit() const { return {clouds, geometry, air, sun}; }
};

const CloudStage& DeckStage() {
  static const CloudStage kStage(tests::PlaneLayer(8.0));
  return kStage;
}

TEST(LitClouds, RaysThatMissTheLayerAreClear) {
  const LitClouds lit = DeckStage().Lit();
  const glm::dvec3 above(0.0, 0.0, 3000.0), below(0.0, 0.0, 10.0);
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 0.1, 0.8));
  EXPECT_TRUE(lit.Along(above, up, kEndless).screens.empty());
  EXPECT_TRUE(lit.Along(below, up, 900.0).screens.empty()) << "the ray ends below the base";
  EXPECT_EQ(lit.Along(above, up, kEndless).transmittance(), 1.0F);
}

// The layer begins at 1000 m and is opaque; its light comes from the first hundreds of metres.
TEST(LitClouds, ScreenStandsInTheLayerAndIsLit) {
  const CloudStage& stage = DeckStage();
  const CloudsOnRay clouds = stage.Lit().Along({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, kEndless);
  ASSERT_EQ(clouds.screens.size(), 1U);
  EXPECT_GT(clouds.screens[0].distance_m, 1000.0);
  EXPECT_LT(clouds.screens[0].distance_m, 1400.0);
  EXPECT_NEAR(static_cast<double>(clouds.unscattered), std::exp(-8.0), 2e-4)
      << "8 optical depths, to the rounding of edges";
  EXPECT_GT(clouds.transmittance(), clouds.unscattered) << "with the forward peak";
  for (const float band : clouds.screens[0].radiance.values()) EXPECT_GT(band, 0.01F);
}

// A deck that covers the sky lights the ground as its own radiance does, seen from there: the
// irradiance is the integral of the radiance. Both come from the same moments; the mean of the fluxes
// and the gather differ by 6 % at most.
TEST(LitClouds, LightOnTheGroundIsThatOfTheDeckAbove) {
  const CloudStage& stage = DeckStage();
  const LitClouds lit = stage.Lit();
  const SkyThroughMedia sky = lit.SkyOnSurface(0.0, 1.0, SkyThroughMedia::Clear(stage.air.bands()));
  const Spectrum clear =
      stage.air.multiple_scattering().Irradiance(1400.0, stage.sun.direction.for_air.z, 1.0, 1.0);
  const GaussRule& rule = GaussLegendre(6);
  constexpr int kAzimuths = 12;
  SpectrumOf<double> integral(stage.air.bands());
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double sine = std::sqrt(1.0 - rule.node[i] * rule.node[i]);
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * kPi * (k + 0.5) / kAzimuths;
      const glm::dvec3 look(sine * std::cos(azimuth), sine * std::sin(azimuth), rule.node[i]);
      const CloudsOnRay clouds = lit.Along({0.0, 0.0, 0.0}, look, kEndless);
      const double weight = 2.0 * kPi / kAzimuths * rule.weight[i] * rule.node[i];
      for (std::size_t band = 0; band < integral.size(); ++band) {
        const double behind =
            static_cast<double>(clouds.transmittance()) * static_cast<double>(clear[band]) / kPi;
        integral[band] +=
            weight * (static_cast<double>(clouds.screens.front().radiance[band]) + behind);
      }
    }
  }
  for (std::size_t band = 0; band < integral.size(); ++band) {
    const double on_ground = static_cast<double>(sky.left[band] * clear[band] + sky.added[band]);
    EXPECT_NEAR(integral[band] / on_ground, 1.0, 0.06) << band;
  }
}

TEST(LitClouds, SurfacesAboveTheLayerKeepTheClearSky) {
  const CloudStage& stage = DeckStage();
  const SkyThroughMedia clear = SkyThroughMedia::Clear(stage.air.bands());
  const SkyThroughMedia sky = stage.Lit().SkyOnSurface(2000.0, 1.0, clear);
  for (std::size_t band = 0; band < stage.air.bands(); ++band) {
    EXPECT_EQ(sky.left[band], 1.0F);
    EXPECT_EQ(sky.added[band], 0.0F);
  }
}

// Light that increases evenly up to 10 km, behind a screen of a half at 4 km.
TEST(LitClouds, LightBehindAScreenIsDimmed) {
  CloudsOnRay clouds;
  clouds.screens.push_back({4000.0, 0.5F, Spectrum(1)});
  clouds.unscattered = 0.25F;
  Spectrum whole(1);
  whole[0] = 10.0F;
  const Spectrum left = clouds.Dimmed(whole, [](double distance_m) {
    Spectrum upto(1);
    upto[0] = static_cast<float>(1e-3 * distance_m);
    return upto;
  });
  EXPECT_FLOAT_EQ(left[0], 4.0F + 0.5F * 6.0F);
  EXPECT_EQ(clouds.TransmittanceTo(3999.0), 1.0F);
  EXPECT_EQ(clouds.TransmittanceTo(4001.0), 0.5F);
  EXPECT_EQ(clouds.DiskLeft(), 0.5F);
  EXPECT_EQ(clouds.WeightedDistance_m(), 2000.0F);
}

TEST(LitClouds, ScreensAtNearlyTheSameDistanceAreOne) {
  Spectrum half(1);
  half[0] = 0.5F;
  CloudsOnRay clouds;
  clouds.Add({10e3, 0.5F, half});
  clouds.Add({11e3, 0.6F, half});
  clouds.Add({16e3, 0.7F, half});
  ASSERT_EQ(clouds.screens.size(), 2U);
  EXPECT_NEAR(clouds.screens[0].distance_m, (0.5 * 10e3 + 0.2 * 11e3) / 0.7, 1e-3)
      << "weighted by the light that each takes away";
  EXPECT_FLOAT_EQ(clouds.screens[0].transmittance, 0.3F);
  EXPECT_FLOAT_EQ(clouds.screens[0].radiance[0], 0.5F + 0.5F * 0.5F);
  EXPECT_EQ(clouds.screens[1].distance_m, 16e3);
}

}  // namespace
}  // namespace alpenglow::renderer
