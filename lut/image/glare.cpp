// SPDX-License-Identifier: MIT
#include "lut/image/glare.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::lut {
namespace {

using Complex = std::complex<double>;

/// Values on a torus whose sides are powers of two.
class Torus {
 public:
  Torus(std::size_t width, std::size_t height)
      : width_(width), height_(height), values_(width * height) {}

  Complex& at(std::size_t x, std::size_t y) { return values_[y * width_ + x]; }
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  std::vector<Complex>& values() { return values_; }

  /// Applies the Fourier transform to rows and columns, without a factor. @param sign  sign of the
  /// exponent.
  void Transform(double sign) {
    tbb::parallel_for(std::size_t{0}, height_, [&](std::size_t y) {
      TransformLine(values_.data() + y * width_, 1, width_, sign);
    });
    tbb::parallel_for(std::size_t{0}, width_, [&](std::size_t x) {
      TransformLine(values_.data() + x, width_, height_, sign);
    });
  }

 private:
  // Cooley and Tukey (1965): bit-reversed order, then pairs of halves.
  static void TransformLine(Complex* first, std::size_t step, std::size_t count, double sign) {
    std::vector<Complex> line(count);
    const int bits = std::countr_zero(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t mirrored = 0;
      for (int b = 0; b < bits; ++b) mirrored |= ((i >> b) & 1U) << (bits - 1 - b);
      line[mirrored] = first[i * step];
    }
    for (std::size_t half = 1; half < count; half *= 2) {
      for (std::size_t k = 0; k < half; ++k) {
        const Complex turn =
            std::polar(1.0, sign * kPi * static_cast<double>(k) / static_cast<double>(half));
        for (std::size_t i = k; i < count; i += 2 * half) {
          const Complex a = line[i], b = turn * line[i + half];
          line[i] = a + b;
          line[i + half] = a - b;
        }
      }
    }
    for (std::size_t i = 0; i < count; ++i) first[i * step] = line[i];
  }

  std::size_t width_, height_;
  std::vector<Complex> values_;
};

/// Returns the fractions of a pixel's light that it scatters to pixels at a distance along both
/// axes. The fraction of the pixel itself is the remainder.
Torus Spread(std::size_t width, std::size_t height, double pixel_rad) {
  Torus spread(width, height);
  double sent = 0.0;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      if (x == 0 && y == 0) continue;
      const auto across = static_cast<double>(std::min(x, width - x));
      const auto down = static_cast<double>(std::min(y, height - y));
      const double share = GlareOfEye(pixel_rad * std::hypot(across, down)) * pixel_rad * pixel_rad;
      spread.at(x, y) = share;
      sent += share;
    }
  }
  spread.at(0, 0) = std::max(1.0 - sent, 0.0);
  return spread;
}

}  // namespace

double GlareOfEye(double angle_rad) {
  const double t = angle_rad / kRadiansPerDegree;
  const double f0 = 2.61e6 * std::exp(-t * t / (0.02 * 0.02));
  const double near = t + 0.02;
  return 0.384 * f0 + 0.478 * 20.91 / (near * near * near) + 0.138 * 72.37 / (near * near);
}

HdrImage WithGlareOfEye(HdrImage image, double pixel_rad) {
  ALPENGLOW_ENSURE(pixel_rad, >, 0.0);
  // The torus is at least twice as wide as the image, so that no light wraps around.
  const auto width = std::bit_ceil(2 * static_cast<std::size_t>(image.width));
  const auto height = std::bit_ceil(2 * static_cast<std::size_t>(image.height));
  Torus spread = Spread(width, height, pixel_rad);
  spread.Transform(-1.0);
  const auto over_picture = [&](const auto& visit) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x)
        visit(image.at(x, y), static_cast<std::size_t>(x), static_cast<std::size_t>(y));
    }
  };
  for (std::size_t c = 0; c < 3; ++c) {
    Torus light(width, height);
    over_picture([&](const auto& rgb, std::size_t x, std::size_t y) {
      light.at(x, y) = static_cast<double>(rgb.at(c));
    });
    light.Transform(-1.0);
    for (std::size_t i = 0; i < light.values().size(); ++i) light.values()[i] *= spread.values()[i];
    light.Transform(1.0);
    const double scale = 1.0 / static_cast<double>(width * height);
    over_picture([&](auto& rgb, std::size_t x, std::size_t y) {
      rgb.at(c) = static_cast<float>(scale * light.at(x, y).real());
    });
  }
  return image;
}

}  // namespace alpenglow::lut
