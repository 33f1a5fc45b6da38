// SPDX-License-Identifier: MIT
// Topic of the report: light scattered once along a view.
#include <fmt/format.h>

#include "lut/report_baselines.h"
#include "lut/report_measure.h"
#include "lut/scattering_table.h"

namespace alpenglow {
namespace {

// Lines of the plot.
enum Style { kGauss = 0, kMidpoint = 1, kTable = 3, kQuadratic = 4, kGaussSplit = 6 };

class Topic : public TopicWork {
 public:
  Topic(const Medium& medium, const ReportEffort& effort)
      : TopicWork(medium, effort, JudgedViews(medium, effort.rays)), air_(medium) {}

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

  void AddMarch(MarchRule rule, int steps, bool in_summary) {
    const bool midpoint = rule == MarchRule::kMidpoint;
    AddRow(
        {.series = midpoint ? "uniform march" : "quadratic march",
         .parameter = fmt::format("{} steps", steps),
         .origin = MethodOrigin::kLiterature,
         .style = midpoint ? kMidpoint : kQuadratic,
         .in_summary = in_summary},
        [&](const ViewRay& ray) {
          const RayExtent extent =
              ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
          const auto samples = air_.SampleAt(ray, MarchNodes(rule, steps, extent));
          return air_.Inscatter(air_.Scatter(samples), ray.nu);
        },
        [&](const ViewRay&) { return steps; });
  }

  void AddTable(const ScatteringTableSize& size, bool in_summary) {
    const auto [table, seconds] =
        Built([&] { return ScatteringTable(medium_, {.size = size, .lowest_mu_s = {}}); });
    AddRow(
        {.series = "4-D table",
         .parameter = fmt::format("{} x {} x {} x {}", size.altitudes, size.mu, size.mu_s, size.nu),
         .style = kTable,
         .in_summary = in_summary,
         .memory_bytes = table.bytes(),
         .build_s = seconds},
        [&](const ViewRay& ray) { return air_.Inscatter(table.Lookup(ray), ray.nu); },
        [](const ViewRay&) { return 0; });
  }

 private:
  AirIntegrator<float> air_;
};

}  // namespace

ReportTopic MeasureSingleScattering(const Medium& medium, const ReportEffort& effort) {
  Topic topic(medium, effort);
  for (const int nodes : {4, 6, 8, 12, 16, 24})
    topic.AddGauss(nodes, false, nodes == 8 || nodes == 12);
  for (const int nodes : {4, 6, 8, 12, 16, 24}) topic.AddGauss(nodes, true, nodes == 16);
  for (const int steps : {16, 32, 64, 128, 256, 512})
    topic.AddMarch(MarchRule::kMidpoint, steps, steps == 64);
  for (const int steps : {16, 32, 64, 128, 256, 512})
    topic.AddMarch(MarchRule::kQuadratic, steps, steps == 32);
  topic.AddTable({.nu = 8, .mu_s = 24, .mu = 64, .altitudes = 16}, false);
  if (!effort.quick) {
    topic.AddTable({}, true);
    topic.AddTable({.nu = 16, .mu_s = 48, .mu = 192, .altitudes = 48}, false);
  }
  return std::move(topic).Finished(
      {.key = "single_scattering",
       .title = "Single scattering: sunlight scattered once towards the eye",
       .what = "Views to the sky and down to the ground from 2 m, 1.5 km and 10 km; the "
               "question is the radiance of sunlight that the air on the way scatters once.",
       .error_unit = "parts of the radiance",
       .notes = "The marches are given this library's exact columns, its planet's shadow and "
                "its SIMD kernel: only where they look at the air differs, so they are better "
                "and faster here than as published. The 4-D table has the size of Bruneton "
                "(2017), 32 x 128 x 32 x 8 (altitude, view, sun, angle between), filled with "
                "12 Gauss nodes a panel; the others are the qualities preview and fine of "
                "skylut build.",
       .wanted = 0.01,
       .cost = CostAxis::kTimeOfAnswer});
}

}  // namespace alpenglow
