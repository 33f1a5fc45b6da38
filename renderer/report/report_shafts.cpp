// SPDX-License-Identifier: MIT
#include "renderer/report/report_shafts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "renderer/illumination/aerial_perspective.h"
#include "renderer/report/reference_methods.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/visibility/shadow_heights.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {
namespace {

constexpr std::array<ReportRegime, 4> kSuns{{{"15", "Sun at 15°", SunRange{15.0, 15.0}},
                                             {"8", "Sun at 8°", SunRange{8.0, 8.0}},
                                             {"3", "Sun at 3°", SunRange{3.0, 3.0}},
                                             {"1", "Sun at 1°", SunRange{1.0, 1.0}}}};

/// Length of the longest relevant ray through the air [m].
constexpr double kLongest_m = 2000e3;

/// Terrain, and an eye 300 m above it.
struct ShaftPlace {
  Terrain terrain;
  double eye_height_m;
};

/// Returns ridges and saddles with a period of 10 km on a square of 40 km: quick to generate, for
/// tests.
ShaftPlace Waves() {
  constexpr std::uint32_t kSide = 81;
  constexpr float kExtent_m = 40e3F, kWave_m = 10e3F, kHeight_m = 900.0F;
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const auto at = [&](std::uint32_t k) {
        return kExtent_m * (static_cast<float>(k) / static_cast<float>(kSide - 1) - 0.5F);
      };
      const float phase = 2.0F * std::numbers::pi_v<float> / kWave_m;
      mesh.positions.push_back(
          {at(i), at(j),
           kHeight_m * (1.0F + std::sin(phase * at(i)) * std::cos(0.7F * phase * at(j)))});
      if (i + 1 == kSide || j + 1 == kSide) continue;
      const std::uint32_t corner = j * kSide + i;
      mesh.triangles.push_back({corner, corner + 1, corner + kSide});
      mesh.triangles.push_back({corner + 1, corner + kSide + 1, corner + kSide});
    }
  }
  mesh.normals.assign(mesh.positions.size(), {0.0F, 0.0F, 1.0F});  // unused
  return {Terrain(std::move(mesh)), static_cast<double>(kHeight_m) + 300.0};
}

ShaftPlace OverTheRange() {
  Scene scene;
  scene.place = {47.0, 11.0, 0.0};
  scene.medium = MediumPreset("earth");
  scene.camera.height = {300.0, true};
  SceneGround ground = LoadGround(scene);
  return {std::move(ground.terrain.value()), ground.eye_height_m};
}

/// A pixel of the picture under a sun, and the ray to the terrain there.
struct ShaftRay {
  std::size_t sun, pixel;
  ViewRay ray;
};
using ShaftStudy = ErrorStudy<ShaftRay>;

/// Objects that the methods of this topic share.
struct ShaftScene {
  ShaftPlace place;
  SingleScattering<float> air;
  MultipleScattering unused;
  AerialPerspective aerial;
  std::vector<ShaftView> views;  // by sun

  explicit ShaftScene(bool quick)
      : place(quick ? Waves() : OverTheRange()),
        air(MediumPreset("earth")),
        unused(air.medium(), {.altitudes = 4, .sun_angles = 4, .degree = 2, .max_orders = 1}),
        aerial(air, unused) {
    for (const ReportRegime& sun : kSuns)
      views.push_back(ViewWithSun(place.eye_height_m, 200.0, sun.sun->lowest_deg, quick ? 8 : 24,
                                  quick ? 5 : 14));
  }

  /// Returns single scattering by a march with `rays` occlusion rays.
  [[nodiscard]] Spectrum March(const ShaftRay& one, int rays, double offset = 0.5) const {
    return air.Inscatter(
        MarchWithOcclusion(air, views[one.sun], one.pixel, place.terrain, rays, offset),
        one.ray.nu);
  }
};

/// Returns the mean of eight marches with different steps.
std::vector<double> MeanOfMarches(const ShaftScene& scene, const ShaftRay& one, int rays) {
  Spectrum mean(scene.air.bands());
  for (int k = 0; k < 8; ++k) {
    const Spectrum light = scene.March(one, rays, (k + 0.5) / 8);
    for (std::size_t band = 0; band < light.size(); ++band) mean[band] += light[band] / 8.0F;
  }
  return ValuesOf(mean);
}

/// Solves all pixels. Errors are relative to the mean of the picture, by band.
void SolvePixels(ShaftStudy& study, const ShaftScene& scene, int rays) {
  const std::size_t pixels = scene.views.front().directions.size();
  study.SolveCases(pixels, [&](std::size_t r, std::size_t i) {
    const double length_m = LengthOf(scene.views[r], i, scene.place.terrain);
    const ShaftRay one{r, i, RayOf(scene.views[r], i, length_m)};
    return std::optional(ShaftStudy::Solved{one, {MeanOfMarches(scene, one, rays), {}, {}}});
  });
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    std::vector<double> mean(scene.air.bands());
    for (const ReferenceValue& pixel : study.references(r)) {
      for (std::size_t band = 0; band < mean.size(); ++band)
        mean[band] += pixel.value[band] / static_cast<double>(pixels);
    }
    for (ReferenceValue& pixel : study.references(r)) pixel.scale = mean;
  }
}

/// Adds Gauss panels on the lit stretches of rays. @param lit_under  function from a sun to an
/// object with the lit stretches under it.
template <typename LitUnder>
void AddPanels(ShaftStudy& study, const ShaftScene& scene, ReportRow row,
               const AerialPerspective::Nodes& nodes, const LitUnder& lit_under) {
  const auto path = [&](const ShaftRay& one) {
    const ShaftView& view = scene.views[one.sun];
    return lit_under(one.sun).Along(view.eye, view.directions[one.pixel],
                                    std::min(one.ray.length_m, kLongest_m));
  };
  study.Add(
      std::move(row),
      [&](const ShaftRay& one) {
        const SunlitPath sunlit = path(one);
        return scene.air.Inscatter(scene.aerial.Once(one.ray, &sunlit, nodes), one.ray.nu);
      },
      [&](const ShaftRay& one) {
        const SunlitPath sunlit = path(one);
        return scene.aerial.Sample(one.ray, &sunlit, nodes).samples.Nodes();
      });
}

void AddHeights(ShaftStudy& study, const ShaftScene& scene) {
  std::vector<ShadowHeights> heights;
  ReportRow row{.series = "shadow heights", .parameter = "", .in_summary = true};
  for (const ShaftView& view : scene.views) {
    auto [made, seconds] = Built(study.effort(), [&] {
      return ShadowHeights(scene.place.terrain.mesh(), view.to_sun, view.sun_radius_rad);
    });
    row.memory_bytes = std::max<std::uint64_t>(row.memory_bytes, made.bytes());
    row.build_s = std::max(row.build_s, seconds);
    heights.push_back(std::move(made));
  }
  const auto under = [&](std::size_t sun) -> const ShadowHeights& { return heights[sun]; };
  for (const int nodes : {0, 4, 8, 16}) {
    row.parameter = nodes == 0 ? "automatic nodes" : fmt::format("at most {} nodes", nodes);
    AddPanels(study, scene, row,
              nodes == 0 ? AerialPerspective::Nodes{} : AerialPerspective::Nodes{.sky = nodes},
              under);
  }
}

void AddProbes(ShaftStudy& study, const ShaftScene& scene, int probes) {
  std::vector<SunProbes> made;
  for (const ShaftView& view : scene.views)
    made.emplace_back(scene.place.terrain, view.to_sun, view.sun_radius_rad, probes);
  AddPanels(study, scene,
            {.series = "sun probes",
             .parameter = fmt::format("{} probes", probes),
             .in_summary = probes == 32},
            {}, [&](std::size_t sun) -> const SunProbes& { return made[sun]; });
}

void AddMarch(ShaftStudy& study, const ShaftScene& scene, int rays) {
  study.Add(
      {.series = "occlusion rays",
       .parameter = fmt::format("{} rays", rays),
       .origin = MethodOrigin::kLiterature,
       .in_summary = rays == 64 || rays == 512},
      [&](const ShaftRay& one) { return scene.March(one, rays); }, rays);
}

ReportTopic WordsOfShafts(bool quick) {
  return {
      .key = "shafts",
      .title = "Shafts: sunlight in air that terrain shades in part",
      .what =
          "A picture of the built-in range from 300 m over the ground, with the sun 20° beside "
          "its middle at four elevations. The methods compute, for every pixel, the radiance of "
          "sunlight that the air scatters once where the terrain does not shade it.",
      .error_unit = "fractions of the mean radiance of the picture",
      .notes =
          "Times include the search for the lit stretches of a ray and the light in them. They do "
          "not include the end of the ray at the terrain, except for the march, whose occlusion "
          "rays take a hundred times as long. The march samples the air at equal steps of a "
          "distance that is dense near the observer, each with a ray to a point of the sun's disk. "
          "This is the exact visibility that shadow maps approximate.",
      .wanted = 0.02,
      .answer = "pixel",
      .scene = quick ? "waves" : "built-in range",
      .regimes = {kSuns.begin(), kSuns.end()}};
}

}  // namespace

ReportTopic MeasureShafts(const ReportEffort& effort) {
  const ShaftScene scene(effort.quick);
  ReportEffort fewer = effort;
  fewer.passes = std::min<std::size_t>(effort.passes, 3);
  fewer.time_every = 4;
  const ErrorRule in_float{[](double value, double truth, double scale) {
                             return static_cast<double>(std::abs(static_cast<float>(value) -
                                                                 static_cast<float>(truth))) /
                                    scale;
                           },
                           false};
  ShaftStudy study(WordsOfShafts(effort.quick), fewer, in_float);
  const int rays = effort.quick ? 64 : 512;
  study.topic().medium = scene.air.medium();
  study.topic().reference.text =
      fmt::format("{} occlusion rays per pixel in eight marches of different steps", 8 * rays);
  SolvePixels(study, scene, rays);
  AddHeights(study, scene);
  for (const int probes : {8, 16, 32, 64}) AddProbes(study, scene, probes);
  for (const int marched : {16, 32, 64, 128, 256, 512}) AddMarch(study, scene, marched);
  study.Add({.series = "no shafts",
             .parameter = "",
             .origin = MethodOrigin::kLiterature,
             .in_summary = true},
            [&](const ShaftRay& one) {
              return scene.air.Inscatter(scene.aerial.Once(one.ray, nullptr, {}), one.ray.nu);
            });
  return std::move(study).Finished();
}

}  // namespace alpenglow::renderer
