// SPDX-License-Identifier: MIT
#include "lut/eval/eval.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/eval/case_results.h"

namespace alpenglow::lut {
namespace {

std::string Lines(const Case& work, const Medium& medium, const Estimates& estimates) {
  std::string lines;
  for (std::size_t band = 0; band < estimates.size(); ++band) {
    lines += ResultLine(work.id, fmt::format("{}", medium.wavelengths_nm[band]), estimates[band]);
  }
  return lines;
}

}  // namespace

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
  constexpr double kVertical = 1e-12;  // of the sine squared
  const double azimuth = work.relative_azimuth_deg * kRadiansPerDegree;
  const double side = std::sin(azimuth) < 0.0 ? -1.0 : 1.0;
  const bool vertical = (1.0 - work.ray.mu) * (1.0 + work.ray.mu) < kVertical;
  // Of the vertical view as if tilted towards the sun, U is 0 by symmetry, and Q turns by the
  // azimuth with the picture, one way above and the other below.
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
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (percent) value /= 100.0;
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

}  // namespace alpenglow::lut
