// SPDX-License-Identifier: MIT
#include "renderer/illumination/polarised_axes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow::renderer {
namespace {

/// Returns the vertical across a view, and the axis to the right of it. A view straight up or down
/// is treated as tilted towards the sun's azimuth, as in polarised_scattering.h.
ViewAxes VerticalAxes(const glm::dvec3& view, const glm::dvec3& up, const glm::dvec3& to_sun) {
  const double mu = glm::dot(view, up), mu_s = glm::dot(to_sun, up);
  const glm::dvec3 level = view - mu * up, level_sun = to_sun - mu_s * up;
  const double sine = glm::length(level), sun_sine = glm::length(level_sun);
  const bool tilted = sine * sun_sine < 1e-6 && sine < sun_sine;
  const glm::dvec3 away = tilted       ? level_sun / sun_sine
                          : sine > 0.0 ? level / sine
                                       : glm::normalize(glm::cross(view, {0.3, -0.5, 0.8}));
  const glm::dvec3 upright =
      glm::normalize(std::sqrt(std::max(1.0 - mu * mu, 0.0)) * up - mu * away);
  return {glm::cross(view, upright), upright, view};
}

}  // namespace

Analyser AnalyserAlong(const glm::dvec3& p, const ViewAxes& axes) {
  const double up = glm::dot(p, axes.up), right = glm::dot(p, axes.right);
  return {static_cast<float>((up - right) * (up + right)), static_cast<float>(2.0 * up * right)};
}

PolarisedLight InAxes(const PolarisedLight& of_vertical, const glm::dvec3& view,
                      const glm::dvec3& up, const glm::dvec3& to_sun, const ViewAxes& axes) {
  const ViewAxes vertical = VerticalAxes(view, up, to_sun);
  const Analyser turned = AnalyserAlong(axes.up, vertical);
  const float side = glm::dot(to_sun, vertical.right) > 0.0 ? -1.0F : 1.0F;
  PolarisedLight light = of_vertical;
  for (std::size_t band = 0; band < light.q.size(); ++band) {
    const float q = of_vertical.q[band], u = side * of_vertical.u[band];
    light.q[band] = turned.q * q + turned.u * u;
    light.u[band] = turned.q * u - turned.u * q;
  }
  return light;
}

Spectrum Passed(const Analyser& analyser, const Spectrum& light, const PolarisedLight* polarised) {
  Spectrum passed = 0.5F * light;
  if (polarised == nullptr) return passed;
  for (std::size_t band = 0; band < passed.size(); ++band) {
    passed[band] += 0.5F * (analyser.q * polarised->q[band] + analyser.u * polarised->u[band]);
  }
  return passed;
}

PolarisedLight operator+(const PolarisedLight& a, const PolarisedLight& b) {
  return {a.q + b.q, a.u + b.u};
}

PolarisedLight operator*(const Spectrum& left, const PolarisedLight& light) {
  return {left * light.q, left * light.u};
}

}  // namespace alpenglow::renderer
