// SPDX-License-Identifier: MIT
// Densities on a regular grid: smoke, clouds, whatever a box can hold.
//
// Samples stand at the middles of nx x ny x nz equal cells of the unit cube; between them density
// is trilinear, beyond the outermost it is as there. Along a straight line such a density is a
// cubic between the planes of samples, so that two Gauss points a piece give its integral exactly.
//
// Blocks of 4 samples a side know their largest density: rays pass over the empty ones, and marches
// know how thick what lies ahead can be.
//
// Files: NRRD (http://teem.sourceforge.net/nrrd/format.html), the part of it that a density needs.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace alpenglow::renderer {

inline constexpr int kMostGridSamples = 1024;  // along an axis

/// Immutable.
class VolumeGrid {
 public:
  /// @param size    samples along x, y, z, each in [2, kMostGridSamples].
  /// @param values  x fastest, z slowest; finite and not negative.
  /// Throws InputError that says what is wrong.
  VolumeGrid(const std::array<int, 3>& size, std::vector<float> values);

  [[nodiscard]] const std::array<int, 3>& size() const { return size_; }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] double largest() const { return largest_; }

  /// Density at a point of the unit cube; coordinates are clamped to it.
  [[nodiscard]] double At(const glm::dvec3& point) const;

  /// A piece of a line and the largest density on it, or more.
  struct Piece {
    double begin, end;
    double largest;
  };
  /// The pieces of origin + t direction, t in [begin, end], where density may not be 0, in order:
  /// one a block. The line's piece lies in the unit cube.
  [[nodiscard]] std::vector<Piece> PiecesAlong(const glm::dvec3& origin,
                                               const glm::dvec3& direction, double begin,
                                               double end) const;

  /// Integral of density over t of that piece. Exact but for rounding: relative error below 1e-12.
  [[nodiscard]] double Column(const glm::dvec3& origin, const glm::dvec3& direction, double begin,
                              double end) const;

 private:
  [[nodiscard]] std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(x);
  }
  void FindLargest();

  std::array<int, 3> size_;
  std::array<int, 3> blocks_{};
  std::vector<float> values_;
  std::vector<float> largest_in_block_;
  double largest_ = 0.0;
};

/// Throws InputError for a grid with a side outside of [2, kMostGridSamples].
void CheckGridSize(const std::array<int, 3>& size);

/// Reads an NRRD file: three axes, type float or uint8 (then 255 is density 1), encoding raw or
/// gzip, data in the file or in another one that it names. Its space directions turn the samples so
/// that they run to the right, ahead and up. Throws InputError "file: ..." or "file:line: ..." for
/// damaged data, and what ReadNrrdHeader refuses.
[[nodiscard]] VolumeGrid ReadNrrd(const std::filesystem::path& file);

/// Reads a file that is nothing but nx * ny * nz floats, little endian, x fastest. Throws
/// InputError "file: ..." when it has another length.
[[nodiscard]] VolumeGrid ReadRawGrid(const std::filesystem::path& file,
                                     const std::array<int, 3>& size);

}  // namespace alpenglow::renderer
