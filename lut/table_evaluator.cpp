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
  TableEvaluator(TransmittanceTable transmittance, ScatteringTable single_scattering)
      : transmittance_(std::move(transmittance)),
        single_scattering_(std::move(single_scattering)),
        air_(transmittance_.medium()),
        integral_(MakeIntegralEvaluator(transmittance_.medium())) {
    if (MediumHash(transmittance_.medium()) != MediumHash(single_scattering_.medium())) {
      throw InputError(
          "the tables of transmittance and of single scattering were made for "
          "different atmospheres");
    }
  }

  [[nodiscard]] const Medium& medium() const override { return transmittance_.medium(); }

  [[nodiscard]] std::optional<std::string> Refusal(Quantity quantity) const override {
    if (!NeedsLightOfAllOrders(quantity)) return std::nullopt;
    return "needs light of all orders, which these tables do not hold; --method integral has it";
  }

  void Prepare(std::span<const Case>) override {}

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
        return Values(transmittance_.LookupAlong(ray));
      case Quantity::kOpticalDepth:
        return OpticalDepth(ray);
      case Quantity::kSingle:
        return Single(ray);
      case Quantity::kInscatterSingle:
        return Inscatter(ray);
      case Quantity::kIrradianceSun:
        return SunIrradiance(ray.altitude_m, ray.mu_s);
      case Quantity::kTotal:
      case Quantity::kIrradianceSky:
        break;
    }
    throw InternalError("a quantity that was to be refused");
  }

  [[nodiscard]] static std::vector<double> Values(const Bands<float>& bands) {
    return {bands.value.begin(), bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count)};
  }

  /// Transmittance that the table holds as 0 has the optical depth of the smallest float.
  [[nodiscard]] std::vector<double> OpticalDepth(const ViewRay& ray) const {
    std::vector<double> depth = Values(transmittance_.LookupAlong(ray));
    constexpr double kSmallest = std::numeric_limits<float>::denorm_min();
    for (double& value : depth) value = -std::log(std::max(value, kSmallest));
    return depth;
  }

  [[nodiscard]] std::vector<double> Inscatter(const ViewRay& ray) const {
    return Values(air_.Inscatter(single_scattering_.Lookup(ray), ray.nu));
  }

  [[nodiscard]] std::vector<double> SunIrradiance(double altitude_m, double mu_s) const {
    if (mu_s <= 0.0) return std::vector<double>(air_.bands(), 0.0);
    std::vector<double> irradiance = Values(transmittance_.Lookup(altitude_m, mu_s));
    for (double& value : irradiance) value *= mu_s;
    return irradiance;
  }

  [[nodiscard]] std::vector<double> Single(const ViewRay& ray) const {
    std::vector<double> light = Inscatter(ray);
    const std::optional<double> mu_s = SunOnGround(medium(), ray);
    if (!mu_s) return light;
    const std::vector<double> transmittance = Values(transmittance_.LookupAlong(ray));
    const std::vector<double> irradiance = SunIrradiance(0.0, *mu_s);
    for (std::size_t band = 0; band < light.size(); ++band) {
      light[band] += transmittance[band] * irradiance[band] * medium().ground_albedo[band] / kPi;
    }
    return light;
  }

  TransmittanceTable transmittance_;
  ScatteringTable single_scattering_;
  AirIntegrator<float> air_;
  std::unique_ptr<Evaluator> integral_;
};

}  // namespace

std::unique_ptr<Evaluator> MakeTableEvaluator(TransmittanceTable transmittance,
                                              ScatteringTable single_scattering) {
  return std::make_unique<TableEvaluator>(std::move(transmittance), std::move(single_scattering));
}

}  // namespace alpenglow
