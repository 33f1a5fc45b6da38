// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_air.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/number/cholesky.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/ray/optical_depth.h"
#include "atmosphere/ray/ray_panels.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kLog2OfE = 1.4426950408889634;

/// A planet [km].
struct Shell {
  double radius, top;
};

DirectLayer LayerOf(double height, double share, const Shell& shell) {
  const double root = std::sqrt(0.5 / height), flatness = height / shell.radius;
  const double up = share * height * (1.0 + flatness) * root;
  const double root_top = std::sqrt(shell.radius + shell.top);
  const auto real = [](double value) { return static_cast<float>(value); };
  return {.per_height = real(-kLog2OfE / height),
          .root = real(root),
          .delta = real(0.625 * flatness),
          .up_scale = real(up),
          .perigee_scale = real(share * std::sqrt(kPi) * height * (1.0 + 0.375 * flatness) * root),
          .beyond_scale = real(up * std::exp(-shell.top / height) * root_top),
          .beyond_root = real(root * root_top)};
}

/// Coordinates of the fit in [-1, 1], at the extrema of a Chebyshev polynomial.
template <std::size_t n>
std::array<double, n> ChebyshevPoints() {
  std::array<double, n> points;
  for (std::size_t i = 0; i < n; ++i)
    points[i] = -std::cos(kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
  return points;
}

/// Least squares of a polynomial with `powers` terms.
template <std::size_t powers, std::size_t n>
std::array<double, powers> FitPolynomial(const std::array<double, n>& x,
                                         const std::array<double, n>& value,
                                         const std::array<double, n>& weight) {
  std::vector<double> matrix(powers * powers, 0.0), side(powers, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    std::array<double, powers> term;
    term[0] = weight[i];
    for (std::size_t a = 1; a < powers; ++a) term[a] = term[a - 1] * x[i];
    for (std::size_t a = 0; a < powers; ++a) {
      side[a] += term[a] * weight[i] * value[i];
      for (std::size_t b = 0; b <= a; ++b) matrix[a * powers + b] += term[a] * term[b];
    }
  }
  const std::vector<double> solution = SolvePositiveDefinite(std::move(matrix), std::move(side));
  std::array<double, powers> coefficients;
  std::copy_n(solution.begin(), powers, coefficients.begin());
  return coefficients;
}

constexpr std::size_t kHeightPoints = 32, kCosinePoints = 12;
using HeightRow = std::array<double, kHeightPoints>;
using CosineRow = std::array<double, kCosinePoints>;
using HeightPolynomial = std::array<double, kOzoneHeights>;

// The polynomial in Y of (mu + k) column along one cosine.
HeightPolynomial FitHeights(double mu, double factor, double ozone_top, double radius) {
  const HeightRow y = ChebyshevPoints<kHeightPoints>();
  HeightRow column, weight;
  weight.fill(1.0);
  for (std::size_t i = 0; i < kHeightPoints; ++i)
    column[i] = factor * shared::SmoothOzoneColumnUp<double>(0.5 * (y[i] + 1.0) * ozone_top, mu,
                                                             ozone_top, radius);
  return FitPolynomial<kOzoneHeights>(y, column, weight);
}

// The weight 1 / (mu + k) depends on U alone, so the fit is one in Y for each cosine, and then one
// in U for each power of Y.
OzoneFit FitOzone(double ozone_top, double radius) {
  constexpr double k = static_cast<double>(kOzoneCosine);
  const CosineRow u = ChebyshevPoints<kCosinePoints>();
  CosineRow weight;
  std::array<HeightPolynomial, kCosinePoints> of_cosine;
  for (std::size_t j = 0; j < kCosinePoints; ++j) {
    const double share = 0.5 * (u[j] + 1.0), mu = share * k / (1.0 + k - share);
    weight[j] = 1.0 / (mu + k);
    of_cosine[j] = FitHeights(mu, mu + k, ozone_top, radius);
  }
  OzoneFit fit;
  const HeightPolynomial level = FitHeights(0.0, 1.0, ozone_top, radius);
  for (std::size_t a = 0; a < kOzoneHeights; ++a) {
    CosineRow value;
    for (std::size_t j = 0; j < kCosinePoints; ++j) value[j] = of_cosine[j][a];
    const auto in_u = FitPolynomial<kOzoneCosines>(u, value, weight);
    for (std::size_t q = 0; q < kOzoneCosines; ++q) fit.up[q][a] = static_cast<float>(in_u[q]);
    fit.perigee[a] = static_cast<float>(level[a]);
  }
  return fit;
}

void SetOzone(const OzoneLayer& ozone, DirectAir& air) {
  air.smooth_ozone = ozone.shape == OzoneShape::kSmooth;
  air.ozone_bottom = static_cast<float>(Kilometres(ozone.bottom_m));
  air.ozone_peak = static_cast<float>(Kilometres(ozone.peak_m));
  air.ozone_top = static_cast<float>(Kilometres(ozone.top_m));
  if (air.has_ozone && air.smooth_ozone)
    air.ozone_fit = FitOzone(Kilometres(ozone.top_m), air.radius);
}

void SetBands(const Medium& medium, DirectAir& air) {
  air.bands = medium.wavelengths_nm.size();
  for (std::size_t band = 0; band < air.bands; ++band) {
    const auto per_km = [](double per_m) {
      return static_cast<float>(per_m * kMetresPerKilometre);
    };
    const Extinction<double> extinction = ExtinctionAt<double>(medium, band);
    air.rayleigh_scattering[band] = per_km(extinction.rayleigh);
    air.mie_scattering[band] = per_km(medium.mie_scattering_per_m[band]);
    air.rayleigh_extinction[band] = per_km(kLog2OfE * extinction.rayleigh);
    air.mie_extinction[band] = per_km(kLog2OfE * extinction.mie);
    air.ozone_extinction[band] = per_km(kLog2OfE * extinction.ozone);
    air.has_ozone = air.has_ozone || extinction.ozone > 0.0;
    air.largest_extinction =
        std::max(air.largest_extinction, per_km(extinction.rayleigh + extinction.mie));
  }
}

// 5e-4 on the planets of the presets. Columns leave twice the square of H/R; what single precision
// leaves grows with the radius in scale heights to the power 3/2 (fitted to 3e7 and 8e7 m).
double LeastError(double highest, double lowest, double radius) {
  const double flatness = highest / radius;
  return std::max({5e-4, 2.0 * flatness * flatness, 6e-10 * std::pow(radius / lowest, 1.5)});
}

// Optical depth above the top that a horizontal ray there would have.
double DepthAboveTop(const Medium& medium, const DirectAir& air) {
  constexpr double kLevel = 1.7724538509055159;  // sqrt(pi), of DirectColumnShape at y = 0
  double depth = 0.0;
  for (std::size_t band = 0; band < air.bands; ++band) {
    const Extinction<double> extinction = ExtinctionAt<double>(medium, band);
    depth = std::max(depth, extinction.rayleigh * static_cast<double>(air.rayleigh.beyond_scale) +
                                extinction.mie * static_cast<double>(air.mie.beyond_scale));
  }
  return kLevel * kMetresPerKilometre * depth;
}

}  // namespace

DirectAir DirectAirOf(const Medium& medium) {
  DirectAir air{};
  const Shell shell{Kilometres(medium.planet_radius_m), Kilometres(medium.atmosphere_height_m)};
  const double share = medium.rayleigh_deficit.share;
  air.radius = shell.radius;
  air.top = shell.top;
  air.has_deficit = share > 0.0;
  air.deficit_share = static_cast<float>(share);
  air.rayleigh = LayerOf(Kilometres(medium.rayleigh_scale_height_m), 1.0 + share, shell);
  air.deficit = LayerOf(Kilometres(medium.rayleigh_deficit.scale_height_m), share, shell);
  air.mie = LayerOf(Kilometres(medium.mie_scale_height_m), 1.0, shell);
  const auto [lowest, highest] =
      std::minmax({medium.rayleigh_scale_height_m, medium.mie_scale_height_m});
  air.least_error = LeastError(highest, lowest, medium.planet_radius_m);
  SetBands(medium, air);
  SetOzone(medium.ozone, air);
  air.reaches_top = DepthAboveTop(medium, air) > 1e-5;
  return air;
}

}  // namespace alpenglow::atmosphere
