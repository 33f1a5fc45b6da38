// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_panels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kLog2OfE = 1.4426950408889634;

/// Radius and top of a planet's atmosphere [km].
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

/// Returns the coordinates of the fit in [-1, 1], at the zeros of a Chebyshev polynomial.
template <std::size_t n>
std::array<double, n> ChebyshevPoints() {
  std::array<double, n> points;
  for (std::size_t i = 0; i < n; ++i)
    points[i] = -std::cos(kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
  return points;
}

/// Returns the least-squares fit of a polynomial with `powers` terms.
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

// Returns the polynomial in Y of (mu + k) column along one cosine.
HeightPolynomial FitHeights(double mu, double factor, double ozone_top, double radius) {
  const HeightRow y = ChebyshevPoints<kHeightPoints>();
  HeightRow column, weight;
  weight.fill(1.0);
  for (std::size_t i = 0; i < kHeightPoints; ++i)
    column[i] = factor * shared::SmoothOzoneColumnUp<double>(0.5 * (y[i] + 1.0) * ozone_top, mu,
                                                             ozone_top, radius);
  return FitPolynomial<kOzoneHeights>(y, column, weight);
}

// The weight 1 / (mu + k) depends on U alone, so the fit is first in Y for each cosine, and then in
// U for each power of Y.
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

// Returns the optical depth above the top for a horizontal ray at the top.
double DepthAboveTop(const Medium& medium, const DirectAir& air) {
  constexpr double kLevel = 1.7724538509055159;  // sqrt(pi), from DirectColumnShape at y = 0
  double depth = 0.0;
  for (std::size_t band = 0; band < air.bands; ++band) {
    const Extinction<double> extinction = ExtinctionAt<double>(medium, band);
    depth = std::max(depth, extinction.rayleigh * static_cast<double>(air.rayleigh.beyond_scale) +
                                extinction.mie * static_cast<double>(air.mie.beyond_scale));
  }
  return kLevel * kMetresPerKilometre * depth;
}

/// A ray from its entry into the air [km].
struct Entry {
  double altitude, mu, mu_s, nu;
  double skipped;  // distance from the observer
  double length;   // length of the ray in the air
  RayEnd end;
};

/// The dark part of a ray; empty unless begin < end.
struct Dark {
  double begin = 0.0, end = 0.0;
  [[nodiscard]] bool Exists() const { return begin < end; }
};

// Moves an observer above the top to the point where the ray enters the air. Returns whether the
// ray does.
bool EnterAir(const DirectAir& air, Entry& entry) {
  if (entry.altitude <= air.top) return true;
  if (entry.mu >= 0.0 || shared::GroundClearance<double>(entry.altitude - air.top, entry.mu,
                                                         air.radius + air.top) <= 0.0)
    return false;
  entry.skipped = shared::DistanceDownTo<double>(entry.altitude, entry.mu, air.top, air.radius);
  entry.mu_s = shared::SunCosineAlongRay<double>(entry.altitude, entry.mu_s, entry.nu,
                                                 entry.skipped, air.top, air.radius);
  entry.mu = shared::ZenithCosineAlongRay<double>(entry.altitude, entry.mu, entry.skipped, air.top,
                                                  air.radius);
  entry.altitude = air.top;
  return true;
}

void FindEnd(const DirectAir& air, double length_m, Entry& entry) {
  const bool ground =
      entry.mu < 0.0 && shared::GroundClearance<double>(entry.altitude, entry.mu, air.radius) > 0.0;
  entry.end = ground ? RayEnd::kGround : RayEnd::kSpace;
  entry.length = ground
                     ? shared::DistanceDownTo<double>(entry.altitude, entry.mu, 0.0, air.radius)
                     : shared::DistanceUpTo<double>(entry.altitude, entry.mu, air.top, air.radius);
  const double asked = Kilometres(length_m) - entry.skipped;
  if (asked >= entry.length) return;
  entry.length = std::max(asked, 0.0);
  entry.end = RayEnd::kLength;
}

// Returns the dark part by the formulas of PlanetShadow, here in double precision.
Dark DarkOf(const DirectAir& air, const Entry& entry) {
  const double height = (air.radius + entry.altitude) * entry.mu_s;
  if (height > 0.0 && height + entry.length * entry.nu > 0.0) return {};
  const double a = (1.0 - entry.nu) * (1.0 + entry.nu);
  const auto& [h, mu, mu_s, nu, skipped, length, end] = entry;
  if (shared::MeetsShadow<double>(h, mu, mu_s, nu, a, air.radius) == 0.0) return {};
  return {std::max(shared::ShadowBegin<double>(h, mu, mu_s, nu, a, air.radius), 0.0),
          std::min(shared::ShadowEnd<double>(h, mu, mu_s, nu, a, air.radius), length)};
}

/// Places the panels of one ray.
class PanelPlacer {
 public:
  PanelPlacer(const DirectAir& air, const Entry& entry, DirectRay& ray)
      : air_(air),
        entry_(entry),
        dark_(DarkOf(air, entry)),
        from_perigee_((air.radius + entry.altitude) * entry.mu),
        ray_(ray) {
    ray_.falls = from_perigee_ < 0.0;
  }

  void Place(bool dark) const {
    const double perigee = std::clamp(-from_perigee_, 0.0, entry_.length);
    PlaceMonotone(0.0, perigee, false, dark);
    PlaceMonotone(perigee, entry_.length, true, dark);
  }

  // Returns whether seven nodes suffice for a single panel. They do not if dense air hides its low
  // end and sunbeams graze that end, or if the ray descends to it.
  [[nodiscard]] bool FitsEightLanes() const {
    if (ray_.panels != 1) return false;
    const DirectPanel& panel = ray_.panel[0];
    const bool rises = panel.direction > 0.0F;
    if (ray_.falls && rises) return false;  // the panel lies behind the perigee
    return !(panel.hard && (dark_.Exists() || panel.mu_s < 0.05F || !rises));
  }

 private:
  // Adds a segment of monotone altitude, cut at the edges of the shadow.
  void PlaceMonotone(double begin, double end, bool rises, bool dark) const {
    if (!(begin < end)) return;
    if (!dark_.Exists() || dark_.begin >= end || dark_.end <= begin) {
      Add(begin, end, rises, true);
      return;
    }
    Add(begin, std::max(begin, dark_.begin), rises, true);
    if (dark) Add(std::max(begin, dark_.begin), std::min(end, dark_.end), rises, false);
    Add(std::min(end, dark_.end), end, rises, true);
  }

  void Add(double begin, double end, bool rises, bool lit) const {
    if (end - begin <= 1e-9 * entry_.length) return;
    const double low = rises ? begin : end, sign = rises ? 1.0 : -1.0;
    const double altitude = AltitudeAt(low);
    const double inverse = 1.0 / (air_.radius + altitude);
    const double sun = (air_.radius + entry_.altitude) * entry_.mu_s + low * entry_.nu;
    const auto real = [](double value) { return static_cast<float>(value); };
    DirectPanel& panel = ray_.panel[ray_.panels++];
    panel.altitude = real(altitude);
    panel.radius = real(air_.radius + altitude);
    panel.inverse_radius = real(inverse);
    panel.from_perigee = real(std::abs(from_perigee_ + low));
    panel.length = real(end - begin);
    panel.mu_s = real(sun * inverse);
    panel.nu = real(sign * entry_.nu);
    panel.entry = real(-sign * low);
    panel.perigee = real(rises && ray_.falls ? -(from_perigee_ + low) : -sign * low);
    panel.begin = real(low);
    panel.direction = real(sign);
    panel.lit = lit ? 1.0F : 0.0F;
    SetMap(dark_.Exists() && (rises ? begin == dark_.end : end == dark_.begin), panel);
  }

  [[nodiscard]] double AltitudeAt(double distance) const {
    if (distance == 0.0) return entry_.altitude;
    return std::max(
        shared::AltitudeAlongRay<double>(entry_.altitude, entry_.mu, distance, air_.radius), 0.0);
  }

  void SetMap(bool at_shadow, DirectPanel& panel) const {
    constexpr float kThinning_km = 8.0F;  // approximate e-folding height of all air
    const float rise = at_shadow ? 12.0F : 10.0F;
    const float dense =
        std::max(air_.largest_extinction * std::exp(-panel.altitude / kThinning_km), 1e-20F);
    const float half =
        shared::DistanceUpTo<float>(panel.altitude, panel.from_perigee * panel.inverse_radius,
                                    panel.altitude + rise, static_cast<float>(air_.radius));
    panel.dense = dense;
    panel.hard = dense * std::min(half, panel.length) > 4.0F;
    const float kappa = at_shadow || panel.mu_s < 0.0F ? 3.0F : 2.0F;
    panel.slope = std::min(kappa * std::min(half, 14.0F / dense) / panel.length, 1.0F);
  }

  const DirectAir& air_;
  const Entry& entry_;
  Dark dark_;
  double from_perigee_;  // distance from the entry, along the ray
  DirectRay& ray_;
};

void GroupPanels(DirectMode mode, DirectRay& ray) {
  for (std::size_t i = 0; i < ray.panels;) {
    const bool two = mode == DirectMode::kFast && i + 1 < ray.panels &&
                     !(ray.panel[i].hard || ray.panel[i + 1].hard);
    ray.group[ray.groups++] = {i, two ? i + 1 : i};
    i += two ? 2 : 1;
  }
}

}  // namespace

DirectAir DirectAirOf(const Medium& medium) {
  DirectAir air{};
  const Shell shell{Kilometres(medium.planet_radius_m), Kilometres(medium.atmosphere_height_m)};
  const double share = medium.rayleigh_deficit.share;
  air.radius = shell.radius;
  air.top = shell.top;
  air.has_deficit = share > 0.0;
  air.is_tall = IsTall(shell.top, shell.radius);
  air.deficit_share = static_cast<float>(share);
  air.rayleigh = LayerOf(Kilometres(medium.rayleigh_scale_height_m), 1.0 + share, shell);
  air.deficit = LayerOf(Kilometres(medium.rayleigh_deficit.scale_height_m), share, shell);
  air.mie = LayerOf(Kilometres(medium.mie_scale_height_m), 1.0, shell);
  SetBands(medium, air);
  SetOzone(medium.ozone, air);
  air.reaches_top = DepthAboveTop(medium, air) > 1e-5;
  return air;
}

float DirectPanel::AltitudeAt(float position) const {
  const float climb = position * (position + 2.0F * from_perigee) * inverse_radius;  // 2 r x
  return altitude + climb / (1.0F + std::sqrt(1.0F + climb * inverse_radius));
}

DirectRay DirectRayOf(const DirectAir& air, const ViewRay& ray, DirectMode mode, bool dark) {
  DirectRay placed;
  Entry entry{Kilometres(std::max(ray.altitude_m, 0.0)),
              ray.mu,
              ray.mu_s,
              ray.nu,
              0.0,
              0.0,
              RayEnd::kSpace};
  if (!EnterAir(air, entry)) return placed;
  FindEnd(air, ray.length_m, entry);
  placed.extent = {entry.skipped * kMetresPerKilometre,
                   (entry.skipped + entry.length) * kMetresPerKilometre, entry.end};
  if (!(entry.length > 0.0)) return placed;
  const PanelPlacer placer(air, entry, placed);
  placer.Place(dark);
  placed.narrow = mode == DirectMode::kFast && placer.FitsEightLanes();
  GroupPanels(mode, placed);
  return placed;
}

}  // namespace alpenglow::atmosphere
