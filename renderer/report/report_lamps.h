// SPDX-License-Identifier: MIT
// Two topics of the report: the airlight of one lamp, and of many lamps.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures the airlight of one lamp, and of many.
[[nodiscard]] ReportTopic MeasureAirlight(const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureManyLamps(const ReportEffort& effort);

}  // namespace alpenglow::renderer
