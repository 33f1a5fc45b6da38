// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/constants.h"
#include "atmosphere/error.h"
#include "lut/eval.h"

namespace alpenglow {
namespace {

class TableEvaluator final : public Evaluator {
 public:
  explicit TableEvaluator(TableFolder tables)
      : tables_(std::move(tables)),
        air_(tables_.medium),
        integral_(MakeIntegralEvaluator(tables_.medium)) {
    const auto require_medium = [this](const auto& table) {
      if (table && MediumHash(table->medium()) != MediumHash(tables_.medium)) {
        throw InputError("the tables were made for different atmospheres");
      }
    };
    require_medium(tables_.transmittance);
    require_medium(tables_.single_scattering);
    require_medium(tables_.multiple_scattering);
  }

  [[nodiscard]] const Medium& medium() const override { return tables_.medium; }

  [[nodiscard]] std::optional<std::string> Refusal(Quantity quantity) const override {
    if (tables_.multiple_scattering || !NeedsLightOfAllOrders(quantity)) return std::nullopt;
    return "needs light of all orders, which these tables do not hold; --method integral has it";
  }

  void Prepare(std::span<const Case> cases) override { integral_->Prepare(cases); }

  [[nodiscard]] Estimates Evaluate(const Case& work) const override {
    const std::vector<double> values = LookUp(work.quantity, work.ray);
    Estimates result = integral_->Evaluate(work);
    for (std::size_t band = 0; band < values.size(); ++band) {
      result[band].error += std::abs(values[band] - result[band].value);
      result[band].value = values[band];
    }
    return result;
  }

 private:
  [[nodiscard]] std::vector<double> LookUp(Quantity quantity, const ViewRay& ray) const {
    switch (quantity) {
      case Quantity::kTransmittance:
        return Transmittance(ray);
      case Quantity::kOpticalDepth:
        return OpticalDepth(ray);
      case Quantity::kSingle:
        return WithGround(ray, Inscatter(ray), false);
      case Quantity::kInscatterSingle:
        return Inscatter(ray);
      case Quantity::kIrradianceSun:
        return SunIrradiance(ray.altitude_m, ray.mu_s);
      case Quantity::kTotal:
        return Total(ray);
      case Quantity::kIrradianceSky:
        return Values(tables_.multiple_scattering->SkyIrradiance(ray.altitude_m, ray.mu_s));
    }
    throw InternalError("an unknown quantity");
  }

  [[nodiscard]] static std::vector<double> Values(const Bands<float>& bands) {
    return {bands.value.begin(), bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count)};
  }

  [[nodiscard]] std::vector<double> Transmittance(const ViewRay& ray) const {
    if (!tables_.transmittance) return Values(air_.TransmittanceAlong(ray));
    return Values(tables_.transmittance->LookupAlong(ray));
  }

  /// Transmittance that the table holds as 0 has the optical depth of the smallest float.
  [[nodiscard]] std::vector<double> OpticalDepth(const ViewRay& ray) const {
    if (!tables_.transmittance) return Values(air_.OpticalDepthAlong(ray));
    std::vector<double> depth = Transmittance(ray);
    constexpr double kSmallest = std::numeric_limits<float>::denorm_min();
    for (double& value : depth) value = -std::log(std::max(value, kSmallest));
    return depth;
  }

  [[nodiscard]] std::vector<double> Inscatter(const ViewRay& ray) const {
    if (tables_.single_scattering) {
      return Values(air_.Inscatter(tables_.single_scattering->Lookup(ray), ray.nu));
    }
    const Sampling lit{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = false};
    return Values(air_.Inscatter(air_.Scatter(air_.Sample(ray, lit)), ray.nu));
  }

  [[nodiscard]] std::vector<double> SunIrradiance(double altitude_m, double mu_s) const {
    if (mu_s <= 0.0) return std::vector<double>(air_.bands(), 0.0);
    std::vector<double> irradiance = Transmittance({altitude_m, mu_s, mu_s, 1.0});
    for (double& value : irradiance) value *= mu_s;
    return irradiance;
  }

  /// Adds what the ground at the end of the ray sends to the observer.
  [[nodiscard]] std::vector<double> WithGround(const ViewRay& ray, std::vector<double> light,
                                               bool under_the_sky) const {
    const std::optional<double> mu_s = SunOnGround(medium(), ray);
    if (!mu_s) return light;
    const std::vector<double> transmittance = Transmittance(ray);
    std::vector<double> irradiance = SunIrradiance(0.0, *mu_s);
    if (under_the_sky) {
      const Bands<float> sky = tables_.multiple_scattering->SkyIrradiance(0.0, *mu_s);
      for (std::size_t band = 0; band < sky.count; ++band) irradiance[band] += double{sky[band]};
    }
    for (std::size_t band = 0; band < light.size(); ++band) {
      light[band] += transmittance[band] * irradiance[band] * medium().ground_albedo[band] / kPi;
    }
    return light;
  }

  [[nodiscard]] std::vector<double> Total(const ViewRay& ray) const {
    std::vector<double> light = Inscatter(ray);
    const Sampling all{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = true};
    const Bands<float> more =
        tables_.multiple_scattering->InscatterAlong(air_.Sample(ray, all), ray.nu);
    for (std::size_t band = 0; band < light.size(); ++band) light[band] += double{more[band]};
    return WithGround(ray, std::move(light), true);
  }

  TableFolder tables_;
  AirIntegrator<float> air_;
  std::unique_ptr<Evaluator> integral_;
};

}  // namespace

std::unique_ptr<Evaluator> MakeTableEvaluator(TableFolder tables) {
  return std::make_unique<TableEvaluator>(std::move(tables));
}

}  // namespace alpenglow
