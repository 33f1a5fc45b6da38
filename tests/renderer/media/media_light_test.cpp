// SPDX-License-Identifier: MIT
#include "renderer/media/media_light.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/airlight.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/illumination/sky_moments.h"
#include "renderer/layers/layer_field.h"
#include "renderer/media/layer_light.h"
#include "renderer/media/local_volume.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/lamp_site.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/noise_grid.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/solved_media.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSunElevation = 0.5;  // about 29 degrees
const glm::dvec3 kToSun(0.6 * std::cos(kSunElevation), 0.8 * std::cos(kSunElevation),
                        std::sin(kSunElevation));

/// Air and ground around an eye over the bare ellipsoid, in three bands.
struct MediaStage {
  explicit MediaStage(SolvedAir of) : air(std::move(of)) {}

  SolvedAir air;
  const Medium& medium = air.medium();
  Scene scene = [this] {
    Scene bare = QuickScene(50.0, 0.0, 0.0, 60.0);
    bare.medium = medium;
    return bare;
  }();
  SceneGround ground = LoadGround(scene);
  BandColour colour{medium.wavelengths_nm};
  SceneGeometry geometry{ground, medium, false};
  Lighting light = [this] {
    SunInSky sun;
    sun.distance_au = 1.0;
    Lighting at = LightingOf(sun, UtcTime{60000, 0.0}, PlaceFromRadians(0.8, 0.0, 0.0), medium);
    at.source.direction = Unrefracted(kToSun);
    at.source.radius_rad = 0.00465;
    return at;
  }();

  [[nodiscard]] MediaLight Lit(const MediaList& media, const LampLight* lamps = nullptr) const {
    return {LocalMedia(media, 3), geometry, air, light, lamps};
  }
  /// Returns the sun's light, before scattering, at a point as an eye 50 m up sees it through 300 m
  /// of air.
  [[nodiscard]] Spectrum SunSeen(const glm::dvec3& point, double mu) const {
    const LocalLight sun = LocalLightAt(geometry, point, light.source);
    ViewRay to;
    to.altitude_m = 50.0;
    to.mu = mu;
    to.length_m = 300.0;
    return air.single_scattering().TransmittanceAlong(to) * light.source.irradiance *
           air.BeamLeft(sun.altitude_m, sun.mu_s_effective);
  }
};

const MediaStage& TheStage() {
  static const MediaStage kStage(tests::ThreeBandAir());
  return kStage;
}

MediumOptics Optics(double extinction, double albedo, double emission = 0.0) {
  MediumOptics optics{SpectrumOf<double>(3), SpectrumOf<double>(3), SpectrumOf<double>(3),
                      tests::LobeOf(0.4)};
  for (std::size_t band = 0; band < 3; ++band) {
    optics.extinction_per_m[band] = extinction * (1.0 + 0.2 * static_cast<double>(band));
    optics.scattering_per_m[band] = albedo * optics.extinction_per_m[band];
    optics.emission_per_m[band] = emission;
  }
  return optics;
}

std::shared_ptr<const LocalVolume> Box(const glm::dvec3& bottom, const glm::dvec3& size,
                                       const MediumOptics& optics,
                                       std::shared_ptr<const VolumeGrid> grid = nullptr,
                                       ScatteringOrders orders = ScatteringOrders::kAll) {
  VolumePlacement placement;
  placement.bottom = bottom;
  placement.size_m = size;
  return std::make_shared<const LocalVolume>(placement, std::nullopt, std::move(grid), optics,
                                             orders);
}

const glm::dvec3 kMediaEye(0.0, 0.0, 50.0);

/// Returns a direction, evenly from the whole sphere.
glm::dvec3 EvenDirection(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * kPi * uniform(random);
  const double level = std::sqrt(1.0 - z * z);
  return {level * std::cos(phi), level * std::sin(phi), z};
}

TEST(MediaLight, ThinVolumeScattersSunAndSkyOnce) {
  const MediaStage& stage = TheStage();
  const MediumOptics optics = Optics(1e-6, 0.9);
  const MediaLight lit = stage.Lit(
      {Box({0.0, 300.0, 20.0}, {50.0, 20.0, 60.0}, optics, nullptr, ScatteringOrders::kSingle)});
  const glm::dvec3 look(0.0, 1.0, 0.0), there(0.0, 300.0, 50.0);
  const MarchedLight light = lit.Along(kMediaEye, look, INFINITY, nullptr);
  const Spectrum direct = stage.SunSeen(there, 0.0);
  ViewRay to;
  to.altitude_m = 50.0;
  to.mu = 0.0;
  to.length_m = 300.0;
  const Spectrum view =
      stage.air.single_scattering().TransmittanceAlong(to) * stage.light.source.irradiance;
  const SkyMoments sky(stage.air.multiple_scattering(), stage.geometry.UpAt(there), kToSun, {50.0});
  const Spectrum from_sky = sky.Towards(
      look,
      LegendreCoefficients(optics.phase, stage.air.multiple_scattering().options().degree))[0];
  for (std::size_t band = 0; band < 3; ++band) {
    const double expected =
        optics.scattering_per_m[band] * 20.0 *
        (Phase(optics.phase, glm::dot(look, kToSun)) * static_cast<double>(direct[band]) +
         static_cast<double>(view[band] * from_sky[band]));
    EXPECT_NEAR(static_cast<double>(light.radiance[band]) / expected, 1.0, 1e-3)
        << "the air is a straight line over 100 m of altitude, the volume's own depth 4e-5";
  }
}

/// Traces the irradiance of a surface by the emission of a body, with all orders of scattering.
double TracedGlow(const LocalVolume& body, std::size_t band, const glm::dvec3& point,
                  const glm::dvec3& normal, int paths) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform;
  const MediumOptics& optics = body.optics();
  const double per_m = optics.extinction_per_m[band];
  const double albedo = optics.scattering_per_m[band] / per_m;
  double sum = 0.0;
  for (int path = 0; path < paths; ++path) {
    // The directions of the first rays have the density of the cosine.
    glm::dvec3 way = glm::normalize(normal + EvenDirection(random)), at = point;
    double weight = kPi / paths;
    for (int order = 0; order < 300; ++order) {
      const auto span = body.SpanAlong(at, way, std::numeric_limits<double>::infinity());
      if (!span) break;
      const double distance_m = span->begin_m - std::log1p(-uniform(random)) / per_m;
      if (distance_m >= span->end_m) break;
      at += distance_m * way;
      sum += weight * optics.emission_per_m[band] / per_m;
      weight *= albedo;
      // The phase function is even.
      way = EvenDirection(random);
    }
  }
  return sum;
}

TEST(MediaLight, BodiesThatGlowLightSurfacesWithAllOrders) {
  const MediaStage& stage = TheStage();
  MediumOptics optics = Optics(0.1, 0.8, 2.0);
  optics.phase = tests::LobeOf(0.0);
  const auto fire = Box({0.0, 300.0, 0.0}, {20.0, 20.0, 20.0}, optics);
  const MediaLight lit = stage.Lit({fire});
  const auto all = [](const glm::dvec3&) { return true; };
  const glm::dvec3 up(0.0, 0.0, 1.0);
  for (const glm::dvec3& point : {glm::dvec3(0.0, 275.0, 0.0), glm::dvec3(25.0, 320.0, 2.0)}) {
    const Spectrum found = lit.GlowOnSurface(point, up, all);
    for (std::size_t band = 0; band < 3; ++band) {
      const double exact = TracedGlow(*fire, band, point, up, tests::ScaledDown(200000, 40000));
      EXPECT_NEAR(static_cast<double>(found[band]) / exact, 1.0, tests::ScaledDown(0.06, 0.1))
          << "light of all orders is solved within a few percent; the paths have 1 % of noise";
    }
  }
}

TEST(MediaLight, TheGlowOfBodiesWithoutHigherOrdersIsNotScatteredAway) {
  const MediaStage& stage = TheStage();
  const auto all = [](const glm::dvec3&) { return true; };
  const auto glow = [&](double extinction, double albedo) {
    return stage
        .Lit({Box({0.0, 300.0, 0.0}, {20.0, 20.0, 20.0}, Optics(extinction, albedo, 2.0), nullptr,
                  ScatteringOrders::kSingle)})
        .GlowOnSurface({0.0, 275.0, 0.0}, {0.0, 0.0, 1.0}, all)[1];
  };
  EXPECT_FLOAT_EQ(glow(0.1, 1.0), glow(1e-9, 0.0)) << "white smoke takes nothing away";
  EXPECT_LT(glow(0.1, 0.0), 0.7F * glow(0.1, 1.0));
}

TEST(MediaLight, OtherMediaDimTheGlowOnSurfaces) {
  const MediaStage& stage = TheStage();
  const auto all = [](const glm::dvec3&) { return true; };
  const glm::dvec3 point(0.0, 200.0, 10.0), facing(0.0, 1.0, 0.0);
  const auto fire = Box({0.0, 300.0, 0.0}, {20.0, 20.0, 20.0}, Optics(0.1, 0.0, 2.0));
  const auto smoke = Box({0.0, 250.0, 0.0}, {50.0, 10.0, 50.0}, Optics(0.1, 0.0));
  const Spectrum clear = stage.Lit({fire}).GlowOnSurface(point, facing, all);
  const Spectrum dimmed = stage.Lit({smoke, fire}).GlowOnSurface(point, facing, all);
  for (std::size_t band = 0; band < 3; ++band)
    EXPECT_NEAR(static_cast<double>(dimmed[band] / clear[band]),
                std::exp(-10.0 * smoke->optics().extinction_per_m[band]), 1e-4);
  EXPECT_EQ(stage.Lit({smoke}).GlowOnSurface(point, facing, all)[0], 0.0F);
  const std::vector<glm::dvec3> places = stage.Lit({smoke, fire}).PlacesThatGlow();
  ASSERT_EQ(places.size(), 1U);
  EXPECT_LT(glm::length(places[0] - fire->Middle()), 0.5);
}

TEST(SkyMoments, IsotropicScatteringIsTheSameInAllDirections) {
  const MediaStage& stage = TheStage();
  const SkyMoments sky(stage.air.multiple_scattering(), {0.0, 0.0, 1.0}, kToSun, {0.0, 1000.0});
  const std::vector<double> isotropic{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const Spectrum up = sky.Towards({0.0, 0.0, 1.0}, isotropic)[0];
  const Spectrum along = sky.Towards({1.0, 0.0, 0.0}, isotropic)[0];
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(static_cast<double>(up[band] / along[band]), 1.0, 1e-5);
  }
}

/// Returns single scattering of the sun in one gridded volume with its exact shadow.
double ExactSun(const LocalVolume& volume, const glm::dvec3& look, std::size_t band) {
  const double k = volume.optics().extinction_per_m[band];
  constexpr int kSteps = 1500;
  constexpr double kFrom = 200.0, kTo = 420.0;
  double passed = 0.0, sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double step = (kTo - kFrom) / kSteps;
    const glm::dvec3 point = kMediaEye + (kFrom + (i + 0.5) * step) * look;
    const double rho = volume.DensityAt(point);
    if (rho == 0.0) continue;
    const double shadow = std::exp(-k * volume.Column(point, kToSun, 1e6));
    sum += std::exp(-passed - 0.5 * k * rho * step) * rho * step * shadow;
    passed += k * rho * step;
  }
  return sum;
}

TEST(MediaLight, ShadowsWithinASmokeCloudAreThoseOfShadowRays) {
  const MediaStage& stage = TheStage();
  for (const double extinction : {0.01, 0.04}) {
    const auto cloud = Box({0.0, 300.0, 0.0}, {120.0, 120.0, 100.0}, Optics(extinction, 0.9),
                           tests::NoiseGrid(40, 6.0, 0.3, 2), ScatteringOrders::kSingle);
    const MediaLight lit = stage.Lit({cloud});
    for (int i = 0; i < 6; ++i) {
      const glm::dvec3 look = glm::normalize(glm::dvec3(0.03 * i - 0.08, 1.0, 0.02 * i - 0.06));
      // The difference is light of the sun: a cloud without sun has the same light of the sky.
      const SunlitPath dark;
      const MarchedLight all = lit.Along(kMediaEye, look, 1e4, nullptr);
      const MarchedLight shaded = lit.Along(kMediaEye, look, 1e4, &dark);
      const double expected = ExactSun(*cloud, look, 1) * cloud->optics().scattering_per_m[1] *
                              Phase(cloud->optics().phase, glm::dot(look, kToSun)) *
                              static_cast<double>(stage.SunSeen({0.0, 300.0, 50.0}, look.z)[1]);
      EXPECT_NEAR(static_cast<double>(all.radiance[1] - shaded.radiance[1]) / expected, 1.0, 0.02)
          << extinction << ": columns to the sun from a grid of 40 samples a side";
    }
  }
}

TEST(MediaLight, ThinVolumesHaveTheSameLightOfAllOrdersAsOfTheFirst) {
  const MediaStage& stage = TheStage();
  const auto lit = [&](ScatteringOrders orders, const glm::dvec3& look) {
    const auto box =
        Box({0.0, 300.0, 20.0}, {50.0, 20.0, 60.0}, Optics(1e-5, 0.9), nullptr, orders);
    return stage.Lit({box}).Along(kMediaEye, look, INFINITY, nullptr);
  };
  const glm::dvec3 look(0.0, 1.0, 0.0);
  const MarchedLight all = lit(ScatteringOrders::kAll, look);
  const MarchedLight single = lit(ScatteringOrders::kSingle, look);
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(static_cast<double>(all.radiance[band] / single.radiance[band]), 1.0, 0.03)
        << "moments of degree 3 of the sky; 3 % of the scattered light is in the forward peak";
    EXPECT_FLOAT_EQ(all.narrow_transmittance[band], single.narrow_transmittance[band]);
    EXPECT_FLOAT_EQ(single.narrow_transmittance[band], single.transmittance[band]);
  }
}

TEST(MediaLight, TwoVolumesDimLightOneAfterTheOther) {
  const auto box_at = [](double along_m, double extinction) {
    return Box(along_m * kToSun - glm::dvec3(0, 0, 10), glm::dvec3(20.0), Optics(extinction, 0.5));
  };
  const auto low = box_at(60.0, 0.02), high = box_at(200.0, 0.03);
  const auto left = [](const MediaList& media) {
    return TheStage().Lit(media).BeamLeft(glm::dvec3(0.0), kToSun);
  };
  const Spectrum product = left({low}) * left({high});
  const Spectrum both = left({low, high}), swapped = left({high, low});
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_LT(left({low})[band], 0.8F);
    EXPECT_NEAR(static_cast<double>(both[band] / product[band]), 1.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(both[band] / swapped[band]), 1.0, 1e-6);
  }
}

std::shared_ptr<const ExponentialLayer> FogMedium(double extinction, double scale_height) {
  MediumOptics optics{SpectrumOf<double>(3), SpectrumOf<double>(3), SpectrumOf<double>(3),
                      DropletPhase(12.0)};
  for (std::size_t band = 0; band < 3; ++band) {
    optics.extinction_per_m[band] = optics.scattering_per_m[band] = extinction;
  }
  return std::make_shared<const ExponentialLayer>(
      LayerShape{0.0, scale_height, 6360e3, 60e3, std::nullopt}, optics);
}

TEST(MediaLight, ThinFogLeavesTheGroundItsLight) {
  const MediaStage& stage = TheStage();
  const MediaLight lit = stage.Lit({FogMedium(1e-7, 50.0)});
  for (const double cos_up : {1.0, 0.7, 0.0}) {
    const SkyThroughMedia sky = lit.SkyOnSurface(0.0, cos_up, SkyThroughMedia::Clear(3));
    for (std::size_t band = 0; band < 3; ++band) {
      EXPECT_NEAR(static_cast<double>(sky.left[band]), 1.0, 1e-4);
      EXPECT_NEAR(static_cast<double>(sky.added[band]), 0.0, 1e-4) << cos_up;
    }
  }
}

// Hard case 30.
TEST(MediaLight, WhiteFogOverBlackGroundConservesEnergy) {
  // The light that leaves fog downwards and upwards is the light that entered it.
  Medium medium = MediumPreset("bruneton2017");
  medium.ground_albedo.assign(3, 0.0);
  const SolvedAir over_black = tests::SolvedAsClearAir(medium);
  const MediaStage stage(over_black);
  const MediaLight lit = stage.Lit({FogMedium(0.02, 60.0)});
  const double mu_s = kToSun.z;
  const Spectrum sun = stage.air.BeamLeft(60.0, mu_s);
  const Spectrum sky = over_black.multiple_scattering().SkyIrradiance(0.0, mu_s);
  const SkyThroughMedia below = lit.SkyOnSurface(0.0, 1.0, SkyThroughMedia::Clear(3));
  const SkyThroughMedia above = lit.SkyOnSurface(5e4, -1.0, SkyThroughMedia::Clear(3));
  const Spectrum beam = lit.BeamLeft({0.0, 0.0, 0.0}, kToSun);
  for (std::size_t band = 0; band < 3; ++band) {
    const double in = mu_s * static_cast<double>(sun[band]) + static_cast<double>(sky[band]);
    const double out =
        static_cast<double>(below.added[band] + below.left[band] * sky[band] + above.added[band]) +
        mu_s * static_cast<double>(beam[band] * sun[band]);
    EXPECT_NEAR(out / in, 1.0, 5e-3);
  }
}

// The irradiance of a surface above fog is that of the rays that come from the fog.
TEST(MediaLight, RaysCarryTheLightThatLeavesFog) {
  Medium medium = MediumPreset("bruneton2017");
  medium.ground_albedo.assign(3, 0.0);
  const MediaStage stage(tests::SolvedAsClearAir(medium));
  const MediaLight lit = stage.Lit({FogMedium(0.02, 60.0)});
  constexpr double kEye_m = 500.0;
  const SkyThroughMedia above = lit.SkyOnSurface(kEye_m, -1.0, SkyThroughMedia::Clear(3));
  const GaussRule& zenith = GaussLegendre(8);
  const int azimuths = tests::ScaledDown(32, 8);
  Spectrum flux(3);
  for (std::size_t i = 0; i < zenith.node.size(); ++i) {
    for (int k = 0; k < azimuths; ++k) {
      const double azimuth = 2.0 * kPi * (k + 0.5) / azimuths, mu = zenith.node[i];
      const double sine = std::sqrt(1.0 - mu * mu);
      const glm::dvec3 direction(sine * std::cos(azimuth), sine * std::sin(azimuth), -mu);
      const MarchedLight light = lit.Along({0.0, 0.0, kEye_m}, direction, 4000.0, nullptr);
      flux =
          flux + static_cast<float>(2.0 * kPi / azimuths * zenith.weight[i] * mu) * light.radiance;
    }
  }
  for (std::size_t band = 0; band < 3; ++band) {
    const double expected =
        static_cast<double>(above.added[band] * stage.light.source.irradiance[band]);
    EXPECT_NEAR(static_cast<double>(flux[band]) / expected, 1.0, 0.05)
        << "the air takes up to 2 %, the widest rays end below the fog or are long";
  }
}

// Fog over a round planet without air is a plane layer, from a thin bank to the filled valley.
TEST(MediaLight, FogWithoutAirIsThePlaneLayer) {
  Medium medium = tests::WithoutAir(MediumPreset("bruneton2017"));
  medium.ground_albedo.assign(3, 0.2);
  const MediaStage stage(tests::SolvedAsClearAir(medium));
  for (const double base_m : {0.0, 200.0, 1000.0}) {
    const LayerShape shape{base_m, 60.0, medium.planet_radius_m, medium.atmosphere_height_m,
                           std::optional(0.0)};
    MediumOptics optics = Optics(0.02, 1.0);
    optics.phase = DropletPhase(14.0);
    const auto fog = std::make_shared<const ExponentialLayer>(shape, optics);
    const double depth = 0.02 * fog->ColumnAbove(0.0);
    std::vector<double> chi = LegendreCoefficients(optics.phase, 1500);
    chi[0] = 1.0;
    const LayerStack plane({{depth, 1.0, chi}}, 0.2, tests::ScaledDown(40, 24));
    const LayerField truth = LayerField::UnderSun(plane, kToSun.z);
    const MediaLight lit = stage.Lit({fog});
    const double sun_azimuth = std::atan2(kToSun.y, kToSun.x);
    for (const double down : {0.2, 0.5, 0.9}) {
      for (const double azimuth : {0.0, 1.5, 3.0}) {
        const double level = std::sqrt(1.0 - down * down);
        const glm::dvec3 look(level * std::cos(sun_azimuth + azimuth),
                              level * std::sin(sun_azimuth + azimuth), -down);
        const MarchedLight light =
            lit.Along({0.0, 0.0, base_m + 900.0}, look, (base_m + 900.0) / down, nullptr);
        const double of_ground = 0.2 / kPi *
                                 (truth.Fluxes(depth).down + truth.Fluxes(depth).direct) *
                                 std::exp(-depth / down);
        const double expected = truth.Radiance(0.0, {down, azimuth}) - of_ground;
        EXPECT_NEAR(
            static_cast<double>(light.radiance[0] / stage.light.source.irradiance[0]) / expected,
            1.0, 0.02)
            << base_m << " " << down << " " << azimuth << ": " << depth;
      }
    }
  }
}

/// A kind of body that only this test has: density 1 throughout.
class PlainBody final : public LocalBody {
 public:
  using LocalBody::LocalBody;

  [[nodiscard]] double DensityAt(const glm::dvec3& point) const override {
    return Contains(point) ? 1.0 : 0.0;
  }
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const override {
    const auto span = SpanAlong(origin, direction, length_m);
    return span ? std::vector<DensePiece>{{span->begin_m, span->end_m, 1.0}}
                : std::vector<DensePiece>();
  }
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const override {
    const auto span = SpanAlong(origin, direction, length_m);
    return span ? span->end_m - span->begin_m : 0.0;
  }
};

TEST(LocalBody, ANewKindOfBodyIsLitLikeAVolume) {
  const MediaStage& stage = TheStage();
  const glm::dvec3 bottom(0.0, 300.0, 20.0), size(50.0, 20.0, 60.0);
  const MediumOptics optics = Optics(0.02, 0.9);
  VolumePlacement placement;
  placement.bottom = bottom;
  placement.size_m = size;
  const auto body = std::make_shared<const PlainBody>(placement, optics);
  const glm::dvec3 look(0.0, 1.0, 0.0);
  const MarchedLight light = stage.Lit({body}).Along(kMediaEye, look, INFINITY, nullptr);
  const MarchedLight expected =
      stage.Lit({Box(bottom, size, optics)}).Along(kMediaEye, look, INFINITY, nullptr);
  EXPECT_GT(light.radiance[1], 0.0F);
  EXPECT_EQ(light.radiance, expected.radiance);
  EXPECT_EQ(light.transmittance, expected.transmittance);
}

TEST(MediaLight, LampsLightAVolumeLikeHomogeneousAir) {
  MediaStage stage(tests::ThreeBandAir());
  stage.scene.lights = {tests::LampNear(stage.scene.place, 60.0, 0.0, 52.0, 100.0)};
  const LampLight lamps(stage.scene, stage.ground, stage.medium, stage.colour);
  stage.light.source.direction = Unrefracted({0.0, 0.6, -0.8});
  const MediumOptics optics = Optics(0.01, 0.8);
  const MediaLight lit = stage.Lit(
      {Box({0.0, 0.0, -200.0}, {500.0, 500.0, 500.0}, optics, nullptr, ScatteringOrders::kSingle)},
      &lamps);
  const LampLight::SceneLamp in_scene = lamps.At(0);
  for (const double rise : {-0.05, 0.0, 0.03, 0.4}) {
    const glm::dvec3 look = glm::normalize(glm::dvec3(0.02, 1.0, rise));
    const MarchedLight light = lit.Along(kMediaEye, look, 150.0, nullptr);
    for (std::size_t band = 0; band < 3; ++band) {
      const LampAir air = HomogeneousAir(optics.scattering_per_m[band],
                                         optics.extinction_per_m[band], optics.phase);
      const double expected = static_cast<double>(in_scene.intensity[band]) *
                              Airlight(air, in_scene.lamp, {kMediaEye, look, 0.0, 150.0}, 64)[0];
      EXPECT_NEAR(static_cast<double>(light.radiance[band]) / expected, 1.0, 1e-2)
          << rise << ": clear air takes up to 0.4 % over 100 m, twice";
    }
  }
}

TEST(MediaLight, FireLightsItsSmokeAtNightAsALamp) {
  MediaStage stage(tests::ThreeBandAir());
  stage.light.source.direction = Unrefracted({0.0, 0.6, -0.8});
  const auto smoke = Box({0.0, 300.0, 20.0}, {60.0, 60.0, 60.0}, Optics(0.02, 0.8));
  const auto fire_of = [](double emission) {
    return Box({0.0, 300.0, 10.0}, glm::dvec3(4.0), Optics(0.0, 0.0, emission));
  };
  const glm::dvec3 look(0.0, 1.0, 0.0);
  const auto light = [&](const MediaList& media) {
    return stage.Lit(media).Along(kMediaEye, look, INFINITY, nullptr).radiance;
  };
  const Spectrum dark = light({smoke}), lit = light({smoke, fire_of(1.0)});
  const Spectrum brighter = light({fire_of(2.0), smoke});
  // At first order smoke at the ray, 40 m over the fire, scatters E p by its depth of 1.2; a half of
  // its light is taken on the way, at least, and light of higher orders is not more than that.
  const double irradiance = 64.0 / (38.0 * 38.0);
  for (std::size_t band = 0; band < 3; ++band) {
    const double glow = static_cast<double>(lit[band] - dark[band]);
    EXPECT_GT(glow, 0.05 * irradiance / (4.0 * kPi));
    EXPECT_LT(glow, 2.0 * irradiance / (4.0 * kPi));
    EXPECT_NEAR(static_cast<double>(brighter[band] - dark[band]) / glow, 2.0, 1e-3);
  }
}

TEST(DimmedByMedia, LightIsDimmedByTheMediaInFrontOfIt) {
  // The slab has a transmittance of 0.3 between 100 and 200 m. Light grows as 1 - exp(-t / 500).
  const auto upto = [](double t) {
    Spectrum light(1);
    light[0] = static_cast<float>(-std::expm1(-t / 500.0));
    return light;
  };
  std::vector<MarchedPiece> pieces;
  constexpr int kPieces = 12;
  const double k = -std::log(0.3) / 100.0;
  double expected = -std::expm1(-100.0 / 500.0);
  for (int i = 0; i < kPieces; ++i) {
    const double a = 100.0 + 100.0 * i / kPieces, b = 100.0 + 100.0 * (i + 1) / kPieces;
    MarchedPiece piece{a, b, Spectrum(1), Spectrum(1), Spectrum(1), Spectrum(1)};
    piece.transmittance[0] = static_cast<float>(std::exp(-k * (b - 100.0)));
    piece.mean_transmittance[0] = static_cast<float>(
        (std::exp(-k * (a - 100.0)) - std::exp(-k * (b - 100.0))) / (k * (b - a)));
    pieces.push_back(piece);
  }
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 100.0 + 100.0 * (i + 0.5) / kSteps;
    expected += std::exp(-k * (t - 100.0)) * std::exp(-t / 500.0) / 500.0 * 100.0 / kSteps;
  }
  expected += 0.3 * std::exp(-200.0 / 500.0);
  Spectrum whole(1);
  whole[0] = 1.0F;
  const Spectrum dimmed = DimmedByMedia(pieces, upto, whole, Behind::kAll);
  EXPECT_NEAR(static_cast<double>(dimmed[0]) / expected, 1.0, 1e-3);
}

TEST(LayerLight, IsNowhereNegative) {
  const MediaStage& stage = TheStage();
  const LayerShape shape{0.0, 30.0, stage.medium.planet_radius_m, 120e3, std::nullopt};
  for (const double g : {-0.99, -0.9, -0.6, 0.0, 0.85, 0.99}) {
    MediumOptics optics = Optics(0.02, 1.0);
    optics.phase = tests::LobeOf(g);
    const ExponentialLayer layer(shape, optics);
    Spectrum sun(3);
    std::ranges::fill(sun.values(), 0.8F);
    const LayerLight lit(layer, stage.air.multiple_scattering(), Unrefracted(kToSun), sun,
                         LightPastClouds::Clear(3));
    for (const double height_m : {0.0, 10.0, 60.0, 200.0}) {
      for (const double z : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        const glm::dvec3 look(std::sqrt(1.0 - z * z), 0.0, z);
        // Sunlight behind an optically thick wall: only the glow is left.
        const LayerLight::Glow light = lit.GlowAt(lit.LookAlong(look), height_m);
        const Spectrum ground = lit.OnSurface(height_m, z);
        for (std::size_t band = 0; band < 3; ++band) {
          EXPECT_GE(light.of_sun[band], 0.0F) << g << " " << height_m << " " << z;
          EXPECT_GE(light.of_sky[band], 0.0F) << g << " " << height_m << " " << z;
          EXPECT_GE(ground[band], 0.0F) << g << " " << height_m << " " << z;
        }
      }
    }
  }
}

/// Returns the light of fog along rays up and down.
std::vector<Spectrum> LightOfFog(const MediumLayer& fog) {
  const MediaStage& stage = TheStage();
  Scene scene = stage.scene;
  scene.layers = {fog};
  const MediaLight lit(LocalMedia(LayersOf(scene, stage.ground, stage.medium), 3), stage.geometry,
                       stage.air, stage.light);
  std::vector<Spectrum> light;
  for (const double z : {-0.5, 0.1, 0.5, 1.0}) {
    const glm::dvec3 look(std::sqrt(1.0 - z * z), 0.0, z);
    const double length_m = z < 0.0 ? 2.0 / -z : std::numeric_limits<double>::infinity();
    light.push_back(lit.Along({0.0, 0.0, 2.0}, look, length_m, nullptr).radiance);
  }
  return light;
}

// Fixed on 2026-11-30: fog with its base above the ground had the light of a layer that ends at its
// base, although it is denser below. Half as much light as that of the same fog with its base on the
// ground, or four times as much.
TEST(LayerLight, IsThatOfTheSameFogWithAnotherBase) {
  for (const double base_m : {50.0, 200.0, 600.0}) {
    const MediumLayer low{0.004 * std::exp(base_m / 100.0), 100.0, 0.0, 1.0, tests::LobeOf(0.8)};
    const MediumLayer high{0.004, 100.0, base_m, 1.0, tests::LobeOf(0.8)};
    const auto by_low = LightOfFog(low), by_high = LightOfFog(high);
    for (std::size_t ray = 0; ray < by_low.size(); ++ray) {
      for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_NEAR(by_high[ray][band] / by_low[ray][band], 1.0F, 1e-3F)
            << base_m << " " << ray << ": the same medium, to the tolerance of the march";
      }
    }
  }
}

// The deck leaves no sunlight, and a tenth of the clear sky's.
TEST(LayerLight, FogUnderAGreyDeckIsGrey) {
  const MediaStage& stage = TheStage();
  const LightPastClouds deck{{Spectrum(3, 0.1F), Spectrum(3, 0.2F)}, Spectrum(3, 0.3F), 0.0F};
  const LayerShape shape{0.0, 60.0, stage.medium.planet_radius_m, 120e3, std::nullopt};
  const ExponentialLayer layer(shape, Optics(0.02, 1.0));
  const auto of_sky = [&](const LightPastClouds& past) {
    const LayerLight lit(layer, stage.air.multiple_scattering(), Unrefracted(kToSun), Spectrum(3),
                         past);
    return lit.GlowAt(lit.LookAlong({0.8, 0.0, 0.6}), 2.0).of_sky;
  };
  const Spectrum blue = of_sky(LightPastClouds::Clear(3)), dull = of_sky(deck);
  EXPECT_GT(blue[0] / blue[2], 2.0F);
  EXPECT_LT(dull[0] / dull[2], 1.0F + 0.3F * (blue[0] / blue[2] - 1.0F));
}

// Fog in a valley can be a million deep below the mountains. Above it, light of the fog and light of the
// sky meet at the horizontal.
TEST(LayerLight, IsContinuousAcrossTheHorizontal) {
  const MediaStage& stage = TheStage();
  const ExponentialLayer layer(
      {1000.0, 60.0, stage.medium.planet_radius_m, 120e3, std::optional(200.0)}, Optics(0.02, 1.0));
  Spectrum sun(3);
  std::ranges::fill(sun.values(), 0.8F);
  const LayerLight lit(layer, stage.air.multiple_scattering(), Unrefracted(kToSun), sun,
                       LightPastClouds::Clear(3));
  const double azimuth = std::atan2(kToSun.y, kToSun.x);
  const auto glow = [&](double height_m, double z) {
    const double level = std::sqrt(1.0 - z * z);
    return lit.GlowAt(lit.LookAlong({level * std::cos(azimuth), level * std::sin(azimuth), z}),
                      height_m);
  };
  for (const double height_m : {1000.0, 1200.0, 1500.0}) {
    const LayerLight::Glow below = glow(height_m, -1e-3), above = glow(height_m, 1e-3);
    for (std::size_t band = 0; band < 3; ++band) {
      // Light changes by at most its whole over 0.06.
      EXPECT_NEAR(below.of_sky[band], above.of_sky[band], 0.05F * above.of_sky[band]) << height_m;
      EXPECT_NEAR(below.of_sun[band], above.of_sun[band], 0.05F * above.of_sun[band]) << height_m;
    }
  }
}

TEST(MediaLight, FogFromSpaceEqualsThatFromTheTopOfTheAir) {
  const MediaStage& stage = TheStage();
  const double radius_m = stage.medium.planet_radius_m;
  const double top_m = stage.medium.atmosphere_height_m;
  const MediaList fog{std::make_shared<const ExponentialLayer>(
      LayerShape{0.0, 200.0, radius_m, top_m, std::nullopt}, Optics(1e-3, 0.9))};
  const MediaLight lit = stage.Lit(fog);
  for (const double tilt : {0.0, 0.6, 1.2}) {  // of the ray at the ground, from the vertical
    const glm::dvec3 out(std::sin(tilt), 0.0, std::cos(tilt));
    const double to_top_m =
        std::sqrt(radius_m * radius_m * out.z * out.z + top_m * (2.0 * radius_m + top_m)) -
        radius_m * out.z;
    const MarchedLight near = lit.Along(to_top_m * out, -out, to_top_m, nullptr);
    for (const double far_m : {4e7, 1e9}) {
      const MarchedLight far = lit.Along(far_m * out, -out, far_m, nullptr);
      for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_NEAR(static_cast<double>(far.radiance[band] / near.radiance[band]), 1.0,
                    2.0 * kMarchTolerance)
            << far_m;
        EXPECT_NEAR(static_cast<double>(far.transmittance[band]),
                    static_cast<double>(near.transmittance[band]), kMarchTolerance);
      }
    }
  }
}

const RenderSettings kSmallMedia{.width = 24, .height = 14, .samples_per_pixel = 1, .layers = {}};
const UtcTime kMediaNoon = ParseInstant("2026-06-21T10:00:00Z");
const UtcTime kMediaNight = ParseInstant("2026-01-01T00:00:00Z");

Scene WithoutVolume() {
  Scene scene = QuickScene(50.0, 0.0, 0.0, 40.0);
  scene.medium = MediumPreset("bruneton2017");
  return scene;
}
MediumLayer FogIn(double extinction_per_m, double scale_height_m, double albedo = 1.0) {
  return {extinction_per_m, scale_height_m, 0.0, albedo, DropletPhase(12.0)};
}
HdrImage Rendered(const Scene& scene, const UtcTime& instant,
                  const RenderSettings& settings = kSmallMedia) {
  return SceneRenderer(scene).Render(instant, settings);
}

const HdrImage& ClearNoon() {
  static const HdrImage image = Rendered(WithoutVolume(), kMediaNoon);
  return image;
}

Scene WithVolume(double extinction, double albedo) {
  Scene scene = WithoutVolume();
  Volume volume;
  volume.place = PlaceFromRadians(scene.place.latitude_rad() + 400.0 / 6.36e6,
                                  scene.place.longitude_rad(), 0.0);
  volume.height = {20.0, false};
  volume.size_m = {60.0, 60.0, 60.0};
  volume.extinction_per_m = {extinction};
  volume.albedo = {albedo};
  scene.volumes.push_back(volume);
  return scene;
}

TEST(RenderMedia, EmptyVolumesChangeNoByte) {
  EXPECT_EQ(Rendered(WithVolume(0.0, 1.0), kMediaNoon).rgb, ClearNoon().rgb);
}

TEST(RenderMedia, FogWhollyBelowTheGroundChangesNoByte) {
  Scene scene = WithoutVolume();
  scene.layers = {FogIn(0.004, 25.0)};
  scene.layers[0].base_height_m = -1000.0;
  EXPECT_EQ(Rendered(scene, kMediaNoon).rgb, ClearNoon().rgb);
}

TEST(LocalMedia, FogBelowTheTerrainLiesOnThePlanetAroundIt) {
  Scene scene = WithoutVolume();
  SceneGround ground = LoadGround(scene);
  TriangleMesh plateau;
  plateau.positions = {{-1e3F, -1e3F, 800.0F}, {1e3F, -1e3F, 800.0F}, {0.0F, 1e3F, 800.0F}};
  plateau.normals.assign(3, {0.0F, 0.0F, 1.0F});
  plateau.triangles = {{0, 1, 2}};
  ground.terrain.emplace(std::move(plateau));
  const auto bottom = [&](double base_m) -> std::optional<double> {
    scene.layers = {FogIn(0.004, 25.0)};
    scene.layers[0].base_height_m = base_m;
    const LocalMedia media(scene, ground, scene.medium);
    return media.HasLayers() ? std::optional(media.layer()->bottom_m()) : std::nullopt;
  };
  EXPECT_NEAR(bottom(700.0).value(), 800.0, 0.1) << "it reaches over the plateau";
  EXPECT_EQ(bottom(10.0), 0.0) << "it lies around the plateau, ever denser down to the ground";
  EXPECT_EQ(bottom(-1000.0), std::nullopt);
}

TEST(RenderMedia, OpaqueBlackVolumeLeavesOnlyTheAirInFrontOfIt) {
  RenderSettings settings = kSmallMedia;
  settings.layers = {PictureLayer::kTransmittance, PictureLayer::kVolumes,
                     PictureLayer::kInscatter};
  const HdrImage image = Rendered(WithVolume(10.0, 0.0), kMediaNoon, settings);
  const HdrImage& without = ClearNoon();
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(image.at(12, 7)[c], 0.0F) << "370 m of air";
    EXPECT_LT(image.at(12, 7)[c], 0.1F * without.at(12, 7)[c]);
  }
  const std::size_t middle = 7 * 24 + 12;
  EXPECT_LT(image.layers[0].values[middle], 1e-5F);
  EXPECT_EQ(image.layers[3].values[middle], 0.0F) << "black volumes emit nothing";
  EXPECT_EQ(image.at(0, 7), without.at(0, 7)) << "and beside it nothing changes";
}

TEST(RenderMedia, AGlowingVolumeShinesLikeABlackBody) {
  Scene scene = WithVolume(0.01, 0.0);
  scene.volumes[0].temperature_k = 2000.0;
  scene.medium = tests::WithoutAir(scene.medium);
  const HdrImage image = Rendered(scene, kMediaNight);
  std::vector<double> radiance;
  for (const double nm : scene.medium.wavelengths_nm) {
    radiance.push_back(BlackBodyRadiance(nm, 2000.0) * -std::expm1(-0.6));
  }
  const auto expected = BandColour(scene.medium.wavelengths_nm).LinearSrgb(radiance);
  EXPECT_NEAR(static_cast<double>(image.at(12, 7)[0]) / expected[0], 1.0, 2e-3)
      << "the ray through the pixel's middle crosses the 60 m at less than 2 degrees";
}

TEST(RenderMedia, GlowingVolumeIsDimmedByFogInFrontOfIt) {
  Scene scene = WithVolume(0.01, 0.0);
  scene.volumes[0].temperature_k = 2000.0;
  const HdrImage clear = Rendered(scene, kMediaNight);
  scene.layers = {FogIn(0.005, 1e5)};
  const HdrImage foggy = Rendered(scene, kMediaNight);
  const double left = static_cast<double>(foggy.at(12, 7)[0] / clear.at(12, 7)[0]);
  EXPECT_GT(left, std::exp(-0.005 * 431.0)) << "all of it at its far side";
  EXPECT_LT(left, std::exp(-0.005 * 369.0)) << "all of it at its near side";
}

TEST(RenderMedia, AFireLightsTheGroundBelowIt) {
  Scene scene = WithVolume(0.01, 0.0);
  scene.volumes[0].temperature_k = 2000.0;
  scene.volumes[0].size_m = {2.0, 2.0, 2.0};
  scene.medium = tests::WithoutAir(scene.medium);
  scene.camera.pitch_rad = -std::atan2(50.0, 400.0);
  scene.camera.fov_rad = 0.02;
  RenderSettings settings = kSmallMedia;
  const HdrImage image = Rendered(scene, kMediaNight, settings);
  std::vector<double> radiance;
  for (std::size_t band = 0; band < scene.medium.wavelengths_nm.size(); ++band) {
    const double emission = 0.01 * BlackBodyRadiance(scene.medium.wavelengths_nm[band], 2000.0);
    radiance.push_back(scene.medium.ground_albedo[band] / kPi * 8.0 * emission / (21.0 * 21.0));
  }
  const auto expected = BandColour(scene.medium.wavelengths_nm).LinearSrgb(radiance);
  EXPECT_NEAR(static_cast<double>(image.at(12, 7)[0]) / expected[0], 1.0, 0.03)
      << "the bound of the light of fires; the ray meets the ground within 3 m below the fire";
  settings.effects = EffectSet::All().Without(Effect::kVolumes);
  EXPECT_LT(Rendered(scene, kMediaNight, settings).at(12, 7)[0], 1e-3F * image.at(12, 7)[0]);
}

TEST(RenderMedia, FogAtNightHasOnlyTheLightOfLamps) {
  Scene scene = WithoutVolume();
  scene.layers = {FogIn(0.01, 30.0)};
  scene.lights = {tests::LampNear(scene.place, 100.0, 0.0, 40.0, 1000.0)};
  const SceneRenderer renderer(scene);
  RenderSettings without = kSmallMedia;
  without.effects = EffectSet::All().Without(Effect::kLayerGlow);
  EXPECT_EQ(renderer.Render(kMediaNight, kSmallMedia).rgb,
            renderer.Render(kMediaNight, without).rgb);
}

TEST(RenderMedia, FogAndSmokeAreFiniteFromNoonToNight) {
  Scene scene = WithVolume(0.05, 0.9);
  scene.layers = {FogIn(0.02, 40.0, 0.95)};
  const SceneRenderer renderer(scene);
  double last = 1e9;
  for (const char* time : {"2026-03-20T12:00:00Z", "2026-03-20T16:30:00Z", "2026-03-20T17:32:00Z",
                           "2026-03-20T17:40:00Z", "2026-03-20T18:10:00Z", "2026-03-20T19:30:00Z",
                           "2026-03-20T23:00:00Z"}) {
    const HdrImage image = renderer.Render(ParseInstant(time), kSmallMedia);
    double sum = 0.0;
    for (const auto& rgb : image.rgb) {
      for (const float value : rgb) EXPECT_TRUE(std::isfinite(value)) << time;
      sum += static_cast<double>(rgb[0] + rgb[1] + rgb[2]);
      EXPECT_GE(tests::Luminance(rgb), 0.0) << time;
    }
    EXPECT_LE(sum, last) << time << ": it only gets darker";
    last = sum;
  }
}

TEST(RenderMedia, AMissingGridIsNamed) {
  Scene scene = WithVolume(0.05, 0.9);
  scene.volumes[0].grid = "nowhere/smoke.nrrd";
  EXPECT_EQ(tests::FaultOf([&] { return std::make_unique<SceneRenderer>(scene); }),
            "volume 1: nowhere/smoke.nrrd: cannot be read");
}

TEST(RenderMedia, FogGrowsOutOfClearAirWithoutAStep) {
  Scene scene = WithoutVolume();
  const HdrImage& a = ClearNoon();
  scene.layers = {FogIn(1e-8, 30.0)};
  const HdrImage b = Rendered(scene, kMediaNoon);
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(static_cast<double>(b.rgb[i][c] / a.rgb[i][c]), 1.0, 3e-3);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
