// SPDX-License-Identifier: MIT
// Measures the topics of the report about air in front of terrain that is 1 to 100 km away.
#include "renderer/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/report/report_baselines.h"
#include "lut/tables/scattering_table.h"
#include "lut/tables/transmittance_table.h"
#include "renderer/illumination/aerial_perspective.h"

namespace alpenglow::renderer {
namespace {

// Line styles of the plots.
enum AirStyle {
  kAirPanels = 0,
  kUniform = 1,
  kFroxels = 2,
  kTable = 3,
  kQuadratic = 4,
  kGrey = 5,
};

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

ReferenceRays ReferenceSegments(const Medium& medium, int count) {
  ReferenceRays solution = SolveReferenceRays(
      ErrorKind::kRelative, count,
      [&](int i, const ReportRegime& regime) { return SegmentNumber(medium, i, regime); },
      [&](const ViewRay& ray) {
        return ReferenceRay{ray,
                            reference::SingleScatteringAlong(medium, ray).inscatter,
                            {},
                            DarkestRadiance(medium, ray)};
      });
  solution.reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error below 1e-8";
  return solution;
}

ReferenceRays ReferenceTransmittances(const Medium& medium, int count) {
  ReferenceRays solution = SolveReferenceRays(
      ErrorKind::kAbsolute, count,
      [&](int i, const ReportRegime& regime) { return SegmentNumber(medium, i, regime); },
      [&](const ViewRay& ray) {
        ReferenceRay answer{ray, {}, {}, {}};
        for (const double tau : reference::OpticalDepthAlong(medium, ray).tau)
          answer.truth.push_back(std::exp(-tau));
        return answer;
      });
  solution.reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error of the optical "
      "depth below 1e-10";
  return solution;
}

/// Returns the mean of the bands in every band.
Bands<float> Grey(const Bands<float>& bands) {
  float sum = 0.0F;
  for (std::size_t band = 0; band < bands.count; ++band) sum += bands[band];
  Bands<float> grey(bands.count);
  for (std::size_t band = 0; band < bands.count; ++band)
    grey[band] = sum / static_cast<float>(bands.count);
  return grey;
}

MultipleScatteringOptions NotLookedAt() {
  MultipleScatteringOptions coarse;
  coarse.altitudes = 4;
  coarse.sun_angles = 4;
  coarse.degree = 2;
  coarse.max_orders = 1;
  return coarse;
}

class Topic : public TopicWork {
 public:
  Topic(const Medium& medium, const ReportEffort& effort, ReferenceRays solution)
      : TopicWork(medium, effort, std::move(solution)),
        air_(medium),
        multiple_scattering_(medium, NotLookedAt()),
        aerial_(air_, multiple_scattering_) {}

  void AddPanels(const std::string& parameter, const AerialPerspective::Nodes& nodes,
                 bool in_summary) {
    AddRow(
        {.series = "direct integration",
         .parameter = parameter,
         .style = kAirPanels,
         .in_summary = in_summary},
        [&](const ViewRay& ray) {
          return air_.Inscatter(aerial_.Once(ray, nullptr, nodes), ray.nu);
        },
        [&](const ViewRay& ray) { return aerial_.Sample(ray, nullptr, nodes).samples.Nodes(); });
  }

  void AddMarch(MarchRule rule, int steps, bool in_summary) {
    TopicWork::AddMarch(air_, rule, steps, rule == MarchRule::kMidpoint ? kUniform : kQuadratic,
                        in_summary);
  }

  void AddTable(ScatteringAxes axes, const ScatteringTableSize& size, bool in_summary) {
    const ScatteringTableOptions options{.size = size, .lowest_mu_s = {}, .axes = axes};
    const auto [table, seconds] = Built([&] { return ScatteringTable(medium_, options); });
    AddLookUp(
        {.series = "two look-ups (Bruneton)",
         .parameter = fmt::format("{} x {} x {} x {}", size.altitudes, size.mu, size.mu_s, size.nu),
         .origin = MethodOrigin::kLiterature,
         .style = kTable,
         .in_summary = in_summary,
         .memory_bytes = table.bytes(),
         .build_s = seconds},
        [&](const ViewRay& ray) { return air_.Inscatter(table.Lookup(ray), ray.nu); });
  }

  enum class FroxelValue { kInscatter, kTransmittance, kGreyTransmittance };

  void AddFroxels(FroxelValue value) {
    constexpr std::uint64_t kColumns = FroxelColumn::kSide * FroxelColumn::kSide;
    ReportRow row{
        .series = value == FroxelValue::kGreyTransmittance ? "froxels, grey (Hillaire 2020)"
                                                           : "froxels (Hillaire 2020)",
        .parameter = "32 x 32 x 32",
        .origin = MethodOrigin::kLiterature,
        .style = value == FroxelValue::kGreyTransmittance ? kGrey : kFroxels,
        .in_summary = true,
        .memory_bytes = kColumns * FroxelColumn::kSlices * (air_.bands() + 1) * sizeof(float)};
    for (std::size_t r = 0; r < kReportRegimes; ++r) {
      const std::vector<ReferenceRay>& rays = solution().rays[r];
      const auto [columns, seconds] = Built([&] {
        std::vector<FroxelColumn> made;
        for (const ReferenceRay& one : rays) made.emplace_back(air_, one.ray);
        return made;
      });
      row.build_s = std::max(
          row.build_s, seconds / static_cast<double>(rays.size()) * static_cast<double>(kColumns));
      const auto answer = [&](std::size_t i) {
        const double distance_m = rays[i].ray.length_m;
        if (value == FroxelValue::kInscatter) return columns[i].Inscatter(distance_m);
        const Bands<float> through = columns[i].Transmittance(distance_m);
        return value == FroxelValue::kTransmittance ? through : Grey(through);
      };
      std::vector<std::vector<double>> answers;
      for (std::size_t i = 0; i < rays.size(); ++i) answers.push_back(ValuesOf(answer(i)));
      row.at[r].error = StatisticsOf(rays, solution().kind, answers);
      TimePasses(
          rays.size(), effort_,
          [&] {
            float sum = 0.0F;
            for (std::size_t i = 0; i < rays.size(); ++i) sum += answer(i)[0];
            return sum;
          },
          row.at[r]);
    }
    AddMeasured(std::move(row));
  }

  void AddClosedForms() {
    AddLookUp(
        {.series = "closed form", .parameter = "float", .style = kAirPanels, .in_summary = true},
        [&](const ViewRay& ray) { return air_.TransmittanceAlong(ray); });
    AddLookUp({.series = "closed form, one grey value",
               .parameter = "",
               .origin = MethodOrigin::kLiterature,
               .style = kGrey,
               .in_summary = true},
              [&](const ViewRay& ray) { return Grey(air_.TransmittanceAlong(ray)); });
  }

  void AddTransmittanceMarch(int steps) {
    AddRow(
        {.series = "uniform march",
         .parameter = fmt::format("{} steps", steps),
         .origin = MethodOrigin::kLiterature,
         .style = kUniform,
         .in_summary = steps == 32},
        [&](const ViewRay& ray) {
          return MarchedTransmittance(medium_, ray, MarchRule::kMidpoint, steps);
        },
        [&](const ViewRay&) { return steps; });
  }

  void AddTransmittanceTable(const TransmittanceTableSize& size) {
    const auto [table, seconds] = Built([&] { return TransmittanceTable(medium_, size); });
    AddLookUp({.series = "two look-ups (Bruneton)",
               .parameter = fmt::format("{} x {}", size.mu, size.altitudes),
               .origin = MethodOrigin::kLiterature,
               .style = kTable,
               .in_summary = true,
               .memory_bytes = table.bytes(),
               .build_s = seconds},
              [&](const ViewRay& ray) { return table.LookupAlong(ray); });
  }

  /// Describes the cost of all orders and the transmittance together.
  [[nodiscard]] std::string AllOrdersText() const {
    const MultipleScattering multiple_scattering(medium_);
    const AerialPerspective aerial(air_, multiple_scattering);
    const std::vector<ReferenceRay>& rays = solution().rays[0];
    RegimeResult result;
    TimePasses(
        rays.size(), effort_,
        [&] {
          float sum = 0.0F;
          for (const ReferenceRay& one : rays) sum += aerial.Along(one.ray, {}).inscatter[0];
          return sum;
        },
        result);
    return fmt::format(
        "Light of all orders and transmittance together, automatic nodes: {} a ray by day.",
        QuantityText(result.time_s, PlotUnit::kSeconds));
  }

 private:
  template <typename Answer>
  void AddLookUp(ReportRow row, const Answer& answer) {
    AddRow(std::move(row), answer, [](const ViewRay&) { return 0; });
  }

  SingleScattering<float> air_;
  MultipleScattering multiple_scattering_;
  AerialPerspective aerial_;
};

constexpr char kSegments[] =
    "Eyes at 2 m, 1.5 km and 10 km look at mountainsides up to 4 km high, 1 to 100 km away "
    "(distances in equal ratios), with nothing of the planet between; the sun shines on all of the "
    "way but for the planet's own shadow. ";

}  // namespace

ReportTopic MeasureAerialPerspective(const Medium& medium, const ReportEffort& effort) {
  Topic topic(medium, effort, ReferenceSegments(medium, effort.rays));
  for (const int nodes : {2, 3, 4, 6, 8})
    topic.AddPanels(fmt::format("at most {}", nodes), {.sky = nodes}, nodes == 2 || nodes == 4);
  topic.AddPanels("automatic", {}, true);
  for (const int steps : {8, 16, 32, 64, 128})
    topic.AddMarch(MarchRule::kMidpoint, steps, steps == 32);
  for (const int steps : {8, 16, 32, 64, 128})
    topic.AddMarch(MarchRule::kQuadratic, steps, steps == 32);
  topic.AddFroxels(Topic::FroxelValue::kInscatter);
  topic.AddTable(ScatteringAxes::kBruneton, {.nu = 8, .mu_s = 24, .mu = 64, .altitudes = 16},
                 effort.quick);
  if (!effort.quick) topic.AddTable(ScatteringAxes::kBruneton, {}, true);
  const std::string all_orders = topic.AllOrdersText();
  return std::move(topic).Finished(
      {.key = "aerial_perspective",
       .title = "Aerial perspective: light scattered by the air before a mountain",
       .what = std::string(kSegments) +
               "The question is the radiance of sunlight that the air on the way scatters once.",
       .error_unit = "parts of the radiance",
       .notes =
           "The marches and the froxels are given this library's exact columns, its planet's "
           "shadow and its SIMD kernel: only where they look at the air differs. The froxels "
           "are those of Hillaire (2020), 32 slices to 128 km, each marched to from the eye, "
           "along every ray's own direction: what interpolation across the picture adds is "
           "not counted, and the time to build is that of 32 x 32 such rays. Bruneton and "
           "Neyret (2008) take what lies before the mountain as the difference of two look-ups "
           "in the table of single scattering, here filled exactly. " +
           all_orders,
       .wanted = 0.01,
       .cost = CostAxis::kTimeOfAnswer});
}

ReportTopic MeasureTransmittanceToTerrain(const Medium& medium, const ReportEffort& effort) {
  Topic topic(medium, effort, ReferenceTransmittances(medium, effort.rays));
  topic.AddClosedForms();
  for (const int steps : {8, 32, 128}) topic.AddTransmittanceMarch(steps);
  topic.AddTransmittanceTable({});
  topic.AddFroxels(Topic::FroxelValue::kTransmittance);
  topic.AddFroxels(Topic::FroxelValue::kGreyTransmittance);
  return std::move(topic).Finished(
      {.key = "terrain_transmittance",
       .title = "Transmittance: what the air leaves of a mountain's light",
       .what =
           std::string(kSegments) +
           "The question is which part of the light of the mountainside arrives, in every band.",
       .error_unit = "parts of the mountainside's light",
       .notes = "One grey value for all colours, the mean, is what volumes of four channels keep "
                "beside the scattered light (Hillaire 2020): exact columns do not help it.",
       .wanted = 0.001,
       .cost = CostAxis::kTimeOfAnswer});
}

namespace {

ReportWords WordsOfReport() {
  return {
      .title = "Alpenglow: speed and accuracy of pictures",
      .lead =
          "What a picture of terrain in real air is made of, each part held against a slow "
          "reference solution: "
          "the air before mountains, the shafts of light and shade in it, lamps in fog, and whole "
          "pictures. Methods of this library and of the literature answer the same questions in "
          "one run.",
      .minute =
          "For each topic: the fastest method that nobody could tell from the truth in any of its "
          "columns. An error of 1 % in radiance is about the smallest step that an eye sees side "
          "by side.",
      .reading =
          "Every topic says what it is asked of and what its errors are relative to. Columns are "
          "heights of the sun, kinds of fog, numbers of lamps or times of the day. Where a method "
          "is not made for a column, its cells are empty. Methods of the literature use this "
          "library's columns, geometry and kernels: what is left of their errors is their own."};
}

}  // namespace

Report MeasurePictureReport(const ReportOptions& options) {
  const ReportEffort effort = options.quick ? ReportEffort::Quick() : ReportEffort{};
  std::vector<MeasureTopic> topics;
  for (const auto measure : {MeasureAerialPerspective, MeasureTransmittanceToTerrain}) {
    for (const Medium& medium : options.mediums)
      topics.emplace_back([measure, &medium, &effort] { return measure(medium, effort); });
  }
  for (const auto measure : {MeasureShafts, MeasureAirlight, MeasureManyLamps, MeasurePictures}) {
    topics.emplace_back([measure, &effort] { return measure(effort); });
  }
  return MeasureTopics(WordsOfReport(), options.quick, options.progress, topics);
}

}  // namespace alpenglow::renderer
