// SPDX-License-Identifier: MIT
// The parts of a ray that lie in sunlight, with soft ends.
#pragma once

#include <optional>
#include <vector>

namespace alpenglow::renderer {

/// Sunlight that passes a straight edge which cuts the sun's disk, in [0, 1].
/// @param x  height of the disk's centre over the edge in radii of the disk: 1 and more, all of the
///           light passes; -1 and less, none.
/// Integral of LimbDarkening(rho) (sun_disk.h) over the circular segment: sunlight_over_edge.glsl.
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

}  // namespace alpenglow::renderer
