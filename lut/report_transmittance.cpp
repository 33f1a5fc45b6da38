// SPDX-License-Identifier: MIT
// Topic of the report: transmittance from a point to the sun.
#include <fmt/format.h>

#include "lut/report_baselines.h"
#include "lut/report_measure.h"
#include "lut/transmittance_table.h"

namespace alpenglow {
namespace {

// Lines of the plot.
enum Style {
  kClosedForm = 0,
  kMidpoint = 1,
  kTable = 3,
  kChapman = 4,
  kTrapezoid = 5,
  kGolubev = 6
};

class Topic : public TopicWork {
 public:
  Topic(const Medium& medium, const ReportEffort& effort)
      : TopicWork(medium, effort, JudgedSunbeams(medium, effort.rays)) {}

  template <typename Answer>
  void Add(ReportRow row, int samples, const Answer& answer) {
    AddRow(std::move(row), answer, [samples](const ViewRay&) { return samples; });
  }

  void AddClosedForms() {
    const AirIntegrator<float> air(medium_);
    Add({.series = "closed form", .parameter = "float", .style = kClosedForm, .in_summary = true},
        0, [&](const ViewRay& ray) { return air.TransmittanceToSpace(ray.altitude_m, ray.mu); });
    const AirIntegrator<double> exact(medium_);
    Add({.series = "closed form", .parameter = "double", .style = kClosedForm}, 0,
        [&](const ViewRay& ray) { return exact.TransmittanceToSpace(ray.altitude_m, ray.mu); });
  }

  void AddTable(const TransmittanceTableSize& size) {
    const auto [table, seconds] = Built([&] { return TransmittanceTable(medium_, size); });
    const bool published = size.mu == 256;
    Add({.series = "table",
         .parameter = fmt::format("{} x {}", size.mu, size.altitudes),
         .style = kTable,
         .in_summary = published,
         .memory_bytes = table.bytes(),
         .build_s = seconds},
        0, [&](const ViewRay& ray) { return table.Lookup(ray.altitude_m, ray.mu); });
  }

  void AddMarch(MarchRule rule, int steps, bool in_summary) {
    const bool midpoint = rule == MarchRule::kMidpoint;
    Add({.series = midpoint ? "midpoint march" : "trapezoid march",
         .parameter = fmt::format("{} steps", steps),
         .origin = MethodOrigin::kLiterature,
         .style = midpoint ? kMidpoint : kTrapezoid,
         .in_summary = in_summary},
        steps, [&](const ViewRay& ray) { return MarchedTransmittance(medium_, ray, rule, steps); });
  }

  void AddChapman(ChapmanRule rule) {
    const AirIntegrator<float> air(medium_);
    const bool schueler = rule == ChapmanRule::kSchueler;
    Add({.series = schueler ? "Schüler 2012" : "Golubev 2019",
         .parameter = "",
         .origin = MethodOrigin::kLiterature,
         .style = schueler ? kChapman : kGolubev,
         .in_summary = true},
        0, [&](const ViewRay& ray) { return ChapmanTransmittance(air, rule, ray); });
  }
};

}  // namespace

ReportTopic MeasureTransmittance(const Medium& medium, const ReportEffort& effort) {
  Topic topic(medium, effort);
  topic.AddClosedForms();
  topic.AddTable({.mu = 64, .altitudes = 16});
  topic.AddTable({.mu = 128, .altitudes = 32});
  topic.AddTable({.mu = 256, .altitudes = 64});
  if (!effort.quick) {
    topic.AddTable({.mu = 512, .altitudes = 128});
    topic.AddTable({.mu = 1024, .altitudes = 256});
  }
  topic.AddChapman(ChapmanRule::kSchueler);
  topic.AddChapman(ChapmanRule::kGolubev);
  for (const int steps : {10, 20, 40, 80, 160})
    topic.AddMarch(MarchRule::kMidpoint, steps, steps == 40);
  topic.AddMarch(MarchRule::kTrapezoid, 50, false);
  topic.AddMarch(MarchRule::kTrapezoid, 500, true);
  return std::move(topic).Finished(
      {.key = "transmittance",
       .title = "Transmittance: how much sunlight reaches a point in the air",
       .what = "A point between the ground and the top of the air, in the light of the sun; "
               "the question is which part of its light arrives there, at every wavelength. In "
               "twilight the beams come from below the horizontal and graze the planet.",
       .error_unit = "parts of the sunlight above the air",
       .notes =
           "256 x 64 is the table of Bruneton (2017) and Hillaire (2020), 500 trapezoids are "
           "how Bruneton and Neyret (2008) fill theirs, 40 steps are what renderers march at "
           "run time; tables here are filled exactly, with rows from the ground to the top and "
           "columns from the zenith to the horizon. The approximations of Schüler and Golubev "
           "are for exponential layers that never end; they get the closed form for ozone.",
       .wanted = 0.001,
       .cost = CostAxis::kTimeOfAnswer});
}

}  // namespace alpenglow
