// SPDX-License-Identifier: MIT
// The rays of the report, drawn once and answered by a judge.
//
// Points of Halton's sequence (1960, Numer. Math. 2, 84), so that every run has the same rays and
// few of them fill the space:
//
//   sun       elevation uniform over the regime
//   observer  2 m, 1500 m or 10 km above the ground, a third each
//   view      half of the rays anywhere in the sky (uniform in solid angle), a quarter within 10
//             degrees above the horizontal, where the air is long, a quarter down to the ground
//   azimuth   uniform from towards the sun to away from it
//
// From space half of the views end on the ground and half pass it, up to 100 km; the sun is that of
// the ray's lowest point, half of the time below 5 degrees.
//
// Transmittance has beams to the sun instead: a point between the ground and the top in the sun's
// light at the regime's elevation, dense in low air. In twilight, where beams come from below the
// horizontal, the perigee of the beam is drawn so; where it would lie above the air, and from space,
// the point is the top of the air.
//
// Errors of radiance are relative. What is darker than a hundredth of the light that the air at the
// zenith of the same place (from space: of the ray's lowest point) scatters once under the same sun
// counts as if it were that bright: the air between the eye and a ground two metres away would else
// rule every mean. Strict errors are relative to each value itself.
//
// One row of the report: a method's errors on judged rays, and the time of its answers.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/judge/path_tracer.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/program/program.h"
#include "lut/report/report.h"
#include "lut/report/report_baselines.h"

namespace alpenglow::lut {

/// Part of the zenith's radiance below which errors are relative to that part.
inline constexpr double kDarkestPart = 0.01;
/// Part of the sun's light below which no strict error is counted, and all light counts as so bright
/// in the others.
inline constexpr double kDarkestValue = 1e-12;

/// A ray with the judge's answer.
struct JudgedRay {
  ViewRay ray;
  std::vector<double> truth;  // by wavelength
  std::vector<double> sigma;  // one standard error; empty when the judge has none
  std::vector<double> floor;  // errors are relative to at least this; empty: 0
};

enum class ErrorKind {
  kAbsolute,  // of transmittance, in parts of the light above the air
  kRelative,  // of radiance
};

struct JudgedRays {
  ErrorKind kind = ErrorKind::kRelative;
  ReportJudge judge;
  std::array<std::vector<JudgedRay>, kReportRegimes> rays;
};

/// Ray number i >= 1 of a regime, and the judge's answer to it.
using DrawRay = std::function<ViewRay(int i, const ReportRegime& regime)>;
using AskJudge = std::function<JudgedRay(const ViewRay& ray)>;

/// Asks the judge about `count` rays in each of kRegimes, in parallel, and notes what an answer
/// takes. The text of the judge is left to the caller.
[[nodiscard]] JudgedRays JudgeRays(ErrorKind kind, int count, const DrawRay& draw,
                                   const AskJudge& ask);

/// Elevation of the sun of ray number i [degrees], uniform over the regime.
[[nodiscard]] double SunElevationNumber(int i, const ReportRegime& regime);

/// Radiance, by wavelength, below which errors count as if it were that bright.
[[nodiscard]] std::vector<double> DarkestRadiance(const Medium& medium, const ViewRay& ray);

/// Beams to the sun and their transmittance, `count` a regime, by judge::OpticalDepthAlong.
[[nodiscard]] JudgedRays JudgedSunbeams(const Medium& medium, int count);

/// Views and light scattered once on the way, by judge::SingleScatteringAlong.
[[nodiscard]] JudgedRays JudgedSkyRays(const Medium& medium, int count);

/// Views and light of all orders scattered on the way (without light from the ground at their
/// end), by the path tracer with so many paths each.
[[nodiscard]] JudgedRays TracedViews(const Medium& medium, int count, std::size_t paths);

/// View number i >= 1 of the distribution above.
[[nodiscard]] ViewRay ViewNumber(const Medium& medium, int i, const ReportRegime& regime);
/// View from space down to the ground number i >= 1.
[[nodiscard]] ViewRay GroundFromSpaceNumber(const Medium& medium, int i,
                                            const ReportRegime& regime);
/// Beam to the sun number i >= 1.
[[nodiscard]] ViewRay SunbeamNumber(const Medium& medium, int i, const ReportRegime& regime);

/// Statistics of a method's answers, by wavelength, to the rays of a regime. The judge's noise is
/// subtracted from the rms; where less than half of the noise is left, half of the noise is given
/// as a bound: with some dozen rays no less can be told.
[[nodiscard]] ErrorStatistics StatisticsOf(const std::vector<JudgedRay>& rays, ErrorKind kind,
                                           const std::vector<std::vector<double>>& answers);

/// Statistics of errors >= 0, of which a judge's noise makes a part; the strict ones are the same.
[[nodiscard]] ErrorStatistics StatisticsOfErrors(std::vector<double> errors, double noise);

/// Rms of the judge's standard errors over rays and wavelengths, as StatisticsOf counts errors.
[[nodiscard]] double NoiseOf(const std::vector<JudgedRay>& rays, ErrorKind kind);

/// How much care a report takes.
struct ReportEffort {
  bool quick = false;
  int rays = 400;             // of a regime, for judges without noise
  int traced_rays = 36;       // of a regime, for the path tracer
  std::size_t paths = 30000;  // of a traced ray
  std::size_t passes = 7;     // at least so many over the rays of a regime
  double seconds = 0.02;      // and at least for so long

  [[nodiscard]] static ReportEffort Quick() { return {true, 40, 6, 2000, 3, 0.0}; }
};

/// Time that `make` takes, and what it made. Short work
/// is done up to three times; the shortest counts.
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

/// Times `pass`, which gives so many answers and returns something of them, on this thread, after
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
  [[maybe_unused]] static volatile float kept;  // else a compiler may see that nobody asks
  kept = sum;
  std::sort(passes.begin(), passes.end());
  result.time_s = passes.front() / static_cast<double>(answers);
  result.time_spread = passes[passes.size() / 2] / passes.front() - 1.0;
}

/// All values of some bands.
template <typename Real>
[[nodiscard]] std::vector<double> ValuesOf(const Bands<Real>& bands) {
  return {bands.value.begin(), bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count)};
}

/// Fills in what `answer`, a function from ViewRay to Bands<>, is worth on the rays.
/// @param samples  function from ViewRay to the number of points that an answer looks at.
template <typename Answer, typename Samples>
[[nodiscard]] ReportRow Measured(ReportRow row, const JudgedRays& judged,
                                 const ReportEffort& effort, const Answer& answer,
                                 const Samples& samples) {
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    const std::vector<JudgedRay>& rays = judged.rays[r];
    std::vector<std::vector<double>> answers;
    double points = 0.0;
    for (const JudgedRay& one : rays) {
      answers.push_back(ValuesOf(answer(one.ray)));
      points += static_cast<double>(samples(one.ray));
    }
    row.at[r].error = StatisticsOf(rays, judged.kind, answers);
    row.at[r].samples = points / static_cast<double>(rays.size());
    const auto pass = [&] {
      float sum = 0.0F;
      for (const JudgedRay& one : rays) sum += static_cast<float>(answer(one.ray)[0]);
      return sum;
    };
    TimePasses(rays.size(), effort, pass, row.at[r]);
    ThrowIfInterrupted();
  }
  return row;
}

/// A topic in the making: judged rays, and the rows measured on them.
class TopicWork {
 public:
  TopicWork(const Medium& medium, const ReportEffort& effort, JudgedRays judged)
      : medium_(medium), effort_(effort), judged_(std::move(judged)) {}

  /// Measures a method; see Measured.
  template <typename Answer, typename Samples>
  void AddRow(ReportRow row, const Answer& answer, const Samples& samples) {
    rows_.push_back(Measured(std::move(row), judged_, effort_, answer, samples));
  }

  /// Light scattered once by a march in steps; `style` is that of its line.
  void AddMarch(const AirIntegrator<float>& air, MarchRule rule, int steps, int style,
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

  /// Adds what was measured elsewhere.
  void AddMeasured(ReportRow row) { rows_.push_back(std::move(row)); }

  [[nodiscard]] const JudgedRays& judged() const { return judged_; }

  /// `words` with what was measured.
  [[nodiscard]] ReportTopic Finished(ReportTopic words) && {
    words.medium = medium_;
    words.rays = judged_.rays[0].size();
    words.judge = judged_.judge;
    words.rows = std::move(rows_);
    return words;
  }

 protected:
  const Medium& medium_;
  const ReportEffort& effort_;

 private:
  JudgedRays judged_;
  std::vector<ReportRow> rows_;
};

/// The topics, each for one medium.
[[nodiscard]] ReportTopic MeasureTransmittance(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureSingleScattering(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureAllOrders(const Medium& medium, const ReportEffort& effort);
/// Where light of all orders is hard: with fewer rays and methods, for paths are long there.
[[nodiscard]] ReportTopic MeasureHardAir(const Medium& medium, const ReportEffort& effort);
/// Of one medium: the others bend alike.
[[nodiscard]] ReportTopic MeasureRefraction(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasurePanoramas(const Medium& medium, const ReportEffort& effort);

}  // namespace alpenglow::lut
