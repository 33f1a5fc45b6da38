// SPDX-License-Identifier: MIT
// A topic of the report: whole pictures, by samples of a pixel and nodes of the air.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Measures whole pictures.
[[nodiscard]] ReportTopic MeasurePictures(const ReportEffort& effort);

/// Returns a runway at night under a layer of droplets, seen from 38 m over its approach: `lamps` lamps in two
/// rows along it, and the landing lights of an aeroplane when `with_beam`.
[[nodiscard]] Scene RunwayScene(int lamps, bool with_beam);

}  // namespace alpenglow::renderer
