// SPDX-License-Identifier: MIT
#include "renderer/report/report_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/report/cloud_views.h"
#include "renderer/report/error_pictures.h"
#include "renderer/report/plume_light.h"
#include "renderer/report/traced_light.h"

namespace alpenglow::renderer {
namespace {

constexpr std::array<ReportRegime, 2> kPlumeDepths{
    {{"10", "Optical depth 10", {}}, {"50", "Optical depth 50", {}}}};
constexpr std::array<double, 2> kLargestDepths{10.0, 50.0};
constexpr double kPlumeSunAzimuth_deg = 20.0, kPlumeSun_deg = 35.0;
constexpr std::size_t kPlumeBatches = 16;
// The view of the pictures, from the side, and the plume.
constexpr std::size_t kPlumePictureView = 2, kPlumePictureDepth = 0;

/// Sizes of the topic.
struct PlumeStudySize {
  int samples;                  // of the plume, along each side
  int rays;                     // of a view, along each side
  std::size_t paths_per_batch;  // of the reference
  int picture;                  // pixels along each side
  std::size_t picture_paths;    // per batch
  std::vector<double> most_cells;
};
PlumeStudySize PlumeSizeOf(bool quick) {
  if (quick) return {24, 3, 16, 12, 4, {512.0, 4096.0}};
  return {64, 6, 125, 40, 25, {4096.0, VolumeOrders::kMostCells, 262144.0}};
}

/// A plume under the sun.
struct PlumeUnderSun {
  Plume plume;
  glm::dvec3 to_sun;
};

/// The light of a ray by a method.
struct PlumeAnswer {
  CloudEstimate whole;  // with the standard error of paths; otherwise 0
  double sun;
};

/// A method that is ready for one plume.
struct ReadyPlumeMethod {
  std::function<double(const CloudRay&)> whole;  // the work of pictures, which is timed
  std::function<PlumeAnswer(const CloudRay&)> answer;
  std::size_t bytes = 0;
  bool has_noise = false;  // whether it has standard errors
};

ReadyPlumeMethod ReadySingle(const PlumeUnderSun& under) {
  const auto parts = [&under](const CloudRay& ray) {
    return FirstOrderOfPlume(under.plume, under.to_sun, ray);
  };
  return {[parts](const CloudRay& ray) { return WholeCloudLight(parts(ray), ray); },
          [parts](const CloudRay& ray) {
            const CloudRayLight light = parts(ray);
            return PlumeAnswer{{WholeCloudLight(light, ray), 0.0}, light.sun};
          }};
}

ReadyPlumeMethod ReadyOrders(const PlumeUnderSun& under, double most_cells) {
  const auto orders = std::make_shared<const PlumeOrders>(under.plume, under.to_sun, most_cells);
  return {[orders](const CloudRay& ray) { return orders->WholeAlong(ray); },
          [orders](const CloudRay& ray) {
            return PlumeAnswer{{orders->WholeAlong(ray), 0.0}, orders->Along(ray).sun};
          },
          orders->bytes()};
}

/// Returns a method of paths in batches, from whose scatter the standard error follows.
ReadyPlumeMethod ReadyPlumePaths(const PlumeUnderSun& under, std::size_t paths_per_batch) {
  const auto tracer =
      std::make_shared<const CloudPathTracer>(PlumeTracer(under.plume, under.to_sun));
  const auto answer = [tracer, paths_per_batch](const CloudRay& ray) {
    const CloudRadiance traced =
        TracedLight(*tracer, ray, SeedOf(ray), kPlumeBatches, paths_per_batch);
    return PlumeAnswer{WholeCloudLight(traced), traced.sun.value};
  };
  return {[answer](const CloudRay& ray) { return answer(ray).whole.value; }, answer, 0, true};
}

struct PlumeMethod {
  std::string key;  // in names of files
  std::string series, parameter;
  MethodOrigin origin;
  std::function<ReadyPlumeMethod(const PlumeUnderSun&)> ready;
};

/// Returns the methods, in the order of the tables. A new line is a new method.
std::vector<PlumeMethod> PlumeMethodsOf(const PlumeStudySize& size) {
  std::vector<PlumeMethod> methods{
      {"single", "single scattering", "", MethodOrigin::kLiterature, ReadySingle}};
  for (const double cells : size.most_cells) {
    methods.push_back({fmt::format("orders{}", cells), "moments on cells",
                       fmt::format("{} cells", cells), MethodOrigin::kOurs,
                       [cells](const PlumeUnderSun& under) { return ReadyOrders(under, cells); }});
  }
  for (const std::size_t paths : {std::size_t{1}, std::size_t{16}}) {
    const std::size_t all = kPlumeBatches * paths;
    methods.push_back({fmt::format("paths{}", all), "path tracing", fmt::format("{} paths", all),
                       MethodOrigin::kOurs, [paths](const PlumeUnderSun& under) {
                         return ReadyPlumePaths(under, paths);
                       }});
  }
  return methods;
}

using PlumeStudy = ErrorStudy<PlumeRay>;

/// Solves the whole light of all rays. Errors are relative to it, at least to a part of the mean of
/// the view.
void SolvePlumes(PlumeStudy& study, const std::vector<PlumeUnderSun>& plumes,
                 const PlumeStudySize& size) {
  // The deeper plume dims the rays of the thinner one, too: both have the same rays.
  const std::vector<PlumeRay> rays =
      PlumeRaysOf(plumes.front().plume, plumes.front().to_sun, size.rays);
  std::vector<CloudPathTracer> tracers;
  for (const PlumeUnderSun& each : plumes) tracers.push_back(PlumeTracer(each.plume, each.to_sun));
  study.SolveCases(rays.size(), [&](std::size_t r, std::size_t i) {
    PlumeRay one = rays[i];
    one.traced = TracedLight(tracers[r], one.ray, i + 1, kPlumeBatches, size.paths_per_batch);
    const CloudEstimate whole = WholeCloudLight(one.traced);
    return std::optional(
        PlumeStudy::Solved{one, {{whole.value}, {whole.standard_error}, {whole.value}}});
  });
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    std::array<double, kPlumeViews> sum{}, rays_of{};
    for (const PlumeRay& one : study.cases(r)) {
      sum[one.view] += WholeCloudLight(one.traced).value;
      rays_of[one.view] += 1.0;
    }
    for (std::size_t i = 0; i < study.cases(r).size(); ++i) {
      const std::size_t view = study.cases(r)[i].view;
      double& scale = study.references(r)[i].scale[0];
      scale = std::max(scale, kDarkestCloud * sum[view] / rays_of[view]);
    }
    study.topic().reference.noise[r] = NoiseOf(study.references(r));
  }
}

/// Returns the table of a plume, without lines.
ReportTable EmptyPlumeTable(const ReportRegime& depth) {
  ReportTable table{
      .key = fmt::format("depth{}", depth.key),
      .title = fmt::format("Volumes, largest optical depth {}: whole light, and bias of the sun's",
                           depth.key),
      .columns = {{"memory", ReportUnit::kBytes},
                  {"solve", ReportUnit::kSeconds},
                  {"time of a ray", ReportUnit::kSeconds},
                  {"whole: rms", ReportUnit::kError},
                  {"whole: median", ReportUnit::kError},
                  {"whole: bias", ReportUnit::kBias},
                  {"standard error", ReportUnit::kError},
                  {"sun: bias", ReportUnit::kBias}},
      .lines = {}};
  for (const PlumeView& view : PlumeViewsOf(TowardsAzimuth(kPlumeSunAzimuth_deg, kPlumeSun_deg)))
    table.columns.push_back({fmt::format("whole: bias, {}", view.name), ReportUnit::kBias});
  return table;
}

/// The cost of a method in one plume, and its light along all rays.
struct PlumeMeasured {
  double bytes = 0.0, solve_s = 0.0;
  bool has_noise = false;
  std::vector<PlumeAnswer> light;
};

/// Returns the numbers of a method in one plume, in the order of the columns.
std::vector<std::optional<double>> PlumeNumbers(const std::vector<PlumeRay>& cases,
                                                const std::vector<ReferenceValue>& references,
                                                const PlumeMeasured& measured,
                                                const RegimeResult& result) {
  double sun = 0.0, true_sun = 0.0;
  CloudErrors whole;
  std::array<CloudErrors, kPlumeViews> of_view;
  std::vector<double> deviations;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CloudEstimate truth = WholeCloudLight(cases[i].traced);
    const CloudEstimate& found = measured.light[i].whole;
    sun += measured.light[i].sun;
    true_sun += cases[i].traced.sun.value;
    whole.Add(found.value, truth, 0.0);
    of_view[cases[i].view].Add(found.value, truth, 0.0);
    deviations.push_back(found.standard_error / references[i].scale[0]);
  }
  std::vector<std::optional<double>> numbers{
      measured.bytes,
      measured.solve_s,
      result.time_s,
      result.error.Rms(),
      result.error.Quantile(0.5),
      whole.Bias(),
      measured.has_noise ? std::optional(RmsOf(deviations)) : std::nullopt,
      sun / true_sun - 1.0};
  for (const CloudErrors& errors : of_view)
    numbers.push_back(errors.count() > 0 ? std::optional(errors.Bias()) : std::nullopt);
  return numbers;
}

/// One view of a plume in whole light, by the reference and by every method.
class PlumePictures {
 public:
  PlumePictures(const PlumeUnderSun& under, const PlumeStudySize& size)
      : rays_(PlumeRaster(PlumeViewsOf(under.to_sun)[kPlumePictureView], size.picture)),
        pictures_(Traced(under, size)) {}

  void Add(const PlumeMethod& method, const std::string& name, const ReadyPlumeMethod& ready) {
    std::vector<double> found(rays_.size());
    ForEachCase(rays_.size(), [&](std::size_t i) { found[i] = ready.whole(rays_[i]); });
    pictures_.Add(method.key, name, found);
  }

  [[nodiscard]] std::vector<ReportPicture> Finished() && { return std::move(pictures_).Finished(); }

 private:
  [[nodiscard]] ErrorPictures Traced(const PlumeUnderSun& under, const PlumeStudySize& size) const {
    const CloudPathTracer tracer = PlumeTracer(under.plume, under.to_sun);
    std::vector<CloudEstimate> traced(rays_.size());
    ForEachCase(rays_.size(), [&](std::size_t i) {
      traced[i] =
          WholeCloudLight(TracedLight(tracer, rays_[i], i + 1, kPlumeBatches, size.picture_paths));
    });
    const double white = BrightestOf(traced);
    return {{size.picture, size.picture},
            std::move(traced),
            {"traced", fmt::format("Traced paths: {} a pixel", kPlumeBatches * size.picture_paths)},
            white};
  }

  std::vector<CloudRay> rays_;
  ErrorPictures pictures_;
};

void AddPlumeMethod(PlumeStudy& study, const std::vector<PlumeUnderSun>& plumes,
                    const PlumeMethod& method, PlumePictures& pictures) {
  std::vector<PlumeMeasured> measured(study.regimes());
  const ReportRow row{.series = method.series,
                      .parameter = method.parameter,
                      .origin = method.origin,
                      .in_summary = true};
  study.AddPrepared(row, [&](std::size_t r, ReportRow& made) {
    auto [ready, seconds] = Built(study.effort(), [&] { return method.ready(plumes[r]); });
    const std::vector<PlumeRay>& cases = study.cases(r);
    measured[r] = {static_cast<double>(ready.bytes), ready.bytes > 0 ? seconds : 0.0,
                   ready.has_noise, std::vector<PlumeAnswer>(cases.size())};
    ForEachCase(cases.size(),
                [&](std::size_t i) { measured[r].light[i] = ready.answer(cases[i].ray); });
    made.memory_bytes = std::max<std::uint64_t>(made.memory_bytes, ready.bytes);
    made.build_s = std::max(made.build_s, measured[r].solve_s);
    if (r == kPlumePictureDepth) pictures.Add(method, made.Name(), ready);
    return [whole = ready.whole](const PlumeRay& one) { return whole(one.ray); };
  });
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    study.topic().tables[r].lines.push_back(
        {row.Name(), row.origin,
         PlumeNumbers(study.cases(r), study.references(r), measured[r],
                      study.topic().rows.back().at[r])});
  }
}

ReportTopic WordsOfVolumes() {
  ReportTopic topic{
      .key = "volumes",
      .title = "Volumes: light of all orders in a plume of smoke",
      .what =
          "A plume of smoke, 640 m wide, over black ground under a sun of 35 degrees, along "
          "parallel "
          "rays from six sides: with the sun and towards it, across from both sides, downwards and "
          "upwards. The columns are the largest optical depth of the plume. The methods compute "
          "the "
          "whole light of rays that the plume dims by a tenth or more: sun + 0.036 sky + 0.012 "
          "ground, with the sky and the ground behind. Smoke absorbs nothing and scatters by "
          "Henyey "
          "and Greenstein (g = 0.85).",
      .error_unit =
          "fractions of the radiance; a radiance below a twentieth of the mean of its view counts "
          "as if it were that bright",
      .notes =
          "Single scattering has the light of the sun alone, and what the smoke transmits of that "
          "behind. \"moments on cells\" are this library's light of all orders: two solutions, one "
          "with sun and sky and one with the ground; the size is the largest number of cells in "
          "the "
          "box of the plume. Errors of path tracing are its noise; the further tables have its "
          "standard error, the rms over the rays. Medians include the noise of the reference. "
          "build "
          "and solve are the time of all threads together.",
      .wanted = 0.1,
      .answer = "ray",
      .everywhere = "in both plumes",
      .scene = "plume of smoke",
      .regimes = {kPlumeDepths.begin(), kPlumeDepths.end()}};
  topic.medium.name.clear();  // there is no air
  topic.medium.wavelengths_nm = {550.0};
  return topic;
}

}  // namespace

ReportTopic MeasureVolumes(const ReportEffort& effort) {
  const PlumeStudySize size = PlumeSizeOf(effort.quick);
  std::vector<PlumeUnderSun> plumes;
  for (const double depth : kLargestDepths) {
    plumes.push_back({MakePlume({.largest_depth = depth, .samples = size.samples}),
                      TowardsAzimuth(kPlumeSunAzimuth_deg, kPlumeSun_deg)});
  }
  ReportEffort fewer = effort;
  fewer.passes = std::min<std::size_t>(effort.passes, 3);
  fewer.time_every = 4;
  PlumeStudy study(WordsOfVolumes(), fewer);
  study.topic().reference.text =
      fmt::format("{} traced paths per ray", kPlumeBatches * size.paths_per_batch);
  SolvePlumes(study, plumes, size);
  for (const ReportRegime& depth : kPlumeDepths)
    study.topic().tables.push_back(EmptyPlumeTable(depth));
  PlumePictures pictures(plumes[kPlumePictureDepth], size);
  for (const PlumeMethod& method : PlumeMethodsOf(size))
    AddPlumeMethod(study, plumes, method, pictures);
  study.topic().pictures = std::move(pictures).Finished();
  return std::move(study).Finished();
}

}  // namespace alpenglow::renderer
