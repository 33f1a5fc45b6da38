// SPDX-License-Identifier: MIT
#include "renderer/report/report_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/lamps/lamp_light.h"
#include "renderer/report/reference_methods.h"
#include "renderer/report/report_pictures.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kKinds = 5;
constexpr std::array<ReportRegime, kKinds> kFogs{{{"isotropic", "Homogeneous, isotropic", {}},
                                                  {"droplets", "Homogeneous, g 0.8", {}},
                                                  {"height-fog", "Height fog, H 30 m", {}},
                                                  {"beam", "Beam in height fog", {}},
                                                  {"through", "Ray through the lamp", {}}}};
const std::array<LampTestKind, kKinds>& Kinds() {
  static const std::array<LampTestKind, kKinds> kinds{
      {{.g = 0.0},
       {.g = 0.8},
       {.g = 0.8, .scale_height_m = 30.0, .clear_air = true},
       {.g = 0.8, .scale_height_m = 30.0, .beam = true, .clear_air = true},
       {.g = 0.8, .scale_height_m = 30.0, .through = true, .clear_air = true}}};
  return kinds;
}

using LampStudy = ErrorStudy<LampTestCase>;

void AddPanels(LampStudy& study, int nodes) {
  study.Add(
      {.series = "panels around the light",
       .parameter = fmt::format("{} nodes", nodes),
       .in_summary = nodes == 12 || nodes == 16},
      [&](const LampTestCase& work) {
        return Airlight(work.air, work.lamp, work.segment, nodes)[0];
      },
      [&](const LampTestCase& work) {
        const AirlightEffort effort = EffortOfAirlight(work.air, work.lamp, work.segment, nodes);
        return effort.scouted + effort.integrated;
      });
}

void AddRule(LampStudy& study, const std::string& series, LampRule rule,
             std::initializer_list<int> points) {
  for (const int nodes : points) {
    study.Add(
        {.series = series,
         .parameter = fmt::format("{} points", nodes),
         .origin = MethodOrigin::kLiterature,
         .in_summary = nodes == 64},
        [&](const LampTestCase& work) { return AirlightByRule(rule, work, nodes); }, nodes);
  }
}

/// Adds the closed form for isotropic scattering in homogeneous air, the only case that it covers.
void AddSun(LampStudy& study) {
  ReportRow row{.series = "Sun et al. (2005)",
                .parameter = "",
                .origin = MethodOrigin::kLiterature,
                .in_summary = true};
  row.at.resize(kKinds);
  study.Measure(0, row.at[0], [](const LampTestCase& work) {
    const glm::dvec3 to_lamp = work.lamp.position_m - work.segment.origin_m;
    const double along = glm::dot(to_lamp, work.segment.direction);
    const LampLayer& layer = work.air.layers[0];
    return AirlightOfSun2005(layer.scattering_per_m[0], layer.extinction_per_m[0],
                             work.segment.end_m, along,
                             glm::length(to_lamp - along * work.segment.direction));
  });
  study.AddMeasured(std::move(row));
}

ReportTopic WordsOfAirlight() {
  ReportTopic topic{
      .key = "airlight",
      .title = "A lamp in fog: light of one lamp that the air scatters towards the observer",
      .what =
          "Lamps 0.1 to 100 m beside rays of 10 to 1000 m, or behind them, in fog of extinction "
          "1e-4 to 0.1 per metre. The fog is homogeneous, or has a scale height of 30 m and lies "
          "under clear air. The methods compute the radiance that the fog along the ray scatters "
          "once.",
      .error_unit = "fractions of the radiance, however faint it is",
      .notes =
          "Samples of this library's rule include the points that only locate the light. The "
          "closed form of Sun et al. (2005) is for isotropic, homogeneous fog; here its function F "
          "is evaluated by quadrature to 1e-11, not by the authors' table, which is faster. The "
          "equi-angular rule of Kulla and Fajardo (2012) uses the middles of its strata, without "
          "noise.",
      .wanted = 1e-3,
      .everywhere = "in every fog",
      .scene = "fog",
      .regimes = {kFogs.begin(), kFogs.end()}};
  topic.medium.name.clear();
  topic.medium.wavelengths_nm = {550.0};
  topic.reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error below 1e-9";
  return topic;
}

constexpr std::array<ReportRegime, 4> kCounts{{{"1", "1 lamp", {}},
                                               {"10", "10 lamps", {}},
                                               {"100", "100 lamps", {}},
                                               {"1000", "1000 lamps", {}}}};
constexpr std::array<int, 4> kLampCounts{1, 10, 100, 1000};

/// The parts of a scene that the lamp light of a picture needs, without its sky.
struct RunwayStage {
  explicit RunwayStage(const Scene& of)
      : scene(of),
        ground(LoadGround(scene)),
        medium(OnOsculatingSphere(scene.medium, scene.place.latitude_rad())),
        colour(medium.wavelengths_nm) {}

  Scene scene;
  SceneGround ground;
  Medium medium;
  BandColour colour;
};

struct Pixel {
  int x, y;
};
using PixelStudy = ErrorStudy<Pixel>;

/// The scenes of all columns, and their lamps.
class Runways {
 public:
  static constexpr int kWidth = 160, kHeight = 90;

  Runways(std::size_t counts, const ReportEffort& effort) {
    for (std::size_t r = 0; r < counts; ++r) {
      stages_.push_back(std::make_unique<RunwayStage>(RunwayScene(kLampCounts[r], false)));
      const RunwayStage& stage = *stages_.back();
      auto [light, seconds] = Built(effort, [&] {
        return std::make_unique<LampLight>(stage.scene, stage.ground, stage.medium, stage.colour);
      });
      light_.push_back(std::move(light));
      tree_s_ = seconds;
    }
  }

  [[nodiscard]] const Medium& medium() const { return stages_.front()->medium; }
  [[nodiscard]] const LampLight& Light(std::size_t r) const { return *light_[r]; }
  [[nodiscard]] double tree_s() const { return tree_s_; }  // time to build the last tree
  [[nodiscard]] CameraRays CameraOf(std::size_t r) const {
    return {stages_[r]->scene.camera, kWidth, kHeight};
  }
  /// Returns the distance to the level ground below the eye [m]; infinite for rays that do not
  /// descend.
  [[nodiscard]] double LengthOf(const glm::dvec3& direction) const {
    return direction.z < 0.0 ? stages_.back()->ground.eye_height_m / -direction.z
                             : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] LampRayEnd RayEnd(std::size_t r, const Pixel& pixel) const {
    const glm::dvec3 direction = CameraOf(r).Direction(pixel.x + 0.5, pixel.y + 0.5);
    return {direction, LengthOf(direction)};
  }
  /// Returns a function from a pixel to the light of all lamps, each with `nodes` nodes.
  [[nodiscard]] auto AllLamps(std::size_t r, int nodes) const {
    return [this, r, nodes, all = light_[r]->All(),
            angle = CameraOf(r).PixelAngle()](const Pixel& pixel) {
      return light_[r]->InAir(all, RayEnd(r, pixel), angle, nodes);
    };
  }

 private:
  std::vector<std::unique_ptr<RunwayStage>> stages_;  // owns the grounds that lamps refer to
  std::vector<std::unique_ptr<LampLight>> light_;
  double tree_s_ = 0.0;
};

void SolvePixels(PixelStudy& study, const Runways& runways, int nodes) {
  const bool quick = study.effort().quick;
  std::vector<Pixel> pixels;
  for (int y = 1; y < Runways::kHeight; y += quick ? 22 : 4) {
    for (int x = 1; x < Runways::kWidth; x += quick ? 40 : 6) pixels.push_back({x, y});
  }
  std::vector<decltype(runways.AllLamps(0, nodes))> truth;
  for (std::size_t r = 0; r < study.regimes(); ++r) truth.push_back(runways.AllLamps(r, nodes));
  study.SolveCases(pixels.size(), [&](std::size_t r, std::size_t i) {
    return std::optional(PixelStudy::Solved{pixels[i], {ValuesOf(truth[r](pixels[i])), {}, {}}});
  });
}

void AddTree(PixelStudy& study, const Runways& runways, double share_of_error) {
  const LampSettings settings{.share_of_error = share_of_error};
  const auto prepare = [&](std::size_t r, ReportRow& row) {
    const CameraRays camera = runways.CameraOf(r);
    auto [plan, seconds] = Built(study.effort(), [&] {
      return runways.Light(r).PlanFor(
          camera, Runways::kWidth, Runways::kHeight, settings,
          [&](const CameraRay& ray) { return runways.LengthOf(ray.direction); });
    });
    row.build_s = std::max(row.build_s, runways.tree_s() + seconds);
    return [&, r, angle = camera.PixelAngle(), plan = std::move(plan)](const Pixel& pixel) {
      return runways.Light(r).InAir(plan, pixel.x, pixel.y, runways.RayEnd(r, pixel), angle,
                                    settings.nodes);
    };
  };
  study.AddPrepared({.series = "tree of lamps",
                     .parameter = fmt::format("{} %", 100.0 * share_of_error),
                     .in_summary = true},
                    prepare);
}

ReportTopic WordsOfManyLamps(std::size_t counts) {
  return {
      .key = "many_lamps",
      .title = "Many lamps in fog: a runway at night",
      .what = fmt::format(
          "A runway in fog of 900 m visibility and 25 m scale height, seen from 38 m over its "
          "approach, {} x {} pixels, with two rows of lamps. The methods compute the light of all "
          "lamps that the air in front of every pixel scatters.",
          Runways::kWidth, Runways::kHeight),
      .error_unit = "fractions of the pixel's light",
      .notes =
          "The tree replaces a group of lamps by one lamp in its middle if that is accurate "
          "enough. The parameter is the largest error, in a tile of 16 x 16 pixels, of these "
          "replacements and of omitted lamps together. build is the time to make the tree and the "
          "plan of all tiles, on all threads. Renderers without such a tree evaluate all lamps one "
          "by one, each with the same 12 nodes.",
      .wanted = 0.02,
      .answer = "pixel",
      .everywhere = "for any number of lamps",
      .scene = "runway in height fog",
      .regimes = {kCounts.begin(), kCounts.begin() + static_cast<std::ptrdiff_t>(counts)}};
}

}  // namespace

ReportTopic MeasureAirlight(const ReportEffort& effort) {
  LampStudy study(WordsOfAirlight(), effort, kRelativeToTruth);
  study.SolveCases(effort.quick ? 60 : 500, [](std::size_t kind, std::size_t i) {
    const LampTestCase work = LampTestCaseNumber(static_cast<int>(i) + 1, Kinds()[kind]);
    std::optional<LampStudy::Solved> solved;
    if (work.converged && work.truth > 0.0) solved = {work, {{work.truth}, {}, {}}};
    return solved;
  });
  for (const int nodes : {8, 12, 16, 24, 32}) AddPanels(study, nodes);
  AddSun(study);
  AddRule(study, "uniform march", LampRule::kUniform, {16, 64, 256});
  AddRule(study, "equi-angular", LampRule::kEquiAngular, {16, 32, 64, 256});
  AddRule(study, "Gauss in tan(θ/2)", LampRule::kHalfAngle, {16, 32, 64});
  AddRule(study, "Gauss in asinh", LampRule::kAsinh, {16, 32, 64});
  return std::move(study).Finished();
}

ReportTopic MeasureManyLamps(const ReportEffort& effort) {
  constexpr int kReferenceNodes = 32;
  const std::size_t counts = effort.quick ? 3 : kLampCounts.size();
  const Runways runways(counts, effort);
  ReportEffort fewer = effort;
  fewer.passes = std::min<std::size_t>(effort.passes, 2);
  PixelStudy study(WordsOfManyLamps(counts), fewer, kRelativeToTruth);
  study.topic().medium = runways.medium();
  study.topic().reference.text = fmt::format("every lamp by itself with {} nodes", kReferenceNodes);
  SolvePixels(study, runways, kReferenceNodes);
  for (const double share : {0.05, 0.005, 0.0005}) AddTree(study, runways, share);
  study.AddPrepared(
      {.series = "all lamps, one by one",
       .parameter = "",
       .origin = MethodOrigin::kLiterature,
       .in_summary = true},
      [&](std::size_t r, ReportRow&) { return runways.AllLamps(r, LampSettings{}.nodes); });
  return std::move(study).Finished();
}

}  // namespace alpenglow::renderer
