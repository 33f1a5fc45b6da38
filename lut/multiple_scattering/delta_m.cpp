// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/delta_m.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_text.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::lut {
namespace {

// Highest degree of the forward peak. Beyond it the peak of any dust or haze is narrower than half
// a degree of arc times its share.
constexpr int kLastDegree = 160;

// Number of angles = pi s^2 with s in [0, 1], dense near the peak.
constexpr std::size_t kAngles = 256;
// The glow about the sun fades out from 15 degrees, beyond which higher degrees are only a ripple,
// and ends at this node, at 30 degrees.
constexpr std::size_t kGlowAngles = 104;
constexpr double kGlowFades_rad = 15.0 * kRadiansPerDegree;
// Number of depths y = kDeepest u^2. Light behind larger depths has lost its direction.
constexpr std::size_t kDepths = 32;
constexpr double kDeepest = 40.0;
// For larger depths the glow of this depth is used. Such air is thick and needs a separate forward
// peak.
constexpr float kDeepestGlow = 4.0F;
constexpr std::size_t kGlowDepths = 12;  // depths beyond kDeepestGlow
// Highest degree of the glow. Light of higher degrees that is scattered twice is narrower than two
// degrees.
constexpr int kLastGlowDegree = 96;

double AngleAt(std::size_t i) {
  const double s = static_cast<double>(i) / static_cast<double>(kAngles - 1);
  return kPi * s * s;
}

double DepthAt(std::size_t i) {
  const double u = static_cast<double>(i) / static_cast<double>(kDepths - 1);
  return kDeepest * u * u;
}

// Returns exp(-y) [(exp(chi y) - 1) / y - chi].
double HigherOrders(double chi, double y) {
  if (y * std::abs(chi) < 1e-4) return 0.5 * chi * chi * y * std::exp(-y);
  return (std::exp((chi - 1.0) * y) - std::exp(-y)) / y - chi * std::exp(-y);
}

// Returns the columns on the path of sunlight that is scattered once at a sample.
ColumnSet<float> FromSunToEye(const RaySamples<float>& samples, std::size_t i) {
  return {samples.view_rayleigh[i] + samples.sun_rayleigh[i],
          samples.view_mie[i] + samples.sun_mie[i], samples.view_ozone[i] + samples.sun_ozone[i]};
}

// Returns exp(-depth) (exp(peak) - 1) for peak < depth without cancellation or overflow.
float Gain(float peak, float depth) {
  if (peak < 1.0F) return std::exp(-depth) * std::expm1(peak);
  return std::exp(peak - depth) - std::exp(-depth);
}

/// Position of a value between the nodes of a table.
struct Place {
  std::size_t cell;
  float share;
};

Place PlaceOfAngle(double nu) {
  const double s = std::sqrt(std::acos(std::clamp(nu, -1.0, 1.0)) / kPi);
  const double at = s * static_cast<double>(kAngles - 1);
  const auto cell = std::min(static_cast<std::size_t>(at), kAngles - 2);
  return {cell, static_cast<float>(at - static_cast<double>(cell))};
}

Place PlaceOfDepth(float y) {
  constexpr auto kLast = static_cast<float>(kDepths - 1);
  constexpr float kScale = kLast * kLast / static_cast<float>(kDeepest);
  const float squared = std::min(y * kScale, kLast * kLast);
  const auto cell = std::min(static_cast<std::size_t>(std::sqrt(squared)), kDepths - 2);
  const auto low = static_cast<float>(cell);
  return {cell, (squared - low * low) / (2.0F * low + 1.0F)};
}

/// Part of a shape that is filled; the rest is 0.
struct ShapeSize {
  int last_degree;
  std::size_t angles, depths;
};

PeakShape ShapeOf(const PhaseFunction& phase, int degree, const ShapeSize& size) {
  const std::vector<double> chi = LegendreCoefficients(phase, size.last_degree);
  const auto first = static_cast<std::size_t>(degree) + 1;
  std::vector<std::array<double, kDepths>> above(chi.size());
  for (std::size_t l = first; l < chi.size(); ++l) {
    for (std::size_t y = 0; y < size.depths; ++y) above[l][y] = HigherOrders(chi[l], DepthAt(y));
  }
  PeakShape shape{std::vector<float>(kAngles), std::vector<float>(kAngles * kDepths)};
  for (std::size_t angle = 0; angle < size.angles; ++angle) {
    const std::vector<double> series = LegendreSeries(size.last_degree, std::cos(AngleAt(angle)));
    double low = 0.0;
    for (std::size_t l = 0; l < first; ++l) low += series[l] * chi[l];
    std::array<double, kDepths> high{};
    for (std::size_t l = first; l < chi.size(); ++l) {
      for (std::size_t y = 0; y < size.depths; ++y) high[y] += series[l] * above[l][y];
    }
    shape.low[angle] = static_cast<float>(low);
    for (std::size_t y = 0; y < size.depths; ++y)
      shape.high[angle * kDepths + y] = static_cast<float>(high[y]);
  }
  return shape;
}

// Returns the light of higher degrees at one angle, for all depths.
std::array<float, kDepths> HighAt(const PeakShape& shape, const Place& angle) {
  std::array<float, kDepths> high;
  for (std::size_t y = 0; y < kDepths; ++y) {
    const float low = shape.high[angle.cell * kDepths + y];
    high[y] = low + angle.share * (shape.high[(angle.cell + 1) * kDepths + y] - low);
  }
  return high;
}

}  // namespace

DeltaScaledMedium WithoutPeak(const Medium& medium, int degree) {
  const std::size_t bands = medium.wavelengths_nm.size();
  const auto last = static_cast<std::size_t>(degree) + 1;
  DeltaScaledMedium air{medium, {}, MieLegendreCoefficients(medium, degree + 1)};
  for (std::size_t band = 0; band < bands; ++band) {
    const double share = std::max(air.chi[last * bands + band], 0.0);
    const double peak_per_m = share * medium.mie_scattering_per_m[band];
    air.share.push_back(share);
    air.medium.mie_scattering_per_m[band] -= peak_per_m;
    air.medium.mie_extinction_per_m[band] -= peak_per_m;
    for (std::size_t l = 0; l <= last; ++l) {
      double& chi = air.chi[l * bands + band];
      chi = (chi - share) / (1.0 - share);
    }
  }
  return air;
}

namespace {

float GlowShare(std::size_t angle) {
  const double end = AngleAt(kGlowAngles);
  const double x = std::clamp((end - AngleAt(angle)) / (end - kGlowFades_rad), 0.0, 1.0);
  return static_cast<float>(x * x * (3.0 - 2.0 * x));
}

PeakShape GlowOf(const PhaseFunction& phase, int degree) {
  PeakShape shape = ShapeOf(phase, degree, {kLastGlowDegree, kGlowAngles, kGlowDepths});
  for (std::size_t angle = 0; angle < kGlowAngles; ++angle) {
    for (std::size_t y = 0; y < kGlowDepths; ++y)
      shape.high[angle * kDepths + y] *= GlowShare(angle);
  }
  return shape;
}

}  // namespace

GlowAboutTheSun::GlowAboutTheSun(const Medium& medium, int degree) {
  for (const double per_m : medium.mie_scattering_per_m)
    scattering_per_km_.push_back(static_cast<float>(1000.0 * per_m));
  for (const PhaseFunction& phase : medium.mie_phase) shapes_.push_back(GlowOf(phase, degree));
}

bool GlowAboutTheSun::Reaches(double nu) {
  static const double cosine = std::cos(AngleAt(kGlowAngles));
  return nu > cosine;
}

Bands<float> GlowAboutTheSun::FactorOf(double nu, float column_km) const {
  Bands<float> factor(scattering_per_km_.size());
  if (!Reaches(nu)) return factor;
  const Place angle = PlaceOfAngle(nu);
  for (std::size_t band = 0; band < factor.count; ++band) {
    const PeakShape& shape = shapes_[shapes_.size() > 1 ? band : 0];
    const float y = std::min(scattering_per_km_[band] * column_km, kDeepestGlow);
    const Place place = PlaceOfDepth(y);
    const auto at = [&](std::size_t depth) {
      const float* high = &shape.high[angle.cell * kDepths + depth];
      return high[0] + angle.share * (high[kDepths] - high[0]);
    };
    const float low = at(place.cell);
    factor[band] = std::exp(y) * (low + place.share * (at(place.cell + 1) - low));
  }
  return factor;
}

DeltaM::DeltaM(const Medium& medium, int degree) : air_(medium), degree_(degree) {
  const std::vector<double> share = WithoutPeak(medium, degree).share;
  share_.assign(share.begin(), share.end());
  for (const PhaseFunction& phase : medium.mie_phase)
    shapes_.push_back(ShapeOf(phase, degree, {kLastDegree, kAngles, kDepths}));
}

Bands<float> DeltaM::Beam(double altitude_m, double mu_s) const {
  const Medium& medium = air_.medium();
  const RayExtent extent =
      ExtentOf({altitude_m, mu_s, 1.0, 1.0}, medium.planet_radius_m, medium.atmosphere_height_m);
  if (extent.end == RayEnd::kGround || altitude_m >= medium.atmosphere_height_m)
    return Bands<float>(air_.bands());
  const std::array<float, 3> columns_m = air_.ColumnsToSpace(altitude_m, mu_s);
  const auto km = [&](std::size_t i) { return 1e-3F * columns_m[i]; };
  Bands<float> beam(air_.bands());
  for (std::size_t band = 0; band < beam.count; ++band) {
    const float depth = OpticalDepthOf(ExtinctionAt(air_.constants(), band), {km(0), km(1), km(2)});
    beam[band] = Gain(share_[band] * air_.constants().mie_scattering[band] * km(1), depth);
  }
  return beam;
}

float DeltaM::SumAlong(std::size_t band, const RaySamples<float>& samples, double nu, float ahead,
                       float base) const {
  const AirConstants<float>& air = air_.constants();
  const Place angle = PlaceOfAngle(nu);
  const PeakShape& shape = shapes_[shapes_.size() > 1 ? band : 0];
  const float low =
      shape.low[angle.cell] + angle.share * (shape.low[angle.cell + 1] - shape.low[angle.cell]);
  const std::array<float, kDepths> high = HighAt(shape, angle);
  const std::vector<double> series = LegendreSeries(degree_, nu);
  const auto narrow = static_cast<float>(std::accumulate(series.begin(), series.end(), 0.0));
  const auto gas =
      static_cast<float>(shared::PhaseMolecules(nu, Depolarisation(air_.medium(), band))) *
      air.rayleigh[band];
  const float mie = air.mie_scattering[band], f = share_[band];
  // Returns the formula minus its value at y = 0, times exp(-depth).
  const auto formula = [&](float y, float depth, float of_gas, float of_aerosol) {
    const float clear = std::exp(-depth), more = Gain(f * y, depth);
    const float once = (y > 1e-4F ? more / y : f * clear) - f * (clear + more);
    const Place place = PlaceOfDepth(y);
    const float above = high[place.cell] + place.share * (high[place.cell + 1] - high[place.cell]);
    return more * (of_gas + of_aerosol * low) + once * of_aerosol * narrow +
           std::exp(y - depth) * of_aerosol * above;
  };
  float sum = 0.0F;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const float lit = samples.weight[i] * samples.lit[i];
    if (!(lit > 0.0F)) continue;
    const float y = mie * (samples.sun_mie[i] + samples.view_mie[i]);
    const float depth = OpticalDepthOf(ExtinctionAt(air, band), FromSunToEye(samples, i));
    const float of_gas = gas * samples.rayleigh_density[i];
    const float of_aerosol = mie * samples.mie_density[i];
    sum += lit * formula(y + ahead, depth, of_gas, of_aerosol);
    if (base != 0.0F) sum -= lit * formula(base * y, depth, of_gas, of_aerosol);
  }
  return sum;
}

Bands<float> DeltaM::Along(const RaySamples<float>& samples, double nu) const {
  Bands<float> light(air_.bands());
  for (std::size_t band = 0; band < light.count; ++band)
    light[band] = SumAlong(band, samples, nu, 0.0F, 0.0F);
  return light;
}

Bands<float> DeltaM::Behind(const Way& way, const RaySamples<float>& samples, double nu) const {
  Bands<float> light(air_.bands());
  for (std::size_t band = 0; band < light.count; ++band)
    light[band] = way.clear[band] * SumAlong(band, samples, nu, way.scattering[band], 1.0F);
  return light;
}

DeltaM::Way DeltaM::WayTo(const RaySamples<float>& samples) const {
  const AirConstants<float>& air = air_.constants();
  float rayleigh = 0.0F, mie = 0.0F;
  for (std::size_t i = 0; i < samples.count; ++i) {
    rayleigh += samples.weight[i] * samples.rayleigh_density[i];
    mie += samples.weight[i] * samples.mie_density[i];
  }
  const float ozone = samples.count > 0 ? samples.view_ozone[samples.count - 1] : 0.0F;
  const Bands<float> none(air_.bands());
  Way way{none, none, none};
  for (std::size_t band = 0; band < none.count; ++band) {
    const float depth = OpticalDepthOf(ExtinctionAt(air, band), {rayleigh, mie, ozone});
    way.clear[band] = std::exp(-depth);
    way.scattering[band] = air.mie_scattering[band] * mie;
    way.more[band] = Gain(share_[band] * way.scattering[band], depth);
  }
  return way;
}

namespace {

// Highest degree of the estimate. Beyond it the peak of any dust or haze is narrower than half a
// degree of arc times its share.
constexpr int kLastMissingDegree = 64;

// Returns P_l(nu) for l = 0 ... kLastMissingDegree.
std::vector<double> LegendreValues(double nu) {
  std::vector<double> values{1.0, nu};
  for (int l = 1; l < kLastMissingDegree; ++l) {
    const auto i = static_cast<std::size_t>(l);
    values.push_back(((2.0 * l + 1.0) * nu * values[i] - l * values[i - 1]) / (l + 1.0));
  }
  return values;
}

// Returns an upper bound of |P_l(cos theta)|: the smaller of 1 and sqrt(2 / (pi (l + 1/2) sin
// theta)) (Bernstein).
double Envelope(int l, double nu) {
  const double sine = std::sqrt(std::max(1.0 - nu * nu, 1e-12));
  return std::min(1.0, std::sqrt(2.0 / (kPi * (l + 0.5) * sine)));
}

}  // namespace

TruncationError::TruncationError(const Medium& medium, int degree)
    : bands_(medium.wavelengths_nm.size()),
      degree_(degree),
      chi_(MieLegendreCoefficients(medium, kLastMissingDegree)) {}

std::vector<double> TruncationError::Along(const AirConstants<float>& air,
                                           const RaySamples<float>& samples, double nu) const {
  std::vector<double> legendre = LegendreValues(nu);
  legendre.push_back(Envelope(degree_ + 1, nu));
  std::vector<double> light;
  for (std::size_t band = 0; band < bands_; ++band)
    light.push_back(AlongBand(air, band, samples, legendre));
  return light;
}

double TruncationError::AlongBand(const AirConstants<float>& air, std::size_t band,
                                  const RaySamples<float>& samples,
                                  const std::vector<double>& legendre) const {
  const double scattering = static_cast<double>(air.mie_scattering[band]);
  if (scattering == 0.0) return 0.0;
  double sum = 0.0, envelope = 0.0;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const float depth = OpticalDepthOf(ExtinctionAt(air, band), FromSunToEye(samples, i));
    const double light = static_cast<double>(samples.weight[i] * samples.lit[i] *
                                             samples.mie_density[i] * std::exp(-depth)) *
                         scattering;
    if (!(light > 0.0)) continue;
    const double tau = scattering * static_cast<double>(samples.view_mie[i] + samples.sun_mie[i]);
    for (int l = degree_ + 1; l <= kLastMissingDegree; ++l) {
      const auto at = static_cast<std::size_t>(l);
      const double chi = chi_[at * bands_ + band];
      const double part = light * (2.0 * l + 1.0) / (4.0 * kPi) * chi * std::expm1(chi * tau);
      sum += part * legendre[at];
      if (l == degree_ + 1) envelope += std::abs(part) * legendre.back();
    }
  }
  return std::abs(sum) + envelope;
}

}  // namespace alpenglow::lut
