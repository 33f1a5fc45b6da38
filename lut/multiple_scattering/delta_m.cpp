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

// The forward peak has as many degrees as it takes until its coefficients are this small. Light
// that is scattered twice has their squares. A peak with more than kMostDegrees is narrower than
// 0.02 degrees, a thirtieth of the sun's disk; its last degrees fade out, and its tip with them.
constexpr double kNegligible = 5e-3;
// A backward lobe is narrow if its coefficient of the first degree that is not kept is this large.
constexpr double kNarrowBackward = 0.03;
constexpr int kFewestDegrees = 160;
constexpr int kMostDegrees = 8192;

// Number of angles = pi s^2 with s in [0, 1], dense near the peak.
constexpr std::size_t kAngles = 256;
// The glow about the sun fades out from 15 degrees, beyond which higher degrees are only a ripple,
// and ends at this node, at 30 degrees.
constexpr std::size_t kGlowAngles = 104;
constexpr double kGlowFades_rad = 15.0 * kRadiansPerDegree;
// Number of depths of the peak, and how many times the depth over which delta-M scaled air scatters
// the largest of them is. Hardly any light passes through more.
constexpr std::size_t kDepths = kPeakShapeDepths;
constexpr double kDeepest = 16.0;
constexpr double kDeepestOfAll = 4000.0;
// The glow belongs to thin air. For larger depths the glow of this depth is used.
constexpr double kDeepestGlow = 4.0;
constexpr std::size_t kGlowDepths = 24;
// Highest degree of the glow. OptionsFor (multiple_scattering.h) treats air separately whose
// aerosol has much light in higher degrees.
constexpr int kLastGlowDegree = 96;

double AngleAt(std::size_t i) {
  const double s = static_cast<double>(i) / static_cast<double>(kAngles - 1);
  return kPi * s * s;
}

// Returns exp(-rate y) [(exp(chi y) - 1) / y - chi].
double HigherOrders(double chi, double y, double rate) {
  if (y * std::abs(chi) < 1e-4) return 0.5 * chi * chi * y * std::exp(-rate * y);
  return (std::exp((chi - rate) * y) - std::exp(-rate * y)) / y - chi * std::exp(-rate * y);
}

// Returns exp(-rate y) [(chi - share) exp(share y) + (exp(share y) - 1) / y - chi].
double LowOrders(double chi, double share, double y, double rate) {
  return HigherOrders(share, y, rate) + (chi - share) * std::exp(-rate * y) * std::expm1(share * y);
}

// Returns the part of the backward lobe that is blurred at a degree up to `last`, the first that is
// not kept.
double BlurOf(std::size_t l, std::size_t last) {
  const double x = std::min(static_cast<double>(l) / static_cast<double>(last), 1.0);
  return 1.0 - (1.0 - x * x) * (1.0 - x * x);
}

// Returns (-1)^l, the value of P_l at -1.
double SignOf(std::size_t l) { return l % 2 == 0 ? 1.0 : -1.0; }

/// Halves of a phase function: (1 + x) / 2 and (1 - x) / 2 times it. Only the forward half has a
/// forward peak.
enum class Half { kForward, kBackward };

// Returns the coefficient of degree l of a half of a phase function, from three of its own:
// (2 l + 1) x P_l = (l + 1) P_{l+1} + l P_{l-1}. The backward half is mirrored, so that the
// coefficients of a backward lobe are positive.
double HalfOf(Half half, std::size_t l, double before, double chi, double after) {
  const auto degree = static_cast<double>(l);
  const double times_x = (degree * before + (degree + 1.0) * after) / (2.0 * degree + 1.0);
  return half == Half::kForward ? 0.5 * (chi + times_x) : 0.5 * SignOf(l) * (chi - times_x);
}

// Returns exp(-depth) (exp(peak) - 1) for peak <= depth without cancellation or overflow.
float Gain(float peak, float depth) {
  if (peak < 1.0F) return std::exp(-depth) * std::expm1(peak);
  return std::exp(peak - depth) - std::exp(-depth);
}

/// Position of a value between the nodes of a table.
struct TablePosition {
  std::size_t cell;
  float share;
};

TablePosition PlaceOfAngle(double nu) {
  const double s = std::sqrt(std::acos(std::clamp(nu, -1.0, 1.0)) / kPi);
  const double at = s * static_cast<double>(kAngles - 1);
  const auto cell = std::min(static_cast<std::size_t>(at), kAngles - 2);
  return {cell, static_cast<float>(at - static_cast<double>(cell))};
}

TablePosition PlaceOfDepth(const PeakShape& shape, float y) {
  const std::size_t last = shape.depth.size() - 1;
  const auto at = static_cast<std::size_t>(shape.depths_a_log * std::log1p(y));
  const std::size_t cell = std::min(at, last - 1);
  const float share = (y - shape.depth[cell]) / (shape.depth[cell + 1] - shape.depth[cell]);
  return {cell, std::clamp(share, 0.0F, 1.0F)};
}

/// The nodes of a shape. Beyond `angles` the shape is 0.
struct ShapeNodes {
  std::size_t angles, depths;
  double deepest;
};

// Returns a shape without light, with depths uniform in log(1 + y).
PeakShape ShapeAt(const ShapeNodes& nodes, double rate) {
  const double unit = static_cast<double>(nodes.depths - 1) / std::log1p(nodes.deepest);
  PeakShape shape{.rate = static_cast<float>(rate),
                  .depths_a_log = static_cast<float>(unit),
                  .depth = {},
                  .high = std::vector<float>(kAngles * nodes.depths),
                  .twice_back = {},
                  .blurred_back = {}};
  for (std::size_t i = 0; i < nodes.depths; ++i)
    shape.depth.push_back(static_cast<float>(std::expm1(static_cast<double>(i) / unit)));
  return shape;
}

// Fills the light by depth at the first angles: the sum over degrees of light_of(degree, y).
template <typename Light>
void FillHigh(std::size_t degrees, std::size_t angles, const Light& light_of, PeakShape& shape) {
  const std::size_t depths = shape.depth.size();
  std::vector<double> light(degrees * depths);
  for (std::size_t l = 0; l < degrees; ++l) {
    for (std::size_t y = 0; y < depths; ++y)
      light[l * depths + y] = light_of(l, static_cast<double>(shape.depth[y]));
  }
  for (std::size_t angle = 0; angle < angles; ++angle) {
    const std::vector<double> series =
        LegendreSeries(static_cast<int>(degrees) - 1, std::cos(AngleAt(angle)));
    std::vector<double> sum(depths);
    for (std::size_t l = 0; l < degrees; ++l) {
      for (std::size_t y = 0; y < depths; ++y) sum[y] += series[l] * light[l * depths + y];
    }
    std::transform(sum.begin(), sum.end(), &shape.high[angle * depths],
                   [](double value) { return static_cast<float>(value); });
  }
}

// Returns the series with these coefficients at every angle.
std::vector<float> SeriesAtAngles(const std::vector<double>& coefficients) {
  std::vector<float> values;
  for (std::size_t angle = 0; angle < kAngles; ++angle) {
    const std::vector<double> series =
        LegendreSeries(static_cast<int>(coefficients.size()) - 1, std::cos(AngleAt(angle)));
    values.push_back(static_cast<float>(
        std::inner_product(series.begin(), series.end(), coefficients.begin(), 0.0)));
  }
  return values;
}

std::vector<double> CoefficientsOf(Half half, const PhaseFunction& phase, int degree) {
  const std::vector<double> chi = LegendreCoefficients(phase, degree + 1);
  std::vector<double> coefficients;
  for (std::size_t l = 0; l + 1 < chi.size(); ++l)
    coefficients.push_back(HalfOf(half, l, l > 0 ? chi[l - 1] : 0.0, chi[l], chi[l + 1]));
  return coefficients;
}

bool EndsSmall(const std::vector<double>& chi) {
  constexpr std::ptrdiff_t kLast = 16;  // one coefficient can be small by chance
  return std::all_of(chi.end() - kLast, chi.end(),
                     [](double value) { return std::abs(value) < kNegligible; });
}

// Returns the coefficients of a half up to the degree where they become negligible.
std::vector<double> AllCoefficientsOf(Half half, const PhaseFunction& phase) {
  int degree = kFewestDegrees;
  std::vector<double> chi = CoefficientsOf(half, phase, degree);
  while (!EndsSmall(chi) && degree < kMostDegrees) {
    degree = std::min(2 * degree, kMostDegrees);
    chi = CoefficientsOf(half, phase, degree);
  }
  if (EndsSmall(chi)) return chi;
  for (std::size_t l = chi.size() / 2; l < chi.size(); ++l) {
    const double x = 2.0 * static_cast<double>(l) / static_cast<double>(chi.size()) - 1.0;
    chi[l] *= (1.0 - x * x) * (1.0 - x * x);
  }
  return chi;
}

/// Coefficients of a narrow backward lobe; all are 0 without one.
struct BackwardLobe {
  std::vector<double> chi;   // of the backward half
  std::vector<double> kept;  // by the moments, which blur it
};

BackwardLobe BackwardLobeOf(const PhaseFunction& phase, std::size_t first) {
  BackwardLobe lobe{AllCoefficientsOf(Half::kBackward, phase), {}};
  const double cut = lobe.chi[first];
  if (cut < kNarrowBackward) return {};
  lobe.kept.resize(lobe.chi.size());
  for (std::size_t l = 0; l < first; ++l) lobe.kept[l] = lobe.chi[l] - cut * BlurOf(l, first);
  return lobe;
}

// Fills the light that a narrow backward lobe scatters twice, once up and once down again: what
// moments with the blurred lobe lack, and what they hold.
void FillTwiceBack(const BackwardLobe& lobe, PeakShape& shape) {
  if (lobe.chi.empty()) return;
  std::vector<double> lacking, kept;
  for (std::size_t l = 0; l < lobe.chi.size(); ++l) {
    kept.push_back(lobe.kept[l] * lobe.kept[l]);
    lacking.push_back(lobe.chi[l] * lobe.chi[l] - kept[l]);
  }
  shape.twice_back = SeriesAtAngles(lacking);
  shape.blurred_back = SeriesAtAngles(kept);
}

// Returns the shape of the peak of air that is scaled to this degree.
PeakShape ScaledShapeOf(const PhaseFunction& phase, int degree) {
  std::vector<double> chi = AllCoefficientsOf(Half::kForward, phase);
  const auto first = static_cast<std::size_t>(degree) + 1;
  const BackwardLobe lobe = BackwardLobeOf(phase, first);
  chi.resize(std::max(chi.size(), lobe.chi.size()), 0.0);
  const double share = std::max(chi[first], 0.0);
  const double rate = std::max(*std::max_element(chi.begin() + degree + 1, chi.end()), 0.0);
  PeakShape shape =
      ShapeAt({kAngles, kDepths, std::min(kDeepest / (1.0 - rate), kDeepestOfAll)}, rate);
  const auto light_of = [&](std::size_t l, double y) {
    const double forward =
        l < first ? LowOrders(chi[l], share, y, rate) : HigherOrders(chi[l], y, rate);
    if (l >= lobe.chi.size()) return forward;
    return forward + SignOf(l) * (lobe.chi[l] - lobe.kept[l]) *
                         (std::exp((chi[l] - rate) * y) - std::exp((share - rate) * y));
  };
  FillHigh(chi.size(), kAngles, light_of, shape);
  FillTwiceBack(lobe, shape);
  return shape;
}

/// Position between the nodes of a table of angles, for cubic interpolation.
struct AngleTaps {
  std::array<std::size_t, 4> node;
  std::array<float, 4> weight;

  /// Returns the value of column `at` of a table with rows of `stride`.
  [[nodiscard]] float Of(const std::vector<float>& table, std::size_t stride,
                         std::size_t at) const {
    float sum = 0.0F;
    for (std::size_t tap = 0; tap < 4; ++tap) sum += weight[tap] * table[node[tap] * stride + at];
    return sum;
  }
};

AngleTaps TapsOfAngle(double nu) {
  const auto [cell, t] = PlaceOfAngle(nu);
  const float u = 1.0F - t;
  return {{cell > 0 ? cell - 1 : 0, cell, cell + 1, std::min(cell + 2, kAngles - 1)},
          {-0.5F * t * u * u, u * (1.0F + t - 1.5F * t * t), t * (1.0F + u - 1.5F * u * u),
           -0.5F * u * t * t}};
}

float GlowShare(std::size_t angle) {
  const double end = AngleAt(kGlowAngles);
  const double x = std::clamp((end - AngleAt(angle)) / (end - kGlowFades_rad), 0.0, 1.0);
  return static_cast<float>(x * x * (3.0 - 2.0 * x));
}

PeakShape GlowOf(const PhaseFunction& phase, int degree) {
  const std::vector<double> chi = LegendreCoefficients(phase, kLastGlowDegree);
  PeakShape shape = ShapeAt({kGlowAngles, kGlowDepths, kDeepestGlow}, 1.0);
  FillHigh(
      chi.size(), kGlowAngles,
      [&](std::size_t l, double y) {
        return l <= static_cast<std::size_t>(degree) ? 0.0 : HigherOrders(chi[l], y, 1.0);
      },
      shape);
  for (std::size_t angle = 0; angle < kGlowAngles; ++angle) {
    for (std::size_t y = 0; y < kGlowDepths; ++y)
      shape.high[angle * kGlowDepths + y] *= GlowShare(angle);
  }
  return shape;
}

// Returns the column [km] below a point of density `density` in the direction from the sun, down to
// the ground, of a gas of this scale height; those of two gases are as their scale heights.
float ColumnBelow(float density, float sun_column, float otherwise) {
  constexpr float kLeastDensity = 1e-20F;  // quotients of smaller densities are not accurate
  return density < kLeastDensity ? otherwise : std::max(sun_column * (1.0F / density - 1.0F), 0.0F);
}

// Highest degree of the estimate. OptionsFor (multiple_scattering.h) treats air separately whose
// aerosol has much light in higher degrees.
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

DeltaScaledMedium WithoutPeak(const Medium& medium, int degree) {
  const std::size_t bands = medium.wavelengths_nm.size();
  const auto last = static_cast<std::size_t>(degree) + 1;
  DeltaScaledMedium air{medium, {}, MieLegendreCoefficients(medium, degree + 2)};
  for (std::size_t band = 0; band < bands; ++band) {
    const auto chi_of = [&](std::size_t l) { return air.chi[l * bands + band]; };
    const auto half_of = [&](Half half) {
      return std::max(HalfOf(half, last, chi_of(last - 1), chi_of(last), chi_of(last + 1)), 0.0);
    };
    const double share = half_of(Half::kForward);
    double backward = half_of(Half::kBackward);
    if (backward < kNarrowBackward) backward = 0.0;
    const double peak_per_m = share * medium.mie_scattering_per_m[band];
    air.share.push_back(share);
    air.medium.mie_scattering_per_m[band] -= peak_per_m;
    air.medium.mie_extinction_per_m[band] -= peak_per_m;
    for (std::size_t l = 0; l <= last + 1; ++l) {
      double& chi = air.chi[l * bands + band];
      chi = (chi - SignOf(l) * BlurOf(l, last) * backward - share) / (1.0 - share);
    }
  }
  return air;
}

GlowAboutTheSun::GlowAboutTheSun(const Medium& medium, int degree) {
  for (const double per_m : medium.mie_scattering_per_m)
    scattering_per_km_.push_back(static_cast<float>(1000.0 * per_m));
  for (const PhaseFunction& phase : medium.mie_phase) shapes_.push_back(GlowOf(phase, degree));
}

bool GlowAboutTheSun::Reaches(double nu) {
  static const double cosine = std::cos(AngleAt(kGlowAngles));
  return nu > cosine;
}

Spectrum GlowAboutTheSun::FactorOf(double nu, float column_km) const {
  Spectrum factor(scattering_per_km_.size());
  if (!Reaches(nu)) return factor;
  const TablePosition angle = PlaceOfAngle(nu);
  for (std::size_t band = 0; band < factor.size(); ++band) {
    const PeakShape& shape = shapes_[shapes_.size() > 1 ? band : 0];
    const float y = std::min(scattering_per_km_[band] * column_km, shape.depth.back());
    const TablePosition place = PlaceOfDepth(shape, y);
    const auto at = [&](std::size_t depth) {
      const float* high = &shape.high[angle.cell * kGlowDepths + depth];
      return high[0] + angle.share * (high[kGlowDepths] - high[0]);
    };
    const float low = at(place.cell);
    factor[band] = std::exp(y) * (low + place.share * (at(place.cell + 1) - low));
  }
  return factor;
}

ScaledBeam::ScaledBeam(const Medium& medium, int degree) : air_(medium) {
  const std::vector<double> share = WithoutPeak(medium, degree).share;
  share_.assign(share.begin(), share.end());
}

DeltaM::DeltaM(const Medium& medium, int degree) : beam_(medium, degree) {
  for (const PhaseFunction& phase : medium.mie_phase)
    shapes_.push_back(ScaledShapeOf(phase, degree));
}

Spectrum ScaledBeam::At(double height_m, double mu_s) const {
  const Medium& medium = air_.medium();
  const double altitude_m = std::max(height_m, 0.0);
  const RayExtent extent =
      ExtentOf({altitude_m, mu_s, 1.0, 1.0}, medium.planet_radius_m, medium.atmosphere_height_m);
  if (extent.end == RayEnd::kGround || altitude_m >= medium.atmosphere_height_m)
    return Spectrum(air_.bands());
  const std::array<float, 3> columns_m = air_.ColumnsToSpace(altitude_m, mu_s);
  const auto km = [&](std::size_t i) { return 1e-3F * columns_m[i]; };
  Spectrum beam(air_.bands());
  for (std::size_t band = 0; band < beam.size(); ++band) {
    const float depth = OpticalDepthOf(ExtinctionAt(air_.constants(), band), {km(0), km(1), km(2)});
    beam[band] = Gain(share_[band] * air_.constants().mie_scattering[band] * km(1), depth);
  }
  return beam;
}

float UpFromBelow(const AirConstants<float>& air, std::size_t band, float share,
                  const SunlitPoint& point) {
  constexpr float kLeastAerosol = 1e-6F;
  if (point.mie_density < kLeastAerosol) return 0.0F;
  const float slant = point.sun_mie / (point.mie_density * air.mie_height);
  const float aerosol = ColumnBelow(point.mie_density, point.sun_mie, 0.0F);
  const float gas =
      ColumnBelow(point.rayleigh_density, point.sun_rayleigh, slant * air.rayleigh_height);
  const float scattering = air.mie_scattering[band] * aerosol;
  const float extinction =
      air.mie_extinction[band] * aerosol - share * scattering + air.rayleigh[band] * gas;
  if (extinction < 1e-4F) return scattering;
  return -0.5F * std::expm1(-2.0F * extinction) * scattering / extinction;
}

PeakAtAngle::PeakAtAngle(const PeakShape& shape, double nu, float share, float phase)
    : shape_(&shape), share_(share), back_(0.5F * static_cast<float>(1.0 - nu) * phase) {
  const AngleTaps taps = TapsOfAngle(nu);
  for (std::size_t y = 0; y < kDepths; ++y) high_[y] = taps.Of(shape.high, kDepths, y);
  twice_back_ = shape.twice_back.empty() ? 0.0F : taps.Of(shape.twice_back, 1, 0);
}

// The value of the formulas at y = 0 is subtracted, times exp(-depth).
float PeakAtAngle::LightOf(float y, float depth, float of_gas, float of_aerosol) const {
  const float more = Gain(share_ * y, depth);
  const TablePosition place = PlaceOfDepth(*shape_, y);
  const float above = high_[place.cell] + place.share * (high_[place.cell + 1] - high_[place.cell]);
  return more * (of_gas + of_aerosol * back_) +
         std::exp(shape_->rate * y - depth) * of_aerosol * above;
}

std::vector<PeakAtAngle> DeltaM::At(double nu) const {
  const Spectrum phase = air().AerosolPhases(nu);
  std::vector<PeakAtAngle> peaks;
  for (std::size_t band = 0; band < phase.size(); ++band)
    peaks.emplace_back(shapes_[shapes_.size() > 1 ? band : 0], nu, share(band), phase[band]);
  return peaks;
}

Spectrum DeltaM::FactorOf(double nu, float column_km) const {
  constexpr auto kDeepestFactor = static_cast<float>(kDeepestGlow);
  const std::vector<PeakAtAngle> peaks = At(nu);
  Spectrum factor(peaks.size());
  for (std::size_t band = 0; band < factor.size(); ++band) {
    const float y = std::min(air().constants().mie_scattering[band] * column_km, kDeepestFactor);
    factor[band] = std::exp(y) * peaks[band].LightOf(y, y, 0.0F, 1.0F);
  }
  return factor;
}

float DeltaM::SumAlong(std::size_t band, const RaySamples<float>& samples, double nu,
                       const PeakAtAngle& peak, const PathAhead& ahead) const {
  const AirConstants<float>& air = beam_.air().constants();
  const auto gas =
      static_cast<float>(shared::PhaseMolecules(nu, Depolarisation(beam_.air().medium(), band))) *
      air.rayleigh[band];
  const float mie = air.mie_scattering[band];
  float sum = 0.0F;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const float lit = samples.weight[i] * samples.lit[i];
    if (!(lit > 0.0F)) continue;
    const float y = mie * (samples.sun_mie[i] + samples.view_mie[i]);
    const float depth =
        ahead.depth + OpticalDepthOf(ExtinctionAt(air, band), FromSunToEye(samples, i));
    const float of_gas = gas * samples.rayleigh_density[i];
    const float of_aerosol = mie * samples.mie_density[i];
    const float up = peak.twice_back() == 0.0F
                         ? 0.0F
                         : UpFromBelow(air, band, share(band), SunlitPointOf(samples, i));
    const auto light_of = [&](float scattering) {
      return peak.LightOf(scattering, depth, of_gas, of_aerosol) +
             of_aerosol * peak.TwiceBackOf(up, scattering, depth);
    };
    sum += lit * light_of(y + ahead.scattering);
    if (ahead.depth > 0.0F) sum -= lit * light_of(y);
  }
  return sum;
}

Spectrum DeltaM::Along(const RaySamples<float>& samples, double nu) const {
  const std::vector<PeakAtAngle> peaks = At(nu);
  Spectrum light(air().bands());
  for (std::size_t band = 0; band < light.size(); ++band)
    light[band] = SumAlong(band, samples, nu, peaks[band], {});
  return light;
}

Spectrum DeltaM::Behind(const Way& way, const RaySamples<float>& samples, double nu) const {
  const std::vector<PeakAtAngle> peaks = At(nu);
  Spectrum light(air().bands());
  for (std::size_t band = 0; band < light.size(); ++band) {
    if (way.scattering[band] > 0.0F) {
      light[band] =
          SumAlong(band, samples, nu, peaks[band], {way.depth[band], way.scattering[band]});
    }
  }
  return light;
}

bool DeltaM::HasBackwardLobe() const {
  return std::any_of(shapes_.begin(), shapes_.end(),
                     [](const PeakShape& shape) { return !shape.twice_back.empty(); });
}

Spectrum DeltaM::BackwardError(const RaySamples<float>& samples, double nu) const {
  // Shares that contain the errors of path-traced lobes with g of -0.9 to -0.999: light of four
  // scatterings, of three, and of two at intermediate angles.
  constexpr float kFourTimes = 0.4F, kThrice = 0.1F, kBlurred = 0.5F;
  const AirConstants<float>& constants = air().constants();
  const Spectrum aerosol = air().AerosolPhases(nu);
  const AngleTaps taps = TapsOfAngle(nu);
  Spectrum error(constants.bands);
  for (std::size_t band = 0; band < error.size(); ++band) {
    const PeakShape& shape = shapes_[shapes_.size() > 1 ? band : 0];
    if (shape.twice_back.empty()) continue;
    const float back = 0.5F * static_cast<float>(1.0 - nu) * aerosol[band];
    const float light = kFourTimes * std::abs(taps.Of(shape.twice_back, 1, 0)) + kThrice * back +
                        kBlurred * std::abs(taps.Of(shape.blurred_back, 1, 0));
    for (std::size_t i = 0; i < samples.count; ++i) {
      const float lit = samples.weight[i] * samples.lit[i];
      if (!(lit > 0.0F)) continue;
      const float depth = OpticalDepthOf(ExtinctionAt(constants, band), FromSunToEye(samples, i));
      const float up = UpFromBelow(constants, band, beam_.share()[band], SunlitPointOf(samples, i));
      error[band] += lit * constants.mie_scattering[band] * samples.mie_density[i] * light * up *
                     std::exp(-depth);
    }
  }
  return error;
}

std::size_t LastSample(const RaySamples<float>& samples) {
  const float* begin = samples.distance.data();
  return static_cast<std::size_t>(std::max_element(begin, begin + samples.count) - begin);
}

DeltaM::Way DeltaM::WayTo(const RaySamples<float>& samples) const {
  const AirConstants<float>& air = beam_.air().constants();
  float rayleigh = 0.0F, mie = 0.0F;
  for (std::size_t i = 0; i < samples.count; ++i) {
    rayleigh += samples.weight[i] * samples.rayleigh_density[i];
    mie += samples.weight[i] * samples.mie_density[i];
  }
  const float ozone = samples.count > 0 ? samples.view_ozone[LastSample(samples)] : 0.0F;
  const Spectrum none(air.bands);
  Way way{none, none, none, none};
  for (std::size_t band = 0; band < none.size(); ++band) {
    way.depth[band] = OpticalDepthOf(ExtinctionAt(air, band), {rayleigh, mie, ozone});
    way.clear[band] = std::exp(-way.depth[band]);
    way.scattering[band] = air.mie_scattering[band] * mie;
    way.more[band] = Gain(beam_.share()[band] * way.scattering[band], way.depth[band]);
  }
  return way;
}

double NarrowLobes(const Medium& medium) {
  constexpr std::size_t kFirst = kLastMissingDegree - 15;  // one can be small by chance
  const std::size_t bands = medium.wavelengths_nm.size();
  double largest = 0.0;
  for (std::size_t band = 0; band < bands; ++band) {
    if (band > 0 && medium.mie_phase.size() == 1) break;
    const std::vector<double> chi =
        LegendreCoefficients(medium.mie_phase[band], kLastMissingDegree);
    for (std::size_t l = kFirst; l < chi.size(); ++l) largest = std::max(largest, chi[l] * chi[l]);
  }
  return largest * medium.mie_scale_height_m *
         *std::max_element(medium.mie_scattering_per_m.begin(), medium.mie_scattering_per_m.end());
}

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
