// SPDX-License-Identifier: MIT
#include "renderer/report/report_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/layers/layer_field.h"
#include "renderer/report/eddington_stack.h"
#include "renderer/report/layer_cases.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLayerCloudG = 0.85;
constexpr std::size_t kCloudDepths = 5;
constexpr std::array<ReportRegime, kCloudDepths> kLayerClouds{{{"0.3", "Optical depth 0.3", {}},
                                                               {"1", "Optical depth 1", {}},
                                                               {"5", "Optical depth 5", {}},
                                                               {"20", "Optical depth 20", {}},
                                                               {"60", "Optical depth 60", {}}}};

/// Numbers of streams and of directions at each depth.
struct LayerStudySize {
  int reference_streams, looks;
  std::vector<int> streams;
};
LayerStudySize LayerSizeOf(bool quick) {
  if (quick) return {24, 4, {2, 4, 8, 12}};
  return {48, 12, {2, 4, 6, 8, 12, 16, 32}};
}

/// A case with its fluxes by the reference; the study has its radiances.
struct SolvedLayers {
  LayerCase of;
  std::vector<double> fluxes;
};
using LayerStudy = ErrorStudy<SolvedLayers>;

void SolveLayers(LayerStudy& study, const LayerStudySize& size) {
  const std::vector<LayerCase> cases = LayerCasesOf(kLayerCloudG, size.looks);
  const std::size_t of_depth = cases.size() / kCloudDepths;
  study.SolveCases(of_depth, [&](std::size_t r, std::size_t i) {
    const LayerCase& one = cases[r * of_depth + i];
    const LayerStack stack(one.layers, one.ground_albedo, size.reference_streams);
    LightOfLayers light = LightIn(one, LayerField::UnderSun(stack, one.mu_s));
    return std::optional(
        LayerStudy::Solved{{one, std::move(light.fluxes)}, {std::move(light.radiances), {}, {}}});
  });
}

/// Discrete ordinates: a stack for all suns, and the light of a sun in it.
class StreamMethod {
 public:
  static constexpr bool kHasStack = true;
  explicit StreamMethod(int streams) : streams_(streams) {}

  [[nodiscard]] auto Prepare(const std::vector<LayerOptics>& layers, double ground) const {
    return std::make_unique<const LayerStack>(layers, ground, streams_);
  }
  [[nodiscard]] LayerField UnderSun(const std::unique_ptr<const LayerStack>& stack,
                                    double mu_s) const {
    return LayerField::UnderSun(*stack, mu_s);
  }

 private:
  int streams_;
};

/// Two streams: every sun is solved on its own.
class TwoStreamMethod {
 public:
  static constexpr bool kHasStack = false;
  struct Layers {
    std::vector<LayerOptics> all;
    double ground;
  };

  [[nodiscard]] Layers Prepare(const std::vector<LayerOptics>& layers, double ground) const {
    return {layers, ground};
  }
  [[nodiscard]] EddingtonStack UnderSun(const Layers& layers, double mu_s) const {
    return {layers.all, layers.ground, mu_s};
  }
};

/// Times of the parts of a method [s].
struct LayerTimes {
  double stack_s, sun_s, radiance_s;
};

/// Returns the times for layers over ground.
template <typename Method>
LayerTimes TimesFor(const Method& method, const std::vector<LayerOptics>& layers,
                    const ReportEffort& effort) {
  constexpr double kGround = 0.2, kSun = 0.4;
  constexpr int kRadiances = 32;
  RegimeResult stack, sun, radiance;
  if constexpr (Method::kHasStack) {
    const auto pass = [&] { return method.Prepare(layers, kGround) == nullptr ? 0.0F : 1.0F; };
    TimePasses(1, effort, pass, stack);
  }
  const auto prepared = method.Prepare(layers, kGround);
  const auto of_sun = [&] {
    return static_cast<float>(method.UnderSun(prepared, kSun).Fluxes(0.0).up);
  };
  TimePasses(1, effort, of_sun, sun);
  const auto field = method.UnderSun(prepared, kSun);
  const auto radiances = [&] {
    double sum = 0.0;
    for (int i = 0; i < kRadiances; ++i)
      sum += field.Radiance(0.05 * (i % 3), {0.93 - 0.06 * i, 0.1 * i});
    return static_cast<float>(sum);
  };
  TimePasses(kRadiances, effort, radiances, radiance);
  return {stack.time_s, sun.time_s, radiance.time_s};
}

/// Largest and root mean square errors of fluxes, relative to the incident flux.
struct FluxErrors {
  double largest = 0.0, rms = 0.0;
};
FluxErrors FluxErrorsOf(const std::vector<std::vector<double>>& found,
                        const std::vector<SolvedLayers>& cases) {
  FluxErrors errors;
  std::vector<double> all;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t k = 0; k < found[i].size(); ++k)
      all.push_back(std::abs(found[i][k] - cases[i].fluxes[k]));
  }
  return {*std::max_element(all.begin(), all.end()), RmsOf(all)};
}

/// Measures a method in clouds of one depth: radiances and the time of a new sun. Returns its errors of
/// fluxes.
template <typename Method>
FluxErrors MeasureLayersIn(const LayerStudy& study, std::size_t r, const Method& method,
                           RegimeResult& result) {
  const std::vector<SolvedLayers>& cases = study.cases(r);
  std::vector<decltype(method.Prepare({}, 0.0))> stacks;
  for (const SolvedLayers& each : cases)
    stacks.push_back(method.Prepare(each.of.layers, each.of.ground_albedo));
  std::vector<std::vector<double>> radiances(cases.size()), fluxes(cases.size());
  ForEachCase(cases.size(), [&](std::size_t i) {
    LightOfLayers light = LightIn(cases[i].of, method.UnderSun(stacks[i], cases[i].of.mu_s));
    radiances[i] = std::move(light.radiances);
    fluxes[i] = std::move(light.fluxes);
  });
  study.Judge(r, radiances, result);
  const auto pass = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i)
      sum += method.UnderSun(stacks[i], cases[i].of.mu_s).Fluxes(0.0).up;
    return static_cast<float>(sum);
  };
  TimePasses(cases.size(), study.effort(), pass, result);
  return FluxErrorsOf(fluxes, cases);
}

/// Measures a method and adds its row and its line of the further table.
template <typename Method>
void AddLayerMethod(LayerStudy& study, ReportRow row, const Method& method) {
  row.in_summary = true;
  row.at.resize(study.regimes());
  const ReportEffort& effort = study.effort();
  const LayerTimes one = TimesFor(method, {CloudInAir(5.0, kLayerCloudG)[1]}, effort);
  const LayerTimes three = TimesFor(method, CloudInAir(5.0, kLayerCloudG), effort);
  row.build_s = three.stack_s;
  std::vector<std::optional<double>> numbers{one.stack_s, one.sun_s, three.stack_s, three.sun_s,
                                             three.radiance_s};
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    const FluxErrors errors = MeasureLayersIn(study, r, method, row.at[r]);
    numbers.insert(numbers.end(), {errors.rms, errors.largest});
    ThrowIfInterrupted();
  }
  study.topic().tables[0].lines.push_back({row.Name(), row.origin, std::move(numbers)});
  study.AddMeasured(std::move(row));
}

ReportTable EmptyLayerTable() {
  ReportTable table{.key = "fluxes",
                    .title =
                        "Layers: times of the parts, and errors of fluxes relative to the "
                        "incident flux",
                    .columns = {{"1 layer: stack", ReportUnit::kSeconds},
                                {"1 layer: sun", ReportUnit::kSeconds},
                                {"3 layers: stack", ReportUnit::kSeconds},
                                {"3 layers: sun", ReportUnit::kSeconds},
                                {"time of a radiance", ReportUnit::kSeconds}},
                    .lines = {}};
  for (const ReportRegime& cloud : kLayerClouds) {
    table.columns.push_back({fmt::format("flux at {}: rms", cloud.key), ReportUnit::kError});
    table.columns.push_back({fmt::format("flux at {}: largest", cloud.key), ReportUnit::kError});
  }
  return table;
}

ReportTopic WordsOfLayers(const LayerStudySize& size) {
  ReportTopic topic{
      .key = "layers",
      .title = "Layers: light of all orders in a plane-parallel cloud between layers of molecules",
      .what = fmt::format(
          "A cloud of optical depth 0.3 to 60 (Henyey and Greenstein, g = {}, albedo 0.9999) "
          "between two layers of molecules, over ground of albedo 0.1 and 0.8, under suns of "
          "zenith cosine 0.15, 0.5 and 0.9. The methods compute radiances at seven depths in {} "
          "random directions each, beyond 3 degrees from the sun, and fluxes at the same depths.",
          kLayerCloudG, size.looks),
      .error_unit = "fractions of the radiance, however faint it is",
      .notes =
          "Discrete ordinates (Stamnes et al. 1988) follow all azimuths. build is the time of a "
          "stack, which serves all suns and other sources; time is that of a new sun. The further "
          "table has both for one layer and for three, and the time of a radiance in a finished "
          "field. Two streams are those of the delta-Eddington approximation (Joseph, Wiscombe and "
          "Weinman 1976) with the exact phase function for light of the first order; they solve "
          "every sun on its own. Times of the preparation are on one thread.",
      .answer = "sun",
      .everywhere = "at every optical depth",
      .scene = "cloud in air",
      .regimes = {kLayerClouds.begin(), kLayerClouds.end()}};
  topic.medium.name.clear();  // the layers have no altitudes
  topic.medium.wavelengths_nm = {550.0};
  topic.reference.text = fmt::format("{} streams", size.reference_streams);
  return topic;
}

}  // namespace

ReportTopic MeasureLayers(const ReportEffort& effort) {
  const LayerStudySize size = LayerSizeOf(effort.quick);
  LayerStudy study(WordsOfLayers(size), effort, kRelativeToTruth);
  SolveLayers(study, size);
  study.topic().tables.push_back(EmptyLayerTable());
  AddLayerMethod(study,
                 {.series = "two streams (Joseph et al. 1976)",
                  .parameter = "",
                  .origin = MethodOrigin::kLiterature},
                 TwoStreamMethod());
  for (const int streams : size.streams) {
    AddLayerMethod(
        study, {.series = "discrete ordinates", .parameter = fmt::format("{} streams", streams)},
        StreamMethod(streams));
  }
  return std::move(study).Finished();
}

}  // namespace alpenglow::renderer
