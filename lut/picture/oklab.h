// SPDX-License-Identifier: MIT
// OKLab: lightness and two opponent colours of linear sRGB. Ottosson (2020), "A perceptual color
// space for image processing", https://bottosson.github.io/posts/oklab.
#pragma once

#include <array>
#include <cmath>

namespace alpenglow::lut {

template <typename Real>
struct Oklab {
  Real lightness;  // 1 for white
  Real a;          // towards red
  Real b;          // towards yellow
};

template <typename Real>
[[nodiscard]] Oklab<Real> OklabOf(const std::array<Real, 3>& rgb) {
  const auto root = [&](double r, double g, double b) {
    return std::cbrt(Real(r) * rgb[0] + Real(g) * rgb[1] + Real(b) * rgb[2]);
  };
  const Real l = root(0.4122214708, 0.5363325363, 0.0514459929);
  const Real m = root(0.2119034982, 0.6806995451, 0.1073969566);
  const Real s = root(0.0883024619, 0.2817188376, 0.6299787005);
  return {Real(0.2104542553) * l + Real(0.7936177850) * m - Real(0.0040720468) * s,
          Real(1.9779984951) * l - Real(2.4285922050) * m + Real(0.4505937099) * s,
          Real(0.0259040371) * l + Real(0.7827717662) * m - Real(0.8086757660) * s};
}

template <typename Real>
[[nodiscard]] std::array<Real, 3> RgbOf(const Oklab<Real>& lab) {
  const auto cube = [&](double a, double b) {
    const Real root = lab.lightness + Real(a) * lab.a + Real(b) * lab.b;
    return root * root * root;
  };
  const Real l = cube(0.3963377774, 0.2158037573);
  const Real m = cube(-0.1055613458, -0.0638541728);
  const Real s = cube(-0.0894841775, -1.2914855480);
  return {Real(4.0767416621) * l - Real(3.3077115913) * m + Real(0.2309699292) * s,
          Real(-1.2684380046) * l + Real(2.6097574011) * m - Real(0.3413193965) * s,
          Real(-0.0041960863) * l - Real(0.7034186147) * m + Real(1.7076147010) * s};
}

}  // namespace alpenglow::lut
