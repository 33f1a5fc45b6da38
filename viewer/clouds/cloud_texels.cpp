// SPDX-License-Identifier: MIT
#include "viewer/clouds/cloud_texels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <map>
#include <numeric>
#include <string_view>

#include "atmosphere/math/constants.h"
#include "renderer/clouds/cloud_bricks.h"
#include "renderer/layers/dense_matrix.h"
#include "viewer/clouds/plane_parallel_texels.h"

namespace alpenglow::viewer {
namespace {

constexpr int kTilesAcross = 56;  // 504 texels: every driver has 3D textures of this size
constexpr double kLeastPeakDepth = 1e-3;

HalfBits Half(double value) { return glm::packHalf1x16(static_cast<float>(value)); }

/// Codes of depths in bytes: 96 is the surface. Extinctions of grids have the codes above it.
constexpr double kSurfaceCode = -kLeastCloudDepth_m;
constexpr double kMostCode = 255.0;

/// Returns the bytes of a field's corners. Those of a grid encode the extinction.
std::vector<std::uint8_t> CornerBytes(const CloudField::StoredBricks& bricks,
                                      double largest_per_m) {
  const auto extinctions = bricks.extinctions_per_m();
  if (extinctions.empty()) return {bricks.depths().begin(), bricks.depths().end()};
  std::vector<std::uint8_t> bytes(extinctions.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const double share = static_cast<double>(extinctions[i]) / largest_per_m;
    bytes[i] = static_cast<std::uint8_t>(
        std::lround(std::lerp(kSurfaceCode, kMostCode, std::min(share, 1.0))));
  }
  return bytes;
}

/// Finds equal bricks, of which plane-parallel fields have thousands, so that each is stored once.
class DistinctBricks {
 public:
  explicit DistinctBricks(const std::vector<std::uint8_t>& bytes) {
    constexpr std::size_t kBrick = CloudField::StoredBricks::kCornersOfBrick;
    std::map<std::string_view, std::int32_t> known;
    for (std::size_t begin = 0; begin + kBrick <= bytes.size(); begin += kBrick) {
      const std::string_view brick(reinterpret_cast<const char*>(bytes.data()) + begin, kBrick);
      const auto next = static_cast<std::int32_t>(first_.size());
      const auto [place, is_new] = known.try_emplace(brick, next);
      if (is_new) first_.push_back(begin);
      number_.push_back(place->second);
    }
  }
  /// Returns the number of the distinct brick of a slot.
  [[nodiscard]] std::int32_t Of(std::int32_t slot) const {
    return number_[static_cast<std::size_t>(slot)];
  }
  /// Returns the first byte of each distinct brick.
  [[nodiscard]] const std::vector<std::size_t>& first() const { return first_; }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::int32_t> number_;
};

void CopyBrick(const std::uint8_t* from, const std::array<int, 3>& tile, CloudLayerTexels& layer) {
  constexpr int kSide = CloudField::StoredBricks::kCornersOfSide;
  const auto width = static_cast<std::size_t>(kSide * layer.tiles[0]);
  const auto height = static_cast<std::size_t>(kSide * layer.tiles[1]);
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      const std::size_t row = (static_cast<std::size_t>(kSide * tile[2] + z) * height +
                               static_cast<std::size_t>(kSide * tile[1] + y)) *
                                  width +
                              static_cast<std::size_t>(kSide * tile[0]);
      std::copy_n(from + (z * kSide + y) * kSide, kSide,
                  layer.depth.begin() + static_cast<std::ptrdiff_t>(row));
    }
  }
}

void FillShape(const CloudField& field, CloudLayerTexels& layer) {
  const CloudField::StoredBricks bricks(field);
  layer.bricks = bricks.count();
  const std::vector<std::uint8_t> bytes = CornerBytes(bricks, field.largest_extinction_per_m());
  const DistinctBricks distinct(bytes);
  const auto slots = static_cast<int>(distinct.first().size());
  const int across = std::clamp(slots, 1, kTilesAcross);
  const int rows = std::clamp((slots + across - 1) / across, 1, kTilesAcross);
  layer.tiles = {across, rows, std::max((slots + across * rows - 1) / (across * rows), 1)};
  constexpr std::size_t kBrick = CloudField::StoredBricks::kCornersOfBrick;
  layer.depth.resize(kBrick * static_cast<std::size_t>(across) * static_cast<std::size_t>(rows) *
                     static_cast<std::size_t>(layer.tiles[2]));
  const auto tile_of = [&](int slot) {
    return std::array{slot % across, slot / across % rows, slot / (across * rows)};
  };
  const auto packed = [](const std::array<int, 3>& tile) {
    return tile[0] | tile[1] << 10 | tile[2] << 20;
  };
  tbb::parallel_for(0, slots, [&](int slot) {
    CopyBrick(bytes.data() + distinct.first()[static_cast<std::size_t>(slot)], tile_of(slot),
              layer);
  });
  layer.brick.resize(bricks.slots().size());
  for (std::size_t i = 0; i < layer.brick.size(); ++i) {
    const std::int32_t slot = bricks.slots()[i];
    layer.brick[i] = slot >= 0 ? packed(tile_of(distinct.Of(slot)))
                               : -std::max(static_cast<std::int32_t>(bricks.distances()[i]), 1);
  }
}

void FillExtinction(const CloudField& field, CloudLayerTexels& layer) {
  const bool is_grid = !CloudField::StoredBricks(field).extinctions_per_m().empty();
  const auto [low_m, high_m] = layer.range;
  for (int row = 0; row < CloudLayerTexels::kExtinctionRows; ++row) {
    const double z = std::lerp(low_m, high_m, row / double{CloudLayerTexels::kExtinctionRows - 1});
    const double core_per_m = field.matter().column.Extinction_per_m(z);
    for (int code = 0; code < CloudLayerTexels::kBytes; ++code) {
      const double depth_m = code + kLeastCloudDepth_m;
      const double per_m = is_grid ? field.largest_extinction_per_m() * std::max(depth_m, 0.0) /
                                         (kMostCode - kSurfaceCode)
                                   : field.matter().edge.FractionAt(depth_m) * core_per_m;
      layer.extinction.push_back(Half(kMetresPerKilometre * per_m));
    }
  }
}

/// The moments of the cells of a field, weighted by what they send.
class WeightedMoments {
 public:
  WeightedMoments(const CloudMoments& moments, const CloudOptics& optics) : moments_(moments) {
    // Y_00 is the same in all directions, and Y_l0 is not 0 along the axis: their ratio tells the
    // weights.
    const glm::dvec3 up(0.0, 0.0, 1.0);
    const CloudHarmonics harmonics = CloudHarmonicsOf(up), factors = optics.SourceFactors(up);
    for (std::size_t l = 0, k = 0; l <= kCloudDegree; ++l) {
      const std::size_t middle = l * l + l;
      for (std::size_t m = 0; m < 2 * l + 1; ++m, ++k)
        weight_[k] = static_cast<double>(factors[middle]) / static_cast<double>(harmonics[middle]);
    }
    FindPatterns();
  }

  static constexpr std::size_t kPatterns = 4;

  /// Returns the components of a cell.
  [[nodiscard]] std::array<double, kPatterns> Of(std::size_t cell) const {
    std::array<double, kPatterns> components{};
    const CloudHarmonics& of = moments_.Of(cell);
    for (std::size_t p = 0; p < kPatterns; ++p) {
      for (std::size_t k = 0; k < kCloudMoments; ++k)
        components[p] += pattern_[p][k] * weight_[k] * static_cast<double>(of[k]);
    }
    return components;
  }
  /// Returns the functions of a direction of travel.
  [[nodiscard]] glm::vec4 Towards(const glm::dvec3& travel) const {
    const CloudHarmonics harmonics = CloudHarmonicsOf(travel);
    glm::dvec4 functions(0.0);
    for (std::size_t p = 0; p < kPatterns; ++p) {
      for (std::size_t k = 0; k < kCloudMoments; ++k)
        functions[static_cast<int>(p)] += pattern_[p][k] * static_cast<double>(harmonics[k]);
    }
    return functions;
  }

 private:
  void FindPatterns() {
    DenseMatrix covariance(kCloudMoments);
    for (std::size_t cell = 0; cell < moments_.cells().full(); ++cell) {
      const CloudHarmonics& of = moments_.Of(cell);
      for (std::size_t a = 0; a < kCloudMoments; ++a) {
        for (std::size_t b = 0; b < kCloudMoments; ++b)
          covariance(a, b) +=
              weight_[a] * weight_[b] * (static_cast<double>(of[a]) * static_cast<double>(of[b]));
      }
    }
    const SymmetricEigen eigen = EigenOfSymmetric(covariance);
    std::array<std::size_t, kCloudMoments> order{};
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return eigen.value[a] > eigen.value[b]; });
    for (std::size_t p = 0; p < kPatterns; ++p) {
      for (std::size_t k = 0; k < kCloudMoments; ++k) pattern_[p][k] = eigen.vector(k, order[p]);
    }
  }

  const CloudMoments& moments_;
  std::array<double, kCloudMoments> weight_{};
  std::array<std::array<double, kCloudMoments>, kPatterns> pattern_{};
};

/// Returns the components of all cells, x fastest; 0 where none is stored.
std::vector<HalfBits> SourceTexels(const CloudMoments& moments, const WeightedMoments& weighted) {
  const CloudCells& cells = moments.cells();
  const CloudCellLattice lattice = cells.lattice();
  const auto [nx, ny, nz] = lattice.count;
  std::vector<HalfBits> texels(WeightedMoments::kPatterns * static_cast<std::size_t>(nx) *
                               static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  tbb::parallel_for(std::size_t{0}, cells.size(), [&, nx = nx, ny = ny](std::size_t cell) {
    const glm::dvec3 at = (cells.Middle(cell) - lattice.origin_m) / lattice.cell_m;
    const std::size_t texel = (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(ny) +
                               static_cast<std::size_t>(at.y)) *
                                  static_cast<std::size_t>(nx) +
                              static_cast<std::size_t>(at.x);
    const auto components = weighted.Of(cell);
    for (std::size_t p = 0; p < components.size(); ++p)
      texels[WeightedMoments::kPatterns * texel + p] = Half(components[p]);
  });
  return texels;
}

void AddBasis(const WeightedMoments& weighted, std::vector<glm::vec4>& basis) {
  for (int row = 0; row < CloudLayerTexels::kElevations; ++row) {
    const double elevation = kPi * ((row + 0.5) / CloudLayerTexels::kElevations - 0.5);
    for (int column = 0; column < CloudLayerTexels::kAzimuths; ++column) {
      const double azimuth = 2.0 * kPi * (column + 0.5) / CloudLayerTexels::kAzimuths;
      const double level = std::cos(elevation);
      const glm::dvec3 view(level * std::sin(azimuth), level * std::cos(azimuth),
                            std::sin(elevation));
      basis.push_back(weighted.Towards(-view));
    }
  }
}

void FillSources(const CloudLight& light, CloudLayerTexels& layer) {
  const CloudMoments &sun = light.sun_moments().moments, &sky = light.sky_moments().moments;
  const CloudCellLattice lattice = sun.cells().lattice();
  layer.cells = lattice.count;
  layer.cells_base_m = lattice.origin_m.z - layer.origin_m.z;
  layer.cell_height_m = lattice.cell_m.z;
  const WeightedMoments by_sun(sun, light.optics()), by_sky(sky, light.optics());
  layer.sun = SourceTexels(sun, by_sun);
  layer.sky = SourceTexels(sky, by_sky);
  AddBasis(by_sun, layer.basis);
  AddBasis(by_sky, layer.basis);
}

void FillBeam(const CloudLight& light, CloudLayerTexels& layer) {
  const CloudOptics& optics = light.optics();
  layer.scale = optics.extinction_scale();
  layer.scaled_albedo = optics.scaled_albedo();
  std::transform(light.factor().node.begin(), light.factor().node.end(), layer.factor.begin(),
                 [](double factor) { return static_cast<float>(factor); });
  for (int row = 0; row < CloudLayerTexels::kPeakDepths; ++row) {
    const double depth = PeakDepthOf(row / double{CloudLayerTexels::kPeakDepths - 1});
    for (int column = 0; column < CloudLayerTexels::kPeakAngles; ++column) {
      const double angle = PeakAngleOf(column / double{CloudLayerTexels::kPeakAngles - 1});
      layer.peak.push_back(static_cast<float>(optics.peak().Effective(std::cos(angle), depth)));
    }
  }
}

CloudLayerTexels LayerTexels(const CloudLight& light) {
  const CloudField& field = light.field();
  const CloudLattice& lattice = field.lattice();
  CloudLayerTexels layer{.range = {field.base_altitude_m(), field.top_altitude_m()},
                         .origin_m = lattice.origin_m,
                         .size_m = glm::dvec2(lattice.size_m()),
                         .is_periodic = lattice.is_periodic,
                         .voxel_m = lattice.voxel_m.x};
  FillShape(field, layer);
  FillExtinction(field, layer);
  if (light.plane_parallel() != nullptr) {
    FillPlaneParallelLight(light, layer);
  } else {
    FillSources(light, layer);
    FillBeam(light, layer);
  }
  return layer;
}

/// Returns the distance between levels. Along a beam they are further apart, and transmittance is linear
/// between them.
double LevelStep_m(const CloudSunDepths& sun) {
  constexpr double kPerSine = 3.0, kLeast_m = 10.0;
  if (sun.map() == nullptr) return 2.0 * CloudSunTexels::kLevel_m;
  return std::clamp(kPerSine * sun.to_sun().z * CloudSunTexels::kLevel_m, kLeast_m,
                    CloudSunTexels::kLevel_m);
}

/// Returns the levels of one layer. A light without a sheared map has levels down to the ground, and a
/// layer that no light reaches has one level without shadow.
CloudSunTexels::Layer LevelsOf(const CloudLight& light, int first) {
  const CloudField& field = light.field();
  CloudSunTexels::Layer levels{.first = first,
                               .low_m = field.base_altitude_m(),
                               .slope = glm::dvec2(0.0),
                               .clear_from_m = field.top_altitude_m()};
  if (light.sun().IsUnlit()) return levels;
  if (const CloudSunMap* map = light.sun().map()) {
    levels.slope = glm::dvec2(map->to_sun()) / map->to_sun().z;
  } else {
    levels.low_m = std::min(levels.low_m, 0.0);
    levels.clear_from_m = 1e9;  // a low sun shines through clouds far away
  }
  const double height_m = std::max(field.top_altitude_m() - levels.low_m, 1.0);
  const double step_m = LevelStep_m(light.sun());
  levels.levels = 1 + static_cast<int>(std::ceil(height_m / step_m));
  levels.level_m = height_m / (levels.levels - 1);
  return levels;
}

/// Returns the transmittance at a node.
double AtNode(const CloudSunDepths& sun, const glm::dvec3& point) {
  const CloudLowSunMap* low = sun.low_map();
  return low != nullptr ? low->TransmittanceAsAtPlace(point) : sun.Transmittance(point);
}

/// Writes the transmittances of a layer at the nodes of a level.
void FillLevel(const CloudLight& light, const CloudSunTexels::Layer& layer, int level, int nodes,
               HalfBits* texel) {
  const CloudLattice& lattice = light.field().lattice();
  const glm::dvec2 origin_m(lattice.origin_m), size_m(lattice.size_m());
  const double z = layer.low_m + level * layer.level_m;
  const glm::dvec2 shift = (z - layer.low_m) * layer.slope;
  for (int y = 0; y < nodes; ++y) {
    for (int x = 0; x < nodes; ++x) {
      const glm::dvec2 foot = origin_m + glm::dvec2(x + 0.5, y + 0.5) / double(nodes) * size_m;
      *texel++ = Half(AtNode(light.sun(), {foot + shift, z}));
    }
  }
}

CloudSunTexels SunTexels(const std::vector<CloudLight>& lights) {
  CloudSunTexels sun;
  bool is_high = false;
  for (const CloudLight& light : lights) {
    sun.layer.push_back(LevelsOf(light, sun.levels));
    sun.levels += sun.layer.back().levels;
    is_high = is_high || light.sun().map() != nullptr;
  }
  // A point under a low sun takes longer.
  sun.nodes = is_high ? CloudSunTexels::kNodes : CloudSunTexels::kNodes / 2;
  const auto nodes_of_level =
      static_cast<std::size_t>(sun.nodes) * static_cast<std::size_t>(sun.nodes);
  sun.transmittance.resize(nodes_of_level * static_cast<std::size_t>(sun.levels));
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const CloudSunTexels::Layer& layer = sun.layer[i];
    tbb::parallel_for(0, layer.levels, [&](int level) {
      FillLevel(lights[i], layer, level, sun.nodes,
                sun.transmittance.data() +
                    nodes_of_level * static_cast<std::size_t>(layer.first + level));
    });
  }
  return sun;
}

}  // namespace

double PeakAngleOf(double coordinate) {
  return 2.0 * std::asin(std::min(coordinate * coordinate, 1.0));
}

double PeakDepthOf(double coordinate) {
  return kLeastPeakDepth * std::pow(ForwardPeak::kDeepest / kLeastPeakDepth, coordinate);
}

CloudTexels TexelsOfClouds(const SolvedClouds& clouds) {
  CloudTexels texels;
  texels.fields = clouds.layers;
  for (const CloudLight& light : clouds.light) texels.layer.push_back(LayerTexels(light));
  texels.sun = SunTexels(clouds.light);
  return texels;
}

}  // namespace alpenglow::viewer
