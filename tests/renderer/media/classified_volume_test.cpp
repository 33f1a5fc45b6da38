// SPDX-License-Identifier: MIT
#include "renderer/media/classified_volume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/media/local_volume.h"
#include "renderer/media/media_march.h"
#include "renderer/media/volume_orders.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "renderer/surface/scene_ground.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

const std::vector<double> kShellBands_nm{450.0, 550.0, 650.0};
constexpr double kShellSide_m = 100.0;

/// Returns distances from the middle, torn by noise: -1 in the middle, about 1 at the faces.
std::shared_ptr<const VolumeGrid> DistanceGrid(int n, double noise) {
  std::vector<float> values;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const glm::dvec3 at = 2.0 * (glm::dvec3(x, y, z) + 0.5) / static_cast<double>(n) - 1.0;
        values.push_back(static_cast<float>(
            2.0 * glm::length(at) - 1.0 +
            noise * FractalNoise(3.0 * (at.x + 0.6 * at.z), 3.0 * (at.y - 0.7 * at.z), 3, 5U)));
      }
    }
  }
  return std::make_shared<const VolumeGrid>(std::array{n, n, n}, std::move(values),
                                            GridValues::kAny);
}

/// Returns shells with sharp edges: a hot core, a thin green shell and a wide pale one, with air
/// between them. Lengths between samples of a grid of 32 are 0.06 in the value.
std::vector<TransferNode> Shells(double scale) {
  return {{-0.70, 0.20 * scale, {0.6, 0.2, 0.1}, 1400.0},
          {-0.699, 0.0, {0.6, 0.2, 0.1}, 0.0},
          {-0.21, 0.0, {0.1, 0.9, 0.1}, 0.0},
          {-0.20, 0.30 * scale, {0.1, 0.9, 0.1}, 0.0},
          {-0.19, 0.0, {0.1, 0.9, 0.1}, 0.0},
          {0.30, 0.0, {0.9, 0.9, 0.95}, 0.0},
          {0.50, 0.03 * scale, {0.9, 0.9, 0.95}, 0.0},
          {0.60, 0.0, {0.9, 0.9, 0.95}, 0.0}};
}

std::shared_ptr<const ClassifiedVolume> Classified(
    std::shared_ptr<const VolumeGrid> grid, const std::vector<TransferNode>& nodes, double g = 0.4,
    ScatteringOrders orders = ScatteringOrders::kAll) {
  VolumePlacement placement;
  placement.bottom = {0.0, 0.0, -0.5 * kShellSide_m};
  placement.size_m = glm::dvec3(kShellSide_m);
  return std::make_shared<const ClassifiedVolume>(
      placement, std::move(grid), std::make_shared<const TransferFunction>(nodes, kShellBands_nm),
      tests::LobeOf(g), orders);
}

struct ShellRay {
  glm::dvec3 origin, direction;
};
std::vector<ShellRay> RaysThroughShells(int count) {
  std::vector<ShellRay> rays;
  for (int i = 0; i < count; ++i) {
    const double z = 2.0 * (i + 0.5) / count - 1.0, phi = 2.4 * i;
    const glm::dvec3 way{std::sqrt(1.0 - z * z) * std::cos(phi),
                         std::sqrt(1.0 - z * z) * std::sin(phi), z};
    const glm::dvec3 across = glm::normalize(glm::cross(way, glm::dvec3(0.3, 0.5, 0.8)));
    rays.push_back({2.3 * (i % 8) * across - 120.0 * way, way});
  }
  return rays;
}

/// The optics of a value, read from the nodes one by one.
struct PlainOptics {
  double extinction_per_m = 0.0;
  std::array<double, 3> albedo{}, emission_per_m{};
};
PlainOptics PlainOpticsOf(const std::vector<TransferNode>& nodes, double value) {
  const auto at = [&](const auto& of) {
    if (value <= nodes.front().value) return of(nodes.front());
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      if (value > nodes[i].value) continue;
      const double u = (value - nodes[i - 1].value) / (nodes[i].value - nodes[i - 1].value);
      return (1.0 - u) * of(nodes[i - 1]) + u * of(nodes[i]);
    }
    return of(nodes.back());
  };
  PlainOptics optics;
  optics.extinction_per_m = at([](const TransferNode& n) { return n.extinction_per_m; });
  const double kelvin = at([](const TransferNode& n) { return n.temperature_k; });
  for (std::size_t band = 0; band < 3; ++band) {
    optics.albedo[band] = at([band](const TransferNode& n) {
      return AlbedoFromLinearSrgb(n.albedo, kShellBands_nm)[band];
    });
    if (kelvin > 0.0)
      optics.emission_per_m[band] = optics.extinction_per_m * (1.0 - optics.albedo[band]) *
                                    BlackBodyRadiance(kShellBands_nm[band], kelvin);
  }
  return optics;
}

TEST(TransferFunction, IsLinearBetweenNodesAndConstantBeyond) {
  const std::vector<TransferNode> nodes{{-2.0, 1.0, {1.0, 1.0, 1.0}, 0.0},
                                        {1.0, 4.0, {0.5, 0.5, 0.5}, 1000.0},
                                        {1.5, 0.0, {0.0, 0.0, 0.0}, 2000.0}};
  const TransferFunction transfer(nodes, kShellBands_nm);
  for (const auto& [value, extinction] :
       {std::pair{-1e12, 1.0}, {-2.0, 1.0}, {-0.5, 2.5}, {1.0, 4.0}, {1.25, 2.0}, {9.0, 0.0}})
    EXPECT_NEAR(transfer.Extinction(value), extinction, 1e-12) << value;
  EXPECT_NEAR(transfer.ColourOf(1.25).albedo[1], 0.25, 1e-12) << "greys are flat";
  EXPECT_NEAR(transfer.ColourOf(1.25).emission[1] / (0.75 * BlackBodyRadiance(550.0, 1500.0)), 1.0,
              1e-12)
      << "Kirchhoff's law";
  EXPECT_EQ(transfer.ColourOf(-3.0).emission[1], 0.0);
  EXPECT_EQ(transfer.LargestExtinction(-5.0, 5.0), 4.0);
  EXPECT_NEAR(transfer.LargestExtinction(1.1, 1.4), 3.2, 1e-12);
  EXPECT_TRUE(transfer.IsLinear(-2.0, 1.0));
  EXPECT_FALSE(transfer.IsLinear(-2.1, 0.0));
  EXPECT_TRUE(transfer.IsLinear(1.5, 7.0));
}

TEST(TransferFunction, CutsCubicsAtAllNodes) {
  // The values fall from 1 to -0.35, rise to 0.35 and fall to -1: three crossings of 0.
  const CubicPiece wave{0.0, 1.0, {1.0, -2.5, 2.5, -1.0}};
  const TransferFunction transfer({{0.0, 0.0}, {1e-7, 1.0}}, kShellBands_nm);
  const std::vector<double> at = transfer.Crossings(wave);
  ASSERT_EQ(at.size(), 8U) << "both nodes are crossed three times";
  for (std::size_t i = 1; i + 1 < at.size(); ++i)
    EXPECT_LT(std::min(std::abs(wave.At(at[i])), std::abs(wave.At(at[i]) - 1e-7)), 1e-13);
  EXPECT_NEAR(transfer.Integral(wave), 0.5, 1e-6) << "half of the wave is above 0";
  const CubicPiece line{2.0, 4.0, {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}};
  EXPECT_NEAR(transfer.Integral(line), 2.0 - 1e-7, 1e-12) << "the ramp is 1e-7 wide";
}

TEST(ClassifiedVolume, ColumnIsTheIntegralOfItsExtinction) {
  const auto grid = DistanceGrid(32, 0.4);
  const std::vector<TransferNode> nodes = Shells(1.0);
  const auto volume = Classified(grid, nodes);
  const double per_m = volume->optics().extinction_per_m[0];
  EXPECT_EQ(per_m, 0.3);
  const int steps = tests::ScaledDown(60000, 10000);
  for (const ShellRay& ray : RaysThroughShells(tests::ScaledDown(12, 4))) {
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
      const glm::dvec3 point = ray.origin + 240.0 * (i + 0.5) / steps * ray.direction;
      if (volume->Contains(point))
        sum += PlainOpticsOf(nodes, grid->At(volume->UnitFromFrame(point))).extinction_per_m;
    }
    EXPECT_NEAR(per_m * volume->Column(ray.origin, ray.direction, 1e4), sum * 240.0 / steps,
                30.0 * 0.3 * 240.0 / steps)
        << "midpoint sums are wrong by half a step at up to 60 edges";
  }
}

TEST(ClassifiedVolume, ColumnAddsUpFromItsParts) {
  const auto volume = Classified(DistanceGrid(32, 0.4), Shells(1.0));
  for (const ShellRay& ray : RaysThroughShells(16)) {
    const double whole = volume->Column(ray.origin, ray.direction, 170.0);
    const double parts =
        volume->Column(ray.origin, ray.direction, 101.7) +
        volume->Column(ray.origin + 101.7 * ray.direction, ray.direction, 170.0 - 101.7);
    EXPECT_NEAR(parts, whole, 1e-10 * (whole + 1.0));
  }
}

TEST(ClassifiedVolume, PiecesContainAllExtinctionAndBoundIt) {
  const auto volume = Classified(DistanceGrid(32, 0.4), Shells(1.0));
  for (const ShellRay& ray : RaysThroughShells(16)) {
    const auto pieces = volume->PiecesAlong(ray.origin, ray.direction, 240.0);
    for (std::size_t i = 1; i < pieces.size(); ++i)
      EXPECT_LE(pieces[i - 1].end_m, pieces[i].begin_m);
    for (int i = 0; i < 20000; ++i) {
      const double t = 240.0 * (i + 0.5) / 20000;
      double bound = 0.0;
      for (const DensePiece& piece : pieces) {
        if (piece.begin_m <= t && t <= piece.end_m) bound = std::max(bound, piece.largest);
      }
      EXPECT_LE(volume->DensityAt(ray.origin + t * ray.direction), bound + 1e-9)
          << "an edge is found to 1e-12 of a piece and rises within 1e-3 of the value";
    }
  }
}

const glm::dvec3 kSunOverShells = glm::normalize(glm::dvec3(0.7, 0.3, 0.6));
constexpr double kShellPhase = 0.25 / kPi;

/// Light by short steps: emission, and sunlight of unit irradiance scattered once and evenly.
SpectrumOf<double> SteppedShells(const ClassifiedVolume& volume, const VolumeGrid& grid,
                                 const std::vector<TransferNode>& nodes, const ShellRay& ray,
                                 int steps) {
  SpectrumOf<double> light(3);
  const double step_m = 240.0 / steps;
  double depth = 0.0;
  for (int i = 0; i < steps; ++i) {
    const glm::dvec3 point = ray.origin + (i + 0.5) * step_m * ray.direction;
    if (!volume.Contains(point)) continue;
    const PlainOptics here = PlainOpticsOf(nodes, grid.At(volume.UnitFromFrame(point)));
    if (here.extinction_per_m == 0.0) continue;
    const double to_sun =
        volume.optics().extinction_per_m[0] * volume.Column(point, kSunOverShells, 1e4);
    const double left = std::exp(-depth - 0.5 * here.extinction_per_m * step_m) * step_m;
    for (std::size_t band = 0; band < 3; ++band) {
      light[band] += left * (here.emission_per_m[band] + here.extinction_per_m * here.albedo[band] *
                                                             kShellPhase * std::exp(-to_sun));
    }
    depth += here.extinction_per_m * step_m;
  }
  return light;
}

TEST(ClassifiedVolume, MarchedLightIsThatOfManySmallSteps) {
  const auto grid = DistanceGrid(32, 0.4);
  const std::vector<TransferNode> nodes = Shells(1.0);
  const auto volume = Classified(grid, nodes);
  const LocalMedia media({volume}, 3);
  const auto source = [&](double, const glm::dvec3& point, std::span<const double> densities,
                          std::span<const double>) {
    const BodyColour colour = *volume->ColourAt(point);
    const double sun = kShellPhase * std::exp(-volume->optics().extinction_per_m[0] *
                                              volume->Column(point, kSunOverShells, 1e4));
    Spectrum light(3);
    for (std::size_t band = 0; band < 3; ++band)
      light[band] = static_cast<float>(
          densities[0] * (colour.emission_per_m[band] + colour.scattering_per_m[band] * sun));
    return light;
  };
  for (const ShellRay& ray : RaysThroughShells(tests::ScaledDown(12, 2))) {
    const MarchedLight marched = MarchMedia(media, ray.origin, ray.direction, 1e4, source);
    const SpectrumOf<double> exact =
        SteppedShells(*volume, *grid, nodes, ray, tests::ScaledDown(20000, 5000));
    for (std::size_t band = 0; band < 3; ++band)
      EXPECT_NEAR(static_cast<double>(marched.radiance[band]) / exact[band], 1.0,
                  tests::ScaledDown(0.005, 0.02))
          << "twice the tolerance of the march; steps of 1.2 cm miss 0.1 % of a shell's edges";
  }
}

/// Returns unit radiance from all directions.
VolumeIllumination UniformSkyOnShells(bool emits) {
  return {.to_sun = kSunOverShells,
          .has_sun = false,
          .sky = [](const glm::dvec3&) { return Spectrum(3, 1.0F); },
          .lamps = nullptr,
          .emits = emits};
}

/// Returns light of all orders along a ray, with the albedo of points as LitVolume has it.
MarchedLight AllOrders(const std::shared_ptr<const ClassifiedVolume>& volume,
                       const VolumeOrders& orders, const ShellRay& ray,
                       Spectrum VolumeOrders::Scattered::*part) {
  const VolumeOrders::Look look = orders.LookAlong(ray.origin, ray.direction);
  const auto source = [&](double, const glm::dvec3& point, std::span<const double> densities,
                          std::span<const double> columns_m) {
    const double to_sun_m = volume->Column(point, kSunOverShells, 1e4);
    Spectrum light = orders.At({point, to_sun_m, columns_m[0]}, look).*part;
    const BodyColour colour = *volume->ColourAt(point);
    for (std::size_t band = 0; band < 3; ++band)
      light[band] *= static_cast<float>(densities[0] * orders.extinction_per_m()[band] *
                                        colour.scattering_per_m[band] /
                                        volume->optics().scattering_per_m[band]);
    return light;
  };
  return MarchMedia(LocalMedia({volume}, 3), ray.origin, ray.direction, 1e4, source,
                    kMarchTolerance, {}, std::vector{orders.extinction_per_m()});
}

TEST(ClassifiedVolume, WhiteShellsInUniformLightAreInvisible) {
  std::vector<TransferNode> nodes = Shells(1.0);
  for (TransferNode& node : nodes) node.albedo = {1.0, 1.0, 1.0};
  const auto volume = Classified(DistanceGrid(32, 0.4), nodes);
  const VolumeOrders orders(*volume, UniformSkyOnShells(false),
                            tests::ScaledDown(VolumeOrders::kMostCells, 4096.0));
  for (const ShellRay& ray : RaysThroughShells(tests::ScaledDown(12, 4))) {
    const MarchedLight light = AllOrders(volume, orders, ray, &VolumeOrders::Scattered::sky);
    for (std::size_t band = 0; band < 3; ++band)
      EXPECT_NEAR(static_cast<double>(light.radiance[band] + light.transmittance[band]), 1.0, 0.01)
          << "the residual of the solution is 0.5 % of the light that enters";
  }
}

/// Returns a direction around an axis with the distribution of Henyey and Greenstein.
glm::dvec3 ScatteredWay(const glm::dvec3& way, double g, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * uniform(random));
  const double cosine = std::clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
  const double sine = std::sqrt(1.0 - cosine * cosine), phi = 2.0 * kPi * uniform(random);
  const glm::dvec3 helper = std::abs(way.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, way)), y = glm::cross(way, x);
  return glm::normalize(cosine * way + sine * (std::cos(phi) * x + std::sin(phi) * y));
}

/// Traces sunlight of unit irradiance through all orders, with the albedo of each point.
SpectrumOf<double> TracedShells(const ClassifiedVolume& volume, double g, const ShellRay& ray,
                                int paths) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  const double most_per_m = volume.optics().extinction_per_m[0];
  SpectrumOf<double> sum(3);
  for (int path = 0; path < paths; ++path) {
    glm::dvec3 point = ray.origin, way = ray.direction;
    SpectrumOf<double> weight(3, 1.0 / paths);
    for (int order = 0; order < 200; ++order) {
      const auto span = volume.SpanAlong(point, way, std::numeric_limits<double>::infinity());
      if (!span) break;
      double t = span->begin_m;
      do {  // Woodcock et al. (1965)
        t -= std::log1p(-uniform(random)) / most_per_m;
      } while (t < span->end_m && uniform(random) >= volume.DensityAt(point + t * way));
      if (t >= span->end_m) break;
      point += t * way;
      const double sun = Phase(tests::LobeOf(g), glm::dot(way, kSunOverShells)) *
                         std::exp(-most_per_m * volume.Column(point, kSunOverShells, 1e4));
      weight = weight * ((1.0 / most_per_m) * volume.ColourAt(point)->scattering_per_m);
      sum = sum + sun * weight;
      way = ScatteredWay(way, g, random);
    }
  }
  return sum;
}

/// Returns the root mean square of the errors of sunlight, relative to its mean over rays.
double ErrorOfShells(const std::vector<TransferNode>& nodes, double g) {
  const auto volume = Classified(DistanceGrid(32, 0.4), nodes, g);
  const VolumeOrders orders(
      *volume,
      {.to_sun = kSunOverShells, .has_sun = true, .sky = nullptr, .lamps = nullptr, .emits = false},
      tests::ScaledDown(VolumeOrders::kMostCells, 4096.0));
  double squares = 0.0, sum = 0.0;
  const std::vector<ShellRay> rays = RaysThroughShells(tests::ScaledDown(16, 4));
  for (const ShellRay& ray : rays) {
    const SpectrumOf<double> exact = TracedShells(*volume, g, ray, tests::ScaledDown(2000, 400));
    const MarchedLight fast = AllOrders(volume, orders, ray, &VolumeOrders::Scattered::sun);
    for (std::size_t band = 0; band < 3; ++band) {
      squares += std::pow(static_cast<double>(fast.radiance[band]) - exact[band], 2.0);
      sum += exact[band];
    }
  }
  const double count = 3.0 * static_cast<double>(rays.size());
  return std::sqrt(squares / count) / (sum / count);
}

/// Returns a core and a shell around it of other albedos.
std::vector<TransferNode> CoreAndShell(double core, double shell) {
  const auto grey = [](double albedo) { return std::array{albedo, albedo, albedo}; };
  return {{-0.2, 0.10, grey(core)},
          {-0.19, 0.10, grey(shell)},
          {0.4, 0.10, grey(shell)},
          {0.45, 0.0, grey(shell)}};
}

TEST(ClassifiedVolume, ShellsHaveTheLightOfTracedPaths) {
  // The coarse cells and few paths of the small case are further from the truth.
  const double more = tests::ScaledDown(1.0, 2.0);
  EXPECT_LT(ErrorOfShells(CoreAndShell(0.9, 0.9), 0.4), more * 0.06) << "of one albedo";
  EXPECT_LT(ErrorOfShells(CoreAndShell(0.3, 0.95), 0.4), more * 0.15);
  EXPECT_LT(ErrorOfShells(CoreAndShell(0.95, 0.3), 0.4), more * 0.2);
}

class ClassifiedFile : public TemporaryFolder {};

TEST_F(ClassifiedFile, GridsOfScenesAreClassified) {
  const std::array<float, 8> values{-3.0F, 5.0F, 1.0F, 2.0F, -3.0F, 5.0F, 1.0F, 2.0F};
  WriteText(folder_ / "scan.raw",
            {reinterpret_cast<const char*>(values.data()), sizeof(float) * values.size()});
  Scene scene = QuickScene(50.0, 0.0, 0.0, 40.0);
  Volume& volume = scene.volumes.emplace_back();
  volume.place = scene.place;
  volume.height = {0.0, false};
  volume.size_m = {10.0, 10.0, 10.0};
  volume.grid = folder_ / "scan.raw";
  volume.grid_size = {2, 2, 2};
  const SceneGround ground = LoadGround(scene);
  EXPECT_THAT(tests::FaultOf([&] { return VolumesOf(scene, ground, scene.medium); }),
              testing::HasSubstr("scan.raw: value 0 of the grid is -3; densities must be"));
  volume.transfer = {{-3.0, 0.0}, {5.0, 0.4}};
  const MediaList media = VolumesOf(scene, ground, scene.medium);
  ASSERT_EQ(media.size(), 1U);
  const auto& made = dynamic_cast<const ClassifiedVolume&>(*media.front());
  EXPECT_EQ(made.optics().extinction_per_m[0], 0.4);
  // The middle of the grid is the mean of its values, 1.25.
  EXPECT_NEAR(0.4 * made.DensityAt(made.Middle()), 0.4 * 4.25 / 8.0, 1e-9);
  volume.transfer = {{6.0, 0.0}, {7.0, 0.4}};
  EXPECT_TRUE(VolumesOf(scene, ground, scene.medium).empty()) << "no value has extinction";
}

TEST(ClassifiedVolume, WithoutExtinctionIsVoid) {
  std::vector<TransferNode> nodes = Shells(1.0);
  for (TransferNode& node : nodes) node.extinction_per_m = 0.0;
  const auto volume = Classified(DistanceGrid(8, 0.0), nodes);
  EXPECT_TRUE(volume->IsVoid());
  EXPECT_EQ(volume->DensityAt(volume->Middle()), 0.0);
  EXPECT_TRUE(volume->PiecesAlong({-99.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1e3).empty());
}

TEST(ClassifiedVolume, ALinearFunctionOfDensityIsALocalVolume) {
  std::vector<float> values;
  for (int i = 0; i < 12 * 12 * 12; ++i)
    values.push_back(static_cast<float>(std::max(GradientNoise(0.3 * i, 0.01 * i, 3U), 0.0)));
  const auto grid = std::make_shared<const VolumeGrid>(std::array{12, 12, 12}, std::move(values));
  const auto classified =
      Classified(grid, {{0.0, 0.0, {0.5, 0.5, 0.5}}, {2.0, 0.4, {0.5, 0.5, 0.5}}});
  const LocalVolume volume(classified->placement(), std::nullopt, grid);
  const double per_m = classified->optics().extinction_per_m[0];
  EXPECT_NEAR(classified->optics().scattering_per_m[0] / per_m, 0.5, 1e-12);
  for (const ShellRay& ray : RaysThroughShells(16)) {
    const double column = volume.Column(ray.origin, ray.direction, 1e4);
    EXPECT_NEAR(per_m * classified->Column(ray.origin, ray.direction, 1e4), 0.2 * column,
                1e-10 * column);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
