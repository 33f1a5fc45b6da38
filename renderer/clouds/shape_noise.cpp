// SPDX-License-Identifier: MIT
#include "renderer/clouds/shape_noise.h"

#include <tbb/task_arena.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow::renderer {
namespace {

constexpr int kTexels = 128;

/// Makes a cube of noise. A thread that waits for the parts of it must not begin other work, which
/// could ask for the same cube.
template <typename Make>
auto Isolated(const Make& make) {
  return tbb::this_task_arena::isolate(make);
}

}  // namespace

const TilingNoise& ShapeNoise::Billow() {
  static const TilingNoise noise = Isolated([] {
    return TilingNoise::Billow(kTexels, {4, 4, 0.55, 11});
  });
  return noise;
}

const TilingVectorNoise& ShapeNoise::Smooth() {
  static const TilingVectorNoise noise = Isolated([] {
    return TilingVectorNoise(kTexels / 2, {4, 3, 0.5, 5});
  });
  return noise;
}

glm::dvec2 WindDirection(const CloudOptions& options) {
  const double speed = glm::length(options.wind_m_per_s);
  return speed > 0.0 ? options.wind_m_per_s / speed : glm::dvec2(1.0, 0.0);
}

}  // namespace alpenglow::renderer
