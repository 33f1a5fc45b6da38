// SPDX-License-Identifier: MIT
// A topic of the report: transmittance from a point to the sun.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "lut/table/transmittance_table.h"

namespace alpenglow::lut {
namespace {

// Lines of the plot.
enum TransmittanceStyle {
  kClosedForm = 0,
  kColumnMidpoint = 1,
  kMany = 2,
  kColumnTable = 3,
  kChapman = 4,
  kTrapezoid = 5,
  kGolubev = 6
};

class TransmittanceTopic : public TopicWork {
 public:
  TransmittanceTopic(const Medium& medium, const ReportEffort& effort)
      : TopicWork(medium, effort, JudgedSunbeams(medium, effort.rays)) {
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
      sigma_.push_back({static_cast<float>(medium.rayleigh_scattering_per_m[band]),
                        static_cast<float>(medium.mie_extinction_per_m[band]),
                        static_cast<float>(medium.ozone_absorption_per_m[band])});
    }
  }

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

  /// Many points at once, as the kernels of this library take them.
  void AddClosedFormOfMany() {
    const AirIntegrator<float> air(medium_);
    ReportRow row{.series = "closed form, many at once",
                  .parameter = "float",
                  .style = kMany,
                  .in_summary = true};
    for (std::size_t r = 0; r < kReportRegimes; ++r) {
      const std::vector<JudgedRay>& rays = judged().rays[r];
      std::vector<float> altitudes_m, mu;
      for (const JudgedRay& one : rays) {
        altitudes_m.push_back(static_cast<float>(one.ray.altitude_m));
        mu.push_back(static_cast<float>(one.ray.mu));
      }
      std::vector<Bands<float>> answers(rays.size(), Bands<float>(air.bands()));
      const auto pass = [&] {
        const auto columns_m = air.ColumnsToSpace(altitudes_m, mu);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          for (std::size_t band = 0; band < air.bands(); ++band) {
            answers[i][band] =
                std::exp(-(sigma_[band][0] * columns_m[0][i] + sigma_[band][1] * columns_m[1][i] +
                           sigma_[band][2] * columns_m[2][i]));
          }
        }
        return answers[0][0];
      };
      TimePasses(rays.size(), effort_, pass, row.at[r]);
      std::vector<std::vector<double>> values;
      for (const Bands<float>& one : answers) values.push_back(ValuesOf(one));
      row.at[r].error = StatisticsOf(rays, judged().kind, values);
    }
    AddMeasured(std::move(row));
  }

  void AddTable(const TransmittanceTableSize& size) {
    const auto [table, seconds] = Built([&] { return TransmittanceTable(medium_, size); });
    const bool published = size.mu == 256;
    Add({.series = "table",
         .parameter = fmt::format("{} x {}", size.mu, size.altitudes),
         .style = kColumnTable,
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
         .style = midpoint ? kColumnMidpoint : kTrapezoid,
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

 private:
  std::vector<std::array<float, 3>> sigma_;  // [1/m] of molecules, aerosol, ozone, by wavelength
};

}  // namespace

ReportTopic MeasureTransmittance(const Medium& medium, const ReportEffort& effort) {
  TransmittanceTopic topic(medium, effort);
  topic.AddClosedForms();
  topic.AddClosedFormOfMany();
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

}  // namespace alpenglow::lut
