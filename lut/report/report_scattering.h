// SPDX-License-Identifier: MIT
// Two topics of the report: light scattered once along a view, and light of all orders along a
// view.
#pragma once

#include <vector>

#include "atmosphere/medium/medium.h"
#include "lut/report/error_study.h"
#include "lut/report/report.h"

namespace alpenglow::lut {

[[nodiscard]] ReportTopic MeasureSingleScattering(const Medium& medium, const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureAllOrders(const Medium& medium, const ReportEffort& effort);
/// Measures light of all orders in difficult media, with fewer rays and methods, because paths are
/// long there.
[[nodiscard]] ReportTopic MeasureHardAir(const Medium& medium, const ReportEffort& effort);

/// Returns the dust of Mars, haze of optical depth 1 and molecules of optical depth 5. A report
/// that is neither quick nor about an atmosphere file includes them.
[[nodiscard]] std::vector<Medium> HardMediums();

}  // namespace alpenglow::lut
