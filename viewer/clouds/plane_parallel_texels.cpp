// SPDX-License-Identifier: MIT
#include "viewer/clouds/plane_parallel_texels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <numeric>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/cloud_light/plane_parallel_light.h"
#include "renderer/layers/dense_matrix.h"

namespace alpenglow::viewer {
namespace {

constexpr std::size_t kLevels = 48, kPatternsOfLevels = 4;
constexpr std::size_t kDirections =
    std::size_t{CloudLayerTexels::kAzimuths} * CloudLayerTexels::kElevations;
// Scaled optical depth of the parts of rays whose source is found.
constexpr double kThin = 0.02;

double ElevationOf(std::size_t direction) {
  const auto row = static_cast<double>(direction / CloudLayerTexels::kAzimuths);
  return kPi * ((row + 0.5) / CloudLayerTexels::kElevations - 0.5);
}

glm::dvec3 ViewOf(std::size_t direction) {
  const auto column = static_cast<double>(direction % CloudLayerTexels::kAzimuths);
  const double azimuth = 2.0 * kPi * (column + 0.5) / CloudLayerTexels::kAzimuths;
  const double elevation = ElevationOf(direction), level = std::cos(elevation);
  return {level * std::sin(azimuth), level * std::cos(azimuth), std::sin(elevation)};
}

/// Sources of all levels in all directions.
using Sources = std::vector<std::array<double, kLevels>>;

/// Light that a part of a ray adds.
using AddedLight = std::function<double(const CloudRay&, const PlaneParallelCloud::Crossing&)>;

Sources SourcesOf(const PlaneParallelCloud& cloud, const AddedLight& added) {
  const double base_m = cloud.depths().base_m();
  const double level_m = (cloud.depths().top_m() - base_m) / kLevels;
  const double scale = cloud.beam().peak_scale();
  Sources sources(kDirections);
  tbb::parallel_for(std::size_t{0}, kDirections, [&](std::size_t direction) {
    const glm::dvec3 view = ViewOf(direction);
    for (std::size_t level = 0; level < kLevels; ++level) {
      const double middle_m = base_m + (static_cast<double>(level) + 0.5) * level_m;
      const double per_m = scale * std::max(cloud.depths().Extinction_per_m(middle_m), 1e-9);
      const double length_m = std::min(kThin / per_m, level_m);
      const CloudRay ray{glm::dvec3(0.0, 0.0, middle_m) - 0.5 * length_m * view, view};
      const auto crossing = cloud.CrossingOf(ray, length_m);
      if (crossing && crossing->scaled > 0.0)
        sources[direction][level] = added(ray, *crossing) / -std::expm1(-crossing->scaled);
    }
  });
  return sources;
}

using Patterns = std::array<std::array<double, kLevels>, kPatternsOfLevels>;

Patterns PatternsOf(const Sources& sources) {
  DenseMatrix covariance(kLevels);
  for (std::size_t direction = 0; direction < kDirections; ++direction) {
    const std::array<double, kLevels>& of = sources[direction];
    const double solid = std::cos(ElevationOf(direction));
    for (std::size_t a = 0; a < kLevels; ++a) {
      for (std::size_t b = 0; b < kLevels; ++b) covariance(a, b) += solid * of[a] * of[b];
    }
  }
  const SymmetricEigen eigen = EigenOfSymmetric(covariance);
  std::array<std::size_t, kLevels> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return eigen.value[a] > eigen.value[b]; });
  Patterns patterns{};
  for (std::size_t p = 0; p < kPatternsOfLevels; ++p) {
    for (std::size_t level = 0; level < kLevels; ++level)
      patterns[p][level] = eigen.vector(level, order[p]);
  }
  return patterns;
}

/// Returns the components of all levels, and appends their functions of the direction.
std::vector<HalfBits> ComponentsOf(const Sources& sources, std::vector<glm::vec4>& basis) {
  const Patterns patterns = PatternsOf(sources);
  std::vector<HalfBits> components;
  for (std::size_t level = 0; level < kLevels; ++level) {
    for (const auto& pattern : patterns)
      components.push_back(glm::packHalf1x16(static_cast<float>(pattern[level])));
  }
  for (const auto& of : sources) {
    glm::vec4 functions(0.0F);
    for (std::size_t p = 0; p < kPatternsOfLevels; ++p)
      functions[static_cast<int>(p)] =
          static_cast<float>(std::inner_product(of.begin(), of.end(), patterns[p].begin(), 0.0));
    basis.push_back(functions);
  }
  return components;
}

void FillPeak(const LayerBeam& beam, CloudLayerTexels& layer) {
  for (int row = 0; row < CloudLayerTexels::kPeakDepths; ++row) {
    const double depth = PeakDepthOf(row / double{CloudLayerTexels::kPeakDepths - 1});
    for (int column = 0; column < CloudLayerTexels::kPeakAngles; ++column) {
      const double angle = PeakAngleOf(column / double{CloudLayerTexels::kPeakAngles - 1});
      layer.peak.push_back(static_cast<float>(beam.AtAngle(std::cos(angle)).At(depth)));
    }
  }
}

}  // namespace

void FillPlaneParallelLight(const CloudLight& light, CloudLayerTexels& layer) {
  const PlaneParallelCloud& cloud = *light.plane_parallel();
  layer.cells = {1, 1, static_cast<int>(kLevels)};
  layer.cells_base_m = cloud.depths().base_m() - layer.origin_m.z;
  layer.cell_height_m = (cloud.depths().top_m() - cloud.depths().base_m()) / kLevels;
  const Sources by_sky = SourcesOf(cloud, [&](const CloudRay& ray, const auto& crossing) {
    return cloud.Unlit(ray, crossing).sky;
  });
  Sources by_sun(kDirections);
  if (!light.sun().IsUnlit()) {
    const PlaneParallelSun sun({std::shared_ptr<void>(), &cloud}, light.sun());
    by_sun = SourcesOf(cloud, [&](const CloudRay& ray, const auto& crossing) {
      return sun.HigherOrders(ray, crossing);
    });
  }
  layer.sun = ComponentsOf(by_sun, layer.basis);
  layer.sky = ComponentsOf(by_sky, layer.basis);
  // Of unit scaled depth, the beam has the source w / s times the table.
  layer.scale = cloud.beam().peak_scale();
  layer.scaled_albedo = cloud.albedo() / layer.scale;
  layer.factor.fill(1.0F);
  FillPeak(cloud.beam(), layer);
}

}  // namespace alpenglow::viewer
