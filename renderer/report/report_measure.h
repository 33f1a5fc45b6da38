// SPDX-License-Identifier: MIT
// The topics of the report of pictures, each measured on its own.
#pragma once

#include "lut/report/report_measure.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// The air in front of terrain, in unbroken sunlight:
/// light scattered on the way, and transmittance.
[[nodiscard]] ReportTopic MeasureAerialPerspective(const Medium& medium,
                                                   const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureTransmittanceToTerrain(const Medium& medium,
                                                        const ReportEffort& effort);

/// Light scattered once where terrain lets the sun into the air.
[[nodiscard]] ReportTopic MeasureShafts(const ReportEffort& effort);

/// Light of one lamp in the air, and of many.
[[nodiscard]] ReportTopic MeasureAirlight(const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureManyLamps(const ReportEffort& effort);

/// Whole pictures.
[[nodiscard]] ReportTopic MeasurePictures(const ReportEffort& effort);

/// A runway at night in height fog, from 38 m over its approach: so many lamps in two rows along
/// it, and the landing lights of an aeroplane when `with_beam`.
[[nodiscard]] Scene RunwayScene(int lamps, bool with_beam);

}  // namespace alpenglow::renderer
