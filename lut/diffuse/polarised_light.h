// SPDX-License-Identifier: MIT
// Polarisation of light along a ray, for unit solar irradiance.
#pragma once

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/ray_samples.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Stokes parameters of light along a ray [1/sr]. Q > 0 vibrates in the vertical plane of the view;
/// U > 0 from the upper right to the lower left as the eye sees it where the sun is to the left of
/// the view (on its right, U has the opposite sign). Straight up and down the view counts as tilted
/// towards the sun's azimuth.
struct PolarisedLight {
  Bands<float> q, u;
};

/// Of sunlight that molecules scatter once into the ray: by 3/(16 pi) D sin^2 of the angle of
/// scattering across the plane through the sun. Aerosol and ground depolarise.
[[nodiscard]] PolarisedLight PolarisedOnce(const Medium& medium, const ScatteredOnce<float>& once,
                                           const ViewRay& ray);

/// Cosine of the azimuth between a direction and the sun; 1 where one of them is vertical.
[[nodiscard]] double AzimuthCosineOrAhead(double mu, double mu_s, double nu);

}  // namespace alpenglow::lut
