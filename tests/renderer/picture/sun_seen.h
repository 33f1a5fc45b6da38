// SPDX-License-Identifier: MIT
// The sun where pictures show it, without preparing a scene.
#pragma once

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/scene/scene.h"

namespace alpenglow::tests {

using namespace renderer;

/// Returns the sun as the eye of a scene without terrain sees it.
inline SunInSky SunSeenIn(const Scene& scene, const UtcTime& instant) {
  Place eye = scene.place;
  eye.height_m = scene.camera.height.value_m;
  return ApparentSunAt(eye, instant,
                       GentleAirOf(OnOsculatingSphere(scene.medium, eye.latitude_rad())));
}

}  // namespace alpenglow::tests
