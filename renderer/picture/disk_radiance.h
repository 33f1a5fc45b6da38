// SPDX-License-Identifier: MIT
// The light that arrives from a point of the disk of the sun or the moon in a picture, with
// refraction, an eclipse, and the motion of the moon while the shutter is open.
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/colour/spectrum.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/picture/frame_context.h"

namespace alpenglow::renderer {

/// Returns the radiance of the sun's disk in a direction, W m^-2 sr^-1 nm^-1; 0 beside it and where
/// the moon covers it.
/// @param through  air in front of it.
[[nodiscard]] Spectrum SunDiskRadiance(const FrameContext& frame, const glm::dvec3& direction,
                                       const AirAlongRay& through);

/// Returns the radiance of the moon's disk in a direction, W m^-2 sr^-1 nm^-1, its mean while the
/// shutter is open; 0 beside it and during an eclipse of the sun.
[[nodiscard]] Spectrum MoonDiskRadiance(const FrameContext& frame, const glm::dvec3& direction,
                                        const AirAlongRay& through);

}  // namespace alpenglow::renderer
