// SPDX-License-Identifier: MIT
// Numbers in [0, 1) that decide a pixel's rays: where in the pixel, where on the lens, where on the
// sun's disk, when. The same on every machine and for any number of threads.
//
// Each decision has a pair of numbers of its own: the first two dimensions of Sobol's sequence
// (1967), a (0,2)-sequence in base 2, with Owen's nested uniform scrambling (1995) by the hash of
// Laine and Karras (2011), and its points in a shuffled order, so that the pairs are padded to each
// other without correlation (Burley 2020, "Practical hash-based Owen scrambling", JCGT 9(4)).
//
// Pixels take consecutive pieces of the sequence along Morton's curve: the points of a pixel are a
// net, and so are those of an aligned square of 2, 4, ... pixels, which makes the error of
// neighbours differ in sign (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte
// Carlo sampling error via hierarchical ordering of pixels", ACM TOG 39(6)).
#pragma once

#include <array>
#include <cstdint>

namespace alpenglow::renderer {

/// What a pair of numbers decides.
enum class SampleOf : std::uint32_t { kPixel, kLens, kSunDisk, kTime };

class PixelSamples {
 public:
  /// Of a square of pixels with a sequence of its own.
  static constexpr int kTile = 256;
  static constexpr int kMostSamples = 1024;

  /// @param x, y  of the pixel, >= 0. @param samples_per_pixel  in [1, kMostSamples].
  PixelSamples(int x, int y, int samples_per_pixel);

  /// Both in [0, 1). Of n = 2^k samples, one lies in each of n equal parts of either number, and in
  /// each of the n parts of every subdivision of the square into 2^j x 2^(k - j) rectangles.
  [[nodiscard]] std::array<double, 2> Point(int sample, SampleOf decision) const;

 private:
  std::uint32_t tile_;   // hash of the tile that the pixel lies in
  std::uint32_t first_;  // index of the pixel's first point
};

}  // namespace alpenglow::renderer
