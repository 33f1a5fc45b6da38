// SPDX-License-Identifier: MIT
#include "lut/report/report_scattering.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "atmosphere/ray/direct_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_rays.h"
#include "lut/table_io/table_folder.h"
#include "lut/tables/scattering_table.h"

namespace alpenglow::lut {
namespace {

void AddGauss(RayStudy& study, int nodes, bool split_ozone, bool in_summary) {
  const SingleScattering<float>& air = study.air();
  const Sampling sampling{.nodes = nodes, .split_ozone = split_ozone};
  study.Add(
      {.series = split_ozone ? "Gauss, cut at ozone" : "Gauss",
       .parameter = fmt::format("{} nodes", nodes),
       .in_summary = in_summary},
      [&](const ViewRay& ray) {
        return air.Inscatter(air.Scatter(air.Sample(ray, sampling)), ray.nu);
      },
      [&](const ViewRay& ray) { return air.Sample(ray, sampling).count; });
}

void AddDirect(RayStudy& study, const DirectScattering& direct, DirectMode mode) {
  const bool fast = mode == DirectMode::kFast;
  study.Add(
      {.series = "direct integration",
       .parameter = fast ? "fast, 7 nodes a panel" : "normal, 14 nodes a panel",
       .in_summary = true},
      [&](const ViewRay& ray) { return study.air().Inscatter(direct.Scatter(ray, mode), ray.nu); },
      [&](const ViewRay& ray) { return direct.Sample(ray, {.mode = mode}).count; });
}

void AddScatteringTables(RayStudy& study) {
  const bool quick = study.effort().quick;
  ReportRow row{
      .series = "4-D table (Bruneton)", .parameter = "", .origin = MethodOrigin::kLiterature};
  study.AddScatteringTable(
      row, {.size = {.nu = 8, .mu_s = 24, .mu = 64, .altitudes = 16}, .lowest_mu_s = {}});
  row.in_summary = true;
  if (!quick) study.AddScatteringTable(row, {});
  for (const BakeQuality quality :
       {BakeQuality::kPreview, BakeQuality::kStandard, BakeQuality::kFine}) {
    study.AddScatteringTable({.series = "table by azimuth",
                              .parameter = "",
                              .in_summary = quality == BakeQuality::kStandard},
                             {.size = SizesOf(quality).single_scattering,
                              .lowest_mu_s = {},
                              .axes = ScatteringAxes::kAzimuth});
    if (quick) break;
  }
}

/// Adds a method for light of all orders.
/// @param sample  function from a ray to the samples and the light scattered once: SampledLight.
/// @param higher  function from samples and nu to light of orders two and up.
template <typename SampleRay, typename Higher>
void AddOnSamples(RayStudy& study, ReportRow row, const SampleRay& sample, const Higher& higher) {
  study.Add(
      std::move(row),
      [&](const ViewRay& ray) {
        const auto& [samples, once] = sample(ray);
        Spectrum light = study.air().Inscatter(once, ray.nu);
        const Spectrum more = higher(samples, ray.nu);
        for (std::size_t band = 0; band < light.size(); ++band) light[band] += more[band];
        return light;
      },
      [&](const ViewRay& ray) { return sample(ray).samples.Nodes(); });
}

/// Adds a method on 12 Gauss nodes: one set of samples for all orders, as a renderer has them.
template <typename Higher>
void AddOnGauss(RayStudy& study, ReportRow row, const Higher& higher) {
  constexpr Sampling kSampling{.nodes = 12, .split_ozone = false, .dark_samples = true};
  const auto sample = [&](const ViewRay& ray) {
    SampledLight light{study.air().Sample(ray, kSampling), {}};
    light.once = study.air().Scatter(light.samples);
    return light;
  };
  AddOnSamples(study, std::move(row), sample, higher);
}

/// Adds the default moments on the nodes of direct integration.
void AddMomentsOnDirectNodes(RayStudy& study, const DirectScattering& direct, DirectMode mode) {
  const auto [light, seconds] =
      Built(study.effort(), [&] { return MultipleScattering(study.medium()); });
  AddOnSamples(
      study,
      {.series = "moments on direct nodes",
       .parameter = mode == DirectMode::kFast ? "fast" : "normal",
       .in_summary = true,
       .memory_bytes = light.values().size() * sizeof(float),
       .build_s = seconds},
      [&](const ViewRay& ray) {
        return direct.Sample(direct.Place(ray, {.mode = mode, .dark_samples = true}), nullptr);
      },
      [&light = light](const RaySamples<float>& samples, double nu) {
        return light.InscatterAlong(samples, nu);
      });
}

void AddNothing(RayStudy& study) {
  AddOnGauss(study, {.series = "single scattering only", .parameter = "", .in_summary = true},
             [&](const RaySamples<float>&, double) { return Spectrum(study.air().bands()); });
}

void AddIsotropic(RayStudy& study, const IsotropicTable::Size& size, bool published) {
  const auto [table, seconds] =
      Built(study.effort(), [&] { return IsotropicTable(study.medium(), size); });
  AddOnGauss(study,
             {.series = "isotropic table (Hillaire 2020)",
              .parameter = fmt::format("{} x {}, {} directions", size.side, size.side,
                                       size.directions_side * size.directions_side),
              .origin = MethodOrigin::kLiterature,
              .in_summary = published,
              .memory_bytes = table.bytes(),
              .build_s = seconds},
             [&table = table](const RaySamples<float>& samples, double) {
               return table.InscatterAlong(samples);
             });
}

void AddMoments(RayStudy& study, ReportRow row, const Medium& medium,
                const MultipleScatteringOptions& options) {
  const auto [light, seconds] =
      Built(study.effort(), [&] { return MultipleScattering(medium, options); });
  row.parameter = fmt::format("{} x {}", options.altitudes, options.sun_angles);
  row.memory_bytes = light.values().size() * sizeof(float);
  row.build_s = seconds;
  AddOnGauss(study, std::move(row), [&light = light](const RaySamples<float>& samples, double nu) {
    return light.InscatterAlong(samples, nu);
  });
}

void AddMultipleScattering(RayStudy& study, const MultipleScatteringOptions& options) {
  const auto is_like = [&](const MultipleScatteringOptions& other) {
    return options.delta_m == other.delta_m && options.degree == other.degree &&
           options.altitudes == other.altitudes && options.sun_angles == other.sun_angles;
  };
  AddMoments(study,
             {.series = fmt::format("moments to degree {}{}", options.degree,
                                    options.delta_m ? ", forward peak apart" : ""),
              .parameter = "",
              .in_summary = is_like({}) || is_like(OptionsFor(study.medium()))},
             study.medium(), options);
}

/// Adds a row that treats light as unpolarised after every scattering.
void AddScalar(RayStudy& study) {
  const MultipleScatteringOptions options;
  AddMoments(study,
             {.series = fmt::format("scalar light, moments to degree {}", options.degree),
              .parameter = "",
              .in_summary = true},
             InScalarLight(study.medium()), options);
}

/// Adds moments of several degrees on grids of several sizes.
void AddDegrees(RayStudy& study) {
  const bool quick = study.effort().quick;
  for (const int degree : {2, 4, 6}) {
    MultipleScatteringOptions options;
    const bool usual = degree == options.degree;
    options.degree = degree;
    const MultipleScatteringOptions same = options;
    options.altitudes = 12;
    options.sun_angles = 24;
    if (degree == 2 || !quick) AddMultipleScattering(study, options);
    if (usual || !quick) AddMultipleScattering(study, same);
    options.altitudes = 28;
    options.sun_angles = 56;
    if (usual && !quick) AddMultipleScattering(study, options);
  }
  if (!quick) AddMultipleScattering(study, SizesOf(BakeQuality::kFine).multiple_scattering);
}

ReportTopic WordsOfAllOrders() {
  return {
      .key = "all_orders",
      .title = "All orders: the whole light of the sky",
      .what =
          "The same views. The methods compute the radiance that the air along the view sends to "
          "the observer after any number of scatterings and reflections by the ground. Every "
          "method except \"moments on direct nodes\" takes single scattering from the same 12 "
          "Gauss nodes; only light of orders two and up differs.",
      .error_unit = "fractions of the whole radiance",
      .notes =
          "The isotropic table is the one of Hillaire (2020), with its integrals as "
          "published (64 directions, 20 steps) and with four times the directions. Moments "
          "are this library's spherical-harmonic moments of the diffuse light over altitude "
          "and sun; the largest is the quality fine of skylut build, which also has more "
          "directions. If the medium's light is polarised, so is that of the reference solution. "
          "Scalar light neglects polarisation: it has the same single scattering, and moments of "
          "scalar light. In hazy air the forward peak of the aerosol is treated separately and in "
          "closed form (delta-M). Only then do more degrees reduce the error, and skylut eval and "
          "build use them.",
      .wanted = 0.02,
      .cost = CostAxis::kTimeToBuild};
}

}  // namespace

ReportTopic MeasureSingleScattering(const Medium& medium, const ReportEffort& effort) {
  RayStudy study(
      {.key = "single_scattering",
       .title = "Single scattering: sunlight scattered once towards the observer",
       .what = "Views of the sky and of the ground from 2 m, 1.5 km and 10 km. The methods "
               "compute the radiance of sunlight that the air along the view scatters once.",
       .error_unit = "fractions of the radiance",
       .notes = "Direct integration is described in atmosphere/ray/direct_scattering.h. "
                "The marches use this library's exact columns, its shadow of the planet and "
                "its SIMD kernel: they differ only in the points at which they sample the air, so "
                "that they are more accurate and faster here than as published. The table on "
                "Bruneton's axes has his (2017) size, 32 x 128 x 32 x 8 (altitude, view, sun, "
                "angle between view and sun), and a smaller one, filled exactly; his own 50 "
                "trapezoids would add their error. Tables by azimuth are those of skylut build: "
                "preview, standard, fine."},
      medium, effort);
  study.SolveSingleScattering(ViewNumber);
  const DirectScattering direct(medium);
  for (const int nodes : {4, 6, 8, 12, 16, 20})
    AddGauss(study, nodes, false, nodes == 8 || nodes == 12 || nodes == 20);
  for (const DirectMode mode : {DirectMode::kFast, DirectMode::kNormal})
    AddDirect(study, direct, mode);
  if (medium.ozone.shape == OzoneShape::kTent) {
    for (const int nodes : {4, 6, 8, 12, 16, 20}) AddGauss(study, nodes, true, nodes == 16);
  }
  for (const int steps : {16, 32, 64, 128, 256, 512})
    study.AddScatteringMarch(MarchRule::kMidpoint, steps, steps == 64);
  for (const int steps : {16, 32, 64, 128, 256, 512})
    study.AddScatteringMarch(MarchRule::kQuadratic, steps, steps == 32);
  AddScatteringTables(study);
  return std::move(study).Finished();
}

ReportTopic MeasureAllOrders(const Medium& medium, const ReportEffort& effort) {
  RayStudy study(WordsOfAllOrders(), medium, effort);
  study.SolveAllOrders();
  const DirectScattering direct(medium);
  AddNothing(study);
  AddIsotropic(study, {}, true);
  if (!effort.quick) AddIsotropic(study, {.side = 32, .directions_side = 16, .steps = 20}, false);
  if (medium.polarised) AddScalar(study);
  for (const DirectMode mode : {DirectMode::kFast, DirectMode::kNormal})
    AddMomentsOnDirectNodes(study, direct, mode);
  AddDegrees(study);
  if (const MultipleScatteringOptions needed = OptionsFor(medium); needed.delta_m)
    AddMultipleScattering(study, needed);
  return std::move(study).Finished();
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
  RayStudy study(WordsOfAllOrders(), medium, fewer);
  study.SolveAllOrders();
  AddNothing(study);
  AddIsotropic(study, {}, true);
  AddMultipleScattering(study, {});
  AddMultipleScattering(study, OptionsFor(medium));
  return std::move(study).Finished();
}

}  // namespace alpenglow::lut
