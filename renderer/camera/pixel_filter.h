// SPDX-License-Identifier: MIT
// What a pixel sees of its surroundings: a weight w(x) w(y) over the distance to its middle.
//
// The weight is not multiplied onto rays but decides where they go: rays are distributed as the
// filter is, and count alike (Ernst, Stamminger and Greiner 2006, "Filter importance sampling",
// IEEE Symposium on Interactive Ray Tracing). That needs no exchange between pixels, and a filter
// that is positive everywhere: none of these rings at the edge of the sun.
//
//   box              1                                                     |x| < 1/2
//   gaussian         exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2)                 |x| < r
//   blackman-harris  sum a_k cos(k pi x / r), k = 0..3 (Harris 1978)       |x| < r
//
// On a zone plate, of the frequencies from 1/2 to 3/2 cycles a pixel, and of those below 1/2:
//                    power that aliases   power kept   rise of an edge, 10 to 90 % [pixels]
//   box                     0.079            0.77          0.80
//   blackman-harris         0.019            0.63          1.08
//   gaussian                0.008            0.56          1.25
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::renderer {

class PixelFilter {
 public:
  enum class Kind { kBox, kGaussian, kBlackmanHarris };

  explicit PixelFilter(Kind kind);

  /// Distance of a ray from the middle of its pixel along one axis [pixels]: distributed as the
  /// filter when `u` is uniform in [0, 1), antisymmetric about 1/2.
  [[nodiscard]] double Offset(double u) const;

  /// Half its width [pixels].
  [[nodiscard]] double radius() const { return radius_; }

  /// Its value at a distance from the middle [1/pixel]; its integral is 1.
  [[nodiscard]] double Weight(double x) const;

 private:
  [[nodiscard]] double Shape(double x) const;

  Kind kind_;
  double radius_;
  double integral_;              // of Shape
  std::vector<double> offsets_;  // at u = 1/2 + i / 2 (size - 1)
};

/// Throws InputError listing the names.
[[nodiscard]] PixelFilter::Kind PixelFilterFromName(std::string_view name);
[[nodiscard]] std::string NameOf(PixelFilter::Kind kind);
[[nodiscard]] const std::vector<std::string>& PixelFilterNames();

}  // namespace alpenglow::renderer
