// SPDX-License-Identifier: MIT
#include "lut/report/report_refraction.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"

namespace alpenglow::lut {
namespace {

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

/// A line of sight from one of the observers of a regime.
struct Line {
  std::size_t eye;
  double height_m, apparent_rad;
};
using LineStudy = ErrorStudy<Line>;

double EyeHeight(std::size_t r, std::size_t eye) {
  const Sight& sight = kSights[r];
  return sight.lowest_m +
         (sight.highest_m - sight.lowest_m) * static_cast<double>(eye) / (kEyes - 1.0);
}

Line LineNumber(const Medium& medium, std::size_t r, std::size_t i) {
  const Sight& sight = kSights[r];
  const double over_deg = sight.lowest_deg + (sight.highest_deg - sight.lowest_deg) *
                                                 Halton(static_cast<int>(i) + 1, 2);
  const double height_m = EyeHeight(r, i % kEyes);
  return {i % kEyes, height_m,
          GrazingElevation(GentleAirOf(medium), height_m) + over_deg * kRadiansPerDegree};
}

void SolveLines(LineStudy& study, const Medium& medium) {
  const reference::RayEquation equation(medium, reference::PeckAndReeder(kHorizonWavelength_nm));
  study.SolveCases(static_cast<std::size_t>(study.effort().rays) / 2, [&](std::size_t r,
                                                                          std::size_t i) {
    const Line line = LineNumber(medium, r, i);
    const auto end = equation.Follow(line.apparent_rad, line.height_m);
    return std::optional(LineStudy::Solved{line, {{end.refraction_rad}, {}, {kSunDiameter_rad}}});
  });
}

void AddTables(LineStudy& study, const Medium& medium) {
  const auto [one, seconds] = Built(study.effort(), [&] { return RefractedView(medium, 0.0); });
  const auto prepare = [&](std::size_t r, ReportRow&) {
    std::vector<RefractedView> views;
    for (std::size_t eye = 0; eye < kEyes; ++eye) views.emplace_back(medium, EyeHeight(r, eye));
    return [views = std::move(views)](const Line& line) {
      return line.apparent_rad - views[line.eye].TrueElevation(line.apparent_rad);
    };
  };
  study.AddPrepared({.series = "tables of one height",
                     .parameter = "",
                     .in_summary = true,
                     .memory_bytes = one.bytes(),
                     .build_s = seconds},
                    prepare);
}

ReportTopic WordsOfRefraction() {
  ReportTopic topic{
      .key = "refraction",
      .title = "Refraction: the direction in which a line of sight leaves the air",
      .what =
          "Lines of sight from the ground and from the air. The methods compute the angle by "
          "which sun, moon or stars behind the air appear lifted (550 nm).",
      .error_unit = "fractions of the sun's diameter, 32'",
      .notes =
          "Rays are bent in the density of the molecules of the atmosphere. Bennett's formula "
          "is for the air of almanacs and for an observer at sea level: most of its error is due "
          "to the different air. A table is valid for one height of the observer; quadrature is "
          "valid for any.",
      .answer = "line of sight",
      .everywhere = "from every height"};
  topic.regimes.clear();
  for (const Sight& sight : kSights) topic.regimes.push_back(sight.regime);
  topic.reference.text =
      "the ray equation, by Runge and Kutta's fourth order, with Peck and "
      "Reeder's refractivity";
  return topic;
}

}  // namespace

ReportTopic MeasureRefraction(const Medium& medium, const ReportEffort& effort) {
  LineStudy study(WordsOfRefraction(), effort, {kRelativeToScale.error, false});
  study.topic().medium = medium;
  SolveLines(study, medium);
  AddTables(study, medium);
  const BendingAir air = GentleAirOf(medium);
  study.Add(
      {.series = "quadrature over elevation (Auer, Standish 2000)",
       .parameter = "",
       .in_summary = true},
      [&](const Line& line) { return RefractionSeenAt(air, line.apparent_rad, line.height_m); });
  ReportRow row{.series = "Bennett 1982, the air of almanacs",
                .parameter = "",
                .origin = MethodOrigin::kLiterature,
                .in_summary = true};
  study.Add(row, [](const Line& line) { return BennettRefraction(line.apparent_rad); });
  row.series = "straight rays";
  study.Add(row, [](const Line&) { return 0.0; });
  return std::move(study).Finished();
}

}  // namespace alpenglow::lut
