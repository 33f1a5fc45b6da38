// SPDX-License-Identifier: MIT
// Irradiance of level ground by place, below a periodic field of clouds.
//
// The radiance L_i leaves the base of the field in directions i of a quadrature over the hemisphere
// downwards, with solid angles w_i. At the depth h below the base
//
//   E(x) = sum_i w_i |z_i| (G_i * L_i)(x - h t_i),   t_i = (x_i, y_i) / |z_i|
//
// A few directions would throw a few images of each cloud on the ground. Each direction stands for a
// cone, whose trace is about as wide as h |t_i| is long between neighbours: G_i is a Gaussian function
// of the standard deviation kTraceWidth h |t_i|, and at least about kLeastTrace_m, because a track
// shows a line of its cone only. The mean over a period is that without it.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Light in one direction through the columns of cells of a field at its base.
struct CloudBaseLight {
  glm::dvec3 travel;            // unit, downwards
  double solid_angle_sr;        // for which the direction stands
  glm::dvec2 place_m;           // where light leaves columns, from their corners
  std::vector<float> radiance;  // by column, x fastest
};

/// The columns of cells of a periodic field.
struct CloudColumns {
  std::array<int, 2> count{};
  glm::dvec2 origin_m{0.0}, cell_m{1.0};
};

/// Immutable; safe to use from many threads.
class CloudFloor {
 public:
  static constexpr double kTraceWidth = 0.4, kLeastTrace_m = 40.0;

  /// @param depth_m  of the ground below the base, >= 0.
  CloudFloor(const CloudColumns& columns, const std::vector<CloudBaseLight>& light, double depth_m);

  /// Returns the irradiance at a place, linear between the middles of columns.
  [[nodiscard]] double At(const glm::dvec2& place_m) const;
  /// Returns the mean over a period.
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] std::size_t bytes() const { return irradiance_.size() * sizeof(float); }

 private:
  CloudColumns columns_;
  std::vector<float> irradiance_;  // in the middles of columns
  double mean_ = 0.0;
};

}  // namespace alpenglow::renderer
