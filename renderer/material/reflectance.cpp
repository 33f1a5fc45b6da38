// SPDX-License-Identifier: MIT
#include "renderer/material/reflectance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

/// Axes around a normal; the first points towards the eye in the surface.
struct Axes {
  glm::dvec3 eyewards, across, normal;
};

Axes AxesAround(const glm::dvec3& normal, const glm::dvec3& to_eye) {
  glm::dvec3 flat = to_eye - glm::dot(to_eye, normal) * normal;
  if (glm::dot(flat, flat) < 1e-12) {
    const glm::dvec3 any =
        std::abs(normal.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    flat = any - glm::dot(any, normal) * normal;
  }
  const glm::dvec3 eyewards = glm::normalize(flat);
  return {eyewards, glm::cross(normal, eyewards), normal};
}

// Lee, Carder, Arnone (2002), equations 2, 3 and table 2.
Spectrum LightFromUnderWater(std::span<const double> wavelengths_nm) {
  Spectrum reflectance(wavelengths_nm.size());
  for (std::size_t band = 0; band < wavelengths_nm.size(); ++band) {
    const double nm = wavelengths_nm[band];
    const double absorption = WaterAbsorption(nm) + 0.02 * std::exp(-0.015 * (nm - 440.0));
    const double backwards = 0.5 * SeaWaterScattering(nm) + 0.001 * 550.0 / nm;
    const double u = backwards / (absorption + backwards);
    const double under = (0.0895 + 0.1247 * u) * u;
    reflectance[band] = static_cast<float>(kPi * 0.52 * under / (1.0 - 1.7 * under));
  }
  return reflectance;
}

double Transmitted(double mu) { return shared::WaterTransmitted(mu, Water::kRefractiveIndex); }

/// Slopes across the line of sight: Gauss-Hermite nodes of weight exp(-x^2), normalised to 1
/// (Abramowitz and Stegun, table 25.10).
struct SlopeNode {
  double x, weight;
};
constexpr std::array<SlopeNode, 3> kAcross{
    {{-1.224744871391589, 1.0 / 6.0}, {0.0, 2.0 / 3.0}, {1.224744871391589, 1.0 / 6.0}}};

// Returns the spread of a direction above the horizontal that represents those between two sines.
Spread SpreadAbout(double sine, double lowest, double highest) {
  const double range = std::max(highest - lowest, 1e-9);
  return {std::max(sine - std::max(lowest, 0.0), 0.0), std::max(highest - sine, 0.0),
          std::clamp(-lowest / range, 0.0, 1.0)};
}

double WithoutAbsorption(const ReflectionAngles& at) {
  return shared::SnowWithoutAbsorption(at.mu_light, at.mu_eye, at.cos_between);
}

/// Factor of R0 for each of its two directions, such that snow without absorption reflects exactly
/// the light that it receives, from any direction. It is found iteratively: both directions are
/// scaled by the square root of the remaining error (Sinkhorn, Knopp 1967, Pacific J. Math. 21,
/// 343). Nodes are at equal steps of the root of mu.
class Balance {
 public:
  Balance() {
    const GaussRule& rule = GaussLegendre(48);
    std::array<std::array<double, 48>, kNodes> received;
    for (std::size_t i = 0; i < kNodes; ++i) {
      for (std::size_t j = 0; j < rule.node.size(); ++j) {
        const double mu = rule.node[j] * rule.node[j];  // dense at the horizon
        received[i][j] = MeanOverAzimuth(MuOf(i), mu) * 4.0 * mu * rule.node[j] * rule.weight[j];
      }
    }
    factor_.fill(1.0);
    for (int step = 0; step < 24; ++step) {
      const Balance before = *this;
      for (std::size_t i = 0; i < kNodes; ++i) {
        double sent = 0.0;
        for (std::size_t j = 0; j < rule.node.size(); ++j)
          sent += received[i][j] * before.AtRoot(rule.node[j]);
        factor_[i] = std::sqrt(before.factor_[i] / sent);
      }
    }
  }

  [[nodiscard]] double At(double mu) const { return AtRoot(std::sqrt(mu)); }
  [[nodiscard]] const std::array<double, Snow::kBalanceNodes>& nodes() const { return factor_; }

 private:
  static constexpr std::size_t kNodes = Snow::kBalanceNodes;

  static double MuOf(std::size_t node) {
    const double root = static_cast<double>(node) / (kNodes - 1);
    return std::max(root * root, 1e-4);
  }

  static double MeanOverAzimuth(double a, double b) {
    constexpr int kAzimuths = 90;
    const double sines = std::sqrt((1.0 - a * a) * (1.0 - b * b));
    double sum = 0.0;
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = kPi * (k + 0.5) / kAzimuths;
      sum += WithoutAbsorption({a, b, std::clamp(a * b + sines * std::cos(azimuth), -1.0, 1.0)});
    }
    return sum / kAzimuths;
  }

  [[nodiscard]] double AtRoot(double root) const {
    const double at = root * (kNodes - 1);
    const std::size_t node = std::min(static_cast<std::size_t>(at), kNodes - 2);
    return factor_[node] + (at - static_cast<double>(node)) * (factor_[node + 1] - factor_[node]);
  }

  std::array<double, kNodes> factor_;
};

const Balance& TheBalance() {
  static const Balance balance;
  return balance;
}

double Balanced(double mu) { return TheBalance().At(mu); }

}  // namespace

ReflectionAngles AnglesBetween(const glm::dvec3& normal, const glm::dvec3& to_light,
                               const glm::dvec3& to_eye) {
  const auto raised = [](double cosine) { return std::clamp(cosine, 1e-4, 1.0); };
  return {raised(glm::dot(normal, to_light)), raised(glm::dot(normal, to_eye)),
          std::clamp(glm::dot(to_light, to_eye), -1.0, 1.0)};
}

double MirroredRays::TotalWeight() const {
  double sum = 0.0;
  for (const MirroredRay& ray : All()) sum += ray.weight;
  return sum;
}

double FresnelReflectance(double cosine, double refractive_index) {
  return shared::FresnelReflectance(cosine, refractive_index);
}

double FresnelPolarisation(double cosine, double refractive_index) {
  return shared::FresnelPolarisation(cosine, refractive_index);
}

Spectrum Wetted(Spectrum albedo, double wetness) {
  for (std::size_t band = 0; band < albedo.size(); ++band)
    albedo[band] = shared::WetAlbedo(albedo[band], static_cast<float>(wetness));
  return albedo;
}

double SchlickReflectance(double cosine, double f0) {
  return shared::SchlickReflectance(cosine, f0);
}

// Portsmouth et al. (2025), equations of sections 2 and 3: "FON" for light reflected once.
RoughDiffuse::RoughDiffuse(double roughness)
    : roughness_(RequireInRange(roughness, 0.0, 1.0, "roughness")),
      scale_(1.0 / (1.0 + (0.5 - 2.0 / (3.0 * kPi)) * roughness)),
      mean_single_(scale_ * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * kPi)) * roughness)) {}

double RoughDiffuse::Single(double mu) const { return shared::RoughSingle(mu, roughness_, scale_); }

Spectrum RoughDiffuse::Brdf(const Spectrum& albedo, const ReflectionAngles& at) const {
  const auto once = static_cast<float>(
      shared::RoughOnce(at.mu_light, at.mu_eye, at.cos_between, roughness_, scale_));
  const auto again =
      static_cast<float>(shared::RoughTwice(at.mu_light, at.mu_eye, roughness_, scale_));
  const auto mean = static_cast<float>(mean_single_);
  Spectrum f(albedo.size());
  for (std::size_t band = 0; band < albedo.size(); ++band)
    f[band] = albedo[band] * once + again * shared::RoughAgain(albedo[band], mean);
  return f;
}

Spectrum RoughDiffuse::Albedo(const Spectrum& albedo, double mu) const {
  const auto once = static_cast<float>(Single(mu));
  const auto mean = static_cast<float>(mean_single_);
  Spectrum sent(albedo.size());
  for (std::size_t band = 0; band < albedo.size(); ++band) {
    sent[band] = albedo[band] * once + (1.0F - once) * shared::RoughAgain(albedo[band], mean);
  }
  return sent;
}

// Giesen (2009), "Phong Normalization Factor derivation": the integral of cos^n of the half vector
// times the cosine of the light over the hemisphere, for an eye at the normal.
Glossy::Glossy(double roughness, double f0)
    : exponent_(2.0 / std::pow(RequireInRange(roughness, 0.1, 1.0, "roughness"), 4) - 2.0),
      f0_(RequireInRange(f0, 0.0, 1.0, "reflectance at normal incidence")),
      normalisation_((exponent_ + 2.0) * (exponent_ + 4.0) /
                     (8.0 * kPi * (std::exp2(-0.5 * exponent_) + exponent_))) {}

double Glossy::Coat(const ReflectionAngles& at) const {
  const double cos_light = shared::HalfCosLight(at.cos_between);
  return shared::CoatLobe(shared::HalfMu(at.mu_light, at.mu_eye, cos_light), cos_light, f0_,
                          exponent_, normalisation_);
}

Spectrum Glossy::Brdf(const Spectrum& albedo, const ReflectionAngles& at) const {
  const auto coat = static_cast<float>(Coat(at));
  const auto body = static_cast<float>(shared::BodyUnderCoat(at.mu_light, at.mu_eye, f0_));
  Spectrum f(albedo.size());
  for (std::size_t band = 0; band < albedo.size(); ++band) f[band] = coat + body * albedo[band];
  return f;
}

Spectrum Glossy::BodyAlbedo(const Spectrum& albedo, double mu) const {
  const auto share = static_cast<float>((1.0 - f0_) * shared::CoatPassed(mu));
  Spectrum sent(albedo.size());
  for (std::size_t band = 0; band < albedo.size(); ++band) sent[band] = share * albedo[band];
  return sent;
}

// Half vectors are distributed by cos^n: 3 Gauss nodes in u = cos^(n + 1) by 8 azimuths. A solid
// angle of half vectors is a quarter of the solid angle of the mirrored lights, per cosine.
MirroredRays Glossy::Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const {
  const Axes axes = AxesAround(normal, to_eye);
  const GaussRule& rule = GaussLegendre(3);
  constexpr int kAzimuths = 8;
  MirroredRays mirrored;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double mu = std::pow(rule.node[i], 1.0 / (exponent_ + 1.0));
    const double sine = std::sqrt(1.0 - mu * mu);
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * kPi * (k + 0.5) / kAzimuths;
      const glm::dvec3 half =
          sine * (std::cos(azimuth) * axes.eyewards + std::sin(azimuth) * axes.across) +
          mu * normal;
      const double cosine = glm::dot(half, to_eye);
      const glm::dvec3 light = 2.0 * cosine * half - to_eye;
      const double mu_light = glm::dot(light, normal);
      if (cosine <= 0.0 || mu_light <= 0.0) continue;
      const double solid_angle =
          2.0 * kPi / (exponent_ + 1.0) * rule.weight[i] / kAzimuths * 4.0 * cosine;
      mirrored.rays[mirrored.count++] = {
          light,
          SchlickReflectance(cosine, f0_) * normalisation_ * mu_light * solid_angle,
          {sine, sine}};  // halfway to the mirror direction, and equally far beyond
    }
  }
  return mirrored;
}

Water::Water(double wind_m_per_s, std::span<const double> wavelengths_nm)
    : variance_(0.003 + 0.00512 * RequireInRange(wind_m_per_s, 0.0, 20.0, "wind")),
      under_surface_(LightFromUnderWater(wavelengths_nm)) {}

double Water::Glitter(const ReflectionAngles& at, double variance) {
  return shared::WaveGlitter(at.mu_light, at.mu_eye, at.cos_between, variance, kRefractiveIndex);
}

double Water::Polarisation(double cos_between) {
  return FresnelPolarisation(shared::HalfCosLight(cos_between), kRefractiveIndex);
}

Spectrum Water::Brdf(const ReflectionAngles& at, double variance) const {
  const auto glitter = static_cast<float>(Glitter(at, variance));
  const auto through = static_cast<float>(Transmitted(at.mu_light) * Transmitted(at.mu_eye) / kPi);
  Spectrum f(under_surface_.size());
  for (std::size_t band = 0; band < f.size(); ++band)
    f[band] = glitter + through * under_surface_[band];
  return f;
}

Spectrum Water::BodyAlbedo(double mu) const {
  const auto through = static_cast<float>(shared::WaterLetsIn(kRefractiveIndex, mu));
  Spectrum sent(under_surface_.size());
  for (std::size_t band = 0; band < sent.size(); ++band)
    sent[band] = through * under_surface_[band];
  return sent;
}

// Wave facets are weighted by the probability of their slope times their area projected towards the
// eye. Slopes along the line of sight are restricted to facets that face the eye.
MirroredRays Water::Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const {
  constexpr double kSteepest = 3.0;  // in units of the width: one in 10^5 is steeper
  const Axes axes = AxesAround(normal, to_eye);
  const double mu = std::max(glm::dot(normal, to_eye), 1e-4);
  const double sine = std::sqrt(std::max(1.0 - mu * mu, 0.0));
  const double width = std::sqrt(variance_);
  const double first = std::max(-kSteepest, -mu / std::max(width * sine, 1e-9));
  const GaussRule& rule = GaussLegendre(8);
  // Returns the sine of the elevation that a facet of slope x along the line of sight mirrors.
  const auto elevation_of = [&](double x) {
    return std::cos(std::acos(std::min(mu, 1.0)) - 2.0 * std::atan(width * x));
  };
  MirroredRays mirrored;
  double total = 0.0;
  double passed = 0.0;  // sum of weights so far; a node represents its share of slopes
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double x = first + (kSteepest - first) * rule.node[i];
    const double seen = (mu + width * x * sine) * std::exp(-x * x) * rule.weight[i];
    const double lowest = elevation_of(first + (kSteepest - first) * passed);
    passed += rule.weight[i];
    const double highest = elevation_of(first + (kSteepest - first) * passed);
    for (const SlopeNode& across : kAcross) {
      const glm::dvec3 face =
          glm::normalize(normal + width * (x * axes.eyewards + across.x * axes.across));
      const double cosine = std::clamp(glm::dot(face, to_eye), 0.0, 1.0);
      const glm::dvec3 light = 2.0 * cosine * face - to_eye;
      const double share = across.weight * seen;
      total += share;
      mirrored.rays[mirrored.count++] = {
          light, share * FresnelReflectance(cosine, kRefractiveIndex),
          SpreadAbout(std::max(glm::dot(light, normal), 0.0), lowest, highest)};
    }
  }
  for (std::size_t i = 0; i < mirrored.count; ++i) {
    MirroredRay& ray = mirrored.rays[i];
    ray.weight /= total;
    const double below = glm::dot(ray.direction, normal);
    if (below < 0.0) ray.direction = glm::normalize(ray.direction - below * normal);
  }
  return mirrored;
}

const std::array<double, Snow::kBalanceNodes>& Snow::BalanceNodes() { return TheBalance().nodes(); }

Snow::Snow(double grain_diameter_m, std::span<const double> wavelengths_nm)
    : y_(wavelengths_nm.size()) {
  constexpr double kEnhancement = 1.6;  // B
  constexpr double kAsymmetry = 0.845;  // g
  const double length = 16.0 * kEnhancement / (9.0 * (1.0 - kAsymmetry)) *
                        RequireInRange(grain_diameter_m, 5e-5, 5e-3, "grain diameter [m]");
  for (std::size_t band = 0; band < y_.size(); ++band)
    y_[band] = static_cast<float>(std::sqrt(length * IceAbsorption(wavelengths_nm[band])));
}

Spectrum Snow::Brdf(const ReflectionAngles& at) const {
  const double r0 = WithoutAbsorption(at) * Balanced(at.mu_light) * Balanced(at.mu_eye);
  const auto fall =
      static_cast<float>(shared::SnowEscape(at.mu_light) * shared::SnowEscape(at.mu_eye) / r0);
  const auto scale = static_cast<float>(r0 / kPi);
  Spectrum f(y_.size());
  for (std::size_t band = 0; band < f.size(); ++band) f[band] = scale * std::exp(-y_[band] * fall);
  return f;
}

Spectrum Snow::Albedo(double mu) const {
  const auto escape = static_cast<float>(shared::SnowEscape(mu));
  Spectrum sent(y_.size());
  for (std::size_t band = 0; band < sent.size(); ++band) sent[band] = std::exp(-y_[band] * escape);
  return sent;
}

Spectrum Snow::SphericalAlbedo() const {
  Spectrum sent(y_.size());
  for (std::size_t band = 0; band < sent.size(); ++band) sent[band] = std::exp(-y_[band]);
  return sent;
}

}  // namespace alpenglow::renderer
