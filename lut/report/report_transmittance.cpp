// SPDX-License-Identifier: MIT
#include "lut/report/report_transmittance.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "lut/report/report_baselines.h"
#include "lut/report/report_rays.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {
namespace {

template <typename Real>
void AddClosedForm(RayStudy& study, const std::string& type, bool in_summary) {
  const SingleScattering<Real> air(study.medium());
  study.Add({.series = "closed form", .parameter = type, .in_summary = in_summary},
            [&](const ViewRay& ray) { return air.TransmittanceToSpace(ray.altitude_m, ray.mu); });
}

/// Computes the transmittance of all rays, with their columns at once, as the kernels of this
/// library do.
/// @param sigma  extinction by molecules, aerosol and ozone, by wavelength [1/m].
void FillTransmittance(const SingleScattering<float>& air,
                       const std::vector<std::array<float, 3>>& sigma,
                       const std::vector<float>& altitudes_m, const std::vector<float>& mu,
                       std::vector<Spectrum>& answers) {
  const auto columns_m = air.ColumnsToSpace(altitudes_m, mu);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    for (std::size_t band = 0; band < air.bands(); ++band) {
      answers[i][band] =
          std::exp(-(sigma[band][0] * columns_m[0][i] + sigma[band][1] * columns_m[1][i] +
                     sigma[band][2] * columns_m[2][i]));
    }
  }
}

void AddClosedFormOfMany(RayStudy& study) {
  const Medium& medium = study.medium();
  std::vector<std::array<float, 3>> sigma;
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    sigma.push_back({static_cast<float>(medium.rayleigh_scattering_per_m[band]),
                     static_cast<float>(medium.mie_extinction_per_m[band]),
                     static_cast<float>(medium.ozone_absorption_per_m[band])});
  }
  ReportRow row{.series = "closed form, many at once", .parameter = "float", .in_summary = true};
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    std::vector<float> altitudes_m, mu;
    for (const ViewRay& ray : study.cases(r)) {
      altitudes_m.push_back(static_cast<float>(ray.altitude_m));
      mu.push_back(static_cast<float>(ray.mu));
    }
    std::vector<Spectrum> answers(mu.size(), Spectrum(study.air().bands()));
    const auto pass = [&] {
      FillTransmittance(study.air(), sigma, altitudes_m, mu, answers);
      return answers[0][0];
    };
    TimePasses(mu.size(), study.effort(), pass, row.at[r]);
    std::vector<std::vector<double>> values;
    for (const Spectrum& one : answers) values.push_back(ValuesOf(one));
    study.Judge(r, values, row.at[r]);
  }
  study.AddMeasured(std::move(row));
}

void AddTransmittanceTable(RayStudy& study, const TransmittanceTableSize& size) {
  const auto [table, seconds] =
      Built(study.effort(), [&] { return TransmittanceTable(study.medium(), size); });
  study.Add({.series = "table",
             .parameter = fmt::format("{} x {}", size.mu, size.altitudes),
             .in_summary = size.mu == 256,  // the published size
             .memory_bytes = table.bytes(),
             .build_s = seconds},
            [&table = table](const ViewRay& ray) { return table.Lookup(ray.altitude_m, ray.mu); });
}

void AddChapman(RayStudy& study, const std::string& series, ChapmanRule rule) {
  study.Add(
      {.series = series, .parameter = "", .origin = MethodOrigin::kLiterature, .in_summary = true},
      [&](const ViewRay& ray) { return ChapmanTransmittance(study.air(), rule, ray); });
}

}  // namespace

ReportTopic MeasureTransmittance(const Medium& medium, const ReportEffort& effort) {
  RayStudy study(
      {.key = "transmittance",
       .title = "Transmittance: the part of sunlight that reaches a point in the air",
       .what = "A point between the ground and the top of the air is lit by the sun. The methods "
               "compute the part of the sun's light that arrives there, at every wavelength. In "
               "twilight the beams come from below the horizontal and graze the planet.",
       .error_unit = "fractions of the sunlight above the air",
       .notes =
           "256 x 64 is the table of Bruneton (2017) and Hillaire (2020). Bruneton and Neyret "
           "(2008) fill theirs with 500 trapezoids. Renderers march in about 40 steps at run "
           "time. The tables here are filled exactly, with rows from the ground to the top and "
           "columns from the zenith to the horizon. The approximations of Schüler and Golubev "
           "are for exponential layers without an upper end; ozone uses the closed form.",
       .wanted = 0.001},
      medium, effort);
  study.SolveTransmittance(SunbeamNumber);
  AddClosedForm<float>(study, "float", true);
  AddClosedForm<double>(study, "double", false);
  AddClosedFormOfMany(study);
  for (const std::size_t side : {64U, 128U, 256U, 512U, 1024U}) {
    if (side > 256 && effort.quick) break;
    AddTransmittanceTable(study, {.mu = side, .altitudes = side / 4});
  }
  AddChapman(study, "Schüler 2012", ChapmanRule::kSchueler);
  AddChapman(study, "Golubev 2019", ChapmanRule::kGolubev);
  for (const int steps : {10, 20, 40, 80, 160})
    study.AddTransmittanceMarch("midpoint march", MarchRule::kMidpoint, steps, steps == 40);
  for (const int steps : {50, 500})
    study.AddTransmittanceMarch("trapezoid march", MarchRule::kTrapezoid, steps, steps == 500);
  return std::move(study).Finished();
}

}  // namespace alpenglow::lut
