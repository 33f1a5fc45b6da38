// SPDX-License-Identifier: MIT
// A field of clouds: a shape with physics on it.
//
// The shape is the signed depth F under the cloud's surface [m], positive inside. It is stored in
// sparse bricks of 8 x 8 x 8 voxels with one byte (1 m) per corner of a voxel, and trilinear between
// corners. A byte of depth keeps an edge sharp that a byte of density would blur, and a field of
// 20.48 km with voxels of 20 m takes some tens of MB. The extinction follows from depth and altitude:
//
//   sigma(p) = f(F(p)) sigma_c(z)
//   f(F)     = smoothstep(F / w) (a + (1 - a) min(1, F / c)),   0 for F <= 0     (CloudEdge)
//
// where sigma_c is the extinction in the core (CloudColumn, cloud_physics.h) and f is the fraction
// of its water that is left after mixing with the air outside. Mixing removes whole droplets
// (inhomogeneous mixing, Baker and Latham 1979, J. Atmos. Sci. 36, 1612), so the effective radius is
// that of the altitude. Fields of others store extinction and radius per corner instead.
//
// Coordinates: metres in a flat frame, x east, y north, z up from the plane of altitude 0. A
// periodic field repeats along x and y; an open one is empty outside its box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/clouds/cloud_noise.h"
#include "renderer/clouds/cloud_physics.h"
#include "renderer/clouds/periodic_index.h"

namespace alpenglow::renderer {

/// Voxels of a field and their place. The corners of voxels hold the values.
struct CloudLattice {
  std::array<int, 3> voxels{1024, 1024, 96};  // along x, y, z; each in [1, 8192]
  glm::dvec3 voxel_m{20.0};                   // sides of a voxel, > 0
  glm::dvec3 origin_m{0.0};                   // corner of the field with the least coordinates
  bool is_periodic = true;                    // along x and y

  [[nodiscard]] glm::dvec3 size_m() const {
    return voxel_m * glm::dvec3(voxels[0], voxels[1], voxels[2]);
  }
};

/// A shape as a function of place. Safe to use from many threads.
class CloudShape {
 public:
  CloudShape() = default;
  CloudShape(const CloudShape&) = delete;
  CloudShape& operator=(const CloudShape&) = delete;
  virtual ~CloudShape() = default;

  /// Returns the depth under the surface, negative outside [m].
  [[nodiscard]] virtual double SignedDepth_m(const glm::dvec3& point) const = 0;
  /// Returns false only if the depth is below -kCloudMargin_m in the whole box.
  [[nodiscard]] virtual bool MayHoldCloud(const glm::dvec3& low, const glm::dvec3& high) const = 0;
};

/// A brick is stored if the depth exceeds -kCloudMargin_m at a corner in it.
inline constexpr double kCloudMargin_m = 16.0;
/// Depths outside this range are stored as its ends; a place without a brick has the least depth.
inline constexpr double kLeastCloudDepth_m = -96.0, kMostCloudDepth_m = 159.0;

/// The fraction of the core's water at a depth under the surface.
struct CloudEdge {
  double width_m = 16.0;        // w > 0
  double outer_fraction = 0.6;  // a in [0, 1]
  double core_depth_m = 120.0;  // c > 0

  /// Returns f in [0, 1]; it does not decrease with depth.
  [[nodiscard]] double FractionAt(double depth_m) const {
    if (depth_m <= 0.0) return 0.0;
    const double t = depth_m < width_m ? depth_m / width_m : 1.0;
    const double core = depth_m < core_depth_m ? depth_m / core_depth_m : 1.0;
    return t * t * (3.0 - 2.0 * t) * (outer_fraction + (1.0 - outer_fraction) * core);
  }
};

/// Structure below the size of a voxel: noise added to the depth, for views from near by. Its
/// period must divide that of the field.
struct CloudDetail {
  const TilingNoise* noise = nullptr;  // mean 0, outlives the field; null: no detail
  double amplitude_m = 0.0;            // of the noise's standard deviation
  double period_m = 160.0;
};

/// The water or ice that fills a shape.
struct CloudMatter {
  CloudColumn column;
  CloudEdge edge;
  CloudDetail detail;
};

/// Values of a field of others at the corners of voxels, x fastest, z slowest. An open field has
/// one corner more than voxels along each axis; a periodic one along z only.
struct CloudSamples {
  std::vector<float> extinction_per_m;     // finite and not negative
  std::vector<float> effective_radius_um;  // finite and > 0; empty: 10 everywhere
  double single_scattering_albedo = 1.0;   // in [0, 1]
};

/// The part of a ray ahead of a point in which one bound of the extinction holds.
struct CloudSpan {
  double length_m;        // > 0; may be infinite
  double majorant_per_m;  // 0: no cloud
};

/// A box with sides along the axes.
struct CloudBox {
  glm::dvec3 low{0.0}, high{0.0};
};

/// Immutable; safe to use from many threads. Copies share their bricks. Points are within 1e9 m of
/// the origin; directions are unit vectors.
class CloudField {
 public:
  /// Samples a shape at the corners of voxels. The result does not depend on the number of threads.
  /// Throws InputError for a lattice out of range or a period of the detail that does not fit.
  CloudField(const CloudLattice& lattice, const CloudShape& shape, CloudMatter matter);
  /// Stores the samples of a field of others. The depth of a corner with extinction is its distance
  /// from the nearest corner without it; that of a corner without it is the same negative.
  /// Throws InputError that states the error.
  CloudField(const CloudLattice& lattice, const CloudSamples& samples);

  /// Returns the memory in which a field of a shape is made, if every brick has cloud [bytes].
  [[nodiscard]] static double MostBytes(const CloudLattice& lattice);

  [[nodiscard]] const CloudLattice& lattice() const { return lattice_; }
  [[nodiscard]] const CloudMatter& matter() const { return matter_; }
  /// Returns the period along x and y; no value for an open field.
  [[nodiscard]] std::optional<glm::dvec2> period_m() const;
  /// Returns the least altitude of a brick with cloud; the bottom of the lattice if there is none.
  [[nodiscard]] double base_altitude_m() const { return Bounds().low.z; }
  /// Returns the greatest altitude of a brick with cloud.
  [[nodiscard]] double top_altitude_m() const { return Bounds().high.z; }
  /// Returns the box of all bricks with cloud, within one period.
  [[nodiscard]] CloudBox Bounds() const;
  /// Returns the memory of the bricks and their index [bytes].
  [[nodiscard]] std::size_t bytes() const;
  /// Returns a hash of the shape (FNV-1a, 64 bits): equal for fields with equal bytes.
  [[nodiscard]] std::uint64_t hash() const;
  [[nodiscard]] double single_scattering_albedo() const { return albedo_; }
  /// Returns an upper bound of the extinction of the whole field [1/m].
  [[nodiscard]] double largest_extinction_per_m() const { return bricks_->largest_per_m; }

  /// Returns the same field moved by an offset, as wind does. It shares the bricks.
  [[nodiscard]] CloudField Moved(const glm::dvec2& offset_m) const;

  /// Returns the depth under the surface, in [kLeastCloudDepth_m, kMostCloudDepth_m] [m]. Rounding
  /// to bytes moves it by 0.5 m at most. Where it is below -kCloudMargin_m it is not continuous.
  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const;
  /// Returns the extinction of the voxels [1/m].
  [[nodiscard]] double Extinction_per_m(const glm::dvec3& point) const;
  /// Values at one point.
  struct Sample {
    double depth_m, extinction_per_m;
  };
  /// Returns SignedDepth_m() and Extinction_per_m() at a point.
  [[nodiscard]] Sample SampleAt(const glm::dvec3& point) const;
  /// Returns the extinction with the detail below the size of a voxel [1/m].
  [[nodiscard]] double DetailedExtinction_per_m(const glm::dvec3& point) const;
  /// Returns the effective radius of droplets or crystals at a point [um]; > 0 everywhere.
  [[nodiscard]] double EffectiveRadius_um(const glm::dvec3& point) const;

  /// Returns the distance along a ray to the border of the brick around a point, or of the empty
  /// bricks around it, and the bound of both extinctions up to there. The distance exceeds that to
  /// the border by a millionth of a voxel, so that it ends behind the border.
  [[nodiscard]] CloudSpan SpanAhead(const glm::dvec3& point, const glm::dvec3& direction) const;
  /// Returns the bound of both extinctions in the brick at a point [1/m].
  [[nodiscard]] double BrickMajorant_per_m(const glm::dvec3& point) const;
  /// Returns a distance within which no cloud lies in any direction [m]; 0 in a brick with cloud.
  /// It may be infinite.
  [[nodiscard]] double EmptyDistance_m(const glm::dvec3& point) const;

  /// Samples along a straight line: cloud_line.h.
  class Line;
  /// The bricks as they are stored: cloud_bricks.h.
  class StoredBricks;

 private:
  static constexpr int kSide = 8, kCorners = 9, kBrick = kCorners * kCorners * kCorners;
  static constexpr int kCubes = 4;  // along each side of a brick

  /// The stored part of a field, shared by copies.
  struct Bricks {
    std::array<int, 3> count{};
    std::vector<std::int32_t> slot;       // of each brick; -1: empty
    std::vector<std::uint8_t> distance;   // to the nearest brick with cloud, in bricks (Chebyshev)
    std::vector<std::uint8_t> depth;      // kBrick per slot
    std::vector<float> majorant_per_m;    // per slot
    std::vector<float> extinction_per_m;  // kBrick per slot; empty for shapes
    std::vector<float> radius_um;         // kBrick per slot; empty for shapes
    CloudBox bounds;                      // relative to the origin of the lattice
    double largest_per_m = 0.0;
    std::vector<std::uint64_t>
        filled;  // per slot: a bit for each cube of 2 x 2 x 2 voxels with cloud
  };
  /// Values at the corners of one brick.
  struct BrickValues {
    std::array<std::uint8_t, kBrick> depth;
    std::vector<float> extinction_per_m, radius_um;
    double majorant_per_m;
  };
  /// Returns the cubes of a brick that have a corner with cloud, by bits, x fastest.
  [[nodiscard]] static std::uint64_t FilledCubes(const BrickValues& values);
  /// Returns the values of a brick, given by its numbers along x, y and z; nothing if it is empty.
  using BrickSource = std::function<std::optional<BrickValues>(const std::array<int, 3>&)>;
  [[nodiscard]] static std::shared_ptr<const Bricks> Collected(const CloudLattice& lattice,
                                                               const BrickSource& source);
  [[nodiscard]] std::optional<BrickValues> ShapeBrick(const CloudShape& shape,
                                                      const std::array<int, 3>& brick) const;

  /// A voxel with a brick, and the place of a point in it.
  struct Place {
    std::size_t corner;  // index of its corner with the least coordinates
    float x, y, z;       // in [0, 1)
  };
  /// A point of one period as voxel and share; is_inside is false outside of the lattice.
  struct Cell {
    std::array<int, 3> voxel;
    glm::dvec3 share;
    bool is_inside;
  };

  [[nodiscard]] Cell CellOf(const glm::dvec3& point) const {
    return CellIn((point - lattice_.origin_m) * per_voxel_);
  }
  /// @param at  a point in voxels from the corner of the lattice.
  [[nodiscard]] Cell CellIn(const glm::dvec3& at) const;
  [[nodiscard]] std::size_t BrickOf(const Cell& cell) const;
  [[nodiscard]] std::optional<Place> Find(const glm::dvec3& point) const;
  /// @param corner  value at the corner of a voxel with the least coordinates, in its brick.
  template <typename Value>
  [[nodiscard]] static float Mixed(const Value* corner, float x, float y, float z);
  template <typename Value>
  [[nodiscard]] static float Mixed(const std::vector<Value>& values, const Place& place) {
    return Mixed(values.data() + place.corner, place.x, place.y, place.z);
  }
  [[nodiscard]] double DepthAt(const Place& place) const;
  [[nodiscard]] double ExtinctionAt(const Place& place, double depth_m, double z) const;
  [[nodiscard]] double MajorantOf(std::int32_t slot) const;
  [[nodiscard]] double DetailAt(const glm::dvec3& point) const;
  /// Returns the brick of a cell, or the empty bricks around it, relative to the cell's point.
  [[nodiscard]] CloudBox BlockAround(const Cell& cell) const;
  /// The first voxel of a block along an axis, and the one behind its last.
  struct BlockEnds {
    int first, end;
  };
  /// Returns the ends of the brick of a cell, or of the empty bricks around it.
  [[nodiscard]] BlockEnds EndsOf(const Cell& cell, int distance, std::size_t axis) const {
    const bool has_short_brick =
        lattice_.is_periodic && axis < 2 && lattice_.voxels[axis] % kSide != 0;
    // A block that reaches the short brick at the end of a period is shorter by less than a brick.
    const int around = kSide * std::max(distance - (has_short_brick ? 2 : 1), 0);
    const int first = cell.voxel[axis] / kSide * kSide;
    return {first - around, std::min(first + kSide, lattice_.voxels[axis]) + around};
  }
  /// Returns the length of a line from a point in a cell until slightly behind the border of this block.
  /// @param m_per_voxel  of the line, along each axis.
  [[nodiscard]] double LengthIn_m(const Cell& cell, int distance,
                                  const glm::dvec3& m_per_voxel) const {
    double exit_m = kEndless_m;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int a = static_cast<int>(axis);
      // A line that begins at a border and leaves it this slowly would take millions of blocks.
      if (!(std::abs(m_per_voxel[a]) < kSlowest * lattice_.voxel_m[a])) continue;
      const BlockEnds ends = EndsOf(cell, distance, axis);
      const int border = m_per_voxel[a] > 0.0 ? ends.end : ends.first;
      exit_m = std::min(exit_m, (border - cell.voxel[axis] - cell.share[a]) * m_per_voxel[a]);
    }
    return std::max(exit_m, 0.0) + behind_border_m();
  }
  /// Returns the distance by which spans end behind a border.
  [[nodiscard]] double behind_border_m() const {
    const glm::dvec3& voxel_m = lattice_.voxel_m;
    return 1e-6 * std::min({voxel_m.x, voxel_m.y, voxel_m.z});
  }
  static constexpr double kEndless_m = std::numeric_limits<double>::infinity();
  // Lines with more than this many metres of length per metre along an axis count as parallel to its
  // borders: over 100 km they move by a thousandth of a millimetre.
  static constexpr double kSlowest = 1e11;

  CloudLattice lattice_;
  glm::dvec3 per_voxel_;
  CloudMatter matter_;
  double albedo_ = 1.0;
  std::shared_ptr<const Bricks> bricks_;
};

// The queries are defined here because paths through clouds call them many times per scattering.

inline CloudField::Cell CloudField::CellIn(const glm::dvec3& at) const {
  Cell cell{{}, at, true};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    // A conversion and a comparison are used, because without SSE4 floor is a function call.
    const auto truncated = static_cast<std::int32_t>(at[axis]);
    const std::int32_t voxel = truncated - (at[axis] < truncated ? 1 : 0);
    cell.share[axis] = at[axis] - voxel;
    cell.voxel[a] = voxel;
    if (voxel >= 0 && voxel < lattice_.voxels[a]) continue;
    cell.is_inside = cell.is_inside && lattice_.is_periodic && axis < 2;
    cell.voxel[a] = PeriodicIndex(voxel, lattice_.voxels[a]);
  }
  return cell;
}

inline std::size_t CloudField::BrickOf(const Cell& cell) const {
  const auto brick = [&](std::size_t axis) {
    return static_cast<std::size_t>(cell.voxel[axis] / kSide);
  };
  const auto count = [&](std::size_t axis) {
    return static_cast<std::size_t>(bricks_->count[axis]);
  };
  return (brick(2) * count(1) + brick(1)) * count(0) + brick(0);
}

inline std::optional<CloudField::Place> CloudField::Find(const glm::dvec3& point) const {
  const Cell cell = CellOf(point);
  if (!cell.is_inside) return std::nullopt;
  const std::int32_t slot = bricks_->slot[BrickOf(cell)];
  if (slot < 0) return std::nullopt;
  const int corner = ((cell.voxel[2] % kSide) * kCorners + cell.voxel[1] % kSide) * kCorners +
                     cell.voxel[0] % kSide;
  return Place{static_cast<std::size_t>(slot) * kBrick + static_cast<std::size_t>(corner),
               static_cast<float>(cell.share.x), static_cast<float>(cell.share.y),
               static_cast<float>(cell.share.z)};
}

template <typename Value>
inline float CloudField::Mixed(const Value* corner, float x, float y, float z) {
  const auto along_x = [&](int offset) {
    const auto west = static_cast<float>(corner[offset]);
    return west + x * (static_cast<float>(corner[offset + 1]) - west);
  };
  const auto along_xy = [&](int offset) {
    const float south = along_x(offset);
    return south + y * (along_x(offset + kCorners) - south);
  };
  const float below = along_xy(0);
  return below + z * (along_xy(kCorners * kCorners) - below);
}

inline double CloudField::DepthAt(const Place& place) const {
  return static_cast<double>(Mixed(bricks_->depth, place)) + kLeastCloudDepth_m;
}

inline double CloudField::SignedDepth_m(const glm::dvec3& point) const {
  const std::optional<Place> place = Find(point);
  return place ? DepthAt(*place) : kLeastCloudDepth_m;
}

inline double CloudField::ExtinctionAt(const Place& place, double depth_m, double z) const {
  if (!bricks_->extinction_per_m.empty()) {
    return static_cast<double>(Mixed(bricks_->extinction_per_m, place));
  }
  if (depth_m <= 0.0) return 0.0;
  return matter_.edge.FractionAt(depth_m) * matter_.column.Extinction_per_m(z);
}

inline double CloudField::Extinction_per_m(const glm::dvec3& point) const {
  const std::optional<Place> place = Find(point);
  return place ? ExtinctionAt(*place, DepthAt(*place), point.z) : 0.0;
}

inline CloudField::Sample CloudField::SampleAt(const glm::dvec3& point) const {
  const std::optional<Place> place = Find(point);
  if (!place) return {kLeastCloudDepth_m, 0.0};
  const double depth_m = DepthAt(*place);
  return {depth_m, ExtinctionAt(*place, depth_m, point.z)};
}

}  // namespace alpenglow::renderer
