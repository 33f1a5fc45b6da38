// SPDX-License-Identifier: MIT
// The parts of a ray that lie in sunlight, with soft ends.
//
// Where any mesh lets the sun into the air: probes along a ray, halved where light and shade meet.
//
// For meshes with overhangs, bridges, buildings, under which ShadowHeights would see only shade.
// Occlusion rays towards the middle of the sun's disk find the lit stretches; where two neighbours
// differ, halving finds the edge, and then the place where the last beam of the disk gets free,
// which says how fast the edge rises over the disk.
//
// What is thinner than the distance of two probes, and its shadow, may fall between them.
//
// This header also reads the shared text sunlight_over_edge.glsl as C++.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/dialect/shared_math.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/shadow/sunlight_over_edge.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// Sunlight that passes a straight edge which cuts the sun's disk, in [0, 1].
/// @param x  height of the disk's centre over the edge in radii of the disk: 1 and more, all of the
///           light passes; -1 and less, none.
/// Integral of LimbDarkening(rho) (sun.h) over the circular segment: sunlight_over_edge.glsl.
/// The law of a single wavelength from 440 to 680 nm is within 0.01.
[[nodiscard]] double SunlightOverEdge(double x);

/// A stretch of a ray that sunlight reaches. The height of the disk's centre over the edge that
/// cuts it, in radii of the disk, runs evenly from begin_x to end_x; both are 1 in full light.
struct SunlitPiece {
  double begin_m, end_m;
  double begin_x = 1.0, end_x = 1.0;

  [[nodiscard]] double length_m() const { return end_m - begin_m; }
  bool operator==(const SunlitPiece&) const = default;
};

/// Pieces in order, without overlap. What they leave out is dark.
using SunlitPath = std::vector<SunlitPiece>;

/// Sunlight at a distance along the ray, in [0, 1].
[[nodiscard]] double SunlightAt(const SunlitPath& path, double distance_m);

/// Joins small pieces, given in order, to long ones: those of full
/// light, and those of half shade as long as no joint is moved by more
/// than kTolerance radii of the disk (Bristol 1990, swinging doors).
class SunlitPathBuilder {
 public:
  static constexpr double kTolerance = 0.02;

  /// x is clamped to [-1, 1]; pieces that are dark at both ends only end what came before.
  void Add(const SunlitPiece& piece);
  [[nodiscard]] SunlitPath Take();

 private:
  void Extend(const SunlitPiece& piece);
  void Close();

  SunlitPath path_;
  std::optional<SunlitPiece> open_;
  double least_slope_ = 0.0, most_slope_ = 0.0;  // of lines that miss no joint of open_
};

/// Immutable; safe to ask from many threads. Refers to the terrain.
class SunProbes {
 public:
  /// @param to_sun  unit vector in the frame of the terrain, z up.
  /// @param probes  along the stretch of a ray that terrain can shade, at least 2.
  SunProbes(const Terrain& terrain, const glm::dvec3& to_sun, double sun_radius_rad,
            int probes = 32);

  /// The stretches of a ray within [0, length_m] that the sun reaches; length_m is finite.
  [[nodiscard]] SunlitPath Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                 double length_m) const;

 private:
  struct Stretch {
    double begin_m, end_m;
  };
  [[nodiscard]] Stretch WithinTheShadowOfTheBox(const glm::dvec3& origin, const glm::dvec3& unit,
                                                double length_m) const;

  const Terrain& terrain_;
  glm::dvec3 to_sun_, bottom_of_sun_;
  glm::dvec3 sunwards_, across_, upwards_;  // upwards: across sunbeams, in their vertical plane
  double highest_c_m_ = 0.0, u_high_m_ = 0.0, v_low_m_ = 0.0, v_high_m_ = 0.0;
  int probes_;
};

/// Whether vertical lines meet a mesh at most once, which ShadowHeights takes for granted: all
/// triangles face up, and nothing lies over or under any corner or middle of a triangle.
[[nodiscard]] bool IsOneSurface(const Terrain& terrain);

}  // namespace alpenglow::renderer
