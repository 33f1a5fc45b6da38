// SPDX-License-Identifier: MIT
// This file measures two topics of the report: transmittance from a point to the sun, and
// refraction of a line of sight by the air.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {
namespace {

// Styles of the lines of the plot.
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
      : TopicWork(medium, effort, ReferenceSunbeams(medium, effort.rays)) {
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
    const SingleScattering<float> air(medium_);
    Add({.series = "closed form", .parameter = "float", .style = kClosedForm, .in_summary = true},
        0, [&](const ViewRay& ray) { return air.TransmittanceToSpace(ray.altitude_m, ray.mu); });
    const SingleScattering<double> exact(medium_);
    Add({.series = "closed form", .parameter = "double", .style = kClosedForm}, 0,
        [&](const ViewRay& ray) { return exact.TransmittanceToSpace(ray.altitude_m, ray.mu); });
  }

  /// Evaluates many points at once, as the kernels of this library do.
  void AddClosedFormOfMany() {
    const SingleScattering<float> air(medium_);
    ReportRow row{.series = "closed form, many at once",
                  .parameter = "float",
                  .style = kMany,
                  .in_summary = true};
    for (std::size_t r = 0; r < kReportRegimes; ++r) {
      const std::vector<ReferenceRay>& rays = solution().rays[r];
      std::vector<float> altitudes_m, mu;
      for (const ReferenceRay& one : rays) {
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
      row.at[r].error = StatisticsOf(rays, solution().kind, values);
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
    const SingleScattering<float> air(medium_);
    const bool schueler = rule == ChapmanRule::kSchueler;
    Add({.series = schueler ? "Schüler 2012" : "Golubev 2019",
         .parameter = "",
         .origin = MethodOrigin::kLiterature,
         .style = schueler ? kChapman : kGolubev,
         .in_summary = true},
        0, [&](const ViewRay& ray) { return ChapmanTransmittance(air, rule, ray); });
  }

 private:
  std::vector<std::array<float, 3>> sigma_;  // [1/m] for molecules, aerosol, ozone, by wavelength
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

namespace {

// Styles of the lines of the plot.
enum RefractionStyle { kTables = 0, kQuadrature = 1, kStraight = 5, kBennett = 6 };

constexpr double kSunDiameter_rad = 32.0 / 60.0 * kRadiansPerDegree;

/// Ranges of the observer's height and of the view's elevation [degrees above the horizon of the
/// ground].
struct Sight {
  ReportRegime regime;
  double lowest_m, highest_m, lowest_deg, highest_deg;
};
constexpr std::array<Sight, 3> kSights{
    {{{"low", "From the ground, 0° to 5° up", {}}, 0.0, 2.0, 0.0, 5.0},
     {{"high", "From the ground, 5° to 90° up", {}}, 0.0, 2.0, 5.0, 90.0},
     {{"aloft", "From 1 to 12 km, 0° to 5° over the horizon", {}}, 1e3, 12e3, 0.0, 5.0}}};
// Number of observers of a regime. A table is valid for one height.
constexpr std::size_t kEyes = 4;

/// Returns the refraction at an apparent elevation by Bennett (1982), J. Navigation 35, 255, as in
/// almanacs: from sea level, at 10 C and 1010 hPa.
double BennettRefraction(double apparent_rad) {
  const double h_deg = apparent_rad / kRadiansPerDegree;
  return kRadiansPerDegree / 60.0 / std::tan((h_deg + 7.31 / (h_deg + 4.4)) * kRadiansPerDegree);
}

class RefractionTopic {
 public:
  RefractionTopic(const Medium& medium, const ReportEffort& effort)
      : medium_(medium), effort_(effort) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t r = 0; r < kSights.size(); ++r) SolveReference(r);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    reference_time_s_ = taken.count() / static_cast<double>(kSights.size() * Count());
  }

  void AddTables() {
    ReportRow row = Row("tables of one height", kTables);
    std::vector<RefractedView> views;
    const auto [one, seconds] = Built([&] { return RefractedView(medium_, 0.0); });
    row.build_s = seconds;
    row.memory_bytes = one.bytes();
    for (std::size_t r = 0; r < kSights.size(); ++r)
      for (std::size_t eye = 0; eye < kEyes; ++eye) views.emplace_back(medium_, EyeHeight(r, eye));
    Measure(row, [&](std::size_t r, const Line& line) {
      return line.apparent_rad - views[r * kEyes + line.eye].TrueElevation(line.apparent_rad);
    });
  }

  void AddQuadrature() {
    const BendingAir air = GentleAirOf(medium_);
    Measure(Row("quadrature over elevation (Auer, Standish 2000)", kQuadrature),
            [&](std::size_t, const Line& line) {
              return RefractionSeenAt(air, line.apparent_rad, line.height_m);
            });
  }

  void AddBennett() {
    ReportRow row = Row("Bennett 1982, the air of almanacs", kBennett);
    row.origin = MethodOrigin::kLiterature;
    Measure(std::move(row),
            [](std::size_t, const Line& line) { return BennettRefraction(line.apparent_rad); });
  }

  void AddStraight() {
    ReportRow row = Row("straight rays", kStraight);
    row.origin = MethodOrigin::kLiterature;
    Measure(std::move(row), [](std::size_t, const Line&) { return 0.0; });
  }

  [[nodiscard]] ReportTopic Finished() && {
    topic_.key = "refraction";
    topic_.title = "Refraction: where a line of sight leads";
    topic_.what =
        "Lines of sight from the ground and from the air; the question is by how much what stands "
        "behind the air, sun, moon or star, is lifted (550 nm).";
    topic_.error_unit = "parts of the sun's diameter, 32'";
    topic_.notes =
        "Rays are bent in the density that the atmosphere's molecules have. Bennett's formula is "
        "of "
        "the air of almanacs, and of an eye at sea level: what it is off by is mostly the other "
        "air. "
        "A table is made once for an eye's height; quadrature serves any.";
    topic_.wanted = 0.01;
    topic_.answer = "line of sight";
    topic_.everywhere = "from every height";
    topic_.regimes.clear();
    for (const Sight& sight : kSights) topic_.regimes.push_back(sight.regime);
    topic_.medium = medium_;
    topic_.rays = Count();
    topic_.reference = {.text =
                            "the ray equation, by Runge and Kutta's fourth order, with Peck and "
                            "Reeder's refractivity",
                        .time_s = reference_time_s_};
    return std::move(topic_);
  }

 private:
  struct Line {
    std::size_t eye;
    double height_m, apparent_rad, refraction_rad;
  };

  [[nodiscard]] std::size_t Count() const { return static_cast<std::size_t>(effort_.rays) / 2; }
  static double EyeHeight(std::size_t r, std::size_t eye) {
    const Sight& sight = kSights[r];
    return sight.lowest_m +
           (sight.highest_m - sight.lowest_m) * static_cast<double>(eye) / (kEyes - 1.0);
  }
  static ReportRow Row(std::string series, RefractionStyle style) {
    return {.series = std::move(series),
            .parameter = "",
            .style = style,
            .in_summary = true,
            .at = std::vector<RegimeResult>(kSights.size())};
  }

  void SolveReference(std::size_t r) {
    const reference::RayEquation equation(medium_, reference::PeckAndReeder(kHorizonWavelength_nm));
    const Sight& sight = kSights[r];
    for (std::size_t i = 0; i < Count(); ++i) {
      Line line{i % kEyes, EyeHeight(r, i % kEyes), 0.0, 0.0};
      const double over_deg = sight.lowest_deg + (sight.highest_deg - sight.lowest_deg) *
                                                     Halton(static_cast<int>(i) + 1, 2);
      line.apparent_rad =
          GrazingElevation(GentleAirOf(medium_), line.height_m) + over_deg * kRadiansPerDegree;
      line.refraction_rad = equation.Follow(line.apparent_rad, line.height_m).refraction_rad;
      lines_[r].push_back(line);
    }
    ThrowIfInterrupted();
  }

  /// @param refraction  function from regime and line to the angle by which it is lifted [rad].
  template <typename Refraction>
  void Measure(ReportRow row, const Refraction& refraction) {
    for (std::size_t r = 0; r < kSights.size(); ++r) {
      std::vector<double> errors;
      for (const Line& line : lines_[r])
        errors.push_back(std::abs(refraction(r, line) - line.refraction_rad) / kSunDiameter_rad);
      row.at[r].error = StatisticsOfErrors(std::move(errors), 0.0);
      const auto pass = [&] {
        float sum = 0.0F;
        for (const Line& line : lines_[r]) sum += static_cast<float>(refraction(r, line));
        return sum;
      };
      TimePasses(lines_[r].size(), effort_, pass, row.at[r]);
      ThrowIfInterrupted();
    }
    topic_.rows.push_back(std::move(row));
  }

  const Medium& medium_;
  const ReportEffort& effort_;
  std::array<std::vector<Line>, kSights.size()> lines_;
  double reference_time_s_ = 0.0;
  ReportTopic topic_;
};

}  // namespace

ReportTopic MeasureRefraction(const Medium& medium, const ReportEffort& effort) {
  RefractionTopic topic(medium, effort);
  topic.AddTables();
  topic.AddQuadrature();
  topic.AddBennett();
  topic.AddStraight();
  return std::move(topic).Finished();
}

}  // namespace alpenglow::lut
