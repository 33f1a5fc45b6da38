// SPDX-License-Identifier: MIT
// This file measures two topics of the report: light scattered once along a view, and light of all
// orders along a view.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "atmosphere/ray/direct_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "lut/table_io/table_folder.h"
#include "lut/tables/scattering_table.h"

namespace alpenglow::lut {
namespace {

// Styles of the lines of the plot.
enum SingleStyle {
  kGauss = 0,
  kMidpoint = 1,
  kTable = 3,
  kQuadratic = 4,
  kAzimuthTable = 2,
  kDirectSingle = 5,
  kGaussSplit = 6
};

class SingleTopic : public TopicWork {
 public:
  SingleTopic(const Medium& medium, const ReportEffort& effort)
      : TopicWork(medium, effort, ReferenceSkyRays(medium, effort.rays)),
        air_(medium),
        direct_(medium) {}

  void AddGauss(int nodes, bool split_ozone, bool in_summary) {
    const Sampling sampling{.nodes = nodes, .split_ozone = split_ozone};
    AddRow(
        {.series = split_ozone ? "Gauss, cut at ozone" : "Gauss",
         .parameter = fmt::format("{} nodes", nodes),
         .style = split_ozone ? kGaussSplit : kGauss,
         .in_summary = in_summary},
        [&](const ViewRay& ray) {
          return air_.Inscatter(air_.Scatter(air_.Sample(ray, sampling)), ray.nu);
        },
        [&](const ViewRay& ray) { return air_.Sample(ray, sampling).count; });
  }

  void AddDirect(DirectMode mode) {
    const bool fast = mode == DirectMode::kFast;
    AddRow(
        {.series = "direct integration",
         .parameter = fast ? "fast, 7 nodes a panel" : "normal, 14 nodes a panel",
         .style = kDirectSingle,
         .in_summary = true},
        [this, mode](const ViewRay& ray) {
          return air_.Inscatter(direct_.Scatter(ray, mode), ray.nu);
        },
        [this, mode](const ViewRay& ray) { return direct_.Sample(ray, {.mode = mode}).count; });
  }

  void AddMarch(MarchRule rule, int steps, bool in_summary) {
    TopicWork::AddMarch(air_, rule, steps, rule == MarchRule::kMidpoint ? kMidpoint : kQuadratic,
                        in_summary);
  }

  void AddTable(ScatteringAxes axes, const ScatteringTableSize& size, bool in_summary) {
    const ScatteringTableOptions options{.size = size, .lowest_mu_s = {}, .axes = axes};
    const auto [table, seconds] = Built([&] { return ScatteringTable(medium_, options); });
    const bool azimuth = axes == ScatteringAxes::kAzimuth;
    AddRow(
        {.series = azimuth ? "table by azimuth" : "4-D table (Bruneton)",
         .parameter = fmt::format("{} x {} x {} x {}", size.altitudes, size.mu, size.mu_s, size.nu),
         .origin = azimuth ? MethodOrigin::kOurs : MethodOrigin::kLiterature,
         .style = azimuth ? kAzimuthTable : kTable,
         .in_summary = in_summary,
         .memory_bytes = table.bytes(),
         .build_s = seconds},
        [&](const ViewRay& ray) { return air_.Inscatter(table.Lookup(ray), ray.nu); },
        [](const ViewRay&) { return 0; });
  }

 private:
  SingleScattering<float> air_;
  DirectScattering direct_;
};

}  // namespace

ReportTopic MeasureSingleScattering(const Medium& medium, const ReportEffort& effort) {
  SingleTopic topic(medium, effort);
  for (const int nodes : {4, 6, 8, 12, 16, 20})
    topic.AddGauss(nodes, false, nodes == 8 || nodes == 12 || nodes == 20);
  for (const DirectMode mode : {DirectMode::kFast, DirectMode::kNormal}) topic.AddDirect(mode);
  if (medium.ozone.shape == OzoneShape::kTent) {
    for (const int nodes : {4, 6, 8, 12, 16, 20}) topic.AddGauss(nodes, true, nodes == 16);
  }
  for (const int steps : {16, 32, 64, 128, 256, 512})
    topic.AddMarch(MarchRule::kMidpoint, steps, steps == 64);
  for (const int steps : {16, 32, 64, 128, 256, 512})
    topic.AddMarch(MarchRule::kQuadratic, steps, steps == 32);
  topic.AddTable(ScatteringAxes::kBruneton, {.nu = 8, .mu_s = 24, .mu = 64, .altitudes = 16},
                 false);
  if (!effort.quick) topic.AddTable(ScatteringAxes::kBruneton, {}, true);
  for (const char* quality : {"preview", "standard", "fine"}) {
    topic.AddTable(ScatteringAxes::kAzimuth, TableQualityFromName(quality).single_scattering,
                   quality[0] == 's');
    if (effort.quick) break;
  }
  return std::move(topic).Finished(
      {.key = "single_scattering",
       .title = "Single scattering: sunlight scattered once towards the eye",
       .what = "Views to the sky and down to the ground from 2 m, 1.5 km and 10 km; the "
               "question is the radiance of sunlight that the air on the way scatters once.",
       .error_unit = "parts of the radiance",
       .notes = "Direct integration is described in atmosphere/ray/direct_scattering.h. "
                "The marches are given this library's exact columns, its planet's shadow and "
                "its SIMD kernel: only where they look at the air differs, so they are better "
                "and faster here than as published. The table on Bruneton's axes has his "
                "(2017) size, 32 x 128 x 32 x 8 (altitude, view, sun, angle between view and "
                "sun), and a smaller one, filled exactly; his own 50 trapezoids would add their "
                "error. Tables by azimuth are those of skylut build: preview, standard, fine.",
       .wanted = 0.01,
       .cost = CostAxis::kTimeOfAnswer});
}

namespace {

// Styles of the lines of the plot.
enum OrdersStyle {
  kDegree4 = 0,
  kIsotropic = 1,
  kDegree2 = 2,
  kScalar = 3,
  kForwardPeak = 4,
  kNothing = 5,
  kDegree6 = 6,
  kDirectNodes = 7
};

int StyleOf(const MultipleScatteringOptions& options) {
  if (options.delta_m) return kForwardPeak;
  return options.degree == 2 ? kDegree2 : options.degree == 4 ? kDegree4 : kDegree6;
}

// Sampling of a renderer: one set of samples for all orders.
constexpr Sampling kSampling{.nodes = 12, .split_ozone = false, .dark_samples = true};

class OrdersTopic : public TopicWork {
 public:
  OrdersTopic(const Medium& medium, const ReportEffort& effort)
      : TopicWork(medium, effort, TracedViews(medium, effort.traced_rays, effort.paths)),
        air_(medium),
        direct_(medium) {}

  /// @param higher  function from samples and nu to light of orders two and up.
  template <typename Higher>
  void Add(ReportRow row, const Higher& higher) {
    const auto sample = [&](const ViewRay& ray) {
      SampledLight light{air_.Sample(ray, kSampling), {}};
      light.once = air_.Scatter(light.samples);
      return light;
    };
    AddOnSamples(std::move(row), sample, higher);
  }

  /// Adds the default moments on the nodes of direct integration.
  void AddDirect(DirectMode mode) {
    const auto [light, seconds] = Built([&] { return MultipleScattering(medium_); });
    const bool fast = mode == DirectMode::kFast;
    AddOnSamples(
        {.series = "moments on direct nodes",
         .parameter = fast ? "fast" : "normal",
         .style = kDirectNodes,
         .in_summary = true,
         .memory_bytes = light.values().size() * sizeof(float),
         .build_s = seconds},
        [this, mode](const ViewRay& ray) {
          return direct_.Sample(direct_.Place(ray, {.mode = mode, .dark_samples = true}), nullptr);
        },
        [&light = light](const RaySamples<float>& samples, double nu) {
          return light.InscatterAlong(samples, nu);
        });
  }

  template <typename SampleRay, typename Higher>
  void AddOnSamples(ReportRow row, const SampleRay& sample, const Higher& higher) {
    AddRow(
        std::move(row),
        [&](const ViewRay& ray) {
          const auto& [samples, once] = sample(ray);
          Bands<float> light = air_.Inscatter(once, ray.nu);
          const Bands<float> more = higher(samples, ray.nu);
          for (std::size_t band = 0; band < light.count; ++band) light[band] += more[band];
          return light;
        },
        [&](const ViewRay& ray) { return sample(ray).samples.Nodes(); });
  }

  void AddNothing() {
    Add({.series = "single scattering only",
         .parameter = "",
         .style = kNothing,
         .in_summary = true},
        [&](const RaySamples<float>&, double) { return Bands<float>(air_.bands()); });
  }

  void AddIsotropic(const IsotropicTable::Size& size, bool published) {
    const auto [table, seconds] = Built([&] { return IsotropicTable(medium_, size); });
    Add({.series = "isotropic table (Hillaire 2020)",
         .parameter = fmt::format("{} x {}, {} directions", size.side, size.side,
                                  size.directions_side * size.directions_side),
         .origin = MethodOrigin::kLiterature,
         .style = kIsotropic,
         .in_summary = published,
         .memory_bytes = table.bytes(),
         .build_s = seconds},
        [&](const RaySamples<float>& samples, double) { return table.InscatterAlong(samples); });
  }

  void AddMultipleScattering(const MultipleScatteringOptions& options) {
    const MultipleScatteringOptions usual, needed = OptionsFor(medium_);
    const auto is_like = [&](const MultipleScatteringOptions& other) {
      return options.delta_m == other.delta_m && options.degree == other.degree &&
             options.altitudes == other.altitudes && options.sun_angles == other.sun_angles;
    };
    const bool in_summary = is_like(usual) || is_like(needed);
    AddMoments({.series = fmt::format("moments to degree {}{}", options.degree,
                                      options.delta_m ? ", forward peak apart" : ""),
                .parameter = "",
                .style = StyleOf(options),
                .in_summary = in_summary},
               medium_, options);
  }

  /// Adds a row that treats light as unpolarised after every scattering.
  void AddScalar(const MultipleScatteringOptions& options) {
    AddMoments({.series = fmt::format("scalar light, moments to degree {}", options.degree),
                .parameter = "",
                .style = kScalar,
                .in_summary = true},
               InScalarLight(medium_), options);
  }

 private:
  void AddMoments(ReportRow row, const Medium& medium, const MultipleScatteringOptions& options) {
    const auto [light, seconds] = Built([&] { return MultipleScattering(medium, options); });
    row.parameter = fmt::format("{} x {}", options.altitudes, options.sun_angles);
    row.memory_bytes = light.values().size() * sizeof(float);
    row.build_s = seconds;
    Add(std::move(row), [&](const RaySamples<float>& samples, double nu) {
      return light.InscatterAlong(samples, nu);
    });
  }

  SingleScattering<float> air_;
  DirectScattering direct_;
};

ReportTopic WordsOfAllOrders() {
  return {
      .key = "all_orders",
      .title = "All orders: the light of the sky as a whole",
      .what =
          "The same views; the question is the radiance that the air on the way sends to "
          "the eye after any number of scatterings and reflections by the ground. Every "
          "method but \"moments on direct nodes\" takes single scattering from the same 12 Gauss "
          "nodes; only light of orders two and up differs.",
      .error_unit = "parts of the whole radiance",
      .notes =
          "The isotropic table is the one of Hillaire (2020), its integrals taken as "
          "published (64 directions, 20 steps) and with four times the directions. Moments "
          "are this library's spherical-harmonic moments of the diffuse light over altitude "
          "and sun; the "
          "largest is the quality fine of skylut build, which also has more directions. "
          "Where the medium's light is polarised, so is the reference solution's, and scalar light "
          "is "
          "what neglects it: the same single scattering, and moments of scalar light. In "
          "hazy air the forward peak of the aerosol is set apart and found in closed form "
          "(delta-M); only then do more degrees pay, and skylut eval and build take it.",
      .wanted = 0.02,
      .cost = CostAxis::kTimeToBuild};
}

}  // namespace

ReportTopic MeasureAllOrders(const Medium& medium, const ReportEffort& effort) {
  OrdersTopic topic(medium, effort);
  topic.AddNothing();
  topic.AddIsotropic({}, true);
  if (!effort.quick) topic.AddIsotropic({.side = 32, .directions_side = 16, .steps = 20}, false);
  if (medium.polarised) topic.AddScalar({});
  for (const DirectMode mode : {DirectMode::kFast, DirectMode::kNormal}) topic.AddDirect(mode);
  for (const int degree : {2, 4, 6}) {
    MultipleScatteringOptions options;
    const bool usual = degree == options.degree;
    options.degree = degree;
    const MultipleScatteringOptions same = options;
    options.altitudes = 12;
    options.sun_angles = 24;
    if (degree == 2 || !effort.quick) topic.AddMultipleScattering(options);
    if (usual || !effort.quick) topic.AddMultipleScattering(same);
    options.altitudes = 28;
    options.sun_angles = 56;
    if (usual && !effort.quick) topic.AddMultipleScattering(options);
  }
  if (!effort.quick) topic.AddMultipleScattering(TableQualityFromName("fine").multiple_scattering);
  if (const MultipleScatteringOptions needed = OptionsFor(medium); needed.delta_m)
    topic.AddMultipleScattering(needed);
  return std::move(topic).Finished(WordsOfAllOrders());
}

std::vector<Medium> HardMediums() {
  Medium haze = MediumPreset("bruneton2017");
  haze.name = "haze of optical depth 1";
  haze.mie_phase = {{.kind = PhaseKind::kHenyeyGreenstein, .g = 0.8}};
  Medium molecules = MediumPreset("bruneton2017");
  molecules.name = "molecules of optical depth 0.5, 2 and 5";
  for (std::size_t band = 0; band < haze.wavelengths_nm.size(); ++band) {
    haze.mie_extinction_per_m[band] = 1.0 / haze.mie_scale_height_m;
    haze.mie_scattering_per_m[band] = 0.9 / haze.mie_scale_height_m;
    molecules.rayleigh_scattering_per_m[band] =
        std::array{0.5, 2.0, 5.0}[band] / molecules.rayleigh_scale_height_m;
    molecules.mie_scattering_per_m[band] = molecules.mie_extinction_per_m[band] = 0.0;
  }
  return {MediumPreset("mars"), haze, molecules};
}

ReportTopic MeasureHardAir(const Medium& medium, const ReportEffort& effort) {
  ReportEffort fewer = effort;
  fewer.traced_rays = std::min(effort.traced_rays, 12);
  fewer.paths = std::min<std::size_t>(effort.paths, 10000);
  OrdersTopic topic(medium, fewer);
  topic.AddNothing();
  topic.AddIsotropic({}, true);
  topic.AddMultipleScattering({});
  topic.AddMultipleScattering(OptionsFor(medium));
  return std::move(topic).Finished(WordsOfAllOrders());
}

}  // namespace alpenglow::lut
