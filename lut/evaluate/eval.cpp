// SPDX-License-Identifier: MIT
#include "lut/evaluate/eval.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/path_tracer.h"
#include "lut/cli/program.h"
#include "lut/evaluate/case_results.h"
#include "lut/evaluate/integral_evaluator.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow::lut {
namespace {

enum Column : std::size_t { kId, kQuantity, kAltitude, kView, kAzimuth, kSun, kDistance };
constexpr std::array<std::string_view, 7> kColumnNames{"id",
                                                       "quantity",
                                                       "altitude_m",
                                                       "view_zenith_deg",
                                                       "relative_azimuth_deg",
                                                       "sun_zenith_deg",
                                                       "distance_m"};

constexpr EnumNames kQuantities{{
    std::pair{Quantity::kInscatterSingle, "inscatter_single"},
    {Quantity::kIrradianceSky, "irradiance_sky"},
    {Quantity::kIrradianceSun, "irradiance_sun"},
    {Quantity::kOpticalDepth, "optical_depth"},
    {Quantity::kSingle, "single"},
    {Quantity::kStokesQ, "stokes_q"},
    {Quantity::kStokesU, "stokes_u"},
    {Quantity::kTotal, "total"},
    {Quantity::kTransmittance, "transmittance"},
}};

std::string Lines(const Case& work, const Medium& medium, const Estimates& estimates) {
  std::string lines;
  for (std::size_t band = 0; band < estimates.size(); ++band) {
    lines += ResultLine(work.id, fmt::format("{}", medium.wavelengths_nm[band]), estimates[band]);
  }
  return lines;
}

Estimates WithErrors(const std::vector<double>& values, const std::vector<double>& errors) {
  Estimates result(values.size());
  for (std::size_t band = 0; band < values.size(); ++band)
    result[band] = {values[band], errors[band]};
  return result;
}

class PathEvaluator final : public Evaluator {
 public:
  PathEvaluator(const Medium& medium, const reference::PathOptions& options)
      : medium_(medium), black_ground_(medium), paths_(options) {
    Validate(medium);
    RequireInRange(options.relative_error, kSmallestMaxError, 1.0, "max_error");
    std::fill(black_ground_.ground_albedo.begin(), black_ground_.ground_albedo.end(), 0.0);
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
    reference::PathOptions options = paths_;
    if (work.quantity != Quantity::kTotal) options.max_order = 1;
    const bool air_only = work.quantity == Quantity::kInscatterSingle;
    const auto traced =
        reference::TraceRadiance(air_only ? black_ground_ : medium_, work.ray, options);
    return WithErrors(traced.total, traced.standard_error);
  }

 private:
  [[nodiscard]] Estimates Stokes(const Case& work) const {
    const auto traced =
        reference::TraceStokes(medium_, reference::ScatteringOf(medium_), work.ray, paths_);
    return StokesOf(work, WithErrors(traced.q.total, traced.q.standard_error),
                    WithErrors(traced.u.total, traced.u.standard_error));
  }

  [[nodiscard]] Estimates SkyIrradiance(const ViewRay& ray) const {
    // A plane above the air receives only direct sunlight from above.
    if (ray.altitude_m > medium_.atmosphere_height_m)
      return Estimates(medium_.wavelengths_nm.size());
    const auto traced = reference::TraceIrradiance(medium_, std::max(ray.altitude_m, 0.0), ray.mu_s,
                                                   reference::PlaneSide::kFromAbove, paths_);
    return WithErrors(traced.value, traced.standard_error);
  }

  Medium medium_;
  Medium black_ground_;
  reference::PathOptions paths_;
};

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
    return WithValues(std::move(result), ValuesOf(LookUp(work.quantity, work.ray)));
  }

 private:
  [[nodiscard]] static Estimates ValuesOf(const Spectrum& bands) {
    Estimates values(bands.size());
    for (std::size_t band = 0; band < bands.size(); ++band)
      values[band].value = static_cast<double>(bands[band]);
    return values;
  }

  // Replaces the values of the integral and increases its error by the difference.
  [[nodiscard]] static Estimates WithValues(Estimates integral, const Estimates& values) {
    for (std::size_t band = 0; band < values.size(); ++band) {
      integral[band].error += std::abs(values[band].value - integral[band].value);
      integral[band].value = values[band].value;
    }
    return integral;
  }

  [[nodiscard]] Estimates Stokes(const Case& work) const {
    const PolarisedLight light = tables_.PolarisationOfAllOrders(work.ray);
    return StokesOf(work, ValuesOf(light.q), ValuesOf(light.u));
  }

  [[nodiscard]] Spectrum LookUp(Quantity quantity, const ViewRay& ray) const {
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

  /// Adds the light that the ground at the end of the ray reflects to the observer.
  [[nodiscard]] Spectrum WithGround(const ViewRay& ray, Spectrum light, bool under_the_sky) const {
    const std::optional<double> mu_s = SunOnGround(medium(), ray);
    if (!mu_s) return light;
    const Spectrum transmittance = tables_.Transmittance(ray);
    const Spectrum sun = tables_.SunIrradiance(0.0, *mu_s);
    const Spectrum sky = under_the_sky ? tables_.SkyIrradiance(0.0, *mu_s) : Spectrum(light.size());
    for (std::size_t band = 0; band < light.size(); ++band) {
      light[band] += transmittance[band] * (sun[band] + sky[band]) *
                     static_cast<float>(medium().ground_albedo[band] / kPi);
    }
    return light;
  }

  TableLookup tables_;
  std::unique_ptr<Evaluator> integral_;
};

}  // namespace

void CaseIds::Add(const std::string& id, const CsvReader& lines) {
  if (id.empty()) lines.Fail(lines.line(), "id is empty");
  const auto [same, is_new] = line_of_.try_emplace(id, lines.line());
  if (is_new) return;
  lines.Fail(lines.line(),
             fmt::format("id is \"{}\", as in line {}; ids must be different", id, same->second));
}

CaseReader::CaseReader(const std::filesystem::path& file) : lines_(file, kColumnNames) {}

std::optional<Case> CaseReader::Next() {
  if (!lines_.Next()) return std::nullopt;
  Case result;
  result.line = lines_.line();
  result.id = lines_.Field(kId);
  ids_.Add(result.id, lines_);
  if (lines_.Field(kQuantity) == "airlight") {
    Fail(result.line,
         "quantity airlight has columns of its own; put such cases in a file of theirs");
  }
  const std::optional<Quantity> quantity = kQuantities.Find(lines_.Field(kQuantity));
  if (!quantity) {
    Fail(result.line, fmt::format("quantity is \"{}\"; it must be one of {}",
                                  lines_.Field(kQuantity), fmt::join(kQuantities.All(), ", ")));
  }
  result.quantity = *quantity;
  const double altitude_m = lines_.Number(kAltitude, -12000.0, 1e9);
  const double view_deg = lines_.Number(kView, 0.0, 180.0);
  result.relative_azimuth_deg = lines_.Number(kAzimuth, -360.0, 360.0);
  result.ray = RayFromAngles(altitude_m, view_deg, result.relative_azimuth_deg,
                             lines_.Number(kSun, 0.0, 180.0));
  if (!lines_.Field(kDistance).empty()) {
    result.ray.length_m = lines_.Number(kDistance, 0.0, 1e12);
  }
  return result;
}

std::optional<double> SunOnGround(const Medium& medium, const ViewRay& ray) {
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  if (!BringsLightOfGround(ray, extent)) return std::nullopt;
  const double r = medium.planet_radius_m + std::max(ray.altitude_m, 0.0);
  return std::clamp((r * ray.mu_s + extent.end_m * ray.nu) / medium.planet_radius_m, -1.0, 1.0);
}

std::optional<std::string> RefusalOfScalarLight(const Medium& medium) {
  if (medium.polarised) return std::nullopt;
  return "needs polarised light; the atmosphere has polarised = false";
}

Estimates StokesOf(const Case& work, const Estimates& q, const Estimates& u) {
  constexpr double kVertical = 1e-12;  // limit of the squared sine
  const double azimuth = work.relative_azimuth_deg * kRadiansPerDegree;
  const double side = std::sin(azimuth) < 0.0 ? -1.0 : 1.0;
  const bool vertical = (1.0 - work.ray.mu) * (1.0 + work.ray.mu) < kVertical;
  // For a vertical view, treated as tilted towards the sun, U is 0 by symmetry, and Q rotates by
  // the azimuth together with the picture, in one direction for upward and in the other for
  // downward views.
  const double turn = work.ray.mu > 0.0 ? 2.0 * azimuth : -2.0 * azimuth;
  Estimates result(q.size());
  for (std::size_t band = 0; band < q.size(); ++band) {
    if (work.quantity == Quantity::kStokesQ) {
      result[band] = q[band];
      if (vertical) result[band].value *= std::cos(turn);
    } else {
      result[band] = {side * u[band].value, u[band].error};
      if (vertical) result[band] = {q[band].value * std::sin(turn), q[band].error};
    }
  }
  return result;
}

double ClosedFormError(const Medium& medium) {
  const double height_m = std::max(medium.rayleigh_scale_height_m, medium.mie_scale_height_m);
  const double columns = 0.3 * std::pow(height_m / medium.planet_radius_m, 2.0);
  if (medium.ozone.shape == OzoneShape::kTent) return std::max(kClosedFormError, columns);
  const double ozone = 4e-4 * std::pow(3.0 * medium.ozone.top_m / medium.planet_radius_m, 4.0);
  return std::max(kClosedFormError, columns + ozone);
}

std::optional<double> RelativeErrorFromText(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  const std::optional<double> number = ParseNumber(text);
  if (!number) return std::nullopt;
  const double value = percent ? *number / 100.0 : *number;
  return value >= kSmallestMaxError && value <= 1.0 ? std::optional(value) : std::nullopt;
}

std::string FaultOfRelativeError(const std::string& text) {
  return RelativeErrorFromText(text) ? "" : "it must be 1e-8 to 1, or a percentage like 0.2%";
}

void EvaluateFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                  Evaluator& evaluator, ProgressStyle style) {
  CaseReader reader(cases);
  const auto prepare = [&](std::span<const Case> work) {
    for (const Case& next : work) {
      if (const auto refusal = evaluator.Refusal(next.quantity)) {
        reader.Fail(next.line, "its quantity " + *refusal);
      }
    }
    evaluator.Prepare(work);
  };
  WriteCaseResults(reader, results, style, prepare, [&](const Case& work) {
    return Lines(work, evaluator.medium(), evaluator.Evaluate(work));
  });
}

std::unique_ptr<Evaluator> MakePathTraceEvaluator(const Medium& medium,
                                                  const reference::PathOptions& options) {
  return std::make_unique<PathEvaluator>(medium, options);
}

std::unique_ptr<Evaluator> MakeTableEvaluator(TableFolder tables) {
  return std::make_unique<TableEvaluator>(std::move(tables));
}

}  // namespace alpenglow::lut
