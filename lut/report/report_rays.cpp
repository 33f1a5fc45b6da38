// SPDX-License-Identifier: MIT
// This file also measures two topics of the report: transmittance from a point to the sun, and
// refraction of a line of sight by the air.
#include "lut/report/report_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/path_tracer.h"
#include "atmosphere/reference/reference_solution.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/cli/program.h"
#include "lut/report/report_baselines.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {
namespace {

// Returns the cosine of the zenith angle at which an observer in space sees a ray with that
// perigee.
double CosineOfPerigee(double radius_m, double altitude_m, double perigee_m) {
  return -std::sqrt((altitude_m - perigee_m) * (2.0 * radius_m + altitude_m + perigee_m)) /
         (radius_m + altitude_m);
}

// Returns the ray with the sun at the regime's elevation as seen from its lowest point, `low_m`
// along it.
ViewRay WithSunAtLowest(const Medium& medium, ViewRay ray, double low_m, int i,
                        const ReportRegime& regime) {
  constexpr double kLow_deg = 5.0;
  const SunRange sun = regime.sun.value();
  const double share = Halton(i, 2);
  const double elevation_deg = share < 0.5
                                   ? sun.lowest_deg + (kLow_deg - sun.lowest_deg) * 2.0 * share
                                   : kLow_deg + (sun.highest_deg - kLow_deg) * (2.0 * share - 1.0);
  const double elevation = elevation_deg * kRadiansPerDegree, azimuth = kPi * Halton(i, 5);
  const double sine = std::sqrt((1.0 - ray.mu) * (1.0 + ray.mu));
  // Angle by which the vertical turns along the ray to the lowest point.
  const double turn =
      std::atan2(low_m * sine, medium.planet_radius_m + ray.altitude_m + low_m * ray.mu);
  const double along = std::cos(elevation) * std::cos(azimuth), up = std::sin(elevation);
  const double x = along * std::cos(turn) + up * std::sin(turn);
  const double z = up * std::cos(turn) - along * std::sin(turn);
  ray.mu_s = std::clamp(z, -1.0, 1.0);
  ray.nu = std::clamp(x * sine + z * ray.mu, -1.0, 1.0);
  return ray;
}

ViewRay LimbFromSpaceNumber(const Medium& medium, int i, const ReportRegime& regime) {
  const double radius_m = medium.planet_radius_m;
  const double highest_m = std::min(100e3, 0.9 * medium.atmosphere_height_m);
  const double perigee_m = highest_m * (0.001 + 0.998 * Halton(i, 3));
  const ViewRay ray{.altitude_m = kSpaceAltitude_m,
                    .mu = CosineOfPerigee(radius_m, kSpaceAltitude_m, perigee_m)};
  return WithSunAtLowest(medium, ray, -(radius_m + ray.altitude_m) * ray.mu, i, regime);
}

// Returns the vertical ray whose light is compared with that of a ray: at the observer, or at the
// lowest point of a ray from above the air.
ViewRay ZenithOf(const Medium& medium, const ViewRay& ray) {
  if (ray.altitude_m <= medium.atmosphere_height_m)
    return {ray.altitude_m, 1.0, ray.mu_s, ray.mu_s};
  const double r = medium.planet_radius_m + ray.altitude_m;
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const double low_m = extent.end == RayEnd::kGround ? extent.end_m : std::max(-r * ray.mu, 0.0);
  const double low_r = std::sqrt(r * r + low_m * (low_m + 2.0 * r * ray.mu));
  const double mu_s = std::clamp((r * ray.mu_s + low_m * ray.nu) / low_r, -1.0, 1.0);
  return {std::max(low_r - medium.planet_radius_m, 0.0), 1.0, mu_s, mu_s};
}

/// Returns, by wavelength, the lower bound of the radiance to which errors are relative.
std::vector<double> DarkestRadiance(const Medium& medium, const ViewRay& ray) {
  std::vector<double> floor =
      reference::SingleScatteringAlong(medium, ZenithOf(medium, ray)).inscatter;
  for (double& value : floor) value *= kDarkestPart;
  return floor;
}

/// Returns view number i, which ends just above the ground if it meets it.
ViewRay ViewAboveGroundNumber(const Medium& medium, int i, const ReportRegime& regime) {
  ViewRay ray = ViewNumber(medium, i, regime);
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  if (extent.end == RayEnd::kGround) ray.length_m = (1.0 - 1e-9) * extent.end_m;
  return ray;
}

/// Solves `count` rays of every regime. @param solve  function from a ray to its reference value.
template <typename Solve>
void SolveRays(RayStudy& study, int count, DrawRay draw, const Solve& solve) {
  study.SolveCases(static_cast<std::size_t>(count), [&](std::size_t r, std::size_t i) {
    const ViewRay ray = draw(study.medium(), static_cast<int>(i) + 1, kRegimes[r]);
    return std::optional(RayStudy::Solved{ray, solve(ray)});
  });
}

}  // namespace

ReferenceValue RadianceReference(std::vector<double> radiance, std::vector<double> sigma,
                                 const std::vector<double>& floor) {
  ReferenceValue reference{std::move(radiance), std::move(sigma), {}};
  for (std::size_t band = 0; band < reference.value.size(); ++band)
    reference.scale.push_back(std::max({reference.value[band], floor[band], kDarkestValue}));
  return reference;
}

double SunElevationNumber(int i, const ReportRegime& regime) {
  const SunRange sun = regime.sun.value();
  return sun.lowest_deg + (sun.highest_deg - sun.lowest_deg) * Halton(i, 2);
}

ViewRay GroundFromSpaceNumber(const Medium& medium, int i, const ReportRegime& regime) {
  const double radius_m = medium.planet_radius_m;
  const double horizon = std::acos(CosineOfPerigee(radius_m, kSpaceAltitude_m, 0.0));
  const double share = Halton(i, 3) * Halton(i, 3);
  const ViewRay ray{.altitude_m = kSpaceAltitude_m,
                    .mu = std::cos(horizon + (kPi - horizon) * share)};
  return WithSunAtLowest(medium, ray, ExtentOf(ray, radius_m, medium.atmosphere_height_m).end_m, i,
                         regime);
}

ViewRay ViewNumber(const Medium& medium, int i, const ReportRegime& regime) {
  if (regime.from_space) {
    return Halton(i, 11) < 0.5 ? GroundFromSpaceNumber(medium, i, regime)
                               : LimbFromSpaceNumber(medium, i, regime);
  }
  constexpr std::array<double, 3> kAltitudes_m{2.0, 1500.0, 10000.0};
  const double altitude_m = kAltitudes_m[static_cast<std::size_t>(3.0 * Halton(i, 7))];
  const double kind = Halton(i, 11), share = Halton(i, 3);
  const double horizon_deg =
      90.0 +
      std::acos(medium.planet_radius_m / (medium.planet_radius_m + altitude_m)) / kRadiansPerDegree;
  const double zenith_deg = kind < 0.5    ? std::acos(share) / kRadiansPerDegree
                            : kind < 0.75 ? 80.0 + 10.0 * share
                                          : horizon_deg + 1.0 + (179.0 - horizon_deg) * share;
  return RayFromAngles(altitude_m, zenith_deg, 180.0 * Halton(i, 5),
                       90.0 - SunElevationNumber(i, regime));
}

ViewRay SunbeamNumber(const Medium& medium, int i, const ReportRegime& regime) {
  const double elevation = SunElevationNumber(i, regime) * kRadiansPerDegree;
  const double share = Halton(i, 3);
  const double low_m = 0.5 * medium.atmosphere_height_m * share * share;
  const double radius_m = medium.planet_radius_m, top_m = medium.atmosphere_height_m;
  const double altitude_m =
      elevation < 0.0 ? (radius_m + low_m) / std::cos(elevation) - radius_m : low_m;
  // Lower suns light no air.
  if (regime.from_space || altitude_m > top_m) {
    const double mu = CosineOfPerigee(radius_m, top_m, low_m);
    return {top_m, mu, mu, 1.0};
  }
  const double mu = std::sin(elevation);
  return {altitude_m, mu, mu, 1.0};
}

RayStudy::RayStudy(ReportTopic topic, const Medium& medium, const ReportEffort& effort)
    : ErrorStudy(std::move(topic), effort), medium_(medium), air_(medium) {
  this->topic().medium = medium;
}

void RayStudy::SolveTransmittance(DrawRay draw) {
  SolveRays(*this, effort().rays, draw, [&](const ViewRay& ray) {
    ReferenceValue reference;
    for (const double tau : reference::OpticalDepthAlong(medium_, ray).tau)
      reference.value.push_back(std::exp(-tau));
    return reference;
  });
  topic().reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "of the optical depth below 1e-10";
}

void RayStudy::SolveSingleScattering(DrawRay draw) {
  SolveRays(*this, effort().rays, draw, [&](const ViewRay& ray) {
    return RadianceReference(reference::SingleScatteringAlong(medium_, ray).inscatter, {},
                             DarkestRadiance(medium_, ray));
  });
  topic().reference.text =
      "adaptive Gauss-Legendre quadrature in extended precision, relative error "
      "below 1e-8";
}

void RayStudy::SolveAllOrders() {
  reference::PathOptions options{.max_paths = effort().paths, .relative_error = 0.0};
  options.stopped = Interrupted;
  SolveRays(*this, effort().traced_rays, ViewAboveGroundNumber, [&](const ViewRay& ray) {
    reference::PathTracedRadiance traced = reference::TraceRadiance(medium_, ray, options);
    return RadianceReference(std::move(traced.total), std::move(traced.standard_error),
                             DarkestRadiance(medium_, ray));
  });
  topic().reference.text =
      fmt::format("backward path tracing of all orders, {} paths per ray", effort().paths);
}

void RayStudy::AddTransmittanceMarch(const std::string& series, MarchRule rule, int steps,
                                     bool in_summary) {
  Add(
      {.series = series,
       .parameter = fmt::format("{} steps", steps),
       .origin = MethodOrigin::kLiterature,
       .in_summary = in_summary},
      [&](const ViewRay& ray) { return MarchedTransmittance(medium_, ray, rule, steps); }, steps);
}

void RayStudy::AddScatteringMarch(MarchRule rule, int steps, bool in_summary) {
  Add(
      {.series = rule == MarchRule::kMidpoint ? "uniform march" : "quadratic march",
       .parameter = fmt::format("{} steps", steps),
       .origin = MethodOrigin::kLiterature,
       .in_summary = in_summary},
      [&](const ViewRay& ray) {
        const RayExtent extent =
            ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
        const auto samples = air_.SampleAt(ray, MarchNodes(rule, steps, extent));
        return air_.Inscatter(air_.Scatter(samples), ray.nu);
      },
      steps);
}

void RayStudy::AddScatteringTable(ReportRow row, const ScatteringTableOptions& options) {
  const auto [table, seconds] = Built(effort(), [&] { return ScatteringTable(medium_, options); });
  const ScatteringTableSize& size = options.size;
  row.parameter = fmt::format("{} x {} x {} x {}", size.altitudes, size.mu, size.mu_s, size.nu);
  row.memory_bytes = table.bytes();
  row.build_s = seconds;
  Add(std::move(row), [&, &table = table](const ViewRay& ray) {
    return air_.Inscatter(table.Lookup(ray), ray.nu);
  });
}

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
                       std::vector<Bands<float>>& answers) {
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
    std::vector<Bands<float>> answers(mu.size(), Bands<float>(study.air().bands()));
    const auto pass = [&] {
      FillTransmittance(study.air(), sigma, altitudes_m, mu, answers);
      return answers[0][0];
    };
    TimePasses(mu.size(), study.effort(), pass, row.at[r]);
    std::vector<std::vector<double>> values;
    for (const Bands<float>& one : answers) values.push_back(ValuesOf(one));
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
