// SPDX-License-Identifier: MIT
// How many rays a pixel takes so that its noise is what was asked for.
//
// Every pixel takes two rays first, but for those well over the skyline, of which one says as much
// (sky_pixels.h). Where those of its eight neighbours would not ask for more even if all that
// they differ by were noise, edges and gradients and all, there is nothing to be missed, and two are
// enough to begin with: skies, haze, still water. Elsewhere more are taken before it is asked how
// much noise there is. What these first rays say of it decides how many follow, once:
//
//   s^2 = sum |c_i - m|^2 / (n - 1) / max(|m|, floor)^2     of the first n rays of a pixel, c in
//                                                           linear R, G and B, m their mean
//   e   = S n^-p,  S^2 the mean of s^2 of the neighbours    of a pixel that takes n rays
//
// p is 1/2 for rays by chance; stratified ones do better, 3/4 at an edge of terrain. The exponent
// here is what pictures of terrain show from 4 to 64 rays.
//
// A pixel does not ask its own rays but its eight neighbours'. Whoever stops where the own rays
// happen to agree keeps those that have missed what is thin: the mean comes out biased (Kirk and
// Arvo 1991, "Unbiased sampling techniques for image synthesis", SIGGRAPH). With the number known
// before, the mean of any number of scrambled points is that of the pixel; and as the filter
// reaches over the neighbours, so do their rays over the pixel. All rays count, for the pixels around
// as well (shared_rays.h), which leaves 0.6 times the error that is asked for.
//
// Rays that count for every pixel whose filter they lie in.
//
// A pixel spreads its rays as its filter w is (camera_rays.h), over three pixels each way: there
// they are samples of its neighbours' filters, too. With n_q rays of each pixel q of a tile the
// light of a pixel p is
//
//   L_p = sum_r g(r) L_r / sum_r g(r) - s . o,     g(r) = w(r - p) / sum_q n_q w(r - q),
//   o   = sum_r g(r) (r - p) / sum_r g(r)
//
// over all rays r: the balance heuristic of Veach, Guibas (1995), "Optimally combining sampling
// techniques for Monte Carlo rendering", SIGGRAPH, by which no ray weighs much more than another. o
// is how far these rays lie off the middle of the filter, s the change of light from pixel to pixel:
// the limited difference of van Leer (1977), J. Comput. Phys. 23, 276, which is 0 at crests and never
// over twice the difference to either neighbour, so that light does not become negative.
//
// All rays of a pixel that meet the sky see one sky, that of the pixel (SharedAir), wherever they go:
// what they say to a neighbour is that there is sky, not which. So L_r is the light beside that of
// the sky of the ray's own pixel, and a pixel adds its own sky as often as there is one:
// sum_r g(r) [r sees sky] / sum_r g(r). Else a sky that brightens from row to row by a quarter would
// come out up to a fifth too bright above a ridge, whose pixels have many rays.
//
// The same rays have 0.6 times the error of means of each pixel's own.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// Mean and variance of the colours of a pixel's rays.
class RaySpread {
 public:
  /// @param rgb  linear [cd/m^2].
  void Add(const std::array<double, 3>& rgb);

  /// Those of another pixel counted with these, as if all were of one.
  void Add(const RaySpread& other);

  /// s^2 as above [1]; 0 of fewer than two rays and where there is no light.
  [[nodiscard]] double RelativeVariance(double floor_cd_per_m2) const;

 private:
  int rays_ = 0;
  std::array<double, 3> mean_{};
  double squares_ = 0.0;  // of distances from the mean
};

/// Rays that bring the error of a pixel to `noise`: a power of two times `first`, as such are
/// spread best, in [first, most].
/// @param relative_variance  S^2. @param noise  e, > 0. @param most  at least first.
[[nodiscard]] int RaysForNoise(double relative_variance, double noise, int first, int most);

/// What a ray saw, and where it went [pixels from the middle of its pixel].
struct SeenRay {
  double right, down;
  BandLight radiance;  // beside the sky of its pixel, where it sees the sky
  bool sees_sky = false;
};

/// Of a rectangle of pixels. First it is told how many rays each will take, then the rays; then it
/// is asked.
class SharedRays {
 public:
  /// @param filter  at most three pixels wide.
  SharedRays(const PixelFilter& filter, int columns, int rows, std::size_t bands);

  void Expect(int column, int row, int rays);
  void Add(int column, int row, const SeenRay& ray);
  /// The sky of a pixel with rays that see it.
  void SetSky(int column, int row, const BandLight& sky);

  /// The mean of a pixel that has rays. Where only those of its neighbours see the sky, it is theirs.
  [[nodiscard]] BandLight Light(int column, int row) const;

 private:
  static constexpr int kReach = 3;  // pixels each way whose filters a ray may lie in
  struct Weights {
    int first;  // column or row
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

  /// The pixel's, else the mean of those around it, else none.
  [[nodiscard]] BandLight SkyAt(int column, int row) const;

  // Sums of a pixel: of g, of g times the ray's column and row and whether it sees the sky, and from
  // kLight on of g times its light, in blocks of four for vector instructions.
  static constexpr std::size_t kColumn = 1, kRow = 2, kSky = 3, kLight = 4;
  int columns_, rows_;
  std::size_t bands_, stride_;
  double radius_;
  std::vector<float> filter_;  // over the distance, up to its radius
  std::vector<float> expected_;
  std::vector<float> sums_;
  std::vector<std::optional<BandLight>> skies_;
};

}  // namespace alpenglow::renderer
