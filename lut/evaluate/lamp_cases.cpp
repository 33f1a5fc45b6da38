// SPDX-License-Identifier: MIT
#include "lut/evaluate/lamp_cases.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/airlight_reference.h"
#include "lut/evaluate/case_results.h"
#include "lut/evaluate/integral_evaluator.h"

namespace alpenglow::lut {
namespace {

constexpr std::array<std::string_view, 16> kLampColumnNames{
    "id",        "quantity",      "scattering_per_m", "extinction_per_m", "phase",  "g",
    "segment_m", "light_along_m", "light_across_m",   "profile",          "axis_x", "axis_y",
    "axis_z",    "exponent",      "inner_deg",        "outer_deg"};
enum LampColumn : std::size_t {
  kLampId,
  kLampQuantity,
  kScattering,
  kExtinction,
  kPhase,
  kG,
  kSegment,
  kAlong,
  kAcross,
  kProfile,
  kAxisX,
  kAxisY,
  kAxisZ,
  kExponent,
  kInner,
  kOuter
};

constexpr double kFarthest_m = 1e9;

// Error that the difference of two numbers of nodes does not detect: that of the reference
// solution; and the smallest error for which node counts are compared.
constexpr double kFloor = 1e-9;
constexpr double kSmallestByNodes = 1e-3;

}  // namespace

bool HoldsLampCases(const std::filesystem::path& file) {
  return HeaderNames(file, kLampColumnNames[kAlong]);
}

LampCaseReader::LampCaseReader(const std::filesystem::path& file)
    : lines_(file, kLampColumnNames) {}

std::optional<LampCase> LampCaseReader::Next() {
  if (!lines_.Next()) return std::nullopt;
  const auto fail = [&](const std::string& fault) { lines_.Fail(lines_.line(), fault); };
  LampCase made;
  made.id = lines_.Field(kLampId);
  made.line = lines_.line();
  ids_.Add(made.id, lines_);
  if (lines_.Field(kLampQuantity) != "airlight") {
    fail(fmt::format("quantity is \"{}\"; in a file of lamps it must be airlight",
                     lines_.Field(kLampQuantity)));
  }
  made.air = Air();
  made.lamp = ReadLamp();
  if (!lines_.Field(kSegment).empty()) {
    made.segment.end_m = lines_.Number(kSegment, 0.0, kFarthest_m);
  }
  const double along = made.lamp.position_m.x;
  if (made.lamp.position_m.y == 0.0 && along >= 0.0 && along <= made.segment.end_m) {
    fail(
        "light_across_m is 0 and the lamp lies on the segment, where a point of light is "
        "infinitely bright");
  }
  return made;
}

LampAir LampCaseReader::Air() const {
  const double scattering = lines_.Number(kScattering, 0.0, 1e5);
  const double extinction = lines_.Number(kExtinction, 0.0, 1e5);
  if (scattering > extinction) {
    lines_.Fail(lines_.line(), fmt::format("scattering_per_m is {}; it must not be more than "
                                           "extinction_per_m, {}",
                                           scattering, extinction));
  }
  const std::string_view phase = lines_.Field(kPhase);
  if (phase != "henyey-greenstein" && phase != "cornette-shanks") {
    lines_.Fail(lines_.line(), fmt::format("phase is \"{}\"; it must be henyey-greenstein or "
                                           "cornette-shanks",
                                           phase));
  }
  const double g = lines_.Number(kG, -0.9999, 0.9999);
  return HomogeneousAir(scattering, extinction, {.kind = PhaseKindFromName(phase), .g = g});
}

void LampCaseReader::ReadAxis(Lamp& lamp) const {
  const glm::dvec3 axis(lines_.Number(kAxisX, -1e6, 1e6), lines_.Number(kAxisY, -1e6, 1e6),
                        lines_.Number(kAxisZ, -1e6, 1e6));
  const double length = glm::length(axis);
  if (!(length > 0.0)) lines_.Fail(lines_.line(), "axis_x, axis_y and axis_z are all 0");
  lamp.axis = axis / length;
  const glm::dvec3 other =
      std::abs(lamp.axis.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  lamp.side = glm::normalize(glm::cross(lamp.axis, other));
}

Lamp LampCaseReader::ReadLamp() const {
  Lamp lamp;
  lamp.position_m = {lines_.Number(kAlong, -kFarthest_m, kFarthest_m),
                     lines_.Number(kAcross, -kFarthest_m, kFarthest_m), 0.0};
  const std::string_view profile = lines_.Field(kProfile);
  if (profile == "iso") return lamp;
  if (profile == "cosn") {
    lamp.profile.kind = LampProfile::Kind::kCosinePower;
    lamp.profile.exponent = lines_.Number(kExponent, 0.0, 1e6);
  } else if (profile == "cone") {
    lamp.profile.kind = LampProfile::Kind::kCone;
    lamp.profile.inner_rad = lines_.Number(kInner, 0.0, 180.0) * kRadiansPerDegree;
    lamp.profile.outer_rad = lines_.Number(kOuter, 0.0, 180.0) * kRadiansPerDegree;
    if (!(lamp.profile.inner_rad < lamp.profile.outer_rad)) {
      lines_.Fail(lines_.line(), fmt::format("inner_deg is {}; it must be less than outer_deg, {}",
                                             lines_.Field(kInner), lines_.Field(kOuter)));
    }
  } else {
    lines_.Fail(lines_.line(),
                fmt::format("profile is \"{}\"; it must be iso, cosn or cone", profile));
  }
  ReadAxis(lamp);
  return lamp;
}

Estimate EvaluateLamp(const LampCase& work, const IntegralOptions& options) {
  const auto with = [&](int nodes) {
    return Airlight(work.air, work.lamp, work.segment, nodes)[0];
  };
  const auto estimate = [](double fine, double coarse) {
    return Estimate{fine, std::abs(fine - coarse) + kFloor * fine};
  };
  if (!options.max_error) {
    return estimate(with(options.samples),
                    with(std::max(2 * options.samples / 3, kFewestLampNodes)));
  }
  // Two numbers of nodes may agree by chance; agreement of three is accepted.
  double coarse = with(8);
  double last_difference = std::numeric_limits<double>::infinity();
  for (const int nodes : {12, 16, 24, 32, 48, 64}) {
    if (*options.max_error < kSmallestByNodes) break;
    Estimate found = estimate(with(nodes), coarse);
    const double difference = std::abs(found.value - coarse);
    found.error = std::max(found.error, last_difference / 3.0);
    if (found.error <= *options.max_error * found.value) return found;
    coarse = found.value;
    last_difference = difference;
  }
  const reference::LampLight reference =
      reference::AirlightAlong(work.air, work.lamp, work.segment);
  const double value = reference.radiance[0];
  return {value, std::max(reference.error, kFloor) * value};
}

void EvaluateLampFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                      const IntegralOptions& options, ProgressStyle style) {
  LampCaseReader reader(cases);
  WriteCaseResults(reader, results, style, [&](const LampCase& work) {
    const Estimate found = EvaluateLamp(work, options);
    return ResultLine(work.id, "", found);
  });
}

}  // namespace alpenglow::lut
