// SPDX-License-Identifier: MIT
// A topic of the report: single scattering in air that terrain shades in part.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures single scattering in air that terrain shades in part.
[[nodiscard]] ReportTopic MeasureShafts(const ReportEffort& effort);

}  // namespace alpenglow::renderer
