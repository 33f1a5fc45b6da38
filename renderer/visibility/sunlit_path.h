// SPDX-License-Identifier: MIT
// The sunlit parts of a ray, with penumbrae at their ends; and SunProbes, which finds them for any
// mesh.
//
// SunProbes handles meshes with overhangs, bridges and buildings, under which ShadowHeights would
// find only shade. Occlusion rays towards the middle of the sun's disk find the lit stretches.
// Where two neighbouring probes differ, bisection finds the edge, and then the place where the last
// beam of the disk becomes visible. The distance between both gives the slope at which the edge
// crosses the disk.
//
// Features thinner than the distance of two probes, and their shadows, can be missed.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// Returns the fraction of sunlight that passes a straight edge across the sun's disk, in [0, 1].
/// @param x  height of the disk's centre over the edge in radii of the disk: all of the light
///     passes for 1 and more, none for -1 and less.
/// Integral of LimbDarkening(rho) (sun.h) over the circular segment: disk_light.glsl.
/// The law of a single wavelength from 440 to 680 nm is within 0.01.
[[nodiscard]] double SunlightOverEdge(double x);

/// A sunlit stretch of a ray. The height of the disk's centre over the edge that cuts it, in radii
/// of the disk, is linear from begin_x to end_x; both are 1 in full light.
struct SunlitPiece {
  double begin_m, end_m;
  double begin_x = 1.0, end_x = 1.0;

  [[nodiscard]] double length_m() const { return end_m - begin_m; }
  bool operator==(const SunlitPiece&) const = default;
};

/// Pieces in order, without overlap. Gaps between them are dark.
using SunlitPath = std::vector<SunlitPiece>;

/// Returns the sunlight at a distance along the ray, in [0, 1].
[[nodiscard]] double SunlightAt(const SunlitPath& path, double distance_m);

/// Joins small pieces, given in order, into long ones: pieces in full light, and pieces in penumbra
/// as long as no joint moves by more than kTolerance radii of the disk (Bristol 1990, swinging
/// doors).
class SunlitPathBuilder {
 public:
  static constexpr double kTolerance = 0.02;

  /// Clamps x to [-1, 1]; pieces that are dark at both ends only end the previous piece.
  void Add(const SunlitPiece& piece);
  [[nodiscard]] SunlitPath Take();

 private:
  void Extend(const SunlitPiece& piece);
  void Close();

  SunlitPath path_;
  std::optional<SunlitPiece> open_;
  double least_slope_ = 0.0, most_slope_ = 0.0;  // slopes of lines that pass within the tolerance
                                                 // of all joints of open_
};

/// Immutable; safe to use from many threads. Refers to the terrain.
class SunProbes {
 public:
  /// @param to_light  unit vector in the frame of the terrain, z up.
  /// @param probes  number along the stretch of a ray that terrain can shade, at least 2.
  SunProbes(const Terrain& terrain, const glm::dvec3& to_light, double radius_rad, int probes = 32);

  /// Returns the sunlit stretches of a ray within [0, length_m]; length_m is finite.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;
  /// Returns the sunlight that terrain lets through to a point, in [0, 1], by rays to the bottom, the
  /// middle and the top of the disk: within a quarter in a penumbra.
  [[nodiscard]] double SunlightAt(const glm::dvec3& point) const;

 private:
  struct Stretch {
    double begin_m, end_m;
  };
  [[nodiscard]] Stretch WithinTheShadowOfTheBox(const glm::dvec3& origin, const glm::dvec3& unit,
                                                double length_m) const;

  const Terrain& terrain_;
  glm::dvec3 to_light_, bottom_of_sun_;
  glm::dvec3 sunwards_, across_,
      upwards_;  // upwards_: normal to the sunbeams, in their vertical plane
  double highest_c_m_ = 0.0, u_high_m_ = 0.0, v_low_m_ = 0.0, v_high_m_ = 0.0;
  int probes_;
};

/// Returns whether vertical lines meet a mesh at most once, which ShadowHeights requires: all
/// triangles face up, and nothing lies over or under any corner or centre of a triangle.
[[nodiscard]] bool IsOneSurface(const Terrain& terrain);

}  // namespace alpenglow::renderer
