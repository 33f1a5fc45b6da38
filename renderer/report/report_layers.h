// SPDX-License-Identifier: MIT
// The topic of the report about light in plane-parallel layers.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures light in plane-parallel layers by number of streams, and that of the two-stream
/// approximation, relative to many streams.
[[nodiscard]] ReportTopic MeasureLayers(const ReportEffort& effort);

}  // namespace alpenglow::renderer
