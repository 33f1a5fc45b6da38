// SPDX-License-Identifier: MIT
#include "lut/eval.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string>

#include "atmosphere/error.h"
#include "lut/program.h"

namespace alpenglow {
namespace {

constexpr std::size_t kCasesAtOnce = 4096;

std::vector<Case> NextCases(CaseReader& reader, const Evaluator& evaluator) {
  std::vector<Case> cases;
  while (cases.size() < kCasesAtOnce) {
    std::optional<Case> next = reader.Next();
    if (!next) break;
    if (const auto refusal = evaluator.Refusal(next->quantity)) {
      reader.Fail(next->line, "its quantity " + *refusal);
    }
    cases.push_back(std::move(*next));
  }
  return cases;
}

std::string Lines(const Case& work, const Medium& medium, const Estimates& estimates) {
  std::string lines;
  for (std::size_t band = 0; band < estimates.size(); ++band) {
    // The error to three digits, rounded up.
    lines += fmt::format("{},{},{},{:.3g}\n", work.id, medium.wavelengths_nm[band],
                         estimates[band].value, 1.005 * estimates[band].error);
  }
  return lines;
}

}  // namespace

std::optional<double> SunOnGround(const Medium& medium, const ViewRay& ray) {
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  if (extent.end != RayEnd::kGround) return std::nullopt;
  const double r = medium.planet_radius_m + std::max(ray.altitude_m, 0.0);
  return std::clamp((r * ray.mu_s + extent.end_m * ray.nu) / medium.planet_radius_m, -1.0, 1.0);
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

void EvaluateFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                  Evaluator& evaluator, ProgressStyle style) {
  CaseReader reader(cases);
  Progress progress("bytes of cases", reader.bytes(), style);
  WriteFileAtomically(results, [&](const std::filesystem::path& name) {
    std::ofstream out(name, std::ios::binary);
    out << "id,wavelength_nm,value,error\n";
    std::uint64_t done = 0;
    while (true) {
      const std::vector<Case> work = NextCases(reader, evaluator);
      if (work.empty()) break;
      evaluator.Prepare(work);
      std::vector<std::string> lines(work.size());
      tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t i) {
        if (!Interrupted()) {
          lines[i] = Lines(work[i], evaluator.medium(), evaluator.Evaluate(work[i]));
        }
      });
      ThrowIfInterrupted();
      for (const std::string& text : lines) out << text;
      if (!out) throw OutputError(name.string() + ": cannot be written");
      progress.Advance(reader.bytes_read() - done);
      done = reader.bytes_read();
    }
    out.close();
    if (!out) throw OutputError(name.string() + ": cannot be written");
  });
}

}  // namespace alpenglow
