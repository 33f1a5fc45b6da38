// SPDX-License-Identifier: MIT
// Rays that meet a sphere of glass, or a mirror, exactly.
//
// A ray in air meets the sphere under the angle i and is refracted to r: sin i = n sin r (Snell). Each
// further encounter with the surface has the same angles, because the chord of a sphere makes equal
// angles with it at both ends. With the outward normal N where the ray enters and the unit vector S
// along the surface, in the plane of incidence (the direction of the ray is -cos i N + sin i S), the
// ray of order p leaves at the angle p (pi - 2 r) from there:
//
//   point      c + R N_p                  N_p = cos(p (pi - 2 r)) N + sin(p (pi - 2 r)) S
//   direction  cos i N_p + sin i S_p      S_p = dN_p / dangle
//   power      F                          p = 0, reflected outside
//              (1 - F)^2 F^(p - 1)        p > 0: refracted twice, reflected p - 1 times inside
//
// F is Fresnel's reflectance of unpolarised light. Powers of all orders add up to 1: glass does not
// absorb. The orders are those of Debye's series (van de Hulst 1957, "Light Scattering by Small
// Particles", 12.2). Polarisation by the first encounter is not followed to the next one, and light
// does not interfere. A mirror has order 0 only, with power 1.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "renderer/layer.h"
#include "renderer/scene/sphere_material.h"

namespace alpenglow::renderer {

struct SpecularSphere {
  glm::dvec3 centre{0.0};
  double radius_m = 1.0;
  SphereMaterial material = SphereMaterial::kGlass;
  double index = 1.5;  // of refraction, relative to air; a mirror has none
};

/// Throws InputError unless the radius is positive and finite, and the index in [1, 4].
void Validate(const SpecularSphere& sphere);

/// Returns the distance along a ray at which it enters a sphere from outside [m]; no value if it
/// misses the sphere or starts inside or behind it. @param direction  unit.
[[nodiscard]] std::optional<double> DistanceTo(const SpecularSphere& sphere,
                                               const glm::dvec3& origin,
                                               const glm::dvec3& direction);

/// A sphere that a ray enters.
struct EnteredSphere {
  std::size_t number;
  double distance_m;
};

/// Returns the first sphere that a ray enters from outside; no value if there is none.
[[nodiscard]] std::optional<EnteredSphere> FirstSphereOn(std::span<const SpecularSphere> spheres,
                                                         const glm::dvec3& origin,
                                                         const glm::dvec3& direction);

/// A ray that leaves a sphere.
struct LeavingRay {
  glm::dvec3 origin;     // on the surface
  glm::dvec3 direction;  // unit
};

/// The rays into which a sphere divides one ray.
class DividedRay {
 public:
  /// Orders beyond are not sampled. A sphere of index 1.5 sends 1e-4 of the light further.
  static constexpr int kMostOrder = 20;

  /// @param point  where the ray meets the surface from outside. @param direction  of the ray, unit.
  DividedRay(const SpecularSphere& sphere, const glm::dvec3& point, const glm::dvec3& direction);

  /// Returns the fraction of the power that leaves as one order >= 0.
  [[nodiscard]] double Share(int order) const;
  /// Returns the ray of an order >= 0. Direction and place are exact to 1e-12.
  [[nodiscard]] LeavingRay Leaving(int order) const;
  /// Returns the angle between the ray and its continuation of an order [rad], in (-pi, pi] modulo
  /// whole turns: 2 (i - r) for order 1.
  [[nodiscard]] double Deviation(int order) const;
  /// Samples an order with the probability Share(); no value for orders beyond kMostOrder.
  /// @param u  uniform in [0, 1).
  [[nodiscard]] std::optional<int> SampleOrder(double u) const;

 private:
  SpecularSphere sphere_;
  glm::dvec3 normal_, along_;
  double incident_rad_, refracted_rad_, reflectance_;
};

}  // namespace alpenglow::renderer
