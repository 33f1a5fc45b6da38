// SPDX-License-Identifier: MIT
// A kind of medium that only this test has, lit and marched through the interface alone.
#include "renderer/media/local_medium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "renderer/media/media_light.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/solved_media.h"

namespace alpenglow::renderer {
namespace {

/// A sheet that glows, 100 to 101 m north of the origin. It counts the rays on which it is looked
/// at.
class GlowingSheet final : public LocalMedium {
 public:
  GlowingSheet(double extinction_per_m, double emission_per_m)
      : LocalMedium({Of(extinction_per_m), Of(0.0), Of(emission_per_m), {}}) {}

  [[nodiscard]] int rays() const { return rays_; }

  [[nodiscard]] double DensityAt(const glm::dvec3& point) const override {
    return point.y >= 100.0 && point.y <= 101.0 ? 1.0 : 0.0;
  }
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const override {
    if (direction.y <= 0.0 || origin.y > 101.0) return {};
    const double end = std::min((101.0 - origin.y) / direction.y, length_m);
    const double begin = std::max((100.0 - origin.y) / direction.y, 0.0);
    if (begin >= end) return {};
    return {{begin, end, 1.0}};
  }
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                              double length_m) const override {
    double sum = 0.0;
    for (const DensePiece& piece : PiecesAlong(origin, direction, length_m))
      sum += piece.end_m - piece.begin_m;
    return sum;
  }
  [[nodiscard]] std::unique_ptr<const LitMedium> LitBy(const MediaSources&) const override {
    return std::make_unique<Lit>(*this);
  }

 private:
  class OnOneRay final : public MediumOnRay {
   public:
    explicit OnOneRay(const GlowingSheet& sheet) : sheet_(sheet) {}
    void AddSource(const LightOnPoint&, double density, Spectrum& sum) const override {
      for (std::size_t band = 0; band < sum.size(); ++band)
        sum[band] += static_cast<float>(density * sheet_.optics().emission_per_m[band]);
    }

   private:
    const GlowingSheet& sheet_;
  };

  class Lit final : public LitMedium {
   public:
    explicit Lit(const GlowingSheet& sheet) : sheet_(sheet) {}
    [[nodiscard]] std::unique_ptr<const MediumOnRay> OnRay(const glm::dvec3&,
                                                           const glm::dvec3&) const override {
      ++sheet_.rays_;
      return std::make_unique<OnOneRay>(sheet_);
    }
    void AddDepthToLight(const glm::dvec3& point, const glm::dvec3& to_disk,
                         SpectrumOf<double>& depth) const override {
      const double column = sheet_.Column(point, to_disk, INFINITY);
      for (std::size_t band = 0; band < depth.size(); ++band)
        depth[band] += column * sheet_.optics().extinction_per_m[band];
    }

   private:
    const GlowingSheet& sheet_;
  };

  [[nodiscard]] static SpectrumOf<double> Of(double value) {
    SpectrumOf<double> bands(3);
    for (std::size_t band = 0; band < 3; ++band) bands[band] = value;
    return bands;
  }

  mutable int rays_ = 0;
};

/// Three media: the sheet between a layer and a box behind it, at night.
struct NightStage {
  Scene scene = [] {
    Scene bare = QuickScene(50.0, 0.0, 0.0, 60.0);
    bare.medium = tests::ThreeBandAir().medium();
    return bare;
  }();
  SceneGround ground = LoadGround(scene);
  SceneGeometry geometry{ground, scene.medium, false};
  const SolvedAir& air = tests::ThreeBandAir();
  Lighting light = [this] {
    SunInSky sun;
    sun.distance_au = 1.0;
    Lighting at =
        LightingOf(sun, UtcTime{60000, 0.0}, PlaceFromRadians(0.8, 0.0, 0.0), scene.medium);
    at.source.direction = Unrefracted({0.0, 0.6, -0.8});
    at.source.radius_rad = 0.00465;
    return at;
  }();

  [[nodiscard]] MediaLight Lit(MediaList media) const {
    return {LocalMedia(std::move(media), 3), geometry, air, light};
  }
};

const glm::dvec3 kOrigin(0.0, 0.0, 50.0);

TEST(LocalMedium, AnyKindIsMarchedThroughItsInterface) {
  const NightStage stage;
  const auto sheet = std::make_shared<const GlowingSheet>(0.5, 3.0);
  const MarchedLight light = stage.Lit({sheet}).Along(kOrigin, {0.0, 1.0, 0.0}, 1e3, nullptr);
  ViewRay to{50.0, 0.0, 0.0, 0.0};
  to.length_m = 100.5;
  const Spectrum air = stage.air.single_scattering().TransmittanceAlong(to);
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(static_cast<double>(light.radiance[band] / air[band]), 6.0 * -std::expm1(-0.5),
                1e-3)
        << "emission over extinction, times the opacity; the air changes by 1e-4 within 1 m";
    EXPECT_NEAR(static_cast<double>(light.transmittance[band]), std::exp(-0.5), 1e-6);
  }
}

TEST(LocalMedium, AnyKindCastsItsShadowThroughItsInterface) {
  const NightStage stage;
  const MediaLight lit = stage.Lit({std::make_shared<const GlowingSheet>(0.5, 3.0)});
  const Spectrum behind = lit.BeamLeft(kOrigin, {0.0, 1.0, 0.0});
  const Spectrum beside = lit.BeamLeft(kOrigin, {0.0, -1.0, 0.0});
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(static_cast<double>(behind[band]), std::exp(-0.5), 1e-6);
    EXPECT_EQ(beside[band], 1.0F);
  }
}

TEST(LocalMedium, IsNotEvaluatedOnRaysThatMissIt) {
  const NightStage stage;
  const auto sheet = std::make_shared<const GlowingSheet>(0.5, 3.0);
  const MediaLight lit = stage.Lit({sheet});
  const MarchedLight behind = lit.Along(kOrigin, {0.0, -1.0, 0.0}, 1e3, nullptr);
  const MarchedLight before = lit.Along(kOrigin, {0.0, 1.0, 0.0}, 99.0, nullptr);
  EXPECT_EQ(behind.nodes + before.nodes, 0U);
  EXPECT_EQ(sheet->rays(), 0);
  (void)lit.Along(kOrigin, {0.0, 1.0, 0.0}, 1e3, nullptr);
  EXPECT_EQ(sheet->rays(), 1);
}

TEST(LocalMedium, BodiesAndLayersMayStandInAnyOrder) {
  const NightStage stage;
  const auto sheet = std::make_shared<const GlowingSheet>(0.5, 3.0);
  MediumOptics optics = sheet->optics();
  for (std::size_t band = 0; band < 3; ++band) {
    optics.extinction_per_m[band] = optics.scattering_per_m[band] = 0.002;
    optics.emission_per_m[band] = 0.0;
  }
  const auto layer = std::make_shared<const ExponentialLayer>(
      LayerShape{0.0, 40.0, stage.scene.medium.planet_radius_m, 60e3, std::nullopt}, optics);
  const MediaLight one = stage.Lit({layer, sheet}), other = stage.Lit({sheet, layer});
  const MarchedLight a = one.Along(kOrigin, {0.0, 1.0, 0.0}, 1e3, nullptr);
  const MarchedLight b = other.Along(kOrigin, {0.0, 1.0, 0.0}, 1e3, nullptr);
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(static_cast<double>(a.radiance[band] / b.radiance[band]), 1.0, 1e-5);
    EXPECT_NEAR(static_cast<double>(a.pieces.back().past_bodies[band]), std::exp(-0.5), 1e-6)
        << "the layer is not a body";
  }
}

TEST(LocalMedium, TwoThinLayersScatterAsOne) {
  NightStage stage;
  stage.light.source.direction = Unrefracted({0.0, 0.6, 0.8});
  const auto layer_of = [&](double per_m) {
    MediumOptics optics{SpectrumOf<double>(3), SpectrumOf<double>(3), SpectrumOf<double>(3), {}};
    for (std::size_t band = 0; band < 3; ++band)
      optics.extinction_per_m[band] = optics.scattering_per_m[band] = per_m;
    return std::make_shared<const ExponentialLayer>(
        LayerShape{0.0, 40.0, stage.scene.medium.planet_radius_m, 60e3, std::nullopt}, optics);
  };
  const MediaLight one = stage.Lit({layer_of(2e-6)});
  const MediaLight two = stage.Lit({layer_of(1e-6), layer_of(1e-6)});
  const Spectrum a = one.Along(kOrigin, {0.0, 1.0, 0.0}, 500.0, nullptr).radiance;
  const Spectrum b = two.Along(kOrigin, {0.0, 1.0, 0.0}, 500.0, nullptr).radiance;
  for (std::size_t band = 0; band < 3; ++band)
    EXPECT_NEAR(static_cast<double>(b[band] / a[band]), 1.0, 1e-3)
        << "each is solved without the other; their depth is 8e-5";
}

}  // namespace
}  // namespace alpenglow::renderer
