// SPDX-License-Identifier: MIT
// A topic of the report: light in fields of clouds.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures the light of sun, sky and ground in cumulus under a high and a low sun, by the methods of
/// one table in the source.
[[nodiscard]] ReportTopic MeasureClouds(const ReportEffort& effort);

}  // namespace alpenglow::renderer
