// SPDX-License-Identifier: MIT
// Where the moon is drawn while it stands before the sun.
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Unit, east, north and up of the eye: towards the moon, lifted as refraction lifts the middle of the
/// sun behind it, for what hides part of a round sun is round.
[[nodiscard]] glm::dvec3 ToMoonBefore(const SunPosition& apparent_sun, const GeodeticPosition& eye,
                                      const UtcInstant& instant);

}  // namespace alpenglow::renderer
