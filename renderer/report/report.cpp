// SPDX-License-Identifier: MIT
// Measures the topics of the report about air in front of terrain that is 1 to 100 km away.
#include "renderer/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_rays.h"
#include "lut/report/svg_plot.h"
#include "lut/tables/transmittance_table.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/report/report_caustics.h"
#include "renderer/report/report_clouds.h"
#include "renderer/report/report_lamps.h"
#include "renderer/report/report_layers.h"
#include "renderer/report/report_pictures.h"
#include "renderer/report/report_shafts.h"
#include "renderer/report/report_volumes.h"

namespace alpenglow::renderer {
namespace {

/// Returns segment number i >= 1 of Halton's sequence: from an eye to a mountainside, both on or
/// above the ground, without the planet in between. The sequence gives the altitudes [m] of the eye
/// and of the other end.
ViewRay SegmentNumber(const Medium& medium, int i, const ReportRegime& regime) {
  if (regime.from_space) {
    ViewRay ray = GroundFromSpaceNumber(medium, i, regime);
    ray.length_m = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m).end_m;
    return ray;
  }
  constexpr std::array<double, 3> kEyes_m{2.0, 1500.0, 10000.0};
  constexpr double kHighestSummit_m = 4000.0;
  const double radius = medium.planet_radius_m;
  const double eye = kEyes_m[static_cast<std::size_t>(3.0 * Halton(i, 7))];
  const double length = 1e3 * std::pow(100.0, Halton(i, 3));
  const double beyond_horizon = std::max(length - std::sqrt(2.0 * radius * eye), 0.0);
  const double least = beyond_horizon * beyond_horizon / (2.0 * radius);
  const double end =
      std::clamp(least + kHighestSummit_m * Halton(i, 11), eye - 0.9 * length, eye + 0.9 * length);
  // Law of cosines in the triangle of eye, end and the planet's centre.
  const double mu = ((end - eye) * (2.0 * radius + end + eye) - length * length) /
                    (2.0 * length * (radius + eye));
  ViewRay ray = RayFromAngles(eye, std::acos(std::clamp(mu, -1.0, 1.0)) / kRadiansPerDegree,
                              180.0 * Halton(i, 5), 90.0 - SunElevationNumber(i, regime));
  ray.length_m = length;
  return ray;
}

/// The slices of a froxel volume along one ray, reimplemented from Hillaire (2020), Computer
/// Graphics Forum 39, 13, section 5.4: inscatter and transmittance up to each slice, linear in
/// between. Slice k of 32 ends at 128 km (k / 32)^2 and is marched to from the eye in 2 k
/// steps.
class FroxelColumn {
 public:
  static constexpr int kSlices = 32;
  static constexpr double kFarthest_m = 128e3;
  static constexpr int kSide = 32;  // froxels of the volume across the picture

  FroxelColumn(const SingleScattering<float>& air, const ViewRay& ray) : slices_(kSlices + 1) {
    slices_[0] = {Spectrum(air.bands()), Spectrum(air.bands())};
    for (std::size_t band = 0; band < air.bands(); ++band) slices_[0].transmittance[band] = 1.0F;
    const Medium& medium = air.medium();
    for (int k = 1; k <= kSlices; ++k) {
      ViewRay part = ray;
      part.length_m = kFarthest_m * k * k / (kSlices * kSlices);
      const RayExtent extent = ExtentOf(part, medium.planet_radius_m, medium.atmosphere_height_m);
      const auto once =
          air.Scatter(air.SampleAt(part, MarchNodes(MarchRule::kMidpoint, 2 * k, extent)));
      slices_[static_cast<std::size_t>(k)] = {
          air.Inscatter(once, ray.nu),
          MarchedTransmittance(medium, part, MarchRule::kMidpoint, 2 * k)};
    }
  }

  [[nodiscard]] Spectrum Inscatter(double distance_m) const {
    return Between(distance_m, &AirAlongRay::inscatter);
  }
  [[nodiscard]] Spectrum Transmittance(double distance_m) const {
    return Between(distance_m, &AirAlongRay::transmittance);
  }

 private:
  [[nodiscard]] Spectrum Between(double distance_m, Spectrum AirAlongRay::*part) const {
    const double slice =
        std::min(std::sqrt(distance_m / kFarthest_m) * kSlices, static_cast<double>(kSlices));
    const auto low = std::min(static_cast<std::size_t>(slice), std::size_t{kSlices} - 1);
    const auto share = static_cast<float>(slice - static_cast<double>(low));
    const Spectrum& from = slices_[low].*part;
    const Spectrum& to = slices_[low + 1].*part;
    Spectrum mixed(from.size());
    for (std::size_t band = 0; band < mixed.size(); ++band)
      mixed[band] = (1.0F - share) * from[band] + share * to[band];
    return mixed;
  }

  std::vector<AirAlongRay> slices_;
};

/// Returns the mean of the bands in every band.
Spectrum Grey(const Spectrum& bands) {
  float sum = 0.0F;
  for (std::size_t band = 0; band < bands.size(); ++band) sum += bands[band];
  Spectrum grey(bands.size());
  for (std::size_t band = 0; band < bands.size(); ++band)
    grey[band] = sum / static_cast<float>(bands.size());
  return grey;
}

/// Returns coarse light of higher orders, for objects that need it and do not use it here.
MultipleScattering UnusedMultipleScattering(const Medium& medium) {
  return MultipleScattering(medium,
                            {.altitudes = 4, .sun_angles = 4, .degree = 2, .max_orders = 1});
}

void AddPanels(RayStudy& study, const AerialPerspective& aerial, const std::string& parameter,
               const AerialPerspective::Nodes& nodes, bool in_summary) {
  study.Add(
      {.series = "direct integration", .parameter = parameter, .in_summary = in_summary},
      [&](const ViewRay& ray) {
        return study.air().Inscatter(aerial.Once(ray, nullptr, nodes), ray.nu);
      },
      [&](const ViewRay& ray) { return aerial.Sample(ray, nullptr, nodes).samples.Nodes(); });
}

void AddScatteringTables(RayStudy& study) {
  ReportRow row{.series = "two look-ups (Bruneton)",
                .parameter = "",
                .origin = MethodOrigin::kLiterature,
                .in_summary = study.effort().quick};
  study.AddScatteringTable(
      row, {.size = {.nu = 8, .mu_s = 24, .mu = 64, .altitudes = 16}, .lowest_mu_s = {}});
  row.in_summary = true;
  if (!study.effort().quick) study.AddScatteringTable(row, {});
}

/// Adds froxels. @param value  function from a column and a distance [m] to the values of a ray.
template <typename Value>
void AddFroxels(RayStudy& study, const std::string& series, const Value& value) {
  constexpr std::uint64_t kColumns = FroxelColumn::kSide * FroxelColumn::kSide;
  const auto prepare = [&](std::size_t r, ReportRow& row) {
    const std::vector<ViewRay>& rays = study.cases(r);
    auto [columns, seconds] = Built(study.effort(), [&] {
      std::vector<FroxelColumn> made;
      for (const ViewRay& ray : rays) made.emplace_back(study.air(), ray);
      return made;
    });
    row.build_s = std::max(
        row.build_s, seconds / static_cast<double>(rays.size()) * static_cast<double>(kColumns));
    return [&value, first = rays.data(), columns = std::move(columns)](const ViewRay& ray) {
      const auto i = static_cast<std::size_t>(&ray - first);
      return value(columns[i], ray.length_m);
    };
  };
  study.AddPrepared({.series = series,
                     .parameter = "32 x 32 x 32",
                     .origin = MethodOrigin::kLiterature,
                     .in_summary = true,
                     .memory_bytes = kColumns * FroxelColumn::kSlices * (study.air().bands() + 1) *
                                     sizeof(float)},
                    prepare);
}

void AddClosedForms(RayStudy& study) {
  study.Add({.series = "closed form", .parameter = "float", .in_summary = true},
            [&](const ViewRay& ray) { return study.air().TransmittanceAlong(ray); });
  study.Add({.series = "closed form, one grey value",
             .parameter = "",
             .origin = MethodOrigin::kLiterature,
             .in_summary = true},
            [&](const ViewRay& ray) { return Grey(study.air().TransmittanceAlong(ray)); });
}

void AddTransmittanceTable(RayStudy& study) {
  const TransmittanceTableSize size;
  const auto [table, seconds] =
      Built(study.effort(), [&] { return TransmittanceTable(study.medium(), size); });
  study.Add({.series = "two look-ups (Bruneton)",
             .parameter = fmt::format("{} x {}", size.mu, size.altitudes),
             .origin = MethodOrigin::kLiterature,
             .in_summary = true,
             .memory_bytes = table.bytes(),
             .build_s = seconds},
            [&table = table](const ViewRay& ray) { return table.LookupAlong(ray); });
}

/// Describes the cost of all orders and the transmittance together.
std::string AllOrdersText(const RayStudy& study) {
  const MultipleScattering multiple_scattering(study.medium());
  const AerialPerspective aerial(study.air(), multiple_scattering);
  const std::vector<ViewRay>& rays = study.cases(0);
  RegimeResult result;
  const auto pass = [&] {
    float sum = 0.0F;
    for (const ViewRay& ray : rays) sum += aerial.Along(ray, {}).inscatter[0];
    return sum;
  };
  TimePasses(rays.size(), study.effort(), pass, result);
  return fmt::format(
      "Light of all orders and transmittance together, with automatic nodes, take {} per ray by "
      "day.",
      QuantityText(result.time_s, PlotUnit::kSeconds));
}

constexpr char kSegments[] =
    "Rays from observers at 2 m, 1.5 km and 10 km to mountainsides up to 4 km high, 1 to 100 km "
    "away (uniform in the logarithm of the distance), without the planet in between. The sun "
    "lights "
    "the whole ray except for the shadow of the planet. ";

ReportWords WordsOfReport() {
  return {
      .title = "Alpenglow: speed and accuracy of pictures",
      .lead =
          "The parts of a picture of terrain in real air are compared with slow reference "
          "solutions: the air in front of mountains, shafts of light and shadow in it, clouds, "
          "plane "
          "layers of cloud, plumes of smoke, the caustic of a glass sphere, lamps in fog, and "
          "whole "
          "pictures. Methods of this library and of the literature are evaluated on the same cases "
          "in one run.",
      .minute =
          "For each topic, this section names the fastest method whose errors are not visible in "
          "any of its columns. An error of 1 % in radiance is about the smallest step between "
          "adjacent areas that an observer sees.",
      .reading =
          "Every topic describes its cases and the values to which its errors are relative. "
          "Columns "
          "are elevations of the sun, optical depths, kinds of fog, numbers of lamps or times of "
          "the "
          "day. Cells are empty if a method does not support a column. Methods of the literature "
          "use "
          "this library's columns, geometry and kernels, so that the remaining errors are their "
          "own."};
}

}  // namespace

ReportTopic MeasureAerialPerspective(const Medium& medium, const ReportEffort& effort) {
  RayStudy study(
      {.key = "aerial_perspective",
       .title = "Aerial perspective: light scattered by the air in front of a mountain",
       .what = std::string(kSegments) +
               "The methods compute the radiance of sunlight that the air along the ray scatters "
               "once.",
       .error_unit = "fractions of the radiance",
       .notes =
           "The marches and the froxels use this library's exact columns, its shadow of the planet "
           "and its SIMD kernel: they differ only in the points at which they sample the air. The "
           "froxels are those of Hillaire (2020), 32 slices to 128 km, each marched from the "
           "observer along the direction of every ray: errors of interpolation across the picture "
           "are not included, and the time to build is that of 32 x 32 such rays. Bruneton and "
           "Neyret (2008) compute the light in front of a mountain as the difference of two "
           "look-ups in the table of single scattering, which is filled exactly here. "},
      medium, effort);
  study.SolveSingleScattering(SegmentNumber);
  const MultipleScattering coarse = UnusedMultipleScattering(medium);
  const AerialPerspective aerial(study.air(), coarse);
  for (const int nodes : {2, 3, 4, 6, 8}) {
    AddPanels(study, aerial, fmt::format("at most {}", nodes), {.sky = nodes},
              nodes == 2 || nodes == 4);
  }
  AddPanels(study, aerial, "automatic", {}, true);
  for (const MarchRule rule : {MarchRule::kMidpoint, MarchRule::kQuadratic}) {
    for (const int steps : {8, 16, 32, 64, 128}) study.AddScatteringMarch(rule, steps, steps == 32);
  }
  AddFroxels(study, "froxels (Hillaire 2020)", [](const FroxelColumn& column, double distance_m) {
    return column.Inscatter(distance_m);
  });
  AddScatteringTables(study);
  study.topic().notes += AllOrdersText(study);
  return std::move(study).Finished();
}

ReportTopic MeasureTransmittanceToTerrain(const Medium& medium, const ReportEffort& effort) {
  RayStudy study(
      {.key = "terrain_transmittance",
       .title = "Transmittance: the part of a mountain's light that the air transmits",
       .what = std::string(kSegments) +
               "The methods compute the part of the light of the mountainside that arrives, in "
               "every band.",
       .error_unit = "fractions of the mountainside's light",
       .notes = "Volumes of four channels store one grey value for all colours, the mean, next to "
                "the scattered light (Hillaire 2020). Exact columns do not reduce its error.",
       .wanted = 0.001},
      medium, effort);
  study.SolveTransmittance(SegmentNumber);
  AddClosedForms(study);
  for (const int steps : {8, 32, 128})
    study.AddTransmittanceMarch("uniform march", MarchRule::kMidpoint, steps, steps == 32);
  AddTransmittanceTable(study);
  AddFroxels(study, "froxels (Hillaire 2020)", [](const FroxelColumn& column, double distance_m) {
    return column.Transmittance(distance_m);
  });
  AddFroxels(study, "froxels, grey (Hillaire 2020)",
             [](const FroxelColumn& column, double distance_m) {
               return Grey(column.Transmittance(distance_m));
             });
  return std::move(study).Finished();
}

Report MeasurePictureReport(const ReportOptions& options) {
  const ReportEffort effort = options.quick ? ReportEffort::Quick() : ReportEffort{};
  std::vector<MeasureTopic> topics;
  for (const auto measure : {MeasureAerialPerspective, MeasureTransmittanceToTerrain}) {
    for (const Medium& medium : options.mediums)
      topics.emplace_back([measure, &medium, &effort] { return measure(medium, effort); });
  }
  for (const auto measure : {MeasureShafts, MeasureClouds, MeasureLayers, MeasureVolumes,
                             MeasureCaustics, MeasureAirlight, MeasureManyLamps, MeasurePictures}) {
    topics.emplace_back([measure, &effort] { return measure(effort); });
  }
  return MeasureTopics(WordsOfReport(), options.quick, options.progress, topics);
}

}  // namespace alpenglow::renderer
