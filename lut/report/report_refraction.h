// SPDX-License-Identifier: MIT
// One topic of the report: refraction of a line of sight by the air.
#pragma once

#include "atmosphere/medium/medium.h"
#include "lut/report/report.h"

namespace alpenglow::lut {

/// Measures refraction for one medium, because other media refract alike.
[[nodiscard]] ReportTopic MeasureRefraction(const Medium& medium, const ReportEffort& effort);

}  // namespace alpenglow::lut
