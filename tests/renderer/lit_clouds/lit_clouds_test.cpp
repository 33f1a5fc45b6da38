// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/lit_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/lit_clouds/air_layers.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/lamp_night.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/mesh_scene.h"
#include "tests/fixtures/solved_media.h"
#include "tests/fixtures/sphere_clouds.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

const glm::dvec3 kHighSun = glm::normalize(glm::dvec3(0.766, 0.0, 0.643));
const glm::dvec3 kVertical(0.0, 0.0, 1.0);
const double kLowestCloudSine = std::sin(kLowestCloudLight_deg * kRadiansPerDegree);

/// Clouds over the bare planet in air of three bands, under a sun 40 degrees high or another one.
struct CloudStage {
  explicit CloudStage(CloudField field, const glm::dvec3& to_sun = kHighSun, double ground_m = 0.0,
                      const CloudPhases& phases = CloudPhases(tests::LobeOf(0.8)))
      : CloudStage(std::vector{std::move(field)}, to_sun, ground_m, phases) {}
  explicit CloudStage(std::vector<CloudField> fields, const glm::dvec3& to_sun = kHighSun,
                      double ground_m = 0.0,
                      const CloudPhases& phases = CloudPhases(tests::LobeOf(0.8)))
      : sun(SunOf(air, to_sun)), clouds([&] {
          auto layers = std::make_shared<CloudLayers>();
          for (CloudField& field : fields) layers->push_back({std::move(field), false});
          auto solved = std::make_shared<SolvedClouds>();
          CloudLightOptions options;
          options.factor.rays = 0;
          for (const SceneCloudField& layer : *layers) {
            options.low_sun = LowSunOver(layer.field, geometry.radius_m());
            solved->light.emplace_back(
                layer.field, CloudScatterers{phases},
                CloudSurroundings{.to_sun = to_sun.z >= kLowestCloudSine ? to_sun : kVertical,
                                  .ground_altitude_m = ground_m},
                options);
          }
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
  DistantLight sun;
  std::shared_ptr<const SolvedClouds> clouds;

  [[nodiscard]] LitClouds Lit(CloudsInPicture view = {}) const {
    return {clouds, geometry, air, sun, std::move(view)};
  }
  static DistantLight SunOf(const SolvedAir& air, const glm::dvec3& to_sun) {
    DistantLight light{LightSource::kSun, Unrefracted(to_sun), 0.00465, Spectrum(air.bands())};
    std::ranges::fill(light.irradiance.values(), 1.0F);
    return light;
  }
  /// Returns a value of the bluest band over that of the reddest.
  [[nodiscard]] double Blueness(const Spectrum& light) const {
    const auto& nm = air.medium().wavelengths_nm;
    const auto [blue, red] = std::ranges::minmax_element(nm);
    return static_cast<double>(light[static_cast<std::size_t>(blue - nm.begin())]) /
           static_cast<double>(light[static_cast<std::size_t>(red - nm.begin())]);
  }
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

TEST(LitClouds, RingOfTheGloryIsRed) {
  const CloudStage stage(tests::PlaneLayer(2.0), kHighSun, 0.0, DropletPhases(550.0));
  const LitClouds grey = stage.Lit(), coloured = stage.Lit({.has_colours = true});
  const auto relative_blueness = [&](double from_centre_deg) {
    const double down_rad = std::asin(kHighSun.z) + from_centre_deg * kRadiansPerDegree;
    const glm::dvec3 look(-std::cos(down_rad), 0.0, -std::sin(down_rad));
    const auto radiance = [&](const LitClouds& lit) {
      return lit.Along({0.0, 0.0, 3000.0}, look, kEndless).screens.front().radiance;
    };
    return stage.Blueness(radiance(coloured)) / stage.Blueness(radiance(grey));
  };
  // The ring of droplets of 10 um and its white centre.
  EXPECT_LT(relative_blueness(2.5), 0.97);
  EXPECT_NEAR(relative_blueness(1.0), 1.0, 0.02);
}

// A deck that covers the sky lights the ground as its own radiance does, seen from there: the
// irradiance is the integral of the radiance. Both come from the same moments; the mean of the fluxes
// and the gather differ by 6 % at most.
TEST(LitClouds, LightOnTheGroundIsThatOfTheDeckAbove) {
  const CloudStage& stage = DeckStage();
  const LitClouds lit = stage.Lit();
  const SkyThroughMedia sky =
      lit.SkyOnSurface({0.0, 0.0, 0.0}, 1.0, SkyThroughMedia::Clear(stage.air.bands()));
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

glm::dvec3 SunOverClouds(double elevation_deg) { return tests::DirectionAt(elevation_deg, 20.0); }

/// The spheres 4 km higher.
class HighSpheres : public CloudShape {
 public:
  static constexpr double kHigher_m = 4000.0;
  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const override {
    return spheres_.SignedDepth_m(point - glm::dvec3(0.0, 0.0, kHigher_m));
  }
  [[nodiscard]] bool MayHoldCloud(const glm::dvec3&, const glm::dvec3&) const override {
    return true;
  }

 private:
  tests::SphereShape spheres_{true};
};

CloudField HighClouds() {
  const CloudLattice lattice{
      {64, 64, 24}, glm::dvec3(20.0), {0.0, 0.0, 1000.0 + HighSpheres::kHigher_m}, true};
  return {lattice, HighSpheres(), tests::EvenMatter(0.05, 20.0)};
}

/// Returns the mean skylight on level ground below a periodic field.
SkyThroughMedia MeanSkyOnGround(const CloudStage& stage) {
  constexpr int kPlaces = 256;
  const LitClouds lit = stage.Lit();
  const glm::dvec2 size(stage.clouds->layers->front().field.lattice().size_m());
  SkyThroughMedia mean{Spectrum(stage.air.bands()), Spectrum(stage.air.bands())};
  for (int i = 1; i <= kPlaces; ++i) {
    const glm::dvec3 place(size.x * Halton(i, 2), size.y * Halton(i, 3), 0.0);
    const SkyThroughMedia sky =
        lit.SkyOnSurface(place, 1.0, SkyThroughMedia::Clear(stage.air.bands()));
    mean.left = mean.left + 1.0F / kPlaces * sky.left;
    mean.added = mean.added + 1.0F / kPlaces * sky.added;
  }
  return mean;
}

/// Returns the mean light of the spheres, seen from below.
Spectrum GlowOfSpheres(const CloudStage& stage) {
  const LitClouds lit = stage.Lit();
  Spectrum sum(stage.air.bands());
  for (int i = 1; i <= 400; ++i) {
    const glm::dvec3 eye(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), 0.0);
    for (const CloudScreen& screen : lit.Along(eye, {0.0, 0.0, 1.0}, kEndless).screens)
      sum = sum + screen.radiance;
  }
  return sum;
}

// Over the ground the sun has set. Clouds at 5000 to 5480 m see it until -2.3 to -2.6 degrees.
TEST(LitClouds, CloudsGlowRedFromBelowAfterSunset) {
  const CloudStage glowing(HighClouds(), SunOverClouds(-1.5));
  const CloudStage dark(HighClouds(), SunOverClouds(-2.9));
  const Spectrum glow = GlowOfSpheres(glowing), shade = GlowOfSpheres(dark);
  EXPECT_GT(glow[2], 3.0F * shade[2]) << "the reddest band";
  const SkyThroughMedia on_ground = MeanSkyOnGround(glowing);
  EXPECT_GT(on_ground.added[2], 0.0F);
  EXPECT_LT(glowing.Blueness(on_ground.added), 0.1) << "light of clouds on the ground";
}

// Without a solution for the sun, means of its beams, which dim the twilight, are those of 4096
// vertical beams in place of all beams of a map: they differ by 0.01 at most.
TEST(LitClouds, NightHasTheSameLightWithoutASolutionForTheSun) {
  const CloudStage stage(HighClouds(), SunOverClouds(-9.0));
  const auto unlit = std::make_shared<SolvedClouds>(*stage.clouds);
  unlit->light.front() = stage.clouds->light.front().WithSun(std::nullopt);
  const LitClouds with = stage.Lit(), without(unlit, stage.geometry, stage.air, stage.sun);
  int screens = 0;
  for (int i = 1; i <= 200; ++i) {
    const glm::dvec3 eye(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), 10.0);
    const glm::dvec3 look = glm::normalize(glm::dvec3(0.3 * Halton(i, 5), 0.1, 1.0));
    const CloudsOnRay one = with.Along(eye, look, kEndless);
    const CloudsOnRay other = without.Along(eye, look, kEndless);
    ASSERT_EQ(one.screens.size(), other.screens.size());
    EXPECT_EQ(one.unscattered, other.unscattered);
    for (std::size_t k = 0; k < one.screens.size(); ++k, ++screens) {
      EXPECT_EQ(one.screens[k].transmittance, other.screens[k].transmittance);
      EXPECT_EQ(one.screens[k].ground, other.screens[k].ground);
      for (std::size_t band = 0; band < stage.air.bands(); ++band) {
        const float light = one.screens[k].radiance[band];
        EXPECT_GT(light, 0.0F) << "of the twilight";
        EXPECT_NEAR(other.screens[k].radiance[band], light, 0.01F * light);
      }
    }
  }
  EXPECT_GT(screens, 20);
  const SkyThroughMedia clear = SkyThroughMedia::Clear(stage.air.bands());
  const SkyThroughMedia one = with.SkyOnSurface({}, 1.0, clear);
  const SkyThroughMedia other = without.SkyOnSurface({}, 1.0, clear);
  for (std::size_t band = 0; band < stage.air.bands(); ++band) {
    EXPECT_NEAR(other.left[band], one.left[band], 0.01F);
    EXPECT_NEAR(other.added[band], one.added[band], 0.02F * one.added[band]);
  }
}

TEST(LitClouds, LightIsContinuousAtTheLowestSunOfAMap) {
  const CloudStage map(tests::SphereClouds(0.05), SunOverClouds(3.0001));
  const CloudStage beams(tests::SphereClouds(0.05), SunOverClouds(2.9999));
  const Spectrum by_map = GlowOfSpheres(map), by_beams = GlowOfSpheres(beams);
  for (std::size_t band = 0; band < by_map.size(); ++band)
    EXPECT_NEAR(by_map[band] / by_beams[band], 1.0F, 0.03F) << "cells of the map are 20 m wide";
}

// Fixed on 2026-11-30: the sun shone past a closed layer at 8 km as soon as it was below 3 degrees.
TEST(LitClouds, HighDecksHideASunBelowThreeDegrees) {
  const CloudField deck = tests::PlaneLayer(4.0, 7500.0);
  const CloudLowSun beams(deck, SunOverClouds(2.7), LowSunOver(deck, 6.371e6));
  EXPECT_GT(beams.OpticalDepth({0.0, 0.0, 0.0}), 20.0) << "the layer is crossed at a flat angle";
  EXPECT_EQ(LowSunOver(tests::PlaneLayer(4.0), 6.371e6).full_m, 60e3);
}

/// Mean light on level ground.
struct LightOnGround {
  Spectrum sky, all;
};
/// @param direct_left  transmittance of clouds for the sun.
LightOnGround LightUnder(const SolvedAir& air, const SkyThroughMedia& sky, double direct_left) {
  const double sine = kHighSun.z;
  const Spectrum diffuse =
      sky.left * air.multiple_scattering().Irradiance(0.0, sine, 1.0, 1.0) + sky.added;
  return {diffuse, diffuse + static_cast<float>(sine * direct_left) * air.BeamLeft(0.0, sine)};
}

// The sun's beam at the clouds gives the light its colour, and the ground is 100 m below them.
TEST(LitClouds, LightOnTheGroundDiffersByPlace) {
  const CloudStage stage(tests::SphereClouds(0.05), kHighSun, 900.0);
  const LitClouds lit = stage.Lit();
  const SkyThroughMedia clear = SkyThroughMedia::Clear(stage.air.bands());
  const Spectrum beam = stage.air.BeamLeft(1240.0, kHighSun.z);
  const double top_m = lit.shadow().highest_cloud_m();
  const Spectrum clear_sky =
      stage.air.multiple_scattering().Irradiance(top_m, kHighSun.z, 1.0, 1.0);
  const auto difference_at = [&](const glm::dvec3& place) {
    return stage.clouds->light.front().GroundDifferenceAt(place);
  };
  const glm::dvec3 first(30.0, 40.0, 900.0);
  const SkyThroughMedia at_first = lit.SkyOnSurface(first, 1.0, clear);
  double most = 0.0;
  for (int i = 1; i <= 40; ++i) {
    const glm::dvec3 place(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), 900.0);
    const SkyThroughMedia sky = lit.SkyOnSurface(place, 1.0, clear);
    const double sun = difference_at(place).sun - difference_at(first).sun;
    const double of_sky = (difference_at(place).sky - difference_at(first).sky) / kPi;
    most = std::max(most, std::abs(sun));
    for (std::size_t band = 0; band < stage.air.bands(); ++band) {
      EXPECT_EQ(sky.left[band], at_first.left[band]) << "light of the air has its mean";
      const double expected =
          sun * static_cast<double>(beam[band]) + of_sky * static_cast<double>(clear_sky[band]);
      EXPECT_NEAR(static_cast<double>(sky.added[band] - at_first.added[band]), expected, 0.002)
          << "the beam at the middle of the field; the flat frame moves places by 0.2 m";
    }
  }
  EXPECT_GT(most, 0.02) << "the test must be able to fail";
}

// Droplets scatter all colours alike: under a closing deck all light falls, and the light of the sky
// loses its blue. The air below the deck scatters this light.
TEST(LitClouds, LightFallsAndTurnsGreyWithCover) {
  const SolvedAir& air = tests::ThreeBandAir();
  const SkyThroughMedia clear = SkyThroughMedia::Clear(air.bands());
  LightOnGround last = LightUnder(air, clear, 1.0);
  Spectrum last_factor = clear.left;
  for (const double cover : {0.3, 0.6, 0.9}) {
    CloudOptions options = DefaultCloudOptions(CloudGenus::kStratocumulus);
    options.cover = cover;
    options.period_m = kPeriodStep_m;
    const CloudStage stage(MakeCloudField(options));
    const LitClouds lit = stage.Lit();
    const LightOnGround light = LightUnder(air, MeanSkyOnGround(stage),
                                           stage.clouds->light.front().sun().MeanTransmittance());
    EXPECT_LT(light.all[1], last.all[1]) << cover;
    EXPECT_LT(stage.Blueness(light.sky), stage.Blueness(last.sky)) << cover;
    const auto stretches = lit.DiffuseInAir({0.0, 0.0, 2.0}, {0.0, 0.0, 1.0});
    ASSERT_EQ(stretches.size(), 2U);
    EXPECT_LT(stage.Blueness(stretches[0].factor), stage.Blueness(last_factor)) << cover;
    last = light;
    last_factor = stretches[0].factor;
  }
}

TEST(LitClouds, AirHasTheLightOfItsSideOfTheLayer) {
  const LitClouds lit = DeckStage().Lit();
  const glm::dvec3 east(1.0, 0.0, 0.0);
  const auto below = lit.DiffuseInAir({0.0, 0.0, 100.0}, {0.0, 0.0, -1.0});
  const auto above = lit.DiffuseInAir({0.0, 0.0, 3000.0}, {0.0, 0.0, 1.0});
  ASSERT_EQ(below.size(), 1U);
  ASSERT_EQ(above.size(), 1U);
  EXPECT_GT(above[0].factor[0], 1.0F) << "the deck is brighter than the ground";
  const auto across = lit.DiffuseInAir({0.0, 0.0, 100.0}, east);
  ASSERT_EQ(across.size(), 2U) << "the planet bends away below the ray";
  EXPECT_NEAR(across[0].end_m, std::sqrt(2.0 * 6.36e6 * 1100.0), 200.0) << "up to 1200 m";
  EXPECT_GT(across[1].factor[0], 1.5F * across[0].factor[0]) << "below the deck and above";
  const auto up = lit.DiffuseInAir({0.0, 0.0, 100.0}, {0.0, 0.0, 1.0});
  ASSERT_EQ(up.size(), 2U);
  EXPECT_NEAR(up[1].factor[0] / above[0].factor[0], 1.0F, 0.05F) << "air from 1200 or 3000 m on";
}

// The deck sends up at most the irradiance of the sun and less than a tenth of it by the sky, and the
// ground at least nothing.
TEST(LitClouds, SurfacesAboveTheLayerSeeItsLightInTheAir) {
  const CloudStage& stage = DeckStage();
  const SkyThroughMedia clear = SkyThroughMedia::Clear(stage.air.bands());
  const SkyThroughMedia sky = stage.Lit().SkyOnSurface({0.0, 0.0, 2000.0}, 1.0, clear);
  const std::vector<double> reflection = ReflectionOfAirAbove(stage.air.medium(), 1400.0);
  for (std::size_t band = 0; band < stage.air.bands(); ++band) {
    EXPECT_EQ(sky.left[band], 1.0F);
    EXPECT_GT(static_cast<double>(sky.added[band]), 0.2 * kHighSun.z * reflection[band]);
    EXPECT_LT(static_cast<double>(sky.added[band]), (kHighSun.z + 0.1) * reflection[band]);
  }
}

/// Returns the radiance of the sky for clouds, relative to that of an even sky with the same irradiance
/// of a level surface. The light from below, a tenth of a cloud's, counts as that of clear air.
Spectrum SkyOnClouds(const CloudStage& stage) {
  const MultipleScattering& orders = stage.air.multiple_scattering();
  const CloudLight& light = stage.clouds->light.front();
  const auto to_radiance = static_cast<float>(1.0 / kPi);
  const LitClouds lit = stage.Lit();
  Spectrum from_sky(stage.air.bands()), even = from_sky;
  for (int i = 1; i <= 400; ++i) {
    const glm::dvec3 eye(1280.0 * Halton(i, 2), 1280.0 * Halton(i, 3), 2000.0),
        down(0.0, 0.0, -1.0);
    const CloudsOnRay clouds = lit.Along(eye, down, eye.z);
    if (clouds.screens.empty()) continue;
    const double altitude_m = eye.z - clouds.screens.front().distance_m;
    const CloudRayLight grey = light.Radiance({eye, down});
    const auto level = [&](double up) {
      return to_radiance * orders.Irradiance(altitude_m, kHighSun.z, up, 1.0);
    };
    const Spectrum beam = stage.air.BeamLeft(altitude_m, kHighSun.z);
    from_sky = from_sky + clouds.screens.front().radiance +
               -1.0F * (static_cast<float>(grey.sun) * beam +
                        static_cast<float>(grey.ground) * level(-1.0));
    even = even + static_cast<float>(grey.sky) * level(1.0);
  }
  for (std::size_t band = 0; band < even.size(); ++band) from_sky[band] /= even[band];
  return from_sky;
}

// The sky near the horizon is up to three times as bright as at the zenith. It lights the sides of
// single clouds, and a closed deck like any level surface. The sky is brightest in the first band.
TEST(LitClouds, SingleCloudsSeeTheBrightHorizon) {
  const CloudStage spheres(tests::SphereClouds(0.05));
  const Spectrum on_spheres = SkyOnClouds(spheres), on_deck = SkyOnClouds(DeckStage());
  EXPECT_GT(on_spheres[0], 1.1F);
  EXPECT_LT(on_spheres[0], 1.6F);
  EXPECT_NEAR(on_deck[0], 1.0F, 0.1F) << "less light from below than counted";
}

/// Returns sunlight past a crest of 5000 m from south to north, 4000 m to the east.
std::shared_ptr<const TerrainSunlight> PastACrest(const std::filesystem::path& folder,
                                                  const glm::dvec3& to_sun) {
  static const SceneGround kCrest = LoadGround(tests::MeshScene(
      QuickScene(2.0, 0.0, 0.0, 60.0), folder / "crest.obj",
      "v 1000 -30000 0\nv 4000 -30000 5000\nv 7000 -30000 0\nv 1000 30000 0\nv 4000 30000 5000\n"
      "v 7000 30000 0\nf 1 2 5 4\nf 2 3 6 5\n"));
  return std::make_shared<const TerrainSunlight>(kCrest, to_sun, 0.00465);
}

using CloudsBehindMountains = TemporaryFolder;

// The sun stands 40 degrees high in the east. Clouds 1000 to 1400 m up are in the shadow for x
// between -300 m and the crest, and in the sun for x below -900 m.
TEST_F(CloudsBehindMountains, HaveNoSunlightInTheShadow) {
  const CloudStage& stage = DeckStage();
  const LitClouds open = stage.Lit();
  const LitClouds behind(stage.clouds, stage.geometry, stage.air, stage.sun,
                         {.past_terrain = PastACrest(folder_, kHighSun)});
  const auto difference_at = [&](double x_m) {
    const glm::dvec3 eye(x_m, 0.0, 0.0);
    const CloudScreen with = open.Along(eye, kVertical, kEndless).screens.at(0);
    const CloudScreen without = behind.Along(eye, kVertical, kEndless).screens.at(0);
    EXPECT_EQ(with.transmittance, without.transmittance);
    EXPECT_EQ(with.ground, without.ground);
    return with.radiance + -1.0F * without.radiance;
  };
  for (const double x_m : {-8000.0, -2000.0, -1000.0}) {
    const Spectrum difference = difference_at(x_m);
    for (const float band : difference.values()) EXPECT_EQ(band, 0.0F) << x_m;
  }
  const CloudRayLight grey = stage.clouds->light.front().Radiance({{}, kVertical});
  const LocalLight sun = LocalLightAt(stage.geometry, {0.0, 0.0, 1400.0}, stage.sun);  // the top
  const Spectrum beam = stage.air.BeamLeft(sun.altitude_m, sun.mu_s_effective);
  for (const double x_m : {-200.0, 500.0}) {
    const Spectrum difference = difference_at(x_m);
    for (std::size_t band = 0; band < beam.size(); ++band) {
      const float sunlight = static_cast<float>(grey.sun) * beam[band];
      EXPECT_NEAR(difference[band], sunlight, 0.01F * sunlight) << x_m;
    }
  }
}

// Between sky and cloud, light seen in a mirror is that of a picture of the sky, but for the light of
// nearer air, which is only as bright as its transmittance tells.
TEST(LitClouds, SkyBehindCloudsIsTheirLightAndWhatTheyLeave) {
  const CloudStage& stage = DeckStage();
  const LitClouds lit = stage.Lit();
  const glm::dvec3 eye(0.0, 0.0, 10.0), up = glm::normalize(glm::dvec3(0.5, 0.2, 0.6));
  Spectrum clear(stage.air.bands());
  std::ranges::fill(clear.values(), 0.05F);
  const Spectrum seen = lit.OverSky(eye, up, clear);
  const CloudScreen screen = lit.Along(eye, up, kEndless).screens.at(0);
  for (std::size_t band = 0; band < seen.size(); ++band) {
    EXPECT_LT(seen[band], screen.radiance[band] + clear[band]);
    EXPECT_GT(seen[band], 0.8F * screen.radiance[band] + screen.transmittance * clear[band]);
  }
  const LitClouds mirrored(stage.clouds, stage.geometry, stage.air, stage.sun,
                           {.mirror = MirrorEye{eye, kVertical, 2.0, stage.geometry.radius_m()}});
  const Spectrum by_table = mirrored.OverSky(eye, up, clear);
  for (std::size_t band = 0; band < seen.size(); ++band) {
    EXPECT_NEAR(by_table[band], seen[band], 0.01F * seen[band]) << "the deck is alike everywhere";
  }
  const Spectrum above = lit.OverSky({0.0, 0.0, 3000.0}, up, clear);
  EXPECT_TRUE(std::ranges::equal(above.values(), clear.values())) << "no cloud in the way";
}

// A thousand candelas below the second of two screens; air takes a few hundredths of the light, and
// the glow of the air is little of it.
TEST(LitClouds, LampsLightCloudsByTheInverseSquare) {
  Scene scene = tests::NightScene();
  scene.lights = {tests::LightAt(600.0, 0.0, 0.0, 1000.0)};
  const tests::LampSite site(scene);
  const SceneGeometry geometry(site.ground, site.medium, false);
  Spectrum none(site.medium.wavelengths_nm.size()), half = none;
  std::ranges::fill(half.values(), 0.5F);
  CloudsOnRay clouds;
  clouds.screens = {{400.0, 0.5F, none, 0.0F}, {1000.0, 0.2F, none, 0.6F}};
  const glm::dvec3 eye = tests::kLampEye, direction(0.0, 0.6, 0.8);
  const Spectrum light =
      LampsOnClouds(clouds, site.light, geometry, eye, direction, [&](double) { return half; });
  const glm::dvec3 away = site.PositionOf(scene.lights[0]) - (eye + 1000.0 * direction);
  const double lux = 1000.0 * -away.z / std::pow(glm::length(away), 3);
  EXPECT_NEAR(site.Luminance(light), 0.5 * 0.5 * 0.6 / kPi * lux, 0.2 * 0.15 / kPi * lux);
  clouds.screens.back().ground = 0.0F;
  const Spectrum dark =
      LampsOnClouds(clouds, site.light, geometry, eye, direction, [&](double) { return half; });
  EXPECT_EQ(site.Luminance(dark), 0.0);
}

Spectrum EvenSpectrum(float value) {
  Spectrum even(3);
  std::ranges::fill(even.values(), value);
  return even;
}

// Half of the light of the night is that of towns; the screens leave 0.3 of what is behind.
TEST(LitClouds, TownsLightCloudsFromBelow) {
  const NightScattered night{EvenSpectrum(2.0F), EvenSpectrum(1.0F)};
  CloudsOnRay clouds;
  const auto seen = [&](float air, float whole) {
    return NightAlong(clouds, night, EvenSpectrum(whole),
                      [&](double) { return EvenSpectrum(air); })[0];
  };
  EXPECT_FLOAT_EQ(seen(0.8F, 0.75F), 0.25F * 2.0F) << "without clouds the air alone has light";
  clouds.screens = {{400.0, 0.5F, Spectrum(3), 0.25F}, {1000.0, 0.6F, Spectrum(3), 0.2F}};
  EXPECT_FLOAT_EQ(seen(1.0F, 0.3F), 0.7F * 2.0F) << "clouds that send J for what they hide";
  clouds.screens.front().ground = 0.4F;
  EXPECT_FLOAT_EQ(seen(1.0F, 0.3F), 0.7F * 2.0F + 2.0F * 0.15F) << "ground of the radiance 2";
  EXPECT_FLOAT_EQ(seen(0.0F, 0.0F), 2.0F) << "clouds behind dense air are not seen";
}

// Lamps of a town of 2 km, seen from 4 km above its edge.
TEST(LitClouds, FarLampsAreAsBrightAsAll) {
  Scene scene = tests::NightScene();
  for (int i = 1; i <= 400; ++i) {
    scene.lights.push_back(
        tests::LightAt(2000.0 * Halton(i, 2), 2000.0 * Halton(i, 3), 0.0, 1000.0));
  }
  const tests::LampSite site(scene);
  const glm::dvec3 point(0.0, 0.0, 4000.0), down(0.0, 0.0, -1.0);
  const LampNodes far = site.light.FarFrom(point);
  EXPECT_LT(far.size(), 40U);
  const double all =
      site.Luminance(site.light.OnSurface(site.light.All(), {point, point, down, down}));
  EXPECT_NEAR(site.Luminance(site.light.OnSurface(far, {point, point, down, down})), all,
              0.03 * all);
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

/// Returns a cube of 400 m of dense cloud, 1000 m high.
CloudField CubeAt(double east_m) {
  const CloudLattice lattice{{8, 8, 8}, glm::dvec3(50.0), {east_m, -200.0, 1000.0}, false};
  return {lattice, tests::FullShape(), tests::EvenMatter(0.05, 1.0)};
}

// Eddington's reflectance of a layer of the optical depth t for diffuse light is x / (1 + x) with
// x = 3/4 (1 - g) t. It is within a few hundredths of exact values for thick layers (Joseph, Wiscombe and
// Weinman 1976, J. Atmos. Sci. 33, 2452). Ground of albedo A sends A of it up again.
TEST(LitClouds, DecksSendLightOfTheGroundBack) {
  const CloudStage& stage = DeckStage();
  const LitClouds lit = stage.Lit();
  const double x = 0.75 * 0.2 * 8.0, reflectance = x / (1.0 + x);
  for (std::size_t band = 0; band < stage.air.bands(); ++band) {
    const double albedo = stage.air.medium().ground_albedo[band];
    EXPECT_NEAR(static_cast<double>(lit.SentBackAt(0.0)[band]),
                reflectance / (1.0 - albedo * reflectance), 0.05);
    EXPECT_EQ(lit.SentBackAt(3000.0)[band], 0.0F) << "above the deck";
  }
}

// Fixed on 2026-11-30: seen from the altitude of two layers, a cloud of the first one hid all clouds of the
// other up to 16 km away, also nearer ones. Light of a dense cloud comes from its first 100 m.
TEST(LitClouds, LayersAtTheSameAltitudesHideEachOtherByDistance) {
  for (const auto& [first_m, second_m] : {std::pair{10000.0, 2000.0}, {2000.0, 10000.0}}) {
    const CloudStage both(std::vector{CubeAt(first_m), CubeAt(second_m)});
    const CloudsOnRay clouds = both.Lit().Along({0.0, 0.0, 1200.0}, {1.0, 0.0, 0.0}, kEndless);
    EXPECT_GT(clouds.WeightedDistance_m(), 2000.0F) << first_m;
    EXPECT_LT(clouds.WeightedDistance_m(), 2100.0F) << first_m;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
