// SPDX-License-Identifier: MIT
// Materials of spheres that light passes without being scattered.
#pragma once

namespace alpenglow::renderer {

enum class SphereMaterial { kGlass, kMirror };

inline constexpr double kLeastRefractiveIndex = 1.0, kMostRefractiveIndex = 4.0;

}  // namespace alpenglow::renderer
