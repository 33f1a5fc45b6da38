// SPDX-License-Identifier: MIT
// The stored cases of lamps in homogeneous air, as lamps, air and segments.
#pragma once

#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/airlight.h"
#include "atmosphere/constants.h"
#include "tests/stored_cases.h"

namespace alpenglow::stored {

struct LampCase {
  std::string id;
  LampAir air;
  Lamp lamp;
  LampSegment segment;
  double radiance;  // of the stored result
};

inline LampCase LampCaseOf(const Row& row, double radiance) {
  LampCase made;
  made.id = row.at("id");
  made.air = HomogeneousAir(
      Number(row, "sigma_s"), Number(row, "sigma_t"),
      {.kind = row.at("phase") == "CS" ? PhaseKind::kCornetteShanks : PhaseKind::kHenyeyGreenstein,
       .g = Number(row, "g")});
  made.lamp.position_m = {Number(row, "a_m"), Number(row, "d_m"), 0.0};
  const double length = Number(row, "D_m");
  if (length >= 0.0) made.segment.end_m = length;
  LampProfile& profile = made.lamp.profile;
  if (row.at("profile") != "iso") {
    made.lamp.axis =
        glm::normalize(glm::dvec3(Number(row, "ax"), Number(row, "ay"), Number(row, "az")));
    made.lamp.side = glm::normalize(glm::cross(made.lamp.axis, glm::dvec3(0.3, -0.5, 0.8)));
  }
  if (row.at("profile") == "cosn") {
    profile.kind = LampProfile::Kind::kCosinePower;
    profile.exponent = Number(row, "n");
  }
  if (row.at("profile") == "cone") {
    profile.kind = LampProfile::Kind::kCone;
    profile.inner_rad = Number(row, "inner_deg") * kRadiansPerDegree;
    profile.outer_rad = Number(row, "outer_deg") * kRadiansPerDegree;
  }
  made.radiance = radiance;
  return made;
}

inline std::vector<LampCase> LampCases() {
  const auto results = Results("airlight_results.csv");
  std::vector<LampCase> cases;
  for (const Row& row : Read("airlight.csv")) {
    cases.push_back(LampCaseOf(row, Number(results.at(row.at("id")).front(), "radiance")));
  }
  return cases;
}

}  // namespace alpenglow::stored
