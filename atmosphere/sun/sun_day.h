// SPDX-License-Identifier: MIT
// Days without an event of the sun: whether it is above or below.
#pragma once

#include "atmosphere/sun/sun.h"

namespace alpenglow::atmosphere {

/// True if the sun stands above the height at which it rises and sets, or begins and ends a
/// twilight (FindSunEvent); an event other than noon. On a day without the event it does so all
/// day, if at noon.
[[nodiscard]] bool IsAboveEvent(SunEvent event, const GeodeticPosition& place,
                                const UtcInstant& instant);

}  // namespace alpenglow::atmosphere
