// SPDX-License-Identifier: MIT
// Solved air that the tests of a program share, because its solution takes long.
#pragma once

#include <vector>

#include "atmosphere/medium/medium.h"
#include "renderer/scene/scene.h"
#include "viewer/passes/painted_scene.h"

namespace alpenglow::tests {

using namespace viewer;

/// Returns the medium of a scene, solved as PaintedScene does it without a first air. Scenes with
/// equal media get the same solution.
inline FirstAir SharedAirOf(const Scene& scene) {
  static std::vector<FirstAir> solved;
  const Medium medium = OnOsculatingSphere(scene.medium, scene.place.latitude_rad());
  for (const FirstAir& air : solved) {
    if (air->air.medium() == medium) return air;
  }
  return solved.emplace_back(TabulateAir(medium));
}

}  // namespace alpenglow::tests
