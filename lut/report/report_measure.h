// SPDX-License-Identifier: MIT
// This header provides the rays of the report, drawn once and evaluated by the reference solution,
// and the measurement of methods on them.
//
// The rays are points of Halton's sequence (1960, Numer. Math. 2, 84), so that they are identical
// in every run and few of them cover the space:
//
//   sun       elevation uniform over the regime
//   observer  2 m, 1500 m or 10 km above the ground, a third each
//   view      half of the rays anywhere in the sky (uniform in solid angle), a quarter within 10
//             degrees above the horizontal, where paths are long, a quarter down to the ground
//   azimuth   uniform from towards the sun to away from it
//
// From space half of the views end on the ground and half pass it, up to 100 km. The sun's
// elevation is that at the ray's lowest point, half of the time below 5 degrees.
//
// Transmittance uses beams to the sun instead: from a point in sunlight between the ground and the
// top, at the regime's elevation, with more points in low air. In twilight, where beams come from
// below the horizontal, the perigee of the beam is drawn in this way. If the point would lie above
// the air, and from space, the beam starts at the top of the air.
//
// Errors of radiance are relative. The lower bound of the denominator is a hundredth of the light
// that the air at the zenith of the observer (from space: of the ray's lowest point) scatters once
// under the same sun. Otherwise the air between the eye and a ground two metres away would dominate
// every mean. Strict errors are relative to each value itself.
//
// A row of the report holds the errors of a method on these rays, and the time of its evaluations.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/reference/path_tracer.h"
#include "lut/cli/program.h"
#include "lut/report/report.h"
#include "lut/report/report_baselines.h"

namespace alpenglow::lut {

/// Fraction of the zenith's radiance that is the lower bound of the denominator of errors.
inline constexpr double kDarkestPart = 0.01;
/// Fraction of the sun's light below which strict errors are not counted. For other errors it is
/// the lower bound of all values.
inline constexpr double kDarkestValue = 1e-12;

/// A ray with the reference value.
struct ReferenceRay {
  ViewRay ray;
  std::vector<double> truth;  // by wavelength
  std::vector<double> sigma;  // one standard error; empty if the reference has none
  std::vector<double> floor;  // lower bound of the denominator of errors; empty: 0
};

enum class ErrorKind {
  kAbsolute,  // for transmittance, relative to the light above the air
  kRelative,  // for radiance
};

struct ReferenceRays {
  ErrorKind kind = ErrorKind::kRelative;
  ReportReference reference;
  std::array<std::vector<ReferenceRay>, kReportRegimes> rays;
};

/// Functions that return ray number i >= 1 of a regime, and the reference value of a ray.
using DrawRay = std::function<ViewRay(int i, const ReportRegime& regime)>;
using SolveReference = std::function<ReferenceRay(const ViewRay& ray)>;

/// Evaluates the reference for `count` rays in each of kRegimes, in parallel, and records the time
/// of one evaluation. The caller sets the text of the judge.
[[nodiscard]] ReferenceRays SolveReferenceRays(ErrorKind kind, int count, const DrawRay& draw,
                                               const SolveReference& ask);

/// Returns the sun's elevation for ray number i [degrees], uniform over the regime.
[[nodiscard]] double SunElevationNumber(int i, const ReportRegime& regime);

/// Returns, by wavelength, the lower bound of the radiance to which errors are relative.
[[nodiscard]] std::vector<double> DarkestRadiance(const Medium& medium, const ViewRay& ray);

/// Returns beams to the sun and their transmittance, `count` per regime, by
/// reference::OpticalDepthAlong.
[[nodiscard]] ReferenceRays ReferenceSunbeams(const Medium& medium, int count);

/// Returns views and the light scattered once along them, by reference::SingleScatteringAlong.
[[nodiscard]] ReferenceRays ReferenceSkyRays(const Medium& medium, int count);

/// Returns views and the light of all orders scattered along them (without light from the ground at
/// their end), by the path tracer with `paths` paths each.
[[nodiscard]] ReferenceRays TracedViews(const Medium& medium, int count, std::size_t paths);

/// Returns view number i >= 1 of the distribution above.
[[nodiscard]] ViewRay ViewNumber(const Medium& medium, int i, const ReportRegime& regime);
/// Returns view number i >= 1 from space down to the ground.
[[nodiscard]] ViewRay GroundFromSpaceNumber(const Medium& medium, int i,
                                            const ReportRegime& regime);
/// Returns beam number i >= 1 to the sun.
[[nodiscard]] ViewRay SunbeamNumber(const Medium& medium, int i, const ReportRegime& regime);

/// Returns the statistics of a method's values, by wavelength, for the rays of a regime. The noise
/// of the reference is subtracted from the rms. If less than half of the noise is left, half of the
/// noise is returned as a bound, because some dozen rays do not allow a lower one.
[[nodiscard]] ErrorStatistics StatisticsOf(const std::vector<ReferenceRay>& rays, ErrorKind kind,
                                           const std::vector<std::vector<double>>& answers);

/// Returns the statistics of errors >= 0, which contain the noise of the reference. The strict
/// statistics have equal values.
[[nodiscard]] ErrorStatistics StatisticsOfErrors(std::vector<double> errors, double noise);

/// Returns the rms of the reference's standard errors over rays and wavelengths, weighted as in
/// StatisticsOf.
[[nodiscard]] double NoiseOf(const std::vector<ReferenceRay>& rays, ErrorKind kind);

/// Numbers of rays, paths and passes of a report.
struct ReportEffort {
  bool quick = false;
  int rays = 400;             // per regime, for references without noise
  int traced_rays = 36;       // per regime, for the path tracer
  std::size_t paths = 30000;  // per traced ray
  std::size_t passes = 7;     // minimum over the rays of a regime
  double seconds = 0.02;      // and minimum duration [s]

  [[nodiscard]] static ReportEffort Quick() { return {true, 40, 6, 2000, 3, 0.0}; }
};

/// Returns the result of `make` and the time that it takes. Short work is done up to three times;
/// the shortest time counts.
template <typename Make>
[[nodiscard]] auto Built(const Make& make) {
  using Clock = std::chrono::steady_clock;
  double shortest = 0.0, all = 0.0;
  for (int i = 0;; ++i) {
    const auto start = Clock::now();
    auto made = make();
    const double taken = std::chrono::duration<double>(Clock::now() - start).count();
    shortest = i == 0 ? taken : std::min(shortest, taken);
    all += taken;
    if (i == 2 || all > 0.4) return std::pair{std::move(made), shortest};
  }
}

/// Times `pass`, which computes `answers` values and returns a sum of them, on this thread, after
/// one pass to warm up.
template <typename Pass>
void TimePasses(std::size_t answers, const ReportEffort& effort, const Pass& pass,
                RegimeResult& result) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> passes;
  float sum = pass();
  for (double all = 0.0; passes.size() < effort.passes || all < effort.seconds;) {
    const auto start = Clock::now();
    sum += pass();
    passes.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    all += passes.back();
  }
  [[maybe_unused]] static volatile float kept;  // keeps the compiler from removing the work
  kept = sum;
  std::sort(passes.begin(), passes.end());
  result.time_s = passes.front() / static_cast<double>(answers);
  result.time_spread = passes[passes.size() / 2] / passes.front() - 1.0;
}

/// Returns the values of all bands.
template <typename Real>
[[nodiscard]] std::vector<double> ValuesOf(const Bands<Real>& bands) {
  return {bands.value.begin(), bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count)};
}

/// Measures errors and time of `answer`, a function from ViewRay to Bands<>, on the rays.
/// @param samples  function from ViewRay to the number of points that an evaluation uses.
template <typename Answer, typename Samples>
[[nodiscard]] ReportRow Measured(ReportRow row, const ReferenceRays& solution,
                                 const ReportEffort& effort, const Answer& answer,
                                 const Samples& samples) {
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    const std::vector<ReferenceRay>& rays = solution.rays[r];
    std::vector<std::vector<double>> answers;
    double points = 0.0;
    for (const ReferenceRay& one : rays) {
      answers.push_back(ValuesOf(answer(one.ray)));
      points += static_cast<double>(samples(one.ray));
    }
    row.at[r].error = StatisticsOf(rays, solution.kind, answers);
    row.at[r].samples = points / static_cast<double>(rays.size());
    const auto pass = [&] {
      float sum = 0.0F;
      for (const ReferenceRay& one : rays) sum += static_cast<float>(answer(one.ray)[0]);
      return sum;
    };
    TimePasses(rays.size(), effort, pass, row.at[r]);
    ThrowIfInterrupted();
  }
  return row;
}

/// A topic during measurement: rays with reference values, and the rows measured on them.
class TopicWork {
 public:
  TopicWork(const Medium& medium, const ReportEffort& effort, ReferenceRays solution)
      : medium_(medium), effort_(effort), reference_rays_(std::move(solution)) {}

  /// Measures a method; see Measured.
  template <typename Answer, typename Samples>
  void AddRow(ReportRow row, const Answer& answer, const Samples& samples) {
    rows_.push_back(Measured(std::move(row), reference_rays_, effort_, answer, samples));
  }

  /// Measures light scattered once by a march in steps; `style` is the style of its line.
  void AddMarch(const SingleScattering<float>& air, MarchRule rule, int steps, int style,
                bool in_summary) {
    AddRow(
        {.series = rule == MarchRule::kMidpoint ? "uniform march" : "quadratic march",
         .parameter = fmt::format("{} steps", steps),
         .origin = MethodOrigin::kLiterature,
         .style = style,
         .in_summary = in_summary},
        [&](const ViewRay& ray) {
          const RayExtent extent =
              ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
          const auto samples = air.SampleAt(ray, MarchNodes(rule, steps, extent));
          return air.Inscatter(air.Scatter(samples), ray.nu);
        },
        [&](const ViewRay&) { return steps; });
  }

  /// Adds a row that was measured elsewhere.
  void AddMeasured(ReportRow row) { rows_.push_back(std::move(row)); }

  [[nodiscard]] const ReferenceRays& solution() const { return reference_rays_; }

  /// Returns `words` completed by the measured rows.
  [[nodiscard]] ReportTopic Finished(ReportTopic words) && {
    words.medium = medium_;
    words.rays = reference_rays_.rays[0].size();
    words.reference = reference_rays_.reference;
    words.rows = std::move(rows_);
    return words;
  }

 protected:
  const Medium& medium_;
  const ReportEffort& effort_;

 private:
  ReferenceRays reference_rays_;
  std::vector<ReportRow> rows_;
};

/// Measure the topics, each for one medium.
[[nodiscard]] ReportTopic MeasureTransmittance(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureSingleScattering(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureAllOrders(const Medium& medium, const ReportEffort& effort);
/// Measures light of all orders in difficult media, with fewer rays and methods, because paths are
/// long there.
[[nodiscard]] ReportTopic MeasureHardAir(const Medium& medium, const ReportEffort& effort);
/// Measures refraction for one medium, because other media refract alike.
[[nodiscard]] ReportTopic MeasureRefraction(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasurePanoramas(const Medium& medium, const ReportEffort& effort);

}  // namespace alpenglow::lut
