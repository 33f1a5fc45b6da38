// SPDX-License-Identifier: MIT
// Polarised light in the axes of a picture.
//
// With up and right the axes at a direction of view, light that vibrates along
// p = cos(a) up + sin(a) right is I(a) = (I + Q cos(2 a) + U sin(2 a)) / 2: Q is what vibrates
// upright more than level, U what vibrates from the lower left to the upper right more than across
// that. It is what an ideal polariser passes; of light without polarisation, half.
#pragma once

#include <glm/vec3.hpp>

#include "lut/diffuse/polarised_light.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// How much of Q and U vibrates along a unit vector p across the view: cos(2 a) and sin(2 a).
struct Analyser {
  float q, u;
};
[[nodiscard]] Analyser AnalyserAlong(const glm::dvec3& p, const PictureAxes& axes);

/// Light that is scattered in the air, whose Stokes parameters are those of the vertical plane
/// (polarised_light.h), in the axes of the picture.
/// @param view, up, to_sun  unit vectors; up is the vertical.
[[nodiscard]] PolarisedLight InAxes(const PolarisedLight& of_vertical, const glm::dvec3& view,
                                    const glm::dvec3& up, const glm::dvec3& to_sun,
                                    const PictureAxes& axes);

/// What passes: half of light without polarisation.
/// @param polarised  its Q and U in the axes of the analyser; null: none.
[[nodiscard]] BandLight Passed(const Analyser& analyser, const BandLight& light,
                               const PolarisedLight* polarised);

/// Q and U of two lights seen together.
[[nodiscard]] PolarisedLight operator+(const PolarisedLight& a, const PolarisedLight& b);
/// Behind what dims it.
[[nodiscard]] PolarisedLight operator*(const BandLight& left, const PolarisedLight& light);

}  // namespace alpenglow::renderer
