// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"

namespace alpenglow::atmosphere {
namespace {

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

/// Returns a cosine of one of two lobes.
/// @param back, front  of a number that is uniform in [0, 1).
template <typename Back, typename Front>
double SampleOneOfTwo(double u, double back_weight, const Back& back, const Front& front) {
  return u < back_weight ? back(u / back_weight) : front((u - back_weight) / (1.0 - back_weight));
}

double SampleHenyeyGreenstein(double u, double g) {
  return HenyeyGreensteinQuantile(2.0 * u - 1.0, g);
}

// Returns the coefficients of a Henyey-Greenstein lobe: the powers of g.
std::vector<double> CoefficientsOfLobe(double g, int degree) {
  std::vector<double> chi{1.0};
  while (chi.size() <= static_cast<std::size_t>(degree)) chi.push_back(g * chi.back());
  return chi;
}

// Returns the coefficients of Draine's lobe, which is Henyey-Greenstein times 1 + alpha x^2 over
// the mean of that factor. The recurrence x P_l = ((l + 1) P_{l+1} + l P_{l-1}) / (2 l + 1), used
// twice, gives those of the lobe times x^2.
std::vector<double> CoefficientsOfDraine(double g, double alpha, int degree) {
  const std::vector<double> lobe = CoefficientsOfLobe(g, degree + 2);
  const double mean = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
  std::vector<double> chi;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
    const auto l = static_cast<double>(i);
    const double two = 2.0 * l;
    double squared = (l + 1.0) * (l + 2.0) / ((two + 1.0) * (two + 3.0)) * lobe[i + 2] +
                     (two * l + two - 1.0) / ((two - 1.0) * (two + 3.0)) * lobe[i];
    if (i >= 2) squared += l * (l - 1.0) / ((two + 1.0) * (two - 1.0)) * lobe[i - 2];
    chi.push_back((lobe[i] + alpha * squared) / mean);
  }
  return chi;
}

std::vector<double> MixedCoefficients(std::vector<double> first, const std::vector<double>& second,
                                      double share_of_second) {
  for (std::size_t l = 0; l < first.size(); ++l)
    first[l] = std::lerp(first[l], second[l], share_of_second);
  return first;
}

using Function = PhaseFunction;

constexpr PhaseParameter kG{
    "g", &Function::g, -1.0, 1.0, false, "1", "Asymmetry of the first lobe"};
constexpr PhaseParameter kGOfSchlick{kG.key,  kG.member, -kLargestSchlickG, kLargestSchlickG, false,
                                     kG.unit, kG.text};
constexpr PhaseParameter kGBack{
    "g_back", &Function::g_back, -1.0, 1.0, false, "1", "Asymmetry of the second lobe"};
constexpr PhaseParameter kBackWeight{"back_weight", &Function::back_weight,       0.0, 1.0, true,
                                     "1",           "Fraction of the second lobe"};
constexpr PhaseParameter kAlpha{
    "alpha", &Function::alpha, 0.0, 100.0, true, "1", "Parameter of Draine's phase function"};

constexpr std::array kOneLobe{kG};
constexpr std::array kOneLobeOfSchlick{kGOfSchlick};
constexpr std::array kTwoLobes{kG, kGBack, kBackWeight};
constexpr std::array kDraineLobe{kG, kAlpha};
constexpr std::array kLobeAndDraine{kG, kGBack, kBackWeight, kAlpha};
constexpr std::array kAllParameters{kG, kGBack, kBackWeight, kAlpha};

// The macro uses the formula of a value three times: as C++ for double and float, and as text for
// GLSL.
#define ALPENGLOW_PHASE_VALUE(formula)                            \
  .value = [](const Function& phase, double c) -> double {        \
    using namespace shared;                                       \
    [[maybe_unused]] const glm::dvec4 p = PhaseVectorOf(phase);   \
    return formula;                                               \
  },                                                              \
  .value_in_float = [](const Function& phase, float c) -> float { \
    using namespace shared;                                       \
    [[maybe_unused]] const glm::vec4 p(PhaseVectorOf(phase));     \
    return formula;                                               \
  },                                                              \
  .expression = #formula

constexpr PhaseForm kForms[] = {
    {.kind = PhaseKind::kRayleigh,
     .name = "rayleigh",
     .parameters = {},
     ALPENGLOW_PHASE_VALUE(PhaseRayleigh(c)),
     .mean_cosine = [](const Function&) { return 0.0; },
     .sample = [](const Function&, double u) { return SampleRayleigh(u); },
     .legendre = nullptr},

    {.kind = PhaseKind::kHenyeyGreenstein,
     .name = "henyey-greenstein",
     .parameters = kOneLobe,
     ALPENGLOW_PHASE_VALUE(PhaseHenyeyGreenstein(c, p.x)),
     .mean_cosine = [](const Function& p) { return p.g; },
     .sample = [](const Function& p, double u) { return SampleHenyeyGreenstein(u, p.g); },
     .legendre = [](const Function& p, int degree) { return CoefficientsOfLobe(p.g, degree); }},

    {.kind = PhaseKind::kDoubleHenyeyGreenstein,
     .name = "double-henyey-greenstein",
     .parameters = kTwoLobes,
     ALPENGLOW_PHASE_VALUE(PhaseDoubleHenyeyGreenstein(c, p.x, p.y, p.z)),
     .mean_cosine =
         [](const Function& p) { return (1.0 - p.back_weight) * p.g + p.back_weight * p.g_back; },
     .sample =
         [](const Function& p, double u) {
           return SampleOneOfTwo(
               u, p.back_weight, [&](double v) { return SampleHenyeyGreenstein(v, p.g_back); },
               [&](double v) { return SampleHenyeyGreenstein(v, p.g); });
         },
     .legendre =
         [](const Function& p, int degree) {
           return MixedCoefficients(CoefficientsOfLobe(p.g, degree),
                                    CoefficientsOfLobe(p.g_back, degree), p.back_weight);
         }},

    {.kind = PhaseKind::kCornetteShanks,
     .name = "cornette-shanks",
     .parameters = kOneLobe,
     ALPENGLOW_PHASE_VALUE(PhaseCornetteShanks(c, p.x)),
     .mean_cosine = [](const Function& p) { return MeanCosineOfDraine(p.g, 1.0); },
     .sample = [](const Function& p, double u) { return SampleDraine(u, p.g, 1.0); },
     .legendre = [](const Function& p,
                    int degree) { return CoefficientsOfDraine(p.g, 1.0, degree); }},

    {.kind = PhaseKind::kSchlick,
     .name = "schlick",
     .parameters = kOneLobeOfSchlick,
     ALPENGLOW_PHASE_VALUE(PhaseSchlick(c, p.x)),
     .mean_cosine = [](const Function& p) { return MeanCosineOfSchlick(SchlickK(p.g)); },
     .sample =
         [](const Function& p, double u) {
           const double s = 2.0 * u - 1.0;
           const double k = SchlickK(p.g);
           return (s + k) / (1.0 + k * s);
         },
     .legendre = nullptr},

    {.kind = PhaseKind::kDraine,
     .name = "draine",
     .parameters = kDraineLobe,
     ALPENGLOW_PHASE_VALUE(PhaseDraine(c, p.x, p.w)),
     .mean_cosine = [](const Function& p) { return MeanCosineOfDraine(p.g, p.alpha); },
     .sample = [](const Function& p, double u) { return SampleDraine(u, p.g, p.alpha); },
     .legendre = [](const Function& p,
                    int degree) { return CoefficientsOfDraine(p.g, p.alpha, degree); }},

    {.kind = PhaseKind::kHenyeyGreensteinDraine,
     .name = "henyey-greenstein-draine",
     .parameters = kLobeAndDraine,
     ALPENGLOW_PHASE_VALUE(PhaseHenyeyGreensteinDraine(c, p.x, p.y, p.z, p.w)),
     .mean_cosine =
         [](const Function& p) {
           return (1.0 - p.back_weight) * p.g +
                  p.back_weight * MeanCosineOfDraine(p.g_back, p.alpha);
         },
     .sample =
         [](const Function& p, double u) {
           return SampleOneOfTwo(
               u, p.back_weight, [&](double v) { return SampleDraine(v, p.g_back, p.alpha); },
               [&](double v) { return SampleHenyeyGreenstein(v, p.g); });
         },
     .legendre =
         [](const Function& p, int degree) {
           return MixedCoefficients(CoefficientsOfLobe(p.g, degree),
                                    CoefficientsOfDraine(p.g_back, p.alpha, degree), p.back_weight);
         }},

    {.kind = PhaseKind::kTable,
     .name = "table",
     .parameters = {},
     .value = [](const Function& p, double c) { return p.table->At(PhaseTable::Position(c)); },
     .value_in_float =
         [](const Function& p, float c) {
           return static_cast<float>(p.table->At(PhaseTable::Position(static_cast<double>(c))));
         },
     .expression = "0.0",
     .mean_cosine = [](const Function& p) { return p.table->mean_cosine(); },
     .sample = [](const Function& p, double u) { return p.table->Quantile(u); },
     .legendre = nullptr},
};

constexpr bool IsInOrderOfKinds() {
  for (std::size_t i = 0; i < std::size(kForms); ++i) {
    if (kForms[i].kind != static_cast<PhaseKind>(i)) return false;
  }
  return true;
}
static_assert(IsInOrderOfKinds());

void RequireInRangeOf(const PhaseParameter& parameter, double value, const std::string& key) {
  if (parameter.has_ends) {
    RequireInRange(value, parameter.low, parameter.high, key);
  } else if (!(value > parameter.low && value < parameter.high)) {  // written so that NaN fails
    throw InputError(fmt::format("{} is {}; it must lie in ({}, {})", key, value, parameter.low,
                                 parameter.high));
  }
}

}  // namespace

std::span<const PhaseForm> PhaseForms() { return kForms; }

const PhaseForm& FormOf(PhaseKind kind) { return kForms[static_cast<std::size_t>(kind)]; }

std::span<const PhaseParameter> PhaseParameters() { return kAllParameters; }

std::optional<PhaseParameter> ParameterOf(const PhaseForm& form, std::string_view key) {
  for (const PhaseParameter& parameter : form.parameters) {
    if (parameter.key == key) return parameter;
  }
  return std::nullopt;
}

PhaseKind PhaseKindFromName(std::string_view name) {
  std::vector<std::string> names;
  for (const PhaseForm& form : kForms) {
    if (name == form.name) return form.kind;
    names.emplace_back(form.name);
  }
  RefuseName("phase is \"{}\"; it must be one of {}", name, names);
}

std::string NameOf(PhaseKind kind) { return FormOf(kind).name; }

void Validate(const PhaseFunction& phase, const std::string& prefix) {
  const PhaseForm& form = FormOf(phase.kind);
  for (const PhaseParameter& any : kAllParameters) {
    const PhaseParameter parameter = ParameterOf(form, any.key).value_or(any);
    RequireInRangeOf(parameter, phase.*parameter.member,
                     fmt::format("{}.{}", prefix, parameter.key));
  }
  if (phase.kind == PhaseKind::kTable && !phase.table) {
    throw InputError(fmt::format("{}.phase is table; it needs values at angles", prefix));
  }
}

}  // namespace alpenglow::atmosphere
