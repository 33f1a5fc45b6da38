// SPDX-License-Identifier: MIT
// One topic of the report: transmittance from a point in the air to the sun, along the beams of
// report_rays.h.
#pragma once

#include "atmosphere/medium/medium.h"
#include "lut/report/report.h"

namespace alpenglow::lut {

[[nodiscard]] ReportTopic MeasureTransmittance(const Medium& medium, const ReportEffort& effort);

}  // namespace alpenglow::lut
