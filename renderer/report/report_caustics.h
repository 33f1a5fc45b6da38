// SPDX-License-Identifier: MIT
// The topic of the report about the light of spheres of glass in fog.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures the caustic of a glass sphere in fog by photon beams, photon points and paths from the eye,
/// relative to quadrature over cones.
[[nodiscard]] ReportTopic MeasureCaustics(const ReportEffort& effort);

}  // namespace alpenglow::renderer
