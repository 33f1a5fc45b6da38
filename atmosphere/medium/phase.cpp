// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"

namespace alpenglow::atmosphere {

ScatteringMatrix RayleighMatrix(double depolarisation, double cos_scattering) {
  const double c = cos_scattering;
  const double round = (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation);
  const double circular = (1.0 - 2.0 * depolarisation) / (1.0 - depolarisation);
  const double polarising = 3.0 / (16.0 * kPi) * round;
  ScatteringMatrix matrix;
  matrix.a2 = polarising * (1.0 + c * c);
  matrix.a1 = matrix.a2 + (1.0 - round) / (4.0 * kPi);
  matrix.a3 = 2.0 * polarising * c;
  matrix.a4 = circular * matrix.a3;
  matrix.b1 = -polarising * (1.0 - c) * (1.0 + c);
  return matrix;
}

double AirDepolarisation(double wavelength_nm) {
  const double x = std::pow(1000.0 / wavelength_nm, 2);  // 1/um^2
  struct Gas {
    double percent, king_factor;
  };
  const Gas gases[] = {{78.084, 1.034 + 3.17e-4 * x},                      // nitrogen
                       {20.946, 1.096 + 1.385e-3 * x + 1.448e-4 * x * x},  // oxygen
                       {0.934, 1.0},                                       // argon
                       {0.036, 1.15}};                                     // carbon dioxide
  double all = 0.0, sum = 0.0;
  for (const Gas& gas : gases) {
    all += gas.percent;
    sum += gas.percent * gas.king_factor;
  }
  const double king_factor = sum / all;
  return 6.0 * (king_factor - 1.0) / (7.0 * king_factor + 3.0);
}

ScatteringMatrix SphereMatrix(const SphereRatios& ratios, double phase_per_sr,
                              double cos_scattering) {
  const std::size_t intervals = ratios.a3.size() - 1;
  const double position =
      std::acos(std::clamp(cos_scattering, -1.0, 1.0)) / kPi * static_cast<double>(intervals);
  const std::size_t i = std::min(static_cast<std::size_t>(position), intervals - 1);
  const auto at = [&](const std::vector<double>& ratio) {
    return phase_per_sr * std::lerp(ratio[i], ratio[i + 1], position - static_cast<double>(i));
  };
  ScatteringMatrix matrix{.a1 = phase_per_sr, .a2 = phase_per_sr};
  matrix.a3 = matrix.a4 = at(ratios.a3);
  matrix.b1 = at(ratios.b1);
  matrix.b2 = at(ratios.b2);
  return matrix;
}

namespace {

constexpr EnumNames kPhaseNames{{
    std::pair{PhaseKind::kRayleigh, "rayleigh"},
    {PhaseKind::kHenyeyGreenstein, "henyey-greenstein"},
    {PhaseKind::kDoubleHenyeyGreenstein, "double-henyey-greenstein"},
    {PhaseKind::kCornetteShanks, "cornette-shanks"},
    {PhaseKind::kSchlick, "schlick"},
    {PhaseKind::kDraine, "draine"},
    {PhaseKind::kHenyeyGreensteinDraine, "henyey-greenstein-draine"},
    {PhaseKind::kTable, "table"},
}};

double SchlickK(double g) { return g * (1.55 - 0.55 * g * g); }

// Returns 1/k - (1 - k^2)/(2 k^2) log((1 + k)/(1 - k)); near 0 by its series, the sum of 2
// k^(2n-1) / ((2n-1)(2n+1)), whose ten terms are exact to rounding for |k| < 0.1.
double MeanCosineOfSchlick(double k) {
  if (std::abs(k) < 0.1) {
    double sum = 0.0;
    double power = k;
    for (int n = 1; n <= 10; ++n, power *= k * k) {
      sum += 2.0 * power / ((2.0 * n - 1.0) * (2.0 * n + 1.0));
    }
    return sum;
  }
  return (1.0 - (1.0 - k) * (1.0 + k) / k * std::atanh(k)) / k;
}

// The moments of the Henyey-Greenstein lobe are <c> = g, <c^2> = (1 + 2 g^2)/3,
// <c^3> = (3 g + 2 g^3)/5.
double MeanCosineOfDraine(double g, double alpha) {
  return g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

// Returns the cosine below which the Henyey-Greenstein lobe has the fraction (1 + s)/2 of its
// light. This is the usual inversion with the division by g carried out, so that g = 0 is not a
// special case.
double HenyeyGreensteinQuantile(double s, double g) {
  const double x = 1.0 + g * s;
  return (2.0 * s + g * (3.0 + s * s) + 2.0 * g * g * s - g * g * g * (1.0 - s) * (1.0 + s)) /
         (2.0 * x * x);
}

// Integral of HenyeyGreensteinQuantile(s, g)^2 from -1 to s, for g in [0, 1). The closed form
// divides by g^3; below 0.1 eight Gauss points are exact to rounding (the integrand's pole is at
// -1/g).
double IntegratedSquareOfQuantile(double s, double g) {
  if (g < 0.1) {
    constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290,
                                          0.7966664774136267, 0.9602898564975363};
    constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};
    const double half = 0.5 * (s + 1.0);
    const double middle = 0.5 * (s - 1.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      for (const double node : {middle - half * kNode[i], middle + half * kNode[i]}) {
        const double cosine = HenyeyGreensteinQuantile(node, g);
        sum += kWeight[i] * cosine * cosine;
      }
    }
    return half * sum;
  }
  const double a = 1.0 + g * g;
  const double b = (1.0 - g) * (1.0 + g) * (1.0 - g) * (1.0 + g);
  const auto antiderivative = [a, b](double x) {
    return a * a * x + 2.0 * a * b / x - b * b / (3.0 * x * x * x);
  };
  return (antiderivative(1.0 + g * s) - antiderivative(1.0 - g)) / (4.0 * g * g * g);
}

// With the quantile s of the Henyey-Greenstein lobe as the variable, Draine's density is
// (1 + alpha c(s)^2) over its mean: up to a constant factor between 1 and 1 + alpha, for every g.
// Newton's method with a bracket converges in a few steps for alpha up to 1, and ends after 60.
double SampleDraine(double u, double g, double alpha) {
  if (g < 0.0) return -SampleDraine(1.0 - u, -g, alpha);
  const double whole = 2.0 * (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
  double low = -1.0;
  double high = 1.0;
  double s = 2.0 * u - 1.0;
  for (int step = 0; step < 60; ++step) {
    const double cosine = HenyeyGreensteinQuantile(s, g);
    const double excess = (s + 1.0 + alpha * IntegratedSquareOfQuantile(s, g)) - u * whole;
    (excess > 0.0 ? high : low) = s;
    double next = s - excess / (1.0 + alpha * cosine * cosine);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - s) < 1e-15) break;
    s = next;
  }
  return HenyeyGreensteinQuantile(s, g);
}

// Solves c^3 + 3 c = 4 (2 u - 1) by Cardano's formula.
double SampleRayleigh(double u) {
  const double half = 2.0 * (2.0 * u - 1.0);
  const double a = std::cbrt(half + std::copysign(std::sqrt(half * half + 1.0), half));
  return a - 1.0 / a;
}

double SampleUnclamped(const PhaseFunction& phase, double u) {
  const double s = 2.0 * u - 1.0;
  switch (phase.kind) {
    case PhaseKind::kRayleigh:
      return SampleRayleigh(u);
    case PhaseKind::kHenyeyGreenstein:
      return HenyeyGreensteinQuantile(s, phase.g);
    case PhaseKind::kDoubleHenyeyGreenstein:
      return u < phase.back_weight
                 ? HenyeyGreensteinQuantile(2.0 * (u / phase.back_weight) - 1.0, phase.g_back)
                 : HenyeyGreensteinQuantile(
                       2.0 * ((u - phase.back_weight) / (1.0 - phase.back_weight)) - 1.0, phase.g);
    case PhaseKind::kCornetteShanks:
      return SampleDraine(u, phase.g, 1.0);
    case PhaseKind::kSchlick: {
      const double k = SchlickK(phase.g);
      return (s + k) / (1.0 + k * s);
    }
    case PhaseKind::kDraine:
      return SampleDraine(u, phase.g, phase.alpha);
    case PhaseKind::kHenyeyGreensteinDraine:
      return u < phase.back_weight
                 ? SampleDraine(u / phase.back_weight, phase.g_back, phase.alpha)
                 : HenyeyGreensteinQuantile(
                       2.0 * ((u - phase.back_weight) / (1.0 - phase.back_weight)) - 1.0, phase.g);
    case PhaseKind::kTable:
      return phase.table->Quantile(u);
  }
  throw InternalError("unknown kind of phase function");
}

void RequireLobe(double g, double limit, const std::string& key) {
  if (!(std::abs(g) < limit)) {  // written so that NaN fails
    throw InputError(fmt::format("{} is {}; it must lie in (-{}, {})", key, g, limit, limit));
  }
}

}  // namespace

bool PhaseFunction::operator==(const PhaseFunction& other) const {
  const bool same_table = table == other.table || (table && other.table && *table == *other.table);
  return kind == other.kind && g == other.g && g_back == other.g_back &&
         back_weight == other.back_weight && alpha == other.alpha && same_table;
}

double Phase(const PhaseFunction& phase, double cos_scattering) {
  switch (phase.kind) {
    case PhaseKind::kRayleigh:
      return shared::PhaseRayleigh(cos_scattering);
    case PhaseKind::kHenyeyGreenstein:
      return shared::PhaseHenyeyGreenstein(cos_scattering, phase.g);
    case PhaseKind::kDoubleHenyeyGreenstein:
      return shared::PhaseDoubleHenyeyGreenstein(cos_scattering, phase.g, phase.g_back,
                                                 phase.back_weight);
    case PhaseKind::kCornetteShanks:
      return shared::PhaseCornetteShanks(cos_scattering, phase.g);
    case PhaseKind::kSchlick:
      return shared::PhaseSchlick(cos_scattering, phase.g);
    case PhaseKind::kDraine:
      return shared::PhaseDraine(cos_scattering, phase.g, phase.alpha);
    case PhaseKind::kHenyeyGreensteinDraine:
      return shared::PhaseHenyeyGreensteinDraine(cos_scattering, phase.g, phase.g_back,
                                                 phase.back_weight, phase.alpha);
    case PhaseKind::kTable:
      return phase.table->At(PhaseTable::Position(cos_scattering));
  }
  throw InternalError("unknown kind of phase function");
}

double MeanCosine(const PhaseFunction& phase) {
  switch (phase.kind) {
    case PhaseKind::kRayleigh:
      return 0.0;
    case PhaseKind::kHenyeyGreenstein:
      return phase.g;
    case PhaseKind::kDoubleHenyeyGreenstein:
      return (1.0 - phase.back_weight) * phase.g + phase.back_weight * phase.g_back;
    case PhaseKind::kCornetteShanks:
      return MeanCosineOfDraine(phase.g, 1.0);
    case PhaseKind::kSchlick:
      return MeanCosineOfSchlick(SchlickK(phase.g));
    case PhaseKind::kDraine:
      return MeanCosineOfDraine(phase.g, phase.alpha);
    case PhaseKind::kHenyeyGreensteinDraine:
      return (1.0 - phase.back_weight) * phase.g +
             phase.back_weight * MeanCosineOfDraine(phase.g_back, phase.alpha);
    case PhaseKind::kTable:
      return phase.table->mean_cosine();
  }
  throw InternalError("unknown kind of phase function");
}

double SampleCosine(const PhaseFunction& phase, double u) {
  return std::clamp(SampleUnclamped(phase, u), -1.0, 1.0);
}

PhaseFunction FogPhase(double droplet_diameter_um, const std::string& key) {
  const double d =
      RequireInRange(droplet_diameter_um, kSmallestDroplet_um, kLargestDroplet_um, key);
  return {.kind = PhaseKind::kHenyeyGreensteinDraine,
          .g = shared::FogForwardG(d),
          .g_back = shared::FogDraineG(d),
          .back_weight = shared::FogDraineWeight(d),
          .alpha = shared::FogDraineAlpha(d)};
}

PhaseKind PhaseKindFromName(std::string_view name) {
  return kPhaseNames.Named(name, "phase is \"{}\"; it must be one of {}");
}

std::string NameOf(PhaseKind kind) { return kPhaseNames.Of(kind); }

void Validate(const PhaseFunction& phase, const std::string& prefix) {
  RequireLobe(phase.g, phase.kind == PhaseKind::kSchlick ? kLargestSchlickG : 1.0, prefix + ".g");
  RequireLobe(phase.g_back, 1.0, prefix + ".g_back");
  RequireInRange(phase.back_weight, 0.0, 1.0, prefix + ".back_weight");
  RequireInRange(phase.alpha, 0.0, 100.0, prefix + ".alpha");
  if (phase.kind == PhaseKind::kTable && !phase.table) {
    throw InputError(fmt::format("{}.phase is table; it needs values at angles", prefix));
  }
}

}  // namespace alpenglow::atmosphere
