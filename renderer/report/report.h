// SPDX-License-Identifier: MIT
// The report `skyseries report` of speed and accuracy of pictures, measured against each other in
// one run.
//
// Topics, each measured on its own: aerial perspective and transmittance in front of terrain,
// shafts, clouds, plane layers, volumes of smoke, caustics of glass, one lamp in a medium, many lamps,
// whole pictures. Rows, folders and pages are those of lut/report/report.h; WriteReport writes them.
#pragma once

#include "lut/report/error_study.h"
#include "lut/report/report.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Measures the air in front of terrain, in unoccluded sunlight: inscatter and transmittance.
[[nodiscard]] ReportTopic MeasureAerialPerspective(const Medium& medium,
                                                   const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureTransmittanceToTerrain(const Medium& medium,
                                                        const ReportEffort& effort);

/// Measures all topics, in some minutes; options.mediums apply to the air in front of
/// terrain. Stops between methods when the program is interrupted.
[[nodiscard]] Report MeasurePictureReport(const ReportOptions& options);

}  // namespace alpenglow::renderer
