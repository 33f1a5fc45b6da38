// SPDX-License-Identifier: MIT
// What the air that a lamp lights brings to surfaces: lamp -> air -> surface, in air of exponential
// density over a level ground.
//
//   E(n) = integral over directions d with n.d > 0 of  L(d) n.d,    L = Airlight from the surface
//
// L is integrated over the sphere around points at several distances from the lamp and elevations
// of the lamp over their horizon, and kept as moments of real spherical harmonics about the
// direction to the lamp, even about the vertical plane through it. Irradiance of any normal is then
// a short sum with the moments of the clamped cosine (Ramamoorthi, Hanrahan 2001, SIGGRAPH, "An
// efficient representation for irradiance environment maps"). Between distances the logarithm of
// the moment 00 times the distance is linear, and level ground has its exact irradiance: E falls as
// 1/d near a lamp, exponentially far from it. Rays end at the level ground at the lamp's foot, or
// at the surface where that is lower.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/lamp/airlight.h"
#include "lut/diffuse/spherical_harmonics.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Of an isotropic lamp of intensity 1 at one altitude. Immutable.
class LampGlow {
 public:
  /// @param ground_altitude_m  at the lamp's foot, not above it.
  /// Of the moments.
  static constexpr int kDegree = 6;

  LampGlow(const std::vector<LampLayer>& layers, double lamp_altitude_m, double ground_altitude_m);

  /// Irradiance [m^-2], in every band.
  /// @param to_lamp  from the surface [m]; its length is clamped to what was tabulated, 0.2 m to
  ///     20 km. normal, up: unit.
  /// Error against quadrature over the hemisphere, in fog of scale heights of 25 to 100 m up to 4
  /// optical depths from the lamp, in parts of the irradiance of the normal that gets most: below
  /// 18 %, rms 5 %.
  [[nodiscard]] Bands<double> On(const glm::dvec3& to_lamp, const glm::dvec3& normal,
                                 const glm::dvec3& up) const;

 private:
  /// Of one place, a band: logarithm of the moment 00 times the distance, and all moments relative
  /// to 00, times those of the clamped cosine.
  struct Light {
    double log_mean = 0.0;
    Moments lobe{};
    double level = 0.0;  // what level ground gets more than the moments say, over the moment 00
  };

  [[nodiscard]] std::vector<Light> LightAt(double distance_m, double sine) const;

  LampAir air_;
  double lamp_altitude_m_, ground_altitude_m_;
  std::vector<Light> lights_;  // [(distance * elevations + elevation) * bands + band]
};

}  // namespace alpenglow::renderer
