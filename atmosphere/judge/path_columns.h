// SPDX-License-Identifier: MIT
// Columns of air along straight lines, for the path tracer: thousands of times faster than
// judge.cpp, and as independent as it is of the shared texts and closed forms.
//
// A line is described by its perigee's distance p from the planet's centre; s
// is the distance along it, counted from the perigee, mu = s / r its zenith
// cosine. With y = r (w^2 - mu^2) / 2, the climb from radius r, nothing is
// singular at the perigee, and an exponential layer's column outwards is
//
//   exp(-h / H) F(r, mu),   F = integral over w >= mu of
//                               exp(-y / H) (r + y) / sqrt(1 + ((w^2 - mu^2) / 2w)^2) dw
//
// F is smooth and nearly the same for every altitude: a table of Gauss-Legendre integrals, read by
// cubic interpolation. Ozone's tent is linear in r, so that its column is elementary:
// integral of sqrt(s^2 + p^2) ds = (s r + p^2 ln((s + r) / p)) / 2; its smooth layer, a polynomial
// of degree 12 in h, is integrated by 14 Gauss nodes.
#pragma once

#include <array>
#include <vector>

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere::judge {

/// Column at relative density 1 [m].
struct AirColumns {
  double rayleigh = 0.0, mie = 0.0, ozone = 0.0;
};

/// Columns along any line outside the planet. Relative error of an optical depth to space below
/// 1e-6 (asserted).
class ColumnTable {
 public:
  explicit ColumnTable(const Medium& medium);

  /// A line with its perigee at `perigee_radius_m` from the centre, and where ozone bends on it.
  struct Line {
    double perigee_radius_m = 0.0;
    std::array<double, 3> ozone_edge_m{};    // s of the layer's bottom, peak, top
    std::array<double, 2> ozone_offset_m{};  // primitives of its two sides at their lower edges
    double ozone_below_peak_m = 0.0;         // column of the whole lower side
  };
  [[nodiscard]] Line LineAt(double perigee_radius_m) const;

  /// What lies beyond |s| on one side: of exponential layers that go on for ever; of ozone, what
  /// lies between the perigee and s instead (with the sign of s).
  [[nodiscard]] AirColumns Primitive(const Line& line, double s_m) const;

  /// The column between s0 and s1 >= s0, given their primitives. A line from s0 < 0 to s1 > 0 must
  /// have its perigee above the ground, and needs the primitive there.
  [[nodiscard]] static AirColumns Difference(double s0_m, const AirColumns& at_s0, double s1_m,
                                             const AirColumns& at_s1, const AirColumns& at_perigee);

  /// The column between s0 and the top of the atmosphere.
  [[nodiscard]] AirColumns ToSpace(double perigee_radius_m, double s0_m) const;

 private:
  static constexpr int kRadii = 12;
  static constexpr int kSlants = 96;

  struct Layer {
    double scale_height_m = 0.0;
    std::vector<double> table;  // F / sqrt(H r) (1 + t), t = mu sqrt(r / 2H); radius major
  };
  [[nodiscard]] Layer Tabulate(double scale_height_m) const;
  [[nodiscard]] double Beyond(const Layer& layer, double radius_m, double s_m) const;
  [[nodiscard]] double MoleculesBeyond(double radius_m, double s_m) const;
  [[nodiscard]] double SmoothOzoneUpTo(const Line& line, double s_m) const;
  [[nodiscard]] double OzoneSide(const Line& line, std::size_t side, double s_m) const;

  double planet_radius_m_;
  double top_radius_m_;
  OzoneLayer ozone_;
  bool has_ozone_;
  double deficit_share_;
  Layer rayleigh_;
  Layer mie_;
  Layer deficit_;  // without a share: empty
};

}  // namespace alpenglow::atmosphere::judge
