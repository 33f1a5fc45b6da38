// SPDX-License-Identifier: MIT
// A topic of the report: the light of all orders along a view.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "atmosphere/ray/direct_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "lut/store/table_folder.h"

namespace alpenglow::lut {
namespace {

// Lines of the plot.
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

int StyleOf(const DiffuseLightOptions& options) {
  if (options.forward_peak) return kForwardPeak;
  return options.degree == 2 ? kDegree2 : options.degree == 4 ? kDegree4 : kDegree6;
}

// What a renderer takes: one set of samples for all orders.
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

  /// The usual moments on the nodes of direct integration.
  void AddDirect(DirectMode mode) {
    const auto [light, seconds] = Built([&] { return DiffuseLight(medium_); });
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

  void AddDiffuse(const DiffuseLightOptions& options) {
    const DiffuseLightOptions usual, needed = OptionsFor(medium_);
    const auto is_like = [&](const DiffuseLightOptions& other) {
      return options.forward_peak == other.forward_peak && options.degree == other.degree &&
             options.altitudes == other.altitudes && options.sun_angles == other.sun_angles;
    };
    const bool in_summary = is_like(usual) || is_like(needed);
    AddMoments({.series = fmt::format("moments to degree {}{}", options.degree,
                                      options.forward_peak ? ", forward peak apart" : ""),
                .parameter = "",
                .style = StyleOf(options),
                .in_summary = in_summary},
               medium_, options);
  }

  /// As if each scattering left light unpolarised.
  void AddScalar(const DiffuseLightOptions& options) {
    AddMoments({.series = fmt::format("scalar light, moments to degree {}", options.degree),
                .parameter = "",
                .style = kScalar,
                .in_summary = true},
               InScalarLight(medium_), options);
  }

 private:
  void AddMoments(ReportRow row, const Medium& medium, const DiffuseLightOptions& options) {
    const auto [light, seconds] = Built([&] { return DiffuseLight(medium, options); });
    row.parameter = fmt::format("{} x {}", options.altitudes, options.sun_angles);
    row.memory_bytes = light.values().size() * sizeof(float);
    row.build_s = seconds;
    Add(std::move(row), [&](const RaySamples<float>& samples, double nu) {
      return light.InscatterAlong(samples, nu);
    });
  }

  AirIntegrator<float> air_;
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
          "Where the medium's light is polarised, so is the judge's, and scalar light is "
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
    DiffuseLightOptions options;
    const bool usual = degree == options.degree;
    options.degree = degree;
    const DiffuseLightOptions same = options;
    options.altitudes = 12;
    options.sun_angles = 24;
    if (degree == 2 || !effort.quick) topic.AddDiffuse(options);
    if (usual || !effort.quick) topic.AddDiffuse(same);
    options.altitudes = 28;
    options.sun_angles = 56;
    if (usual && !effort.quick) topic.AddDiffuse(options);
  }
  if (!effort.quick) topic.AddDiffuse(TableQualityFromName("fine").multiple_scattering);
  if (const DiffuseLightOptions needed = OptionsFor(medium); needed.forward_peak)
    topic.AddDiffuse(needed);
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
  topic.AddDiffuse({});
  topic.AddDiffuse(OptionsFor(medium));
  return std::move(topic).Finished(WordsOfAllOrders());
}

}  // namespace alpenglow::lut
