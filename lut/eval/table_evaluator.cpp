// SPDX-License-Identifier: MIT
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/eval/eval.h"
#include "lut/store/table_lookup.h"

namespace alpenglow::lut {
namespace {

class TableEvaluator final : public Evaluator {
 public:
  explicit TableEvaluator(TableFolder tables)
      : tables_(std::move(tables)), integral_(MakeIntegralEvaluator(tables_.medium())) {}

  [[nodiscard]] const Medium& medium() const override { return tables_.medium(); }

  [[nodiscard]] std::optional<std::string> Refusal(Quantity quantity) const override {
    if (const auto refusal = integral_->Refusal(quantity)) return refusal;
    if (tables_.tables().multiple_scattering || !NeedsLightOfAllOrders(quantity)) {
      return std::nullopt;
    }
    return "needs light of all orders, which these tables do not hold; --method integral has it";
  }

  void Prepare(std::span<const Case> cases) override { integral_->Prepare(cases); }

  [[nodiscard]] Estimates Evaluate(const Case& work) const override {
    Estimates result = integral_->Evaluate(work);
    if (NeedsPolarisedLight(work.quantity)) return WithValues(std::move(result), Stokes(work));
    const Bands<float> found = LookUp(work.quantity, work.ray);
    Estimates values(found.count);
    for (std::size_t band = 0; band < found.count; ++band)
      values[band].value = static_cast<double>(found[band]);
    return WithValues(std::move(result), values);
  }

 private:
  // The error grows by the distance to the values.
  [[nodiscard]] static Estimates WithValues(Estimates integral, const Estimates& values) {
    for (std::size_t band = 0; band < values.size(); ++band) {
      integral[band].error += std::abs(values[band].value - integral[band].value);
      integral[band].value = values[band].value;
    }
    return integral;
  }

  [[nodiscard]] Estimates Stokes(const Case& work) const {
    const PolarisedLight light = tables_.PolarisationOfAllOrders(work.ray);
    const auto of = [](const Bands<float>& bands) {
      Estimates values(bands.count);
      for (std::size_t band = 0; band < bands.count; ++band)
        values[band].value = static_cast<double>(bands[band]);
      return values;
    };
    return StokesOf(work, of(light.q), of(light.u));
  }

  [[nodiscard]] Bands<float> LookUp(Quantity quantity, const ViewRay& ray) const {
    switch (quantity) {
      case Quantity::kTransmittance:
        return tables_.Transmittance(ray);
      case Quantity::kOpticalDepth:
        return tables_.OpticalDepth(ray);
      case Quantity::kSingle:
        return WithGround(ray, tables_.InscatterOnce(ray), false);
      case Quantity::kInscatterSingle:
        return tables_.InscatterOnce(ray);
      case Quantity::kTotal:
        return WithGround(ray, tables_.InscatterOfAllOrders(ray), true);
      case Quantity::kStokesQ:
      case Quantity::kStokesU:
        break;
      case Quantity::kIrradianceSun:
        return tables_.SunIrradiance(ray.altitude_m, ray.mu_s);
      case Quantity::kIrradianceSky:
        return tables_.SkyIrradiance(ray.altitude_m, ray.mu_s);
    }
    throw InternalError("an unknown quantity");
  }

  /// Adds what the ground at the end of the ray sends to the observer.
  [[nodiscard]] Bands<float> WithGround(const ViewRay& ray, Bands<float> light,
                                        bool under_the_sky) const {
    const std::optional<double> mu_s = SunOnGround(medium(), ray);
    if (!mu_s) return light;
    const Bands<float> transmittance = tables_.Transmittance(ray);
    const Bands<float> sun = tables_.SunIrradiance(0.0, *mu_s);
    const Bands<float> sky =
        under_the_sky ? tables_.SkyIrradiance(0.0, *mu_s) : Bands<float>(light.count);
    for (std::size_t band = 0; band < light.count; ++band) {
      light[band] += transmittance[band] * (sun[band] + sky[band]) *
                     static_cast<float>(medium().ground_albedo[band] / kPi);
    }
    return light;
  }

  TableLookup tables_;
  std::unique_ptr<Evaluator> integral_;
};

}  // namespace

std::unique_ptr<Evaluator> MakeTableEvaluator(TableFolder tables) {
  return std::make_unique<TableEvaluator>(std::move(tables));
}

}  // namespace alpenglow::lut
