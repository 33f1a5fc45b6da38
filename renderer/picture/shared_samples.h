// SPDX-License-Identifier: MIT
// Chooses how many rays a pixel takes for a requested noise, and combines the rays of neighbouring
// pixels.
//
// Every pixel first takes two rays; pixels well above the skyline take one, which gives the same
// result (unoccluded_sky_pixels.h). Two first rays are enough where the eight neighbours would not
// require more even if all differences between their rays were noise, edges and gradients included:
// such pixels hide nothing (skies, haze, still water). Other pixels take more first rays before the
// noise is estimated. The number of rays that follow is decided once, from the first rays:
//
//   s^2 = sum |c_i - m|^2 / (n - 1) / max(|m|, floor)^2     of the first n rays of a pixel, c in
//                                                           linear R, G and B, m their mean
//   e   = S n^-p,  S^2 the mean of s^2 of the neighbours    of a pixel that takes n rays
//
// p is 1/2 for random rays; stratified ones do better, 3/4 at an edge of terrain. The exponent used
// here is the one that pictures of terrain show from 4 to 64 rays.
//
// A pixel uses the variance of its eight neighbours, not of its own rays. Stopping where a pixel's
// own rays happen to agree favours pixels whose rays missed thin features, and biases the mean
// (Kirk and Arvo 1991, "Unbiased sampling techniques for image synthesis", SIGGRAPH). With the
// number fixed in advance, the mean of any number of scrambled points is that of the pixel. As the
// filter reaches over the neighbours, their rays also sample the pixel. All rays also count for the
// pixels around them, which reduces the error to 0.6 times the requested one.
//
// Rays count for every pixel whose filter they lie in.
//
// A pixel distributes its rays like its filter w (camera_rays.h), over three pixels along each
// axis: there they also sample the filters of its neighbours. With n_q rays of each pixel q of a
// tile the light of a pixel p is
//
//   L_p = sum_r g(r) L_r / sum_r g(r) - s . o,     g(r) = w(r - p) / sum_q n_q w(r - q),
//   o   = sum_r g(r) (r - p) / sum_r g(r)
//
// over all rays r. This is the balance heuristic of Veach, Guibas (1995), "Optimally combining
// sampling techniques for Monte Carlo rendering", SIGGRAPH, which gives no ray much more weight
// than another. o is the offset of these rays from the middle of the filter, s the change of light
// from pixel to pixel: the limited difference of van Leer (1977), J. Comput. Phys. 23, 276, which
// is 0 at crests and never over twice the difference to either neighbour, so that light does not
// become negative.
//
// All rays of a pixel that meet the sky have one sky radiance, that of the pixel
// (SharedSegmentAir), whatever their direction. To a neighbour they contribute only the fact that
// sky is visible, not its radiance. So L_r is the light relative to the sky of the ray's own pixel,
// and a pixel adds its own sky in proportion to its visible fraction: sum_r g(r) [r sees sky] /
// sum_r g(r). Otherwise a sky whose radiance grows by a quarter from row to row would come out up
// to a fifth too bright above a ridge, whose pixels have many rays. Rays past the limb of the
// planet have a sky of their own (LimbView), which counts like the light of ground.
//
// The combined rays have 0.6 times the error of the mean of each pixel's own rays.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/camera/camera_rays.h"

namespace alpenglow::renderer {

/// Mean and variance of the colours of a pixel's rays.
class RaySpread {
 public:
  /// @param rgb  linear [cd/m^2].
  void Add(const std::array<double, 3>& rgb);

  /// Merges the rays of another pixel, as if all belonged to one pixel.
  void Add(const RaySpread& other);

  /// Returns s^2 as above [1]; 0 for fewer than two rays and where there is no light.
  [[nodiscard]] double RelativeVariance(double floor_cd_per_m2) const;

 private:
  int rays_ = 0;
  std::array<double, 3> mean_{};
  double squares_ = 0.0;  // sum of squared distances from the mean
};

/// Returns the number of rays that brings the error of a pixel to `noise`: a power of two times
/// `first`, since such numbers are distributed best, in [first, most].
/// @param relative_variance  S^2. @param noise  e, > 0. @param most  at least first.
[[nodiscard]] int RaysForNoise(double relative_variance, double noise, int first, int most);

/// The radiance of a ray and its offset from the middle of its pixel [pixels].
struct SeenRay {
  double right, down;
  Spectrum radiance;  // relative to the sky of its pixel where it sees the sky
  bool sees_sky = false;
};

/// Combines the rays of a rectangle of pixels. Call Expect() for the number of rays of each pixel,
/// then Add() for the rays, then Light().
class SharedSampleFilter {
 public:
  /// @param filter  at most three pixels wide.
  SharedSampleFilter(const PixelFilter& filter, int columns, int rows, std::size_t bands);

  void Expect(int column, int row, int rays);
  void Add(int column, int row, const SeenRay& ray);
  /// Sets the sky radiance of a pixel with rays that see it.
  void SetSky(int column, int row, const Spectrum& sky);

  /// Returns the mean light of a pixel that has rays. If only rays of neighbours see the sky, their
  /// sky is used.
  [[nodiscard]] Spectrum Light(int column, int row) const;

 private:
  static constexpr int kReach = 3;  // pixels along each axis whose filters a ray can lie in
  struct Weights {
    int first;  // first column or row
    std::array<float, kReach> of;
  };
  [[nodiscard]] Weights Around(double at, int end) const;
  [[nodiscard]] std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] float Mean(std::size_t pixel, std::size_t sum) const {
    return sums_[pixel * stride_ + sum] / sums_[pixel * stride_];
  }

  /// Returns the pixel's sky, else the mean sky of the pixels around it, else zero.
  [[nodiscard]] Spectrum SkyAt(int column, int row) const;

  // Each pixel stores sums of g, of g times the ray's column, row and sky visibility, and from
  // kLight on of g times its light, in blocks of four for vector instructions.
  static constexpr std::size_t kColumn = 1, kRow = 2, kSky = 3, kLight = 4;
  int columns_, rows_;
  std::size_t bands_, stride_;
  double radius_;
  std::vector<float> filter_;  // filter weight over the distance, up to its radius
  std::vector<float> expected_;
  std::vector<float> sums_;
  std::vector<std::optional<Spectrum>> skies_;
};

}  // namespace alpenglow::renderer
