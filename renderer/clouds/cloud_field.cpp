// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_field.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void CheckLattice(const CloudLattice& lattice) {
  for (int axis = 0; axis < 3; ++axis) {
    const int voxels = lattice.voxels[static_cast<std::size_t>(axis)];
    if (voxels < 1 || voxels > 8192) {
      throw InputError(fmt::format(
          "a field of clouds with {} voxels along an axis; it must have 1 to 8192", voxels));
    }
    RequireInRange(lattice.voxel_m[axis], 1e-3, 1e5, "the side of a voxel [m]");
    RequireInRange(lattice.origin_m[axis], -1e8, 1e8, "the origin of a field of clouds [m]");
  }
}

void CheckDetail(const CloudLattice& lattice, const CloudDetail& detail) {
  if (!detail.noise) return;
  RequireInRange(detail.amplitude_m, 0.0, 50.0, "the amplitude of a cloud's detail [m]");
  RequireInRange(detail.period_m, 1.0, 1e5, "the period of a cloud's detail [m]");
  if (!lattice.is_periodic) return;
  for (int axis = 0; axis < 2; ++axis) {
    const double periods = lattice.size_m()[axis] / detail.period_m;
    if (std::abs(periods - std::round(periods)) > 1e-9 * periods) {
      throw InputError(
          fmt::format("the detail of a cloud repeats after {} m, which does not divide "
                      "the field's {} m",
                      detail.period_m, lattice.size_m()[axis]));
    }
  }
}

std::uint8_t ByteOfDepth(double depth_m) {
  return static_cast<std::uint8_t>(std::clamp(depth_m, kLeastCloudDepth_m, kMostCloudDepth_m) -
                                   kLeastCloudDepth_m + 0.5);
}

/// Returns the greatest value of the noise, from its texels.
double LargestDetail(const CloudDetail& detail) {
  return detail.noise ? detail.amplitude_m * detail.noise->Largest() : 0.0;
}

/// The interval of altitudes, or of x or y, that a lattice covers; all x and y if it is periodic.
struct AxisExtent {
  double low, high;
};
AxisExtent AxisExtentOf(const CloudLattice& lattice, int axis) {
  if (lattice.is_periodic && axis < 2) return {-kInfinite, kInfinite};
  return {lattice.origin_m[axis], lattice.origin_m[axis] + lattice.size_m()[axis]};
}

/// Returns the length of a ray from outside of the lattice until its border; infinite if it misses.
double DistanceToLattice(const CloudLattice& lattice, const glm::dvec3& point,
                         const glm::dvec3& direction) {
  double enter = 0.0, exit = kInfinite;
  for (int axis = 0; axis < 3; ++axis) {
    const AxisExtent extent = AxisExtentOf(lattice, axis);
    if (direction[axis] == 0.0) {
      if (point[axis] < extent.low || point[axis] >= extent.high) return kInfinite;
      continue;
    }
    const double a = (extent.low - point[axis]) / direction[axis];
    const double b = (extent.high - point[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return enter < exit ? enter : kInfinite;
}

/// Returns the distance of a point outside of the lattice from it.
double OutsideDistance(const CloudLattice& lattice, const glm::dvec3& point) {
  glm::dvec3 away(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const AxisExtent extent = AxisExtentOf(lattice, axis);
    away[axis] = std::max({extent.low - point[axis], point[axis] - extent.high, 0.0});
  }
  return glm::length(away);
}

/// Replaces distances along one axis by the Chebyshev distance over this axis and those before.
class DistanceSweep {
 public:
  DistanceSweep(const std::array<int, 3>& count, bool is_periodic)
      : count_(count), is_periodic_(is_periodic) {}

  void Along(std::size_t axis, std::vector<std::uint8_t>& distance) const {
    std::size_t stride = 1;
    for (std::size_t a = 0; a < axis; ++a) stride *= static_cast<std::size_t>(count_[a]);
    const auto length = static_cast<std::size_t>(count_[axis]);
    std::vector<std::uint8_t> line(length);
    for (std::size_t first = 0; first < distance.size(); ++first) {
      if (first / stride % length != 0) continue;
      for (std::size_t i = 0; i < length; ++i) line[i] = distance[first + i * stride];
      for (std::size_t i = 0; i < length; ++i) {
        distance[first + i * stride] = Least(line, static_cast<int>(i), axis);
      }
    }
  }

 private:
  /// Returns the least of max(|i - j|, line[j]) over all j.
  [[nodiscard]] std::uint8_t Least(const std::vector<std::uint8_t>& line, int i,
                                   std::size_t axis) const {
    const int length = count_[axis];
    const bool wraps = is_periodic_ && axis < 2;
    int least = line[static_cast<std::size_t>(i)];
    for (int away = 1; away < std::min(least, length); ++away) {
      for (int j : {i - away, i + away}) {
        if (wraps) j = PeriodicIndex(j, length);
        if (j < 0 || j >= length) continue;
        least =
            std::min(least, std::max(away, static_cast<int>(line[static_cast<std::size_t>(j)])));
      }
    }
    return static_cast<std::uint8_t>(least);
  }

  std::array<int, 3> count_;
  bool is_periodic_;
};

/// Distances to the nearest of some places, axis by axis: the square of a distance is the sum of the
/// squares along the axes (Saito and Toriwaki 1994, Pattern Recognition 27, 1551).
class DistanceGrid {
 public:
  /// @param count  places along x, y, z. @param wraps  whether x and y repeat.
  DistanceGrid(const std::array<int, 3>& count, const glm::dvec3& spacing, bool wraps)
      : count_(count), spacing_(spacing), wraps_(wraps) {}

  /// Returns the distance of every place to the nearest one with `is_target`; at most kFar_m.
  [[nodiscard]] std::vector<float> To(const std::vector<char>& is_target) const {
    std::vector<float> square(is_target.size());
    for (std::size_t i = 0; i < square.size(); ++i)
      square[i] = is_target[i] ? 0.0F : kFar_m * kFar_m;
    std::size_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t first = 0; first < square.size(); ++first) {
        if (first / stride % static_cast<std::size_t>(count_[axis]) == 0) {
          AlongLine(square, first, stride, axis);
        }
      }
      stride *= static_cast<std::size_t>(count_[axis]);
    }
    for (float& value : square) value = std::sqrt(value);
    return square;
  }

 private:
  static constexpr float kFar_m = 400.0F;  // beyond all stored depths

  /// Replaces each value of a line by the least sum of a value and the square of its distance.
  void AlongLine(std::vector<float>& square, std::size_t first, std::size_t stride,
                 std::size_t axis) const {
    const int length = count_[axis];
    const double step = spacing_[static_cast<int>(axis)];
    const int reach = std::min(length - 1, static_cast<int>(static_cast<double>(kFar_m) / step));
    std::vector<float> line(static_cast<std::size_t>(length));
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = square[first + i * stride];
    for (int i = 0; i < length; ++i) {
      float least = line[static_cast<std::size_t>(i)];
      for (int away = 1; away <= reach; ++away) {
        const auto distance = static_cast<float>(away * step * (away * step));
        if (distance >= least) break;
        for (int j : {i - away, i + away}) {
          if (wraps_ && axis < 2) j = PeriodicIndex(j, length);
          if (j < 0 || j >= length) continue;
          least = std::min(least, line[static_cast<std::size_t>(j)] + distance);
        }
      }
      square[first + static_cast<std::size_t>(i) * stride] = least;
    }
  }

  std::array<int, 3> count_;
  glm::dvec3 spacing_;
  bool wraps_;
};

void CheckSamples(const std::vector<float>& values, std::size_t corners, std::string_view name,
                  bool must_be_positive) {
  if (values.size() != corners) {
    throw InputError(
        fmt::format("{} values of {}; the lattice has {} corners", values.size(), name, corners));
  }
  for (std::size_t i = 0; i < corners; ++i) {
    const bool is_valid = must_be_positive ? values[i] > 0.0F : values[i] >= 0.0F;
    if (!is_valid || !std::isfinite(values[i])) {
      throw InputError(fmt::format("value {} of the {} is {}; it must be finite and {}", i, name,
                                   values[i], must_be_positive ? "positive" : "not negative"));
    }
  }
}

/// The samples of a field of others by corner, with their depths.
class SampleGrid {
 public:
  SampleGrid(const CloudLattice& lattice, const CloudSamples& samples)
      : lattice_(lattice), samples_(samples) {
    const int beyond = lattice.is_periodic ? 0 : 1;
    count_ = {lattice.voxels[0] + beyond, lattice.voxels[1] + beyond, lattice.voxels[2] + 1};
    std::size_t corners = 1;
    for (const int count : count_) corners *= static_cast<std::size_t>(count);
    CheckSamples(samples.extinction_per_m, corners, "extinction", false);
    if (!samples.effective_radius_um.empty()) {
      CheckSamples(samples.effective_radius_um, corners, "effective radius", true);
    }
    RequireInRange(samples.single_scattering_albedo, 0.0, 1.0, "the single-scattering albedo");
    std::vector<char> is_cloud(corners), is_clear(corners);
    for (std::size_t i = 0; i < corners; ++i) {
      is_cloud[i] = samples.extinction_per_m[i] > 0.0F ? 1 : 0;
      is_clear[i] = is_cloud[i] != 0 ? 0 : 1;
    }
    const DistanceGrid distances(count_, lattice.voxel_m, lattice.is_periodic);
    to_cloud_ = distances.To(is_cloud);
    to_clear_ = distances.To(is_clear);
  }

  /// Returns the sample of a corner; corners beyond the end of an open field are those of its end.
  [[nodiscard]] std::size_t Index(int x, int y, int z) const {
    const auto number = [&](int at, std::size_t axis) {
      const bool wraps = lattice_.is_periodic && axis < 2;
      return static_cast<std::size_t>(wraps ? at % count_[axis] : std::min(at, count_[axis] - 1));
    };
    return (number(z, 2) * static_cast<std::size_t>(count_[1]) + number(y, 1)) *
               static_cast<std::size_t>(count_[0]) +
           number(x, 0);
  }
  [[nodiscard]] double depth_m(std::size_t sample) const {
    return static_cast<double>(to_clear_[sample]) - static_cast<double>(to_cloud_[sample]);
  }
  [[nodiscard]] float radius_um(std::size_t sample) const {
    return samples_.effective_radius_um.empty() ? 10.0F : samples_.effective_radius_um[sample];
  }

 private:
  const CloudLattice& lattice_;
  const CloudSamples& samples_;
  std::array<int, 3> count_{};
  std::vector<float> to_cloud_, to_clear_;
};

}  // namespace

std::uint64_t CloudField::FilledCubes(const BrickValues& values) {
  const auto has_cloud = [&](int x, int y, int z) {
    const auto corner = static_cast<std::size_t>((z * kCorners + y) * kCorners + x);
    return values.extinction_per_m.empty() ? values.depth[corner] > -kLeastCloudDepth_m
                                           : values.extinction_per_m[corner] > 0.0F;
  };
  constexpr int kVoxels = kSide / kCubes;
  std::uint64_t filled = 0;
  for (int cube = 0; cube < kCubes * kCubes * kCubes; ++cube) {
    const int x = cube % kCubes, y = cube / kCubes % kCubes, z = cube / (kCubes * kCubes);
    bool is_filled = false;
    for (int k = 0; k <= kVoxels; ++k) {
      for (int j = 0; j <= kVoxels; ++j) {
        for (int i = 0; i <= kVoxels; ++i) {
          is_filled = is_filled || has_cloud(kVoxels * x + i, kVoxels * y + j, kVoxels * z + k);
        }
      }
    }
    if (is_filled) filled |= std::uint64_t{1} << static_cast<unsigned>(cube);
  }
  return filled;
}

std::shared_ptr<const CloudField::Bricks> CloudField::Collected(const CloudLattice& lattice,
                                                                const BrickSource& source) {
  auto bricks = std::make_shared<Bricks>();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bricks->count[axis] = (lattice.voxels[axis] + kSide - 1) / kSide;
  }
  const auto [nx, ny, nz] = bricks->count;
  std::vector<std::vector<std::pair<int, BrickValues>>> rows(static_cast<std::size_t>(ny * nz));
  tbb::parallel_for(0, ny * nz, [&, nx = nx, ny = ny](int row) {
    for (int x = 0; x < nx; ++x) {
      if (auto values = source({x, row % ny, row / ny})) {
        rows[static_cast<std::size_t>(row)].emplace_back(x, std::move(*values));
      }
    }
  });
  bricks->slot.assign(static_cast<std::size_t>(nx * ny * nz), -1);
  bricks->distance.assign(bricks->slot.size(), 255);
  glm::dvec3 low(kInfinite), high(-kInfinite);
  for (int row = 0; row < ny * nz; ++row) {
    for (const auto& [x, values] : rows[static_cast<std::size_t>(row)]) {
      const auto brick = static_cast<std::size_t>(row * nx + x);
      bricks->slot[brick] = static_cast<std::int32_t>(bricks->majorant_per_m.size());
      bricks->distance[brick] = 0;
      bricks->depth.insert(bricks->depth.end(), values.depth.begin(), values.depth.end());
      bricks->extinction_per_m.insert(bricks->extinction_per_m.end(),
                                      values.extinction_per_m.begin(),
                                      values.extinction_per_m.end());
      bricks->radius_um.insert(bricks->radius_um.end(), values.radius_um.begin(),
                               values.radius_um.end());
      bricks->filled.push_back(FilledCubes(values));
      bricks->majorant_per_m.push_back(static_cast<float>(values.majorant_per_m * (1.0 + 1e-6)));
      bricks->largest_per_m = std::max(bricks->largest_per_m, values.majorant_per_m);
      const glm::dvec3 corner(x, row % ny, row / ny);
      low = glm::min(low, corner);
      high = glm::max(high, corner + 1.0);
    }
    rows[static_cast<std::size_t>(row)].clear();
  }
  const DistanceSweep sweep(bricks->count, lattice.is_periodic);
  for (std::size_t axis = 0; axis < 3; ++axis) sweep.Along(axis, bricks->distance);
  if (!bricks->majorant_per_m.empty()) {
    bricks->bounds = {double{kSide} * low * lattice.voxel_m,
                      glm::min(double{kSide} * high * lattice.voxel_m, lattice.size_m())};
  }
  return bricks;
}

std::optional<CloudField::BrickValues> CloudField::ShapeBrick(
    const CloudShape& shape, const std::array<int, 3>& brick) const {
  const glm::dvec3 first = double{kSide} * glm::dvec3(brick[0], brick[1], brick[2]);
  const auto corner_at = [&](int x, int y, int z) {
    return lattice_.origin_m + (first + glm::dvec3(x, y, z)) * lattice_.voxel_m;
  };
  if (!shape.MayHoldCloud(corner_at(0, 0, 0), corner_at(kSide, kSide, kSide))) return std::nullopt;
  BrickValues values{};
  std::array<double, kCorners> deepest;  // of each layer of corners
  deepest.fill(kLeastCloudDepth_m);
  std::size_t at = 0;
  for (int z = 0; z < kCorners; ++z) {
    for (int y = 0; y < kCorners; ++y) {
      for (int x = 0; x < kCorners; ++x) {
        values.depth[at] = ByteOfDepth(shape.SignedDepth_m(corner_at(x, y, z)));
        const double depth_m = values.depth[at++] + kLeastCloudDepth_m;
        deepest[static_cast<std::size_t>(z)] =
            std::max(deepest[static_cast<std::size_t>(z)], depth_m);
      }
    }
  }
  if (*std::max_element(deepest.begin(), deepest.end()) <= -kCloudMargin_m) return std::nullopt;
  for (int z = 0; z < kSide; ++z) {
    const auto layer = static_cast<std::size_t>(z);
    const double depth_m =
        std::max(deepest[layer], deepest[layer + 1]) + LargestDetail(matter_.detail);
    values.majorant_per_m = std::max(
        values.majorant_per_m,
        matter_.edge.FractionAt(depth_m) *
            matter_.column.LargestBetween_per_m(corner_at(0, 0, z).z, corner_at(0, 0, z + 1).z));
  }
  return values;
}

CloudField::CloudField(const CloudLattice& lattice, const CloudShape& shape, CloudMatter matter)
    : lattice_(lattice), per_voxel_(1.0 / lattice.voxel_m), matter_(std::move(matter)) {
  CheckLattice(lattice_);
  CheckDetail(lattice_, matter_.detail);
  bricks_ = Collected(lattice_,
                      [&](const std::array<int, 3>& brick) { return ShapeBrick(shape, brick); });
}

CloudField::CloudField(const CloudLattice& lattice, const CloudSamples& samples)
    : lattice_(lattice),
      per_voxel_(1.0 / lattice.voxel_m),
      albedo_(samples.single_scattering_albedo) {
  CheckLattice(lattice_);
  const SampleGrid grid(lattice_, samples);
  bricks_ = Collected(lattice_, [&](const std::array<int, 3>& brick) -> std::optional<BrickValues> {
    BrickValues values{};
    std::size_t at = 0;
    for (int z = 0; z < kCorners; ++z) {
      for (int y = 0; y < kCorners; ++y) {
        for (int x = 0; x < kCorners; ++x) {
          const std::size_t sample =
              grid.Index(kSide * brick[0] + x, kSide * brick[1] + y, kSide * brick[2] + z);
          values.depth[at++] = ByteOfDepth(grid.depth_m(sample));
          values.extinction_per_m.push_back(samples.extinction_per_m[sample]);
          values.radius_um.push_back(grid.radius_um(sample));
        }
      }
    }
    values.majorant_per_m = static_cast<double>(
        *std::max_element(values.extinction_per_m.begin(), values.extinction_per_m.end()));
    if (values.majorant_per_m == 0.0) return std::nullopt;
    return values;
  });
}

double CloudField::MostBytes(const CloudLattice& lattice) {
  double bricks = 1.0;
  for (const int voxels : lattice.voxels) bricks *= (voxels + kSide - 1) / kSide;
  constexpr std::size_t kIndexed = sizeof(std::int32_t) + 1 + sizeof(float) + sizeof(std::uint64_t);
  return bricks * static_cast<double>(kBrick + kIndexed + sizeof(std::pair<int, BrickValues>));
}

std::optional<glm::dvec2> CloudField::period_m() const {
  if (!lattice_.is_periodic) return std::nullopt;
  return glm::dvec2(lattice_.size_m());
}

CloudBox CloudField::Bounds() const {
  return {lattice_.origin_m + bricks_->bounds.low, lattice_.origin_m + bricks_->bounds.high};
}

std::size_t CloudField::bytes() const {
  return bricks_->slot.size() * sizeof(std::int32_t) + bricks_->distance.size() +
         bricks_->depth.size() +
         bricks_->majorant_per_m.size() * (sizeof(float) + sizeof(std::uint64_t)) +
         (bricks_->extinction_per_m.size() + bricks_->radius_um.size()) * sizeof(float);
}

std::uint64_t CloudField::hash() const {
  Fnv1a hash;
  for (const std::int32_t slot : bricks_->slot) hash.Add(static_cast<std::uint64_t>(slot + 1));
  hash.AddBytes({reinterpret_cast<const char*>(bricks_->depth.data()), bricks_->depth.size()});
  return hash.hash();
}

CloudField CloudField::Moved(const glm::dvec2& offset_m) const {
  CloudField moved = *this;
  moved.lattice_.origin_m += glm::dvec3(offset_m, 0.0);
  return moved;
}

double CloudField::DetailAt(const glm::dvec3& point) const {
  return matter_.detail.amplitude_m *
         matter_.detail.noise->At((point - lattice_.origin_m) / matter_.detail.period_m);
}

double CloudField::DetailedExtinction_per_m(const glm::dvec3& point) const {
  if (!matter_.detail.noise) return Extinction_per_m(point);
  const std::optional<Place> place = Find(point);
  if (!place) return 0.0;
  // The detail changes the extinction only where the fraction is not constant.
  const double depth_m = DepthAt(*place);
  if (depth_m + LargestDetail(matter_.detail) <= 0.0) return 0.0;
  return matter_.edge.FractionAt(depth_m + DetailAt(point)) *
         matter_.column.Extinction_per_m(point.z);
}

double CloudField::EffectiveRadius_um(const glm::dvec3& point) const {
  if (!bricks_->radius_um.empty()) {
    const std::optional<Place> place = Find(point);
    if (place) return static_cast<double>(Mixed(bricks_->radius_um, *place));
  }
  return matter_.column.EffectiveRadius_um(point.z);
}

CloudBox CloudField::BlockAround(const Cell& cell) const {
  const int distance = bricks_->distance[BrickOf(cell)];
  CloudBox block;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const BlockEnds ends = EndsOf(cell, distance, axis);
    const double at = cell.voxel[axis] + cell.share[a];
    block.low[a] = (ends.first - at) * lattice_.voxel_m[a];
    block.high[a] = (ends.end - at) * lattice_.voxel_m[a];
  }
  return block;
}

CloudSpan CloudField::SpanAhead(const glm::dvec3& point, const glm::dvec3& direction) const {
  const Cell cell = CellOf(point);
  if (!cell.is_inside) {
    return {DistanceToLattice(lattice_, point, direction) + behind_border_m(), 0.0};
  }
  const std::size_t brick = BrickOf(cell);
  return {LengthIn_m(cell, bricks_->distance[brick], lattice_.voxel_m / direction),
          MajorantOf(bricks_->slot[brick])};
}

double CloudField::MajorantOf(std::int32_t slot) const {
  return slot < 0 ? 0.0
                  : static_cast<double>(bricks_->majorant_per_m[static_cast<std::size_t>(slot)]);
}

double CloudField::BrickMajorant_per_m(const glm::dvec3& point) const {
  const Cell cell = CellOf(point);
  return cell.is_inside ? MajorantOf(bricks_->slot[BrickOf(cell)]) : 0.0;
}

double CloudField::EmptyDistance_m(const glm::dvec3& point) const {
  const Cell cell = CellOf(point);
  if (!cell.is_inside) return OutsideDistance(lattice_, point);
  if (bricks_->slot[BrickOf(cell)] >= 0) return 0.0;
  const CloudBox block = BlockAround(cell);
  double least = kInfinite;
  for (int axis = 0; axis < 3; ++axis) {
    least = std::min({least, -block.low[axis], block.high[axis]});
  }
  return std::max(least, 0.0);
}

}  // namespace alpenglow::renderer
