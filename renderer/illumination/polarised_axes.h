// SPDX-License-Identifier: MIT
// This header defines polarised light in the axes of a picture.
//
// With the axes up and right at a viewing direction, light that vibrates along
// p = cos(a) up + sin(a) right has the intensity I(a) = (I + Q cos(2 a) + U sin(2 a)) / 2. Q is the
// excess of vertical over horizontal vibration, and U the excess along the diagonal from the lower
// left to the upper right over the other diagonal. I(a) is the light that an ideal polariser
// passes; of unpolarised light this is half.
#pragma once

#include <glm/vec3.hpp>

#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Coefficients of Q and U along a unit vector p across the view: cos(2 a) and sin(2 a).
struct Analyser {
  float q, u;
};
[[nodiscard]] Analyser AnalyserAlong(const glm::dvec3& p, const ViewAxes& axes);

/// Returns polarised light scattered in the air, whose Stokes parameters refer to the vertical
/// plane (polarised_scattering.h), in the axes of the picture.
/// @param view, up, to_sun  unit vectors; up is the vertical.
[[nodiscard]] PolarisedLight InAxes(const PolarisedLight& of_vertical, const glm::dvec3& view,
                                    const glm::dvec3& up, const glm::dvec3& to_sun,
                                    const ViewAxes& axes);

/// Returns the light that passes the analyser: half of unpolarised light.
/// @param polarised  its Q and U in the axes of the analyser; null: unpolarised.
[[nodiscard]] Spectrum Passed(const Analyser& analyser, const Spectrum& light,
                              const PolarisedLight* polarised);

/// Returns Q and U of two superposed lights.
[[nodiscard]] PolarisedLight operator+(const PolarisedLight& a, const PolarisedLight& b);
/// Returns Q and U behind a medium with a transmittance.
[[nodiscard]] PolarisedLight operator*(const Spectrum& left, const PolarisedLight& light);

}  // namespace alpenglow::renderer
