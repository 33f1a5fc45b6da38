// SPDX-License-Identifier: MIT
#include "lut/evaluate/integral_evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/multiple_scattering/delta_m.h"
#include "lut/multiple_scattering/multiple_scattering.h"

namespace alpenglow::lut {
namespace {

// Error of closed forms in single scattering, twice that of the worst stored case; for smaller
// errors the reference solution is used. For small planets it is three times the error of the
// closed forms.
constexpr double kFastPathFloor = 4e-6;

double FastPathFloor(const Medium& medium) {
  const double error = ClosedFormError(medium);
  const double height_m = std::max(medium.rayleigh_scale_height_m, medium.mie_scale_height_m);
  const double of_series = 0.8 * std::pow(height_m / medium.planet_radius_m, 2.0);
  return std::max({kFastPathFloor, of_series, error > kClosedFormError ? 3.0 * error : 0.0});
}

// Numbers of nodes that are tried in order to reach a requested error.
constexpr std::array<int, 6> kLadder{4, 8, 12, 16, 24, 32};

// The coarser solutions with which light of all orders is compared: two, because one difference can
// be small by chance. They are coarse in the parameters that dominate the error: degree, altitudes
// and directions in haze, nodes of later orders in thick air, suns in twilight.
constexpr MultipleScatteringOptions kCoarseLight{.altitudes = 12,
                                                 .sun_angles = 28,
                                                 .degree = 2,
                                                 .zenith_nodes = 8,
                                                 .azimuth_nodes = 6,
                                                 .ray_nodes = 8};
constexpr MultipleScatteringOptions kMiddlingLight{.altitudes = 12,
                                                   .sun_angles = 22,
                                                   .degree = 4,
                                                   .zenith_nodes = 9,
                                                   .azimuth_nodes = 6,
                                                   .ray_nodes = 7,
                                                   .later_zenith_nodes = 4,
                                                   .later_azimuth_nodes = 4,
                                                   .later_ray_nodes = 4,
                                                   .tolerance = 3e-2};

// Factors that compute the error of light of higher orders from the two differences and the
// truncated degrees. They were calibrated on 342 path-traced values, in clear air, haze, dust and
// molecules of optical depths 0.1 to 5 (eval.h has the result).
constexpr double kShareOfDifferences = 0.6;
constexpr double kFloorOfHigherOrders = 3e-3;
// Narrow backward lobes are blurred in all three solutions, which then agree better with each other
// than with paths.
constexpr double kFactorOfBackwardLobes = 3.0;

// Share of the light from behind the end of a segment that a forward peak adds to it. Towards a low
// sun this light reaches the end on ways that are not those of the closed form.
constexpr double kShareOfLightBehind = 0.1;

// Light of higher orders below this fraction of the sun's is not resolved [1/sr]: it comes from air
// beyond the horizon, between the directions of the solution.
constexpr double kLeastLight = 1e-12;

// Returns coarser options that can be compared with a solution. In air that needs many altitudes
// they have two thirds of them: with a few its light would not be of the same size.
MultipleScatteringOptions ComparableWith(const MultipleScatteringOptions& fine,
                                         MultipleScatteringOptions coarse) {
  constexpr int kFewInThickAir = 24;
  coarse.delta_m = fine.delta_m;
  if (fine.altitudes > kFewInThickAir) coarse.altitudes = 2 * fine.altitudes / 3;
  return coarse;
}

double Sum(const Estimate& a) { return std::abs(a.value) + a.error; }

/// Returns the product of two estimates; to first order the relative errors add, and for large
/// errors the product of errors is included.
Estimate operator*(const Estimate& a, const Estimate& b) {
  return {a.value * b.value, Sum(a) * Sum(b) - std::abs(a.value * b.value)};
}

Estimate operator+(const Estimate& a, const Estimate& b) {
  return {a.value + b.value, a.error + b.error};
}

template <typename Combine>
Estimates Combined(const Estimates& a, const Estimates& b, const Combine& combine) {
  Estimates result(a.size());
  for (std::size_t band = 0; band < a.size(); ++band) result[band] = combine(a[band], b[band]);
  return result;
}

Estimates operator+(const Estimates& a, const Estimates& b) {
  return Combined(a, b, [](const Estimate& x, const Estimate& y) { return x + y; });
}

/// Returns the light that the ground reflects along a ray of this transmittance, for an irradiance
/// of the ground.
Estimates FromGround(const Medium& medium, const Estimates& transmittance,
                     const Estimates& irradiance) {
  Estimates light = Combined(transmittance, irradiance,
                             [](const Estimate& t, const Estimate& e) { return t * e; });
  for (std::size_t band = 0; band < light.size(); ++band) {
    light[band] = light[band] * Estimate{medium.ground_albedo[band] / kPi, 0.0};
  }
  return light;
}

ViewRay TowardsSun(double altitude_m, double mu_s) { return {altitude_m, mu_s, mu_s, 1.0}; }

bool WithinError(const Estimates& estimates, double max_error) {
  return std::all_of(estimates.begin(), estimates.end(), [&](const Estimate& estimate) {
    return estimate.error <= max_error * std::abs(estimate.value);
  });
}

class IntegralEvaluator final : public Evaluator {
 public:
  IntegralEvaluator(const Medium& medium, const IntegralOptions& options)
      : air_(medium),
        quick_air_(medium),
        options_(options),
        closed_form_error_(ClosedFormError(medium)),
        fast_path_floor_(FastPathFloor(medium)) {
    if (medium.wavelengths_nm.size() > kMaxBands) {
      throw InputError(
          fmt::format("spectrum.wavelengths_nm has {} values; at most {} are evaluated",
                      medium.wavelengths_nm.size(), kMaxBands));
    }
    RequireInRange(options.samples, kFewestSamples, kMostSamples, "samples");
    if (options.max_error) {
      RequireInRange(*options.max_error, kSmallestMaxError, 1.0, "max_error");
    }
  }

  [[nodiscard]] const Medium& medium() const override { return air_.medium(); }

  [[nodiscard]] std::optional<std::string> Refusal(Quantity quantity) const override {
    return NeedsPolarisedLight(quantity) ? RefusalOfScalarLight(medium()) : std::nullopt;
  }

  void Prepare(std::span<const Case> cases) override {
    if (fine_light_ || std::none_of(cases.begin(), cases.end(), [](const Case& work) {
          return NeedsLightOfAllOrders(work.quantity);
        })) {
      return;
    }
    fine_light_.emplace(medium(), OptionsFor(medium()));
    const MultipleScatteringOptions& fine = fine_light_->options();
    coarse_light_.emplace(medium(), ComparableWith(fine, kCoarseLight));
    middling_light_.emplace(medium(), ComparableWith(fine, kMiddlingLight));
    if (!fine.delta_m) {
      missing_degrees_.emplace(medium(), fine.degree);
    } else if (DeltaM peak(medium(), fine.degree); peak.HasBackwardLobe()) {
      backward_lobe_.emplace(std::move(peak));
    }
  }

  [[nodiscard]] Estimates Evaluate(const Case& work) const override {
    switch (work.quantity) {
      case Quantity::kTransmittance:
        return Transmittance(work.ray);
      case Quantity::kOpticalDepth:
        return OpticalDepth(work.ray);
      case Quantity::kSingle:
        return Inscatter(work.ray) + SunlitGround(work.ray);
      case Quantity::kInscatterSingle:
        return Inscatter(work.ray);
      case Quantity::kTotal:
        return Inscatter(work.ray) + HigherOrders(work.ray) + LitGround(work.ray);
      case Quantity::kStokesQ:
      case Quantity::kStokesU:
        return Stokes(work);
      case Quantity::kIrradianceSun:
        return SunIrradiance(work.ray.altitude_m, work.ray.mu_s);
      case Quantity::kIrradianceSky:
        return SkyIrradiance(work.ray.altitude_m, work.ray.mu_s);
    }
    throw InternalError("a quantity without a method");
  }

 private:
  /// Returns whether the requested relative error is below this error.
  [[nodiscard]] bool NeedsReference(double error) const {
    return options_.max_error && *options_.max_error < error;
  }

  [[nodiscard]] Estimates OpticalDepth(const ViewRay& ray) const {
    if (NeedsReference(closed_form_error_)) return ReferenceOpticalDepth(ray);
    const SpectrumOf<double> depth = air_.OpticalDepthAlong(ray);
    Estimates result(depth.size());
    for (std::size_t band = 0; band < depth.size(); ++band) {
      result[band] = {depth[band], closed_form_error_ * depth[band]};
    }
    return result;
  }

  [[nodiscard]] Estimates ReferenceOpticalDepth(const ViewRay& ray) const {
    Estimates result;
    for (const double tau : reference::OpticalDepthAlong(medium(), ray).tau) {
      result.push_back({tau, kSmallestMaxError * tau});
    }
    return result;
  }

  [[nodiscard]] Estimates Transmittance(const ViewRay& ray) const {
    Estimates result = OpticalDepth(ray);
    const auto exponential = [](const Estimates& depth) {
      Estimates transmittance;
      for (const Estimate& tau : depth) {
        // Behind thick air the first factor underflows before the second overflows.
        const double value = std::exp(-tau.value);
        const double error =
            value > 0.0 ? value * std::expm1(tau.error) : std::exp(tau.error - tau.value);
        transmittance.push_back({value, error});
      }
      return transmittance;
    };
    const Estimates transmittance = exponential(result);
    if (!options_.max_error || WithinError(transmittance, *options_.max_error))
      return transmittance;
    return exponential(ReferenceOpticalDepth(ray));
  }

  [[nodiscard]] SpectrumOf<double> InscatterWith(const ViewRay& ray, int nodes) const {
    const Sampling sampling{.nodes = nodes, .split_ozone = true, .dark_samples = false};
    return air_.Inscatter(air_.Scatter(air_.Sample(ray, sampling)), ray.nu);
  }

  [[nodiscard]] Estimates Difference(const SpectrumOf<double>& fine,
                                     const SpectrumOf<double>& coarse) const {
    Estimates result(fine.size());
    for (std::size_t band = 0; band < fine.size(); ++band) {
      result[band] = {fine[band],
                      std::abs(fine[band] - coarse[band]) + fast_path_floor_ * fine[band]};
    }
    return result;
  }

  [[nodiscard]] Estimates Inscatter(const ViewRay& ray) const {
    if (!options_.max_error) {
      const int fewer = std::max(2 * options_.samples / 3, 1);
      return Difference(InscatterWith(ray, options_.samples), InscatterWith(ray, fewer));
    }
    if (*options_.max_error >= fast_path_floor_) {
      SpectrumOf<double> coarse = InscatterWith(ray, kLadder.front());
      for (std::size_t rung = 1; rung < kLadder.size(); ++rung) {
        const SpectrumOf<double> fine = InscatterWith(ray, kLadder[rung]);
        Estimates result = Difference(fine, coarse);
        if (WithinError(result, *options_.max_error)) return result;
        coarse = fine;
      }
    }
    const reference::RayRadiance reference = reference::SingleScatteringAlong(medium(), ray);
    Estimates result;
    for (const double value : reference.inscatter) {
      result.push_back({value, std::max(reference.error, kSmallestMaxError) * value});
    }
    return result;
  }

  [[nodiscard]] Estimates SunIrradiance(double altitude_m, double mu_s) const {
    if (mu_s <= 0.0) return Estimates(air_.bands());
    Estimates result = Transmittance(TowardsSun(altitude_m, mu_s));
    for (Estimate& estimate : result) estimate = estimate * Estimate{mu_s, 0.0};
    return result;
  }

  [[nodiscard]] Estimates SunlitGround(const ViewRay& ray) const {
    const std::optional<double> mu_s = SunOnGround(medium(), ray);
    if (!mu_s) return Estimates(air_.bands());
    return FromGround(medium(), Transmittance(ray), SunIrradiance(0.0, *mu_s));
  }

  [[nodiscard]] Estimates LitGround(const ViewRay& ray) const {
    const std::optional<double> mu_s = SunOnGround(medium(), ray);
    if (!mu_s) return Estimates(air_.bands());
    return FromGround(medium(), Transmittance(ray),
                      SunIrradiance(0.0, *mu_s) + SkyIrradiance(0.0, *mu_s));
  }

  /// Combines both differences and the floors into the error.
  /// @param least  error of light that is not resolved.
  [[nodiscard]] static Estimates Differences(const Spectrum& fine, const Spectrum& middling,
                                             const Spectrum& coarse, double least) {
    Estimates result(fine.size());
    for (std::size_t band = 0; band < fine.size(); ++band) {
      const double value = fine[band];
      const double differences =
          std::abs(value - double{middling[band]}) + std::abs(value - double{coarse[band]});
      result[band] = {value, kShareOfDifferences * differences +
                                 kFloorOfHigherOrders * std::abs(value) + least};
    }
    return result;
  }

  /// Returns the least error of light of higher orders [1/sr]. Where orders are missing, nothing is
  /// known of the rest but that it is less than the sunlight.
  [[nodiscard]] double LeastLight() const { return fine_light_->converged() ? kLeastLight : 1.0; }

  [[nodiscard]] Estimates HigherOrders(const ViewRay& ray) const {
    const RaySamples<float> samples =
        quick_air_.Sample(ray, {.nodes = 24, .split_ozone = false, .dark_samples = true});
    Estimates result = Differences(fine_light_->InscatterAlong(samples, ray.nu),
                                   middling_light_->InscatterAlong(samples, ray.nu),
                                   coarse_light_->InscatterAlong(samples, ray.nu), LeastLight());
    if (backward_lobe_) {
      const Spectrum lobe = backward_lobe_->BackwardError(samples, ray.nu);
      for (std::size_t band = 0; band < result.size(); ++band)
        result[band].error = kFactorOfBackwardLobes * result[band].error + double{lobe[band]};
    }
    if (fine_light_->peak() && samples.extent.end == RayEnd::kLength) {
      const Spectrum opaque = fine_light_->InscatterAlong(samples, ray.nu, SegmentEnd::kOpaque);
      for (std::size_t band = 0; band < result.size(); ++band) {
        result[band].error +=
            kShareOfLightBehind * std::abs(result[band].value - double{opaque[band]});
      }
    }
    if (!missing_degrees_) return result;
    const std::vector<double> missing =
        missing_degrees_->Along(quick_air_.constants(), samples, ray.nu);
    for (std::size_t band = 0; band < result.size(); ++band)
      result[band].error += kShareOfDifferences * missing[band];
    return result;
  }

  // The error is that of the differences between solutions, and of the closed forms.
  [[nodiscard]] Estimates Stokes(const Case& work) const {
    const ViewRay& ray = work.ray;
    const RaySamples<float> samples =
        quick_air_.Sample(ray, {.nodes = 24, .split_ozone = false, .dark_samples = true});
    const PolarisedLight once = PolarisedOnce(medium(), quick_air_.Scatter(samples), ray);
    const PolarisedLight fine = fine_light_->PolarisationAlong(samples, ray.nu);
    const PolarisedLight middling = middling_light_->PolarisationAlong(samples, ray.nu);
    const PolarisedLight coarse = coarse_light_->PolarisationAlong(samples, ray.nu);
    const auto sum = [&](const Spectrum& first, const Estimates& more) {
      Estimates result = more;
      for (std::size_t band = 0; band < result.size(); ++band) {
        const auto value = static_cast<double>(first[band]);
        result[band].value += value;
        result[band].error += fast_path_floor_ * std::abs(value);
      }
      return result;
    };
    return StokesOf(work, sum(once.q, Differences(fine.q, middling.q, coarse.q, LeastLight())),
                    sum(once.u, Differences(fine.u, middling.u, coarse.u, LeastLight())));
  }

  [[nodiscard]] Estimates SkyIrradiance(double altitude_m, double mu_s) const {
    return Differences(fine_light_->SkyIrradiance(altitude_m, mu_s),
                       middling_light_->SkyIrradiance(altitude_m, mu_s),
                       coarse_light_->SkyIrradiance(altitude_m, mu_s), kPi * LeastLight());
  }

  SingleScattering<double> air_;
  SingleScattering<float>
      quick_air_;  // for the samples along which multiple scattering is gathered
  IntegralOptions options_;
  double closed_form_error_, fast_path_floor_;  // relative errors
  std::optional<MultipleScattering> fine_light_, middling_light_, coarse_light_;
  std::optional<TruncationError> missing_degrees_;
  std::optional<DeltaM> backward_lobe_;
};

}  // namespace

std::unique_ptr<Evaluator> MakeIntegralEvaluator(const Medium& medium,
                                                 const IntegralOptions& options) {
  return std::make_unique<IntegralEvaluator>(medium, options);
}

}  // namespace alpenglow::lut
