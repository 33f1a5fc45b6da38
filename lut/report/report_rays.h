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
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/judge/path_tracer.h"
#include "atmosphere/ray/ray.h"
#include "lut/report/report.h"

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
[[nodiscard]] JudgedRays JudgedViews(const Medium& medium, int count);

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

}  // namespace alpenglow::lut
