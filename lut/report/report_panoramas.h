// SPDX-License-Identifier: MIT
// A topic of the report: the whole sphere around an observer under one sun.
#pragma once

#include "atmosphere/medium/medium.h"
#include "lut/report/error_study.h"
#include "lut/report/report.h"

namespace alpenglow::lut {

/// Measures the topic.
[[nodiscard]] ReportTopic MeasurePanoramas(const Medium& medium, const ReportEffort& effort);

}  // namespace alpenglow::lut
