// SPDX-License-Identifier: MIT
// Columns of air along straight lines, for the path tracer.
//
// They are computed thousands of times faster than in reference_solution.cpp, and also without the
// shared sources and closed forms.
//
// A line is described by the distance p of its perigee from the planet's centre; s is the distance
// along the line, counted from the perigee, and mu = s / r its zenith cosine. In the variable
// y = r (w^2 - mu^2) / 2, the climb from radius r, the integrand has no singularity at the perigee,
// and an exponential layer's column outwards is
//
//   exp(-h / H) F(r, mu),   F = integral over w >= mu of
//                               exp(-y / H) (r + y) / sqrt(1 + ((w^2 - mu^2) / 2w)^2) dw
//
// F is smooth and nearly independent of altitude: it is a table of Gauss-Legendre integrals, read
// by cubic interpolation. The ozone tent is linear in r, so that its column is elementary: integral
// of sqrt(s^2 + p^2) ds = (s r + p^2 ln((s + r) / p)) / 2. The smooth ozone layer, a polynomial of
// degree 12 in h, is integrated by 14 Gauss nodes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "atmosphere/medium/medium.h"

namespace alpenglow::atmosphere::reference {

/// Column at relative density 1 [m].
struct AirColumns {
  double rayleigh = 0.0, mie = 0.0, ozone = 0.0;
};

/// Computes columns along any line; below altitude 0 air has the density of altitude 0. The
/// relative error of an optical depth to space is below 1e-6 (asserted).
class ColumnTable {
 public:
  explicit ColumnTable(const Medium& medium);

  /// A line with its perigee at `perigee_radius_m` from the centre, and the points at which the
  /// ozone profile has a kink on it.
  struct Line {
    double perigee_radius_m = 0.0;
    std::array<double, 3> ozone_edge_m{};    // s of the layer's bottom, peak, top
    std::array<double, 2> ozone_offset_m{};  // antiderivatives at the lower edges of both sides
    double ozone_below_peak_m = 0.0;         // column of the whole lower side
  };
  [[nodiscard]] Line LineAt(double perigee_radius_m) const;

  /// Returns, for exponential layers of infinite extent, the column beyond |s| on one side; for
  /// ozone, the column between the perigee and s (with the sign of s).
  [[nodiscard]] AirColumns Primitive(const Line& line, double s_m) const;

  /// Returns the column between s0 and s1 >= s0, given their primitives. A line from s0 < 0 to
  /// s1 > 0 needs the primitive at its perigee.
  [[nodiscard]] static AirColumns Difference(double s0_m, const AirColumns& at_s0, double s1_m,
                                             const AirColumns& at_s1, const AirColumns& at_perigee);

  /// Returns the column between s0 and the top of the atmosphere.
  [[nodiscard]] AirColumns ToSpace(double perigee_radius_m, double s0_m) const;

 private:
  static constexpr int kRadii = 12;
  static constexpr int kSlants = 96;

  struct Layer {
    double scale_height_m = 0.0;
    std::vector<double> table;  // F / sqrt(H r) (1 + t), t = mu sqrt(r / 2H); radius-major order
  };
  [[nodiscard]] Layer Tabulate(double scale_height_m) const;

  /// First of four nodes, and their weights.
  struct Cubic {
    std::size_t first;
    double w0, w1, w2, w3;
  };
  [[nodiscard]] static Cubic CubicAt(double x, int count);

  /// A point on a line, and its interpolation between the radii of the tables.
  struct LinePoint {
    double radius_m, s_m, height_m;
    Cubic across;
  };
  [[nodiscard]] LinePoint PlaceAt(double radius_m, double s_m) const;
  [[nodiscard]] static double Beyond(const Layer& layer, const LinePoint& place);
  [[nodiscard]] double MoleculesBeyond(const LinePoint& place) const;
  [[nodiscard]] double SmoothOzoneUpTo(const Line& line, double s_m) const;
  [[nodiscard]] double OzoneSide(const Line& line, std::size_t side, double s_m) const;

  double planet_radius_m_;
  double top_radius_m_;
  OzoneLayer ozone_;
  bool has_ozone_;
  double deficit_share_;
  Layer rayleigh_;
  Layer mie_;
  Layer deficit_;  // empty if the medium has no deficit
};

}  // namespace alpenglow::atmosphere::reference
