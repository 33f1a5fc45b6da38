// SPDX-License-Identifier: MIT
// Samples of a field of clouds along a straight line.
//
// A line keeps the brick of its last point, or the empty bricks around it, so that most samples need
// no search. Samples are those of CloudField::SampleAt() up to the rounding of coordinates. In a brick
// a line passes cubes of 2 x 2 x 2 voxels without cloud by their borders (Amanatides and Woo 1987,
// Eurographics 87, 3).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// It refers to the field, which must outlive it. For one thread.
class CloudField::Line {
 public:
  /// @param direction  unit vector.
  Line(const CloudField& field, const glm::dvec3& origin, const glm::dvec3& direction)
      : field_(&field),
        origin_(origin),
        direction_(direction),
        voxel_((origin - field.lattice_.origin_m) * field.per_voxel_),
        per_m_(direction * field.per_voxel_),
        m_per_voxel_(field.lattice_.voxel_m / direction) {}

  /// Returns SampleAt() the point at a distance, and goes there.
  /// @param distance_m  >= 0; not below that of the sample before.
  [[nodiscard]] Sample At(double distance_m) {
    GoTo(distance_m);
    if (depth_ == nullptr) return {kLeastCloudDepth_m, 0.0};
    const Place place = InBrick();
    const double depth_m =
        static_cast<double>(Mixed(depth_ + place.corner, place.x, place.y, place.z)) +
        kLeastCloudDepth_m;
    return {depth_m, Extinction_per_m(place, depth_m)};
  }
  /// Returns a distance from a point within which the line meets no cloud: to a cube with cloud, or to
  /// the border of the brick or of the empty bricks around the point. It may be infinite, and it is 0
  /// in a cube with cloud. @param distance_m  of the point, as for At().
  [[nodiscard]] double ClearAhead_m(double distance_m);

 private:
  void GoTo(double distance_m) {
    at_m_ = distance_m;
    if (distance_m >= block_until_m_) FindBlock();
  }
  /// Takes the brick at the point, or the empty bricks around it.
  void FindBlock();
  /// Returns the place of the point in the brick. Lines end slightly behind its border.
  [[nodiscard]] Place InBrick() const {
    const glm::dvec3 inside = voxel_ + at_m_ * per_m_ - low_;
    const auto voxel = [&](int axis) {
      return std::min(static_cast<int>(inside[axis]), kSide - 1);
    };
    const int x = voxel(0), y = voxel(1), z = voxel(2);
    return {static_cast<std::size_t>((z * kCorners + y) * kCorners + x),
            static_cast<float>(inside.x - x), static_cast<float>(inside.y - y),
            static_cast<float>(inside.z - z)};
  }
  [[nodiscard]] double Extinction_per_m(const Place& place, double depth_m) const {
    if (extinction_per_m_ != nullptr) {
      return static_cast<double>(
          Mixed(extinction_per_m_ + place.corner, place.x, place.y, place.z));
    }
    if (depth_m <= 0.0) return 0.0;
    return field_->matter_.edge.FractionAt(depth_m) *
           field_->matter_.column.Extinction_per_m(origin_.z + at_m_ * direction_.z);
  }

  const CloudField* field_;
  glm::dvec3 origin_, direction_;
  glm::dvec3 voxel_, per_m_, m_per_voxel_;   // of the line in voxels
  double at_m_ = 0.0;                        // of the last point
  double block_until_m_ = -1.0;              // end of the brick or the empty bricks
  glm::dvec3 low_{0.0};                      // corner of the brick [voxels]
  const std::uint8_t* depth_ = nullptr;      // at the corners of the brick; null without cloud
  const float* extinction_per_m_ = nullptr;  // likewise; null for shapes
  std::uint64_t filled_ = 0;                 // cubes of the brick with cloud
};

}  // namespace alpenglow::renderer
