// SPDX-License-Identifier: MIT
#include "lut/sky/sky_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/direct_scattering.h"
#include "atmosphere/ray/shell.h"
#include "lut/multiple_scattering/azimuth_fan.h"
#include "lut/multiple_scattering/moment_grid.h"
#include "lut/sky/sky_row_kernel.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {
namespace {

constexpr std::size_t kViewLanes = 4;

/// Returns the weights of the four uniform cubic B-splines that are non-zero at a fraction t of a
/// cell.
std::array<float, 4> SplineWeights(double t) {
  const double s = 1.0 - t;
  const auto weight = [](double six_times) { return static_cast<float>(six_times / 6.0); };
  return {weight(s * s * s), weight(4.0 - 3.0 * t * t * (2.0 - t)),
          weight(4.0 - 3.0 * s * s * (2.0 - s)), weight(t * t * t)};
}

/// Cell and fraction within it, for a coordinate in [0, 1] over n nodes.
struct CellPosition {
  int cell;
  double fraction;
};
CellPosition PositionOf(double coordinate, int n) {
  const double x = std::clamp(coordinate, 0.0, 1.0) * (n - 1);
  const int cell = std::min(static_cast<int>(x), n - 2);
  return {cell, x - cell};
}

/// Memory layout of a line of nodes, each with `width` floats.
struct Line {
  float* first;        // the extra node before the first one
  std::size_t stride;  // floats between neighbours
  std::size_t width;
  int n;  // number of nodes, without the extra node at each end
  [[nodiscard]] float* node(int i) const {
    return first + stride * static_cast<std::size_t>(i + 1);
  }
};

// Solves c[i - 1] + 4 c[i] + c[i + 1] = 6 f[i] for i in [from, to] in place, with c known at
// from - 1 and to + 1 (Thomas' algorithm).
void SolveTridiagonal(const Line& line, int from, int to) {
  if (from > to) return;
  std::vector<float> factor(static_cast<std::size_t>(to - from + 1));
  float last = 0.0F;
  for (int i = from; i <= to; ++i) {
    const float f = 1.0F / (4.0F - last);
    factor[static_cast<std::size_t>(i - from)] = last = f;
    float* c = line.node(i);
    const float* before = line.node(i - 1);
    for (std::size_t k = 0; k < line.width; ++k) c[k] = (6.0F * c[k] - before[k]) * f;
  }
  // In the first equation the known neighbour is subtracted in full. In the others the neighbour is
  // eliminated: c[i - 1] above was already the reduced right side.
  const float* after = line.node(to + 1);
  float* c = line.node(to);
  for (std::size_t k = 0; k < line.width; ++k)
    c[k] -= factor[static_cast<std::size_t>(to - from)] * after[k];
  for (int i = to - 1; i >= from; --i) {
    const float f = factor[static_cast<std::size_t>(i - from)];
    float* here = line.node(i);
    const float* next = line.node(i + 1);
    for (std::size_t k = 0; k < line.width; ++k) here[k] -= f * next[k];
  }
}

// Replaces values by coefficients, with the third derivative continuous at the second node from
// each end ("not a knot"): there c[1] = f[1] - (f[0] - 2 f[1] + f[2]) / 6.
void SplineOpenLine(const Line& line) {
  const int n = line.n;
  for (std::size_t k = 0; k < line.width; ++k) {
    const auto f = [&](int i) { return line.node(i)[k]; };
    const float first = (8.0F * f(1) - f(0) - f(2)) / 6.0F;
    const float last = (8.0F * f(n - 2) - f(n - 1) - f(n - 3)) / 6.0F;
    line.node(-1)[k] = f(1);  // stored for c[0] = 6 f[1] - 4 c[1] - c[2]
    line.node(n)[k] = f(n - 2);
    line.node(1)[k] = first;
    line.node(n - 2)[k] = last;
  }
  SolveTridiagonal(line, 2, n - 3);
  for (std::size_t k = 0; k < line.width; ++k) {
    const auto c = [&](int i) -> float& { return line.node(i)[k]; };
    c(0) = 6.0F * c(-1) - 4.0F * c(1) - c(2);
    c(n - 1) = 6.0F * c(n) - 4.0F * c(n - 2) - c(n - 3);
    c(-1) = 4.0F * c(0) - 6.0F * c(1) + 4.0F * c(2) - c(3);
    c(n) = 4.0F * c(n - 1) - 6.0F * c(n - 2) + 4.0F * c(n - 3) - c(n - 4);
  }
}

// Replaces values by coefficients for a line that continues beyond each end as its mirror image.
void SplineMirroredLine(const Line& line) {
  const int n = line.n;
  std::vector<float> factor(static_cast<std::size_t>(n));
  // The equation is 4 c[0] + 2 c[1] = 6 f[0] at the first end, and correspondingly at the last.
  for (int i = 0; i < n; ++i) {
    const float lower = i == 0 ? 0.0F : i == n - 1 ? 2.0F : 1.0F;
    const float upper = i == 0 ? 2.0F : 1.0F;
    const float before = i == 0 ? 0.0F : factor[static_cast<std::size_t>(i - 1)];
    const float f = 1.0F / (4.0F - lower * before);
    factor[static_cast<std::size_t>(i)] = upper * f;
    float* c = line.node(i);
    const float* left = line.node(i - 1);
    for (std::size_t k = 0; k < line.width; ++k)
      c[k] = (6.0F * c[k] - (i == 0 ? 0.0F : lower * left[k])) * f;
  }
  for (int i = n - 2; i >= 0; --i) {
    float* here = line.node(i);
    const float* next = line.node(i + 1);
    for (std::size_t k = 0; k < line.width; ++k)
      here[k] -= factor[static_cast<std::size_t>(i)] * next[k];
  }
  std::copy_n(line.node(1), line.width, line.node(-1));
  std::copy_n(line.node(n - 2), line.width, line.node(n));
}

constexpr std::size_t kPeakDepths = kSkyPeakTerms - 1;

/// Depths y of the forward peak of one band, between which its light is interpolated; at 0 it is
/// dark. Lagrange's polynomials in y / (y + scale) go through Chebyshev's extrema.
class PeakDepths {
 public:
  /// @param share    f, >= 0.
  /// @param deepest  largest depth; depths beyond it count as it.
  PeakDepths(float share, double deepest) : share_(share), scale_(4.0F / std::max(share, 0.1F)) {
    constexpr double kSmallest = 1e-4;  // products of places are normal numbers
    last_ = PlaceOf(static_cast<float>(std::max(deepest, kSmallest)));
    for (std::size_t k = 0; k < kPeakDepths; ++k) {
      const double turn = kPi * static_cast<double>(k + 1) / static_cast<double>(kPeakDepths);
      place_[k] = last_ * static_cast<float>(0.5 - 0.5 * std::cos(turn));
    }
    for (std::size_t k = 0; k < kPeakDepths; ++k) factor_[k] = 1.0F / Product(place_[k], k);
  }

  /// Returns P of depth k at one angle.
  [[nodiscard]] float LightAt(const PeakAtAngle& peak, std::size_t k) const {
    const float y = scale_ * place_[k] / (1.0F - place_[k]);
    return peak.LightOf(y, share_ * y, 0.0F, 1.0F);
  }

  /// Returns the polynomials at y.
  [[nodiscard]] std::array<float, kPeakDepths> WeightsAt(float y) const {
    const float place = std::min(PlaceOf(y), last_);
    std::array<float, kPeakDepths> weights;
    for (std::size_t k = 0; k < kPeakDepths; ++k) weights[k] = factor_[k] * Product(place, k);
    return weights;
  }

 private:
  [[nodiscard]] float PlaceOf(float y) const { return y / (y + scale_); }

  // Returns the product of distances to 0 and to all nodes but k.
  [[nodiscard]] float Product(float place, std::size_t k) const {
    float product = place;
    for (std::size_t other = 0; other < kPeakDepths; ++other)
      product *= other == k ? 1.0F : place - place_[other];
    return product;
  }

  float share_, scale_, last_ = 0.0F;
  std::array<float, kPeakDepths> place_{}, factor_{};
};

// Returns the depths of every band: up to that of two horizontal paths on the ground, but not
// beyond
// 40 and f y = 20, which is enough in mist (same_light_test).
std::vector<PeakDepths> DepthsFor(const SingleScattering<float>& air, const DeltaM& peak) {
  constexpr double kDeepestAir = 40.0, kDeepestPeak = 20.0;
  const double column_m = double{air.ColumnsToSpace(0.0, 0.0)[1]};
  std::vector<PeakDepths> depths;
  for (std::size_t band = 0; band < air.bands(); ++band) {
    const float share = peak.share(band);
    const double depth = 2.0 * column_m * air.medium().mie_scattering_per_m[band];
    const double most = std::min(kDeepestAir, kDeepestPeak / std::max(double{share}, 1e-3));
    depths.emplace_back(share, std::min(depth, most));
  }
  return depths;
}

/// Terms of aerosol that the tables of phase functions and the nodes of a view share.
struct AerosolTerms {
  std::size_t count;  // 1, kSkyPeakTerms or kSkyLobeTerms
  float glow_column_km;
  std::vector<PeakDepths> depths;  // by band, with a forward peak
};

std::size_t TermsOf(const MultipleScattering& multiple_scattering) {
  const std::optional<DeltaM>& peak = multiple_scattering.peak();
  if (!peak) return 1;
  return peak->HasBackwardLobe() ? kSkyLobeTerms : kSkyPeakTerms;
}

// Returns the phase functions of the terms of aerosol at one angle: of light scattered once, with
// the glow around the sun, or with the forward peak by depth and the backward lobe.
std::vector<Spectrum> PhasesAt(const SingleScattering<float>& air,
                               const MultipleScattering& multiple_scattering,
                               const AerosolTerms& terms, double nu) {
  std::vector<Spectrum> phases(terms.count, air.AerosolPhases(nu));
  const std::optional<DeltaM>& peak = multiple_scattering.peak();
  if (!peak) {
    const Spectrum glow = multiple_scattering.GlowFactor(nu, terms.glow_column_km);
    for (std::size_t band = 0; band < glow.size(); ++band) phases[0][band] += glow[band];
    return phases;
  }
  const std::vector<PeakAtAngle> at = peak->At(nu);
  for (std::size_t band = 0; band < air.bands(); ++band) {
    for (std::size_t k = 0; k < kPeakDepths; ++k)
      phases[k + 1][band] = terms.depths[band].LightAt(at[band], k);
    if (terms.count == kSkyLobeTerms) phases[kSkyPeakTerms][band] = at[band].twice_back();
  }
  return phases;
}

// Returns a table of the phase functions of all terms for every four bands.
std::vector<std::vector<float>> PhaseTables(const SingleScattering<float>& air,
                                            const MultipleScattering& multiple_scattering,
                                            const AerosolTerms& terms) {
  const std::size_t blocks = (air.bands() + kViewLanes - 1) / kViewLanes;
  const std::size_t width = kViewLanes * terms.count;
  std::vector<std::vector<float>> tables(blocks, std::vector<float>(width * (kSkyPhaseNodes + 1)));
  for (std::size_t k = 0; k <= kSkyPhaseNodes; ++k) {
    const double x = static_cast<double>(k) / kSkyPhaseNodes;
    const auto phases = PhasesAt(air, multiple_scattering, terms, std::cos(kPi * x * x));
    for (std::size_t term = 0; term < terms.count; ++term) {
      for (std::size_t lane = 0; lane < blocks * kViewLanes; ++lane) {
        const std::size_t band = std::min(lane, air.bands() - 1);
        tables[lane / kViewLanes][width * k + kViewLanes * term + lane % kViewLanes] =
            phases[term][band];
      }
    }
  }
  return tables;
}

/// Position of an azimuth between columns, with interpolation weights.
struct AzimuthTap {
  std::int32_t cell;
  std::array<float, 4> weights;
  float half_sine2;
};

AzimuthTap TapAt(const SkyViewMap& map, int columns, double azimuth_rad) {
  const double half_turn = std::abs(std::remainder(azimuth_rad, 2.0 * kPi));
  const CellPosition at = PositionOf(map.AzimuthCoordinate(half_turn), columns);
  const double sine = std::sin(0.5 * half_turn);
  return {at.cell, SplineWeights(at.fraction), static_cast<float>(sine * sine)};
}

/// Light reflected upwards by Lambertian ground [1/sr], over the sun's zenith cosines on the
/// visible ground.
class GroundLight {
 public:
  GroundLight(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
              double least_mu_s, double most_mu_s)
      : bands_(air.bands()),
        least_(MultipleScattering::SunCoordinate(least_mu_s)),
        most_(MultipleScattering::SunCoordinate(most_mu_s)),
        nodes_(most_ - least_ < kOneNode ? 4 : kNodes) {
    for (int i = 0; i < nodes_; ++i) {
      const double v = least_ + (most_ - least_) * i / (nodes_ - 1);
      const double mu_s = MultipleScattering::SunNodes().MuS(v);
      Spectrum irradiance = multiple_scattering.SkyIrradiance(0.0, mu_s);
      if (mu_s > 0.0) {
        const Spectrum sun = air.TransmittanceToSpace(0.0, mu_s);
        for (std::size_t band = 0; band < bands_; ++band)
          irradiance[band] += static_cast<float>(mu_s) * sun[band];
      }
      for (std::size_t band = 0; band < bands_; ++band) {
        light_.push_back(irradiance[band] *
                         static_cast<float>(air.medium().ground_albedo[band] / kPi));
      }
    }
  }

  [[nodiscard]] Spectrum At(double mu_s) const {
    const double width = std::max(most_ - least_, 1e-12);
    const CubicTaps taps =
        TapsAt((MultipleScattering::SunCoordinate(mu_s) - least_) / width, nodes_);
    Spectrum light(bands_);
    for (std::size_t tap = 0; tap < 4; ++tap) {
      const float* node = &light_[taps.node[tap] * bands_];
      for (std::size_t band = 0; band < bands_; ++band)
        light[band] += taps.weight[tap] * node[band];
    }
    return light;
  }

 private:
  static constexpr int kNodes = 128;
  static constexpr double kOneNode = 1e-3;  // coordinate range in which light is linear

  std::size_t bands_;
  double least_, most_;
  int nodes_;
  std::vector<float> light_;
};

}  // namespace

float GlowColumn_km(const SingleScattering<float>& air, double altitude_m, double mu_s) {
  constexpr double kHair = 1e-6;  // small offset above the horizon
  const Medium& medium = air.medium();
  if (altitude_m >= medium.atmosphere_height_m) return 0.0F;
  const double h = std::max(altitude_m, 0.0);
  const double horizon = shared::HorizonCosine<double>(
      h / kMetresPerKilometre, medium.planet_radius_m / kMetresPerKilometre);
  return air.ColumnsToSpace(h, std::max(mu_s, horizon + kHair))[1] * 1e-3F;
}

// Returns the smallest size, of those tried for `skylut report`, that has the stated
// error.
SkyViewSize SkyViewSizeFor(const Medium& medium, double altitude_m, double mu_s) {
  constexpr double kHigh_m = 15e3;
  constexpr double kMidday = 0.15;  // sines of the sun's elevation
  constexpr double kDay = 0.1;
  if (altitude_m > medium.atmosphere_height_m) {
    if (mu_s > kMidday) return {40, 28, 25, 14};
    return altitude_m > 1e6 ? SkyViewSize{48, 48, 97, 14} : SkyViewSize{44, 36, 61, 14};
  }
  if (altitude_m > kHigh_m) return {38, 26, 25, 16};
  if (mu_s > kDay) return {28, 16, 13, 12};
  return altitude_m > 2000.0 ? SkyViewSize{36, 24, 25, 16} : SkyViewSize{32, 16, 21, 16};
}

SkyAzimuths::SkyAzimuths(const SkyView& view, std::span<const double> azimuth_rad)
    : columns_(view.size().azimuths) {
  for (const double azimuth : azimuth_rad) {
    const AzimuthTap tap = TapAt(view.map(), columns_, azimuth);
    cell_.push_back(tap.cell);
    weights_.insert(weights_.end(), tap.weights.begin(), tap.weights.end());
    half_sine2_.push_back(tap.half_sine2);
  }
}

/// Evaluates the nodes of a sky view.
class SkyView::Builder {
 public:
  Builder(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
          double altitude_m, double mu_s, const std::vector<PeakDepths>& depths, SkyView& view)
      : air_(air),
        direct_(air.medium()),
        peak_(multiple_scattering.peak()),
        depths_(depths),
        fan_(multiple_scattering),
        altitude_m_(altitude_m),
        mu_s_(std::clamp(mu_s, -1.0, 1.0)),
        view_(view),
        ground_light_(GroundInView(air, multiple_scattering)) {
    for (int k = 0; k < view.size_.azimuths; ++k) {
      cosines_.push_back(
          std::cos(view.map_.Azimuth(static_cast<double>(k) / (view.size_.azimuths - 1))));
    }
  }

  void Fill() {
    const std::size_t columns = Columns();
    const auto rows = static_cast<std::size_t>(view_.size_.sky_rows + view_.size_.ground_rows + 4);
    for (Block& block : view_.blocks_)
      block.coefficients.assign(rows * columns * NodeFloats(), 0.0F);
    for (int i = 0; i < view_.size_.sky_rows; ++i) {
      const double v = static_cast<double>(i) / (view_.size_.sky_rows - 1);
      FillRow(view_.map_.SkyZenithAngle(v), 1 + i, false, i == 0);
    }
    const int ground = view_.size_.sky_rows + 3;
    for (int i = 0; i < view_.size_.ground_rows; ++i) {
      const double v = static_cast<double>(i) / (view_.size_.ground_rows - 1);
      FillRow(view_.map_.GroundZenithAngle(v), ground + i, true, i == 0);
    }
    for (Block& block : view_.blocks_) {
      SplineColumns(block, 0, view_.size_.sky_rows);
      SplineColumns(block, ground - 1, view_.size_.ground_rows);
    }
  }

 private:
  // The visible ground extends to the horizon, at a distance of `dip` along the ground from the
  // observer.
  [[nodiscard]] GroundLight GroundInView(const SingleScattering<float>& air,
                                         const MultipleScattering& multiple_scattering) const {
    const double dip = view_.map_.horizon_zenith_angle_rad() - 0.5 * kPi;
    const double sun = std::acos(mu_s_);
    return {air, multiple_scattering, std::cos(std::min(sun + dip, kPi)),
            std::cos(std::max(sun - dip, 0.0))};
  }

  [[nodiscard]] std::size_t Columns() const {
    return static_cast<std::size_t>(view_.size_.azimuths + 2);
  }
  [[nodiscard]] float* Node(Block& block, int row, int column) const {
    return &block.coefficients[(static_cast<std::size_t>(row) * Columns() +
                                static_cast<std::size_t>(column)) *
                               NodeFloats()];
  }
  [[nodiscard]] std::size_t NodeFloats() const { return SkyNodeFloats(view_.terms_); }

  // The two sides differ on the horizon: the zenith angle of each row there is moved slightly to
  // its own side.
  void FillRow(double zenith_angle, int row, bool ground, bool on_horizon) {
    constexpr double kHair_rad = 1e-9;
    const double angle =
        on_horizon ? zenith_angle + (ground ? kHair_rad : -kHair_rad) : zenith_angle;
    const double mu = std::clamp(std::cos(angle), -1.0, 1.0);
    const double sines = std::sin(angle) * std::sqrt(std::max(1.0 - mu_s_ * mu_s_, 0.0));
    std::vector<float> nus;
    for (const double cosine : cosines_)
      nus.push_back(static_cast<float>(std::clamp(mu * mu_s_ + sines * cosine, -1.0, 1.0)));
    AddOnce(mu, sines, row);
    AddRest(mu, nus, row);
    for (Block& block : view_.blocks_) {
      SplineMirroredLine({Node(block, row, 0), NodeFloats(), NodeFloats(), view_.size_.azimuths});
    }
  }

  void AddOnce(double mu, double sines, int row) {
    for (std::size_t k = 0; k < cosines_.size(); ++k) {
      const double nu = std::clamp(mu * mu_s_ + sines * cosines_[k], -1.0, 1.0);
      const ViewRay ray{altitude_m_, mu, mu_s_, nu};
      if (peak_) {
        AddPeak(air_.Sample(ray, {.nodes = view_.size_.ray_nodes}), row, static_cast<int>(k) + 1);
        continue;
      }
      const ScatteredOnce<float> once = direct_.Scatter(ray, DirectMode::kNormal);
      for (std::size_t band = 0; band < view_.bands_; ++band) {
        float* node = BandOfNode(row, static_cast<int>(k) + 1, band);
        AddMolecules(band, once.rayleigh[band], node);
        node[2 * kViewLanes] = once.mie[band];
      }
    }
  }

  // Returns the coefficient R of a band; those of D and of the terms M follow at every fourth
  // place.
  [[nodiscard]] float* BandOfNode(int row, int column, std::size_t band) const {
    return Node(view_.blocks_[band / kViewLanes], row, column) + band % kViewLanes;
  }

  // Divides the light of molecules into that with Rayleigh's phase function and a uniform rest.
  void AddMolecules(std::size_t band, float light, float* node) const {
    const float round = 10.0F * RayleighChi2(air_.medium(), band);
    node[0] = round * light;
    node[kViewLanes] = (1.0F - round) * static_cast<float>(0.25 / kPi) * light;
  }

  void AddPeak(const RaySamples<float>& samples, int row, int column) {
    const AirConstants<float>& air = air_.constants();
    for (std::size_t band = 0; band < view_.bands_; ++band) {
      float* node = BandOfNode(row, column, band);
      float molecules = 0.0F;
      for (std::size_t i = 0; i < samples.count; ++i) {
        const float lit = samples.weight[i] * samples.lit[i];
        if (!(lit > 0.0F)) continue;
        const float y = air.mie_scattering[band] * (samples.sun_mie[i] + samples.view_mie[i]);
        const float depth = OpticalDepthOf(ExtinctionAt(air, band), FromSunToEye(samples, i));
        const float aerosol = lit * air.mie_scattering[band] * samples.mie_density[i];
        const float spread = std::exp(peak_->share(band) * y - depth);
        molecules += lit * air.rayleigh[band] * samples.rayleigh_density[i] * spread;
        node[2 * kViewLanes] += aerosol * std::exp(-depth);
        const std::array<float, kPeakDepths> weights = depths_[band].WeightsAt(y);
        for (std::size_t k = 0; k < kPeakDepths; ++k)
          node[(3 + k) * kViewLanes] += aerosol * spread * weights[k];
        if (view_.terms_ != kSkyLobeTerms) continue;
        node[(2 + kSkyPeakTerms) * kViewLanes] +=
            aerosol * spread *
            UpFromBelow(air, band, peak_->share(band), SunlitPointOf(samples, i));
      }
      AddMolecules(band, molecules, node);
    }
  }

  // With the sun in the zenith no part of the ray is in the planet's shadow: these samples are
  // valid for every sun.
  void AddRest(double mu, const std::vector<float>& nus, int row) {
    const ViewRay under_zenith_sun{altitude_m_, mu, 1.0, mu};
    const RaySamples<float> samples =
        air_.Sample(under_zenith_sun, {.nodes = view_.size_.ray_nodes, .dark_samples = false});
    const std::vector<float> rest =
        fan_.InscatterAlong(samples, {altitude_m_, mu, mu_s_, 0.0}, nus);
    const bool ground = samples.extent.end == RayEnd::kGround;
    const Spectrum through = ground ? Through(under_zenith_sun, samples) : Spectrum(0);
    const double r = air_.medium().planet_radius_m + std::max(altitude_m_, 0.0);
    for (std::size_t k = 0; k < nus.size(); ++k) {
      Spectrum reflected(view_.bands_);
      if (ground) {
        reflected = ground_light_.At(std::clamp(
            (r * mu_s_ + samples.extent.end_m * double{nus[k]}) / air_.medium().planet_radius_m,
            -1.0, 1.0));
      }
      for (std::size_t band = 0; band < view_.bands_; ++band) {
        BandOfNode(row, static_cast<int>(k) + 1, band)[kViewLanes] +=
            rest[k * view_.bands_ + band] + (ground ? through[band] * reflected[band] : 0.0F);
      }
    }
  }

  // Returns the fraction of the light of the ground that is seen around its true direction.
  [[nodiscard]] Spectrum Through(const ViewRay& ray, const RaySamples<float>& samples) const {
    Spectrum through = air_.TransmittanceAlong(ray);
    if (!peak_) return through;
    const DeltaM::Way way = peak_->WayTo(samples);
    for (std::size_t band = 0; band < through.size(); ++band) through[band] += way.more[band];
    return through;
  }

  void SplineColumns(Block& block, int first_row, int rows) {
    const std::size_t width = Columns() * NodeFloats();
    SplineOpenLine({Node(block, first_row, 0), width, width, rows});
  }

  const SingleScattering<float>& air_;
  DirectScattering direct_;
  const std::optional<DeltaM>& peak_;
  const std::vector<PeakDepths>& depths_;
  AzimuthFan fan_;
  double altitude_m_, mu_s_;
  SkyView& view_;
  GroundLight ground_light_;
  std::vector<double> cosines_;  // cosines of the columns' azimuths
};

SkyView::SkyView(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
                 double altitude_m, double mu_s)
    : SkyView(air, multiple_scattering, altitude_m, mu_s,
              SkyViewSizeFor(air.medium(), altitude_m, mu_s)) {}

SkyView::SkyView(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
                 double altitude_m, double mu_s, const SkyViewSize& size)
    : map_(air.medium(), altitude_m, mu_s),
      size_(size),
      bands_(air.bands()),
      terms_(TermsOf(multiple_scattering)),
      sun_zenith_angle_rad_(std::acos(std::clamp(mu_s, -1.0, 1.0))),
      blocks_((air.bands() + kViewLanes - 1) / kViewLanes) {
  RequireInRange(size.sky_rows, 5, 4096, "sky_rows");
  RequireInRange(size.ground_rows, 5, 4096, "ground_rows");
  RequireInRange(size.azimuths, 3, 4096, "azimuths");
  ALPENGLOW_ENSURE(multiple_scattering.bands(), ==, bands_);
  const std::optional<DeltaM>& peak = multiple_scattering.peak();
  const AerosolTerms terms{terms_, GlowColumn_km(air, altitude_m, mu_s),
                           peak ? DepthsFor(air, *peak) : std::vector<PeakDepths>()};
  auto phases = PhaseTables(air, multiple_scattering, terms);
  for (std::size_t i = 0; i < blocks_.size(); ++i) blocks_[i].phase = std::move(phases[i]);
  Builder(air, multiple_scattering, altitude_m, mu_s, terms.depths, *this).Fill();
}

std::size_t SkyView::bytes() const {
  std::size_t floats = 0;
  for (const Block& block : blocks_) floats += block.coefficients.size() + block.phase.size();
  return floats * sizeof(float);
}

/// Position of a zenith angle between rows, with interpolation weights.
struct SkyView::RowPosition {
  std::size_t first_row;
  std::array<float, 4> weights;
  float offset, scale;  // sin^2 of half the angle to the sun: offset + scale sin^2(azimuth / 2)
};

std::optional<SkyView::RowPosition> SkyView::PositionOfRow(double zenith_angle_rad) const {
  const bool ground = zenith_angle_rad > map_.horizon_zenith_angle_rad();
  if (!ground && map_.sees_upper_edge() && zenith_angle_rad <= map_.upper_edge_zenith_angle_rad())
    return std::nullopt;
  const CellPosition at =
      ground ? PositionOf(map_.GroundCoordinate(zenith_angle_rad), size_.ground_rows)
             : PositionOf(map_.SkyCoordinate(zenith_angle_rad), size_.sky_rows);
  const double sine = std::sin(0.5 * (zenith_angle_rad - sun_zenith_angle_rad_));
  return RowPosition{
      static_cast<std::size_t>(at.cell + (ground ? size_.sky_rows + 2 : 0)),
      SplineWeights(at.fraction), static_cast<float>(sine * sine),
      static_cast<float>(std::sin(zenith_angle_rad) * std::sin(sun_zenith_angle_rad_))};
}

void SkyView::FillRow(double zenith_angle_rad, const SkyAzimuths& azimuths,
                      std::span<float> radiance) const {
  ALPENGLOW_ENSURE(azimuths.columns_, ==, size_.azimuths);
  ALPENGLOW_ENSURE(radiance.size(), ==, azimuths.count() * stride());
  const std::optional<RowPosition> at = PositionOfRow(zenith_angle_rad);
  if (!at) {
    std::fill(radiance.begin(), radiance.end(), 0.0F);
    return;
  }
  const std::size_t node_floats = SkyNodeFloats(terms_);
  const std::size_t width = static_cast<std::size_t>(size_.azimuths + 2) * node_floats;
  std::vector<float> row(width);
  const SkyRowKernel& kernel = Kernel<SkyRowKernel>();
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    kernel.blend({&blocks_[i].coefficients[at->first_row * width], width, width, at->weights.data(),
                  row.data()});
    kernel.fill({terms_, row.data(), blocks_[i].phase.data(), azimuths.cell_.data(),
                 azimuths.weights_.data(), azimuths.half_sine2_.data(), at->offset, at->scale,
                 azimuths.count(), radiance.data() + kViewLanes * i, stride()});
  }
}

// This sums the four nodes of the look-up instead of the whole row.
Spectrum SkyView::Radiance(double zenith_angle_rad, double azimuth_rad) const {
  Spectrum radiance(bands_);
  const std::optional<RowPosition> at = PositionOfRow(zenith_angle_rad);
  if (!at) return radiance;
  const AzimuthTap tap = TapAt(map_, size_.azimuths, azimuth_rad);
  const std::size_t node_floats = SkyNodeFloats(terms_);
  const std::size_t width = static_cast<std::size_t>(size_.azimuths + 2) * node_floats;
  const SkyRowKernel& kernel = Kernel<SkyRowKernel>();
  std::array<float, 4 * SkyNodeFloats(kSkyLobeTerms)> nodes;
  std::array<float, kViewLanes> light;
  constexpr std::int32_t kFirst = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    kernel.blend({&blocks_[i].coefficients[at->first_row * width +
                                           static_cast<std::size_t>(tap.cell) * node_floats],
                  width, 4 * node_floats, at->weights.data(), nodes.data()});
    kernel.fill({terms_, nodes.data(), blocks_[i].phase.data(), &kFirst, tap.weights.data(),
                 &tap.half_sine2, at->offset, at->scale, 1, light.data(), kViewLanes});
    for (std::size_t lane = 0; lane < kViewLanes && kViewLanes * i + lane < bands_; ++lane)
      radiance[kViewLanes * i + lane] = light[lane];
  }
  return radiance;
}

}  // namespace alpenglow::lut
