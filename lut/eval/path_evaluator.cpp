// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "atmosphere/judge/path_tracer.h"
#include "atmosphere/text/error.h"
#include "lut/eval/eval.h"
#include "lut/program/program.h"

namespace alpenglow::lut {
namespace {

Estimates WithErrors(const std::vector<double>& values, const std::vector<double>& errors) {
  Estimates result(values.size());
  for (std::size_t band = 0; band < values.size(); ++band)
    result[band] = {values[band], errors[band]};
  return result;
}

class PathEvaluator final : public Evaluator {
 public:
  PathEvaluator(const Medium& medium, const PathTraceOptions& options)
      : medium_(medium), black_ground_(medium) {
    Validate(medium);
    RequireInRange(options.max_error, kSmallestMaxError, 1.0, "max_error");
    std::fill(black_ground_.ground_albedo.begin(), black_ground_.ground_albedo.end(), 0.0);
    paths_.seed = options.seed;
    paths_.max_paths = options.max_paths;
    paths_.relative_error = options.max_error;
    paths_.stopped = Interrupted;
  }

  [[nodiscard]] const Medium& medium() const override { return medium_; }

  [[nodiscard]] std::optional<std::string> Refusal(Quantity quantity) const override {
    switch (quantity) {
      case Quantity::kSingle:
      case Quantity::kInscatterSingle:
      case Quantity::kTotal:
      case Quantity::kIrradianceSky:
        return std::nullopt;
      case Quantity::kStokesQ:
      case Quantity::kStokesU:
        return RefusalOfScalarLight(medium_);
      case Quantity::kTransmittance:
      case Quantity::kOpticalDepth:
      case Quantity::kIrradianceSun:
        break;
    }
    return "is not scattered light, which is what paths are traced for; --method integral has it";
  }

  void Prepare(std::span<const Case>) override {}

  [[nodiscard]] Estimates Evaluate(const Case& work) const override {
    if (work.quantity == Quantity::kIrradianceSky) return SkyIrradiance(work.ray);
    if (NeedsPolarisedLight(work.quantity)) return Stokes(work);
    judge::PathOptions options = paths_;
    if (work.quantity != Quantity::kTotal) options.max_order = 1;
    const bool air_only = work.quantity == Quantity::kInscatterSingle;
    const auto traced = judge::TraceRadiance(air_only ? black_ground_ : medium_, work.ray, options);
    return WithErrors(traced.total, traced.standard_error);
  }

 private:
  [[nodiscard]] Estimates Stokes(const Case& work) const {
    const auto traced = judge::TraceStokes(medium_, judge::ScatteringOf(medium_), work.ray, paths_);
    return StokesOf(work, WithErrors(traced.q.total, traced.q.standard_error),
                    WithErrors(traced.u.total, traced.u.standard_error));
  }

  [[nodiscard]] Estimates SkyIrradiance(const ViewRay& ray) const {
    // Nothing shines down on a plane above the air but the sun itself.
    if (ray.altitude_m > medium_.atmosphere_height_m)
      return Estimates(medium_.wavelengths_nm.size());
    const auto traced = judge::TraceIrradiance(medium_, std::max(ray.altitude_m, 0.0), ray.mu_s,
                                               judge::PlaneSide::kFromAbove, paths_);
    return WithErrors(traced.value, traced.standard_error);
  }

  Medium medium_;
  Medium black_ground_;
  judge::PathOptions paths_;
};

}  // namespace

std::unique_ptr<Evaluator> MakePathTraceEvaluator(const Medium& medium,
                                                  const PathTraceOptions& options) {
  return std::make_unique<PathEvaluator>(medium, options);
}

}  // namespace alpenglow::lut
