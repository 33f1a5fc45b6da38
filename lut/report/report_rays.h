// SPDX-License-Identifier: MIT
// This header provides the rays of the report, which are drawn once and evaluated by the reference
// solution, and the methods that several topics of rays measure.
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
#pragma once

#include <string>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "lut/report/report_baselines.h"
#include "lut/tables/scattering_table.h"

namespace alpenglow::lut {

/// Fraction of the zenith's radiance that is the lower bound of the denominator of errors.
inline constexpr double kDarkestPart = 0.01;

/// Returns the reference value of a radiance. Errors are relative to the radiance, at least to the
/// floor and to kDarkestValue.
[[nodiscard]] ReferenceValue RadianceReference(std::vector<double> radiance,
                                               std::vector<double> sigma,
                                               const std::vector<double>& floor);

/// Returns the sun's elevation for ray number i [degrees], uniform over the regime.
[[nodiscard]] double SunElevationNumber(int i, const ReportRegime& regime);

/// Function that returns ray number i >= 1 of a regime.
using DrawRay = ViewRay (*)(const Medium& medium, int i, const ReportRegime& regime);

/// Returns view number i >= 1 of the distribution above.
[[nodiscard]] ViewRay ViewNumber(const Medium& medium, int i, const ReportRegime& regime);
/// Returns view number i >= 1 from space down to the ground.
[[nodiscard]] ViewRay GroundFromSpaceNumber(const Medium& medium, int i,
                                            const ReportRegime& regime);
/// Returns beam number i >= 1 to the sun.
[[nodiscard]] ViewRay SunbeamNumber(const Medium& medium, int i, const ReportRegime& regime);

/// A study of rays through one medium, in all of kRegimes.
class RayStudy : public ErrorStudy<ViewRay> {
 public:
  /// @param medium  must live as long as the study.
  RayStudy(ReportTopic topic, const Medium& medium, const ReportEffort& effort);

  /// Solve effort().rays rays of a distribution with the reference solutions for transmittance and
  /// for single scattering.
  void SolveTransmittance(DrawRay draw);
  void SolveSingleScattering(DrawRay draw);
  /// Solves effort().traced_rays views for the light of all orders scattered along them (without
  /// light from the ground at their end), by the path tracer.
  void SolveAllOrders();

  /// Adds transmittance by a march through the densities.
  void AddTransmittanceMarch(const std::string& series, MarchRule rule, int steps, bool in_summary);
  /// Adds light scattered once by a march in steps.
  void AddScatteringMarch(MarchRule rule, int steps, bool in_summary);
  /// Adds light scattered once by look-ups in a table; the row has no parameter, memory and time.
  void AddScatteringTable(ReportRow row, const ScatteringTableOptions& options);

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] const SingleScattering<float>& air() const { return air_; }

 private:
  const Medium& medium_;
  SingleScattering<float> air_;
};

}  // namespace alpenglow::lut
