// SPDX-License-Identifier: MIT
// A topic of the report: light scattered once along a view.
#include <fmt/format.h>

#include "atmosphere/ray/direct_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "lut/store/table_folder.h"
#include "lut/table/scattering_table.h"

namespace alpenglow::lut {
namespace {

// Lines of the plot.
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
      : TopicWork(medium, effort, JudgedViews(medium, effort.rays)),
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
  AirIntegrator<float> air_;
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

}  // namespace alpenglow::lut
