// SPDX-License-Identifier: MIT
// Measures the topics of the report about the airlight of one lamp, and of many.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>

#include "lut/cli/program.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/report/lamp_test_cases.h"
#include "renderer/report/report.h"

namespace alpenglow::renderer {
namespace {

// Line styles of the plot of one lamp.
enum LampStyle {
  kHere = 0,
  kUniformNodes = 1,
  kEquiAngular = 2,
  kSun = 3,
  kHalfAngle = 4,
  kAsinh = 6,
};

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

class AirlightTopic {
 public:
  explicit AirlightTopic(const ReportEffort& effort) : effort_(effort) {
    const int count = effort.quick ? 60 : 500;
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t k = 0; k < kKinds; ++k) {
      works_[k].resize(static_cast<std::size_t>(count));
      tbb::parallel_for(0, count, [&](int i) {
        if (!Interrupted())
          works_[k][static_cast<std::size_t>(i)] = LampTestCaseNumber(i + 1, Kinds()[k]);
      });
      ThrowIfInterrupted();
      std::erase_if(works_[k], [](const LampTestCase& work) {
        return !work.converged || !(work.truth > 0.0);
      });
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    topic_.reference.time_s = taken.count() / static_cast<double>(kKinds) / count;
    topic_.rays = static_cast<std::size_t>(count);
  }

  void AddHere(int nodes) {
    ReportRow row =
        Row("panels around the light", fmt::format("{} nodes", nodes), MethodOrigin::kOurs, kHere);
    row.in_summary = nodes == 12 || nodes == 16;
    for (std::size_t k = 0; k < kKinds; ++k) {
      Measure(k, row, [&](const LampTestCase& work) {
        return Airlight(work.air, work.lamp, work.segment, nodes)[0];
      });
      double points = 0.0;
      for (const LampTestCase& work : works_[k]) {
        const AirlightEffort effort = EffortOfAirlight(work.air, work.lamp, work.segment, nodes);
        points += effort.scouted + effort.integrated;
      }
      row.at[k].samples = points / static_cast<double>(works_[k].size());
    }
    topic_.rows.push_back(std::move(row));
  }

  void AddRule(const std::string& series, LampRule rule, int style, int nodes) {
    ReportRow row = Row(series, fmt::format("{} points", nodes), MethodOrigin::kLiterature, style);
    row.in_summary = nodes == 64;
    for (std::size_t k = 0; k < kKinds; ++k) {
      Measure(k, row, [&](const LampTestCase& work) { return AirlightByRule(rule, work, nodes); });
      row.at[k].samples = nodes;
    }
    topic_.rows.push_back(std::move(row));
  }

  /// Adds the closed form for isotropic scattering in homogeneous air, the only case that it covers.
  void AddSun() {
    ReportRow row = Row("Sun et al. (2005)", "", MethodOrigin::kLiterature, kSun);
    row.in_summary = true;
    Measure(0, row, [](const LampTestCase& work) {
      const glm::dvec3 to_lamp = work.lamp.position_m - work.segment.origin_m;
      const double along = glm::dot(to_lamp, work.segment.direction);
      const LampLayer& layer = work.air.layers[0];
      return AirlightOfSun2005(layer.scattering_per_m[0], layer.extinction_per_m[0],
                               work.segment.end_m, along,
                               glm::length(to_lamp - along * work.segment.direction));
    });
    topic_.rows.push_back(std::move(row));
  }

  [[nodiscard]] ReportTopic Finished() && {
    topic_.key = "airlight";
    topic_.title = "A lamp in fog: light of one lamp that the air scatters towards the eye";
    topic_.what =
        "Lamps 0.1 to 100 m beside rays of 10 to 1000 m, or behind them, in fog of extinction "
        "1e-4 to 0.1 per metre, of one density, or of a scale height of 30 m under clear air; the "
        "question is the radiance that the fog on the ray scatters "
        "once.";
    topic_.error_unit = "parts of the radiance, which may be as faint as it likes";
    topic_.notes =
        "Samples of this library's rule are all points at which it looks at the ray, those that "
        "only find where the light is too. The closed form of Sun et al. (2005) is for isotropic "
        "fog of one density; it is evaluated here by quadrature of its function F to 1e-11, not by "
        "the authors' table, which is faster. The equi-angular rule of Kulla and Fajardo (2012) is "
        "taken in the middle of its strata, without noise.";
    topic_.wanted = 1e-3;
    topic_.everywhere = "in every fog";
    topic_.scene = "fog";
    topic_.regimes.assign(kFogs.begin(), kFogs.end());
    topic_.medium.name.clear();
    topic_.medium.wavelengths_nm = {550.0};
    topic_.reference.text =
        "adaptive Gauss-Legendre quadrature in extended precision, relative error below 1e-9";
    topic_.reference.noise.assign(kKinds, 0.0);
    return std::move(topic_);
  }

 private:
  [[nodiscard]] static ReportRow Row(const std::string& series, const std::string& parameter,
                                     MethodOrigin origin, int style) {
    ReportRow row{.series = series, .parameter = parameter, .origin = origin, .style = style};
    row.at.resize(kKinds);
    return row;
  }

  template <typename Answer>
  void Measure(std::size_t k, ReportRow& row, const Answer& answer) {
    std::vector<double> errors;
    for (const LampTestCase& work : works_[k])
      errors.push_back(std::abs(answer(work) / work.truth - 1.0));
    row.at[k].error = StatisticsOfErrors(std::move(errors), 0.0);
    TimePasses(
        works_[k].size(), effort_,
        [&] {
          double sum = 0.0;
          for (const LampTestCase& work : works_[k]) sum += answer(work);
          return static_cast<float>(sum);
        },
        row.at[k]);
    ThrowIfInterrupted();
  }

  const ReportEffort& effort_;
  std::array<std::vector<LampTestCase>, kKinds> works_;
  ReportTopic topic_;
};

// Line styles of the plot of many lamps.
enum ManyStyle { kTree = 0, kAll = 1 };

constexpr std::array<ReportRegime, 4> kCounts{{{"1", "1 lamp", {}},
                                               {"10", "10 lamps", {}},
                                               {"100", "100 lamps", {}},
                                               {"1000", "1000 lamps", {}}}};
constexpr std::array<int, 4> kLampCounts{1, 10, 100, 1000};

/// The parts of a scene that the lamp light of a picture needs, without its sky.
struct LampStage {
  explicit LampStage(const Scene& of)
      : scene(of),
        ground(LoadGround(scene)),
        medium(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
        colour(medium.wavelengths_nm) {}

  Scene scene;
  SceneGround ground;
  Medium medium;
  BandColour colour;
};

class ManyLampsTopic {
 public:
  static constexpr int kWidth = 160, kHeight = 90;
  static constexpr int kReferenceNodes = 32;

  explicit ManyLampsTopic(const ReportEffort& effort) : effort_(effort) {
    for (int y = 1; y < kHeight; y += effort.quick ? 22 : 4) {
      for (int x = 1; x < kWidth; x += effort.quick ? 40 : 6) pixels_.push_back({x, y});
    }
    const std::size_t counts = effort.quick ? 3 : kLampCounts.size();
    for (std::size_t r = 0; r < counts; ++r) SolveReference(r);
  }

  void AddTree(double share_of_error) {
    ReportRow row = Row("tree of lamps", fmt::format("{} %", 100.0 * share_of_error),
                        MethodOrigin::kOurs, kTree);
    row.in_summary = true;
    const LampSettings settings{.share_of_error = share_of_error};
    for (std::size_t r = 0; r < stages_.size(); ++r) {
      const CameraRays camera = CameraOf(r);
      const auto [plan, seconds] = Built([&] {
        return light_[r]->PlanFor(camera, kWidth, kHeight, settings,
                                  [this](const CameraRay& ray) { return LengthOf(ray.direction); });
      });
      row.build_s = std::max(row.build_s, tree_s_ + seconds);
      Measure(r, row, [&, &shared = plan](std::size_t i) {
        const auto [x, y] = pixels_[i];
        return light_[r]->InAir(shared, x, y, RayEnd(r, i), camera.PixelAngle(), settings.nodes);
      });
    }
    topic_.rows.push_back(std::move(row));
  }

  void AddAll() {
    ReportRow row = Row("all lamps, one by one", "", MethodOrigin::kLiterature, kAll);
    row.in_summary = true;
    for (std::size_t r = 0; r < stages_.size(); ++r) {
      const LampNodes all = light_[r]->All();
      const double pixel = CameraOf(r).PixelAngle();
      Measure(r, row, [&](std::size_t i) {
        return light_[r]->InAir(all, RayEnd(r, i), pixel, LampSettings{}.nodes);
      });
    }
    topic_.rows.push_back(std::move(row));
  }

  [[nodiscard]] ReportTopic Finished() && {
    topic_.key = "many_lamps";
    topic_.title = "Many lamps in fog: a runway at night";
    topic_.what = fmt::format(
        "A runway in fog of 900 m visibility and 25 m scale height, from 38 m over its approach, "
        "{} x {} pixels, with so many lamps in two rows along it; the question is the light of "
        "lamps that the air before every pixel scatters.",
        kWidth, kHeight);
    topic_.error_unit = "parts of the pixel's light";
    topic_.notes =
        "The tree stands nodes for groups of lamps where one lamp in their middle is as good; the "
        "parameter is what that, and what is left out, may add up to in a tile of 16 x 16 pixels. "
        "build is the time to make the tree and the plan of all tiles, on all threads. All lamps "
        "one by one, each with the same 12 nodes, is what renderers without such a tree do.";
    topic_.wanted = 0.02;
    topic_.answer = "pixel";
    topic_.everywhere = "for any number of lamps";
    topic_.scene = "runway in height fog";
    topic_.regimes.assign(kCounts.begin(),
                          kCounts.begin() + static_cast<std::ptrdiff_t>(stages_.size()));
    topic_.medium = stages_.front()->medium;
    topic_.rays = pixels_.size();
    topic_.reference.text = fmt::format("every lamp by itself with {} nodes", kReferenceNodes);
    topic_.reference.time_s = reference_s_ / static_cast<double>(stages_.size() * pixels_.size());
    topic_.reference.noise.assign(stages_.size(), 0.0);
    return std::move(topic_);
  }

 private:
  [[nodiscard]] CameraRays CameraOf(std::size_t r) const {
    return {stages_[r]->scene.camera, kWidth, kHeight};
  }
  /// Returns the distance to the level ground below the eye [m]; infinite for rays that do not descend.
  [[nodiscard]] double LengthOf(const glm::dvec3& direction) const {
    return direction.z < 0.0 ? eye_height_m_ / -direction.z
                             : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] LampRayEnd RayEnd(std::size_t r, std::size_t i) const {
    const glm::dvec3 direction = CameraOf(r).Direction(pixels_[i][0] + 0.5, pixels_[i][1] + 0.5);
    return {direction, LengthOf(direction)};
  }

  void SolveReference(std::size_t r) {
    stages_.push_back(std::make_unique<LampStage>(RunwayScene(kLampCounts[r], false)));
    const LampStage& stage = *stages_.back();
    eye_height_m_ = stage.ground.eye_height_m;
    auto [light, seconds] = Built([&] {
      return std::make_unique<LampLight>(stage.scene, stage.ground, stage.medium, stage.colour);
    });
    light_.push_back(std::move(light));
    tree_s_ = seconds;
    const LampNodes all = light_.back()->All();
    const double pixel = CameraOf(r).PixelAngle();
    std::vector<Bands<float>>& truth = truth_.emplace_back(pixels_.size(), Bands<float>(0));
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(std::size_t{0}, pixels_.size(), [&](std::size_t i) {
      if (!Interrupted())
        truth[i] = light_.back()->InAir(all, RayEnd(r, i), pixel, kReferenceNodes);
    });
    ThrowIfInterrupted();
    reference_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  [[nodiscard]] ReportRow Row(const std::string& series, const std::string& parameter,
                              MethodOrigin origin, int style) const {
    ReportRow row{.series = series, .parameter = parameter, .origin = origin, .style = style};
    row.at.resize(stages_.size());
    return row;
  }

  template <typename Answer>
  void Measure(std::size_t r, ReportRow& row, const Answer& answer) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const Bands<float> found = answer(i);
      for (std::size_t band = 0; band < found.count; ++band) {
        const double truth = static_cast<double>(truth_[r][i][band]);
        errors.push_back(std::abs(static_cast<double>(found[band]) / truth - 1.0));
      }
    }
    row.at[r].error = StatisticsOfErrors(std::move(errors), 0.0);
    ReportEffort effort = effort_;
    effort.passes = 2;
    TimePasses(
        pixels_.size(), effort,
        [&] {
          float sum = 0.0F;
          for (std::size_t i = 0; i < pixels_.size(); ++i) sum += answer(i)[0];
          return sum;
        },
        row.at[r]);
    ThrowIfInterrupted();
  }

  const ReportEffort& effort_;
  std::vector<std::array<int, 2>> pixels_;
  std::vector<std::unique_ptr<LampStage>> stages_;  // owns the grounds that lamps refer to
  std::vector<std::unique_ptr<LampLight>> light_;
  double eye_height_m_ = 0.0;
  std::vector<std::vector<Bands<float>>> truth_;
  double tree_s_ = 0.0, reference_s_ = 0.0;
  ReportTopic topic_;
};

}  // namespace

ReportTopic MeasureAirlight(const ReportEffort& effort) {
  AirlightTopic topic(effort);
  for (const int nodes : {8, 12, 16, 24, 32}) topic.AddHere(nodes);
  topic.AddSun();
  for (const int nodes : {16, 64, 256})
    topic.AddRule("uniform march", LampRule::kUniform, kUniformNodes, nodes);
  for (const int nodes : {16, 32, 64, 256})
    topic.AddRule("equi-angular", LampRule::kEquiAngular, kEquiAngular, nodes);
  for (const int nodes : {16, 32, 64})
    topic.AddRule("Gauss in tan(θ/2)", LampRule::kHalfAngle, kHalfAngle, nodes);
  for (const int nodes : {16, 32, 64})
    topic.AddRule("Gauss in asinh", LampRule::kAsinh, kAsinh, nodes);
  return std::move(topic).Finished();
}

ReportTopic MeasureManyLamps(const ReportEffort& effort) {
  ManyLampsTopic topic(effort);
  for (const double share : {0.05, 0.005, 0.0005}) topic.AddTree(share);
  topic.AddAll();
  return std::move(topic).Finished();
}

}  // namespace alpenglow::renderer
