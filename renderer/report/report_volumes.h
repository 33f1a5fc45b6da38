// SPDX-License-Identifier: MIT
// The topic of the report about light in volumes of smoke.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures the light of all orders in a plume of smoke of optical depth 10 and 50, by the methods of
/// one table in the source, relative to traced paths.
[[nodiscard]] ReportTopic MeasureVolumes(const ReportEffort& effort);

}  // namespace alpenglow::renderer
