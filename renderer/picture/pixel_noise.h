// SPDX-License-Identifier: MIT
// How many rays a pixel takes so that its noise is what was asked for.
//
// Every pixel takes two rays first, but for those well over the skyline, of which one says as much
// (open_sky_pixels.h). Where those of its eight neighbours would not ask for more even if all that
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
#pragma once

#include <array>

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

}  // namespace alpenglow::renderer
