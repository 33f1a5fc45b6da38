// SPDX-License-Identifier: MIT
// Measures the topic of the report about single scattering in air that terrain shades in part.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include "lut/cli/program.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/report/occlusion_march.h"
#include "renderer/report/report.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/visibility/shadow_heights.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {
namespace {

// Line styles of the plot.
enum ShaftStyle { kHeights = 0, kMarch = 1, kProbes = 2, kUnbroken = 5 };

constexpr std::array<ReportRegime, 4> kSuns{{{"15", "Sun at 15°", SunRange{15.0, 15.0}},
                                             {"8", "Sun at 8°", SunRange{8.0, 8.0}},
                                             {"3", "Sun at 3°", SunRange{3.0, 3.0}},
                                             {"1", "Sun at 1°", SunRange{1.0, 1.0}}}};

/// Length of the longest relevant ray through the air [m].
constexpr double kLongest_m = 2000e3;

/// The picture under one sun, with the reference solution's answers.
struct ReferenceView {
  ShaftView view;
  std::vector<double> length_m;
  std::vector<Bands<float>> truth;
  std::vector<double> mean;  // of the picture, by band; errors are relative to it
};

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
  scene.place = PlaceFromDegrees(47.0, 11.0, 0.0);
  scene.medium = MediumPreset("earth");
  scene.camera.height = {300.0, true};
  SceneGround ground = LoadGround(scene);
  return {std::move(ground.terrain.value()), ground.eye_height_m};
}

class ShaftTopic {
 public:
  explicit ShaftTopic(const ReportEffort& effort)
      : effort_(effort),
        ground_(effort.quick ? Waves() : OverTheRange()),
        air_(MediumPreset("earth")),
        multiple_scattering_(air_.medium(),
                             {.altitudes = 4, .sun_angles = 4, .degree = 2, .max_orders = 1}),
        aerial_(air_, multiple_scattering_) {
    for (const ReportRegime& sun : kSuns) SolveReference(sun.sun->lowest_deg);
    topic_.reference.time_s = reference_s_ / static_cast<double>(kSuns.size() * Pixels());
  }

  void AddHeights(const std::string& parameter, const AerialPerspective::Nodes& nodes) {
    ReportRow row = Row("shadow heights", parameter, MethodOrigin::kOurs, kHeights);
    row.in_summary = true;
    for (std::size_t r = 0; r < views_.size(); ++r) {
      row.memory_bytes = std::max<std::uint64_t>(row.memory_bytes, heights_[r].bytes());
      row.build_s = std::max(row.build_s, sweep_s_[r]);
      AddPanels(heights_[r], nodes, r, row);
    }
    topic_.rows.push_back(std::move(row));
  }

  void AddProbes(int probes) {
    ReportRow row =
        Row("sun probes", fmt::format("{} probes", probes), MethodOrigin::kOurs, kProbes);
    row.in_summary = probes == 32;
    for (std::size_t r = 0; r < views_.size(); ++r) {
      const ShaftView& view = views_[r].view;
      const SunProbes along(ground_.terrain, view.to_sun, view.sun_radius_rad, probes);
      AddPanels(along, {}, r, row);
    }
    topic_.rows.push_back(std::move(row));
  }

  void AddMarch(int rays) {
    ReportRow row =
        Row("occlusion rays", fmt::format("{} rays", rays), MethodOrigin::kLiterature, kMarch);
    row.in_summary = rays == 64 || rays == 512;
    for (std::size_t r = 0; r < views_.size(); ++r) {
      Measure(r, row, [&](std::size_t i) {
        return MarchWithOcclusion(air_, views_[r].view, i, ground_.terrain, rays);
      });
      row.at[r].samples = rays;
    }
    topic_.rows.push_back(std::move(row));
  }

  void AddUnbroken() {
    ReportRow row = Row("no shafts", "", MethodOrigin::kLiterature, kUnbroken);
    row.in_summary = true;
    for (std::size_t r = 0; r < views_.size(); ++r) {
      Measure(r, row, [&](std::size_t i) { return aerial_.Once(Ray(r, i), nullptr, {}); });
    }
    topic_.rows.push_back(std::move(row));
  }

  [[nodiscard]] std::size_t Pixels() const { return views_.front().view.directions.size(); }

  [[nodiscard]] ReportTopic Finished() && {
    topic_.key = "shafts";
    topic_.title = "Shafts: sunlight that terrain lets into the air";
    topic_.what =
        "A picture of the built-in range from 300 m over the ground, the sun 20° beside its "
        "middle at four heights; the question is, for every pixel, the radiance of sunlight that "
        "the air scatters once where the terrain does not shade it.";
    topic_.error_unit = "parts of the mean radiance of the picture";
    topic_.notes =
        "Times are those of finding the lit stretches of a ray and of the light in them; "
        "ending the ray at the terrain is not counted, but for the march, whose occlusion rays "
        "cost a hundred times as much. The march looks at the air at equal steps of a distance "
        "that is dense near the eye, each with a ray to a point of the sun's disk: the exact "
        "visibility that shadow maps approximate.";
    topic_.wanted = 0.02;
    topic_.answer = "pixel";
    topic_.scene = effort_.quick ? "waves" : "built-in range";
    topic_.regimes.assign(kSuns.begin(), kSuns.end());
    topic_.medium = air_.medium();
    topic_.rays = Pixels();
    topic_.reference.text = fmt::format(
        "{} occlusion rays a pixel in eight marches of different steps", 8 * MarchRays());
    topic_.reference.noise.assign(kSuns.size(), 0.0);
    return std::move(topic_);
  }

 private:
  [[nodiscard]] int MarchRays() const { return effort_.quick ? 64 : 512; }

  void SolveReference(double sun_deg) {
    ReferenceView solution{effort_.quick
                               ? ViewWithSun(ground_.eye_height_m, 200.0, sun_deg, 8, 5)
                               : ViewWithSun(ground_.eye_height_m, 200.0, sun_deg, 24, 14),
                           {},
                           {},
                           std::vector<double>(air_.bands())};
    const std::size_t pixels = solution.view.directions.size();
    solution.truth.assign(pixels, Bands<float>(air_.bands()));
    solution.length_m.resize(pixels);
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(std::size_t{0}, pixels, [&](std::size_t i) {
      if (Interrupted()) return;
      solution.length_m[i] = LengthOf(solution.view, i, ground_.terrain);
      const double nu = RayOf(solution.view, i, solution.length_m[i]).nu;
      for (int k = 0; k < 8; ++k) {
        const Bands<float> light = air_.Inscatter(
            MarchWithOcclusion(air_, solution.view, i, ground_.terrain, MarchRays(), (k + 0.5) / 8),
            nu);
        for (std::size_t band = 0; band < light.count; ++band)
          solution.truth[i][band] += light[band] / 8.0F;
      }
    });
    ThrowIfInterrupted();
    reference_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (const Bands<float>& pixel : solution.truth) {
      for (std::size_t band = 0; band < pixel.count; ++band)
        solution.mean[band] += static_cast<double>(pixel[band]) / static_cast<double>(pixels);
    }
    auto [heights, seconds] = Built([&] {
      return ShadowHeights(ground_.terrain.mesh(), solution.view.to_sun,
                           solution.view.sun_radius_rad);
    });
    heights_.push_back(std::move(heights));
    sweep_s_.push_back(seconds);
    views_.push_back(std::move(solution));
  }

  [[nodiscard]] static ReportRow Row(const std::string& series, const std::string& parameter,
                                     MethodOrigin origin, int style) {
    ReportRow row{.series = series, .parameter = parameter, .origin = origin, .style = style};
    row.at.resize(kSuns.size());
    return row;
  }

  [[nodiscard]] ViewRay Ray(std::size_t r, std::size_t i) const {
    return RayOf(views_[r].view, i, views_[r].length_m[i]);
  }

  /// Adds Gauss panels on the lit stretches that `lit` finds.
  template <typename Lit>
  void AddPanels(const Lit& lit, const AerialPerspective::Nodes& nodes, std::size_t r,
                 ReportRow& row) {
    const auto path = [&](std::size_t i) {
      return lit.Along(views_[r].view.eye, views_[r].view.directions[i],
                       std::min(Ray(r, i).length_m, kLongest_m));
    };
    Measure(r, row, [&](std::size_t i) {
      const SunlitPath sunlit = path(i);
      return aerial_.Once(Ray(r, i), &sunlit, nodes);
    });
    double points = 0.0;
    for (std::size_t i = 0; i < Pixels(); ++i) {
      const SunlitPath sunlit = path(i);
      points += static_cast<double>(aerial_.Sample(Ray(r, i), &sunlit, nodes).samples.Nodes());
    }
    row.at[r].samples = points / static_cast<double>(Pixels());
  }

  /// Measures the error on every pixel, and the time on every fourth.
  template <typename Scatter>
  void Measure(std::size_t r, ReportRow& row, const Scatter& scatter) {
    const ReferenceView& solution = views_[r];
    const auto answer = [&](std::size_t i) { return air_.Inscatter(scatter(i), Ray(r, i).nu); };
    std::vector<Bands<float>> answers(Pixels(), Bands<float>(air_.bands()));
    tbb::parallel_for(std::size_t{0}, Pixels(), [&](std::size_t i) { answers[i] = answer(i); });
    std::vector<double> errors;
    for (std::size_t i = 0; i < Pixels(); ++i) {
      for (std::size_t band = 0; band < air_.bands(); ++band) {
        errors.push_back(static_cast<double>(std::abs(answers[i][band] - solution.truth[i][band])) /
                         solution.mean[band]);
      }
    }
    row.at[r].error = StatisticsOfErrors(std::move(errors), 0.0);
    ReportEffort effort = effort_;
    effort.passes = 3;
    TimePasses((Pixels() + 3) / 4, effort,
               [&] {
                 float sum = 0.0F;
                 for (std::size_t i = 0; i < Pixels(); i += 4) sum += answer(i)[0];
                 return sum;
               },
               row.at[r]);
    ThrowIfInterrupted();
  }

  const ReportEffort& effort_;
  ShaftPlace ground_;
  SingleScattering<float> air_;
  MultipleScattering multiple_scattering_;  // unused
  AerialPerspective aerial_;
  std::vector<ReferenceView> views_;
  std::vector<ShadowHeights> heights_;  // one for each view
  std::vector<double> sweep_s_;         // time to build `heights_`
  double reference_s_ = 0.0;
  ReportTopic topic_;
};

}  // namespace

ReportTopic MeasureShafts(const ReportEffort& effort) {
  ShaftTopic topic(effort);
  topic.AddHeights("automatic nodes", {});
  topic.AddHeights("at most 4 nodes", {.sky = 4});
  topic.AddHeights("at most 8 nodes", {.sky = 8});
  topic.AddHeights("at most 16 nodes", {.sky = 16});
  for (const int probes : {8, 16, 32, 64}) topic.AddProbes(probes);
  for (const int rays : {16, 32, 64, 128, 256, 512}) topic.AddMarch(rays);
  topic.AddUnbroken();
  return std::move(topic).Finished();
}

}  // namespace alpenglow::renderer
