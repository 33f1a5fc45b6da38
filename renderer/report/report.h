// SPDX-License-Identifier: MIT
// Speed and accuracy of pictures held against each other, in one run: `skyseries report`.
//
// Topics: aerial perspective and transmittance before terrain, shafts, one lamp in fog, many
// lamps, whole pictures. Rows, folders and pages are those of lut/report/report.h;
// WriteReport writes them.
#pragma once

#include "lut/report/report.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Measures everything: a minute or two; `mediums` are those of the air before terrain. Stops
/// between methods when the program is interrupted.
[[nodiscard]] Report MeasurePictureReport(const ReportOptions& options);

}  // namespace alpenglow::renderer
