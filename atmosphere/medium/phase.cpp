// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"

namespace alpenglow::atmosphere {

ScatteringMatrix RayleighMatrix(double depolarisation, double cos_scattering) {
  const double c = cos_scattering;
  const double round = (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation);
  const double circular = (1.0 - 2.0 * depolarisation) / (1.0 - depolarisation);
  const double polarising = 3.0 / (16.0 * kPi) * round;
  ScatteringMatrix matrix;
  matrix.a2 = polarising * (1.0 + c * c);
  matrix.a1 = matrix.a2 + (1.0 - round) / (4.0 * kPi);
  matrix.a3 = 2.0 * polarising * c;
  matrix.a4 = circular * matrix.a3;
  matrix.b1 = -polarising * (1.0 - c) * (1.0 + c);
  return matrix;
}

double AirDepolarisation(double wavelength_nm) {
  const double x = std::pow(1000.0 / wavelength_nm, 2);  // 1/um^2
  struct Gas {
    double percent, king_factor;
  };
  const Gas gases[] = {{78.084, 1.034 + 3.17e-4 * x},                      // nitrogen
                       {20.946, 1.096 + 1.385e-3 * x + 1.448e-4 * x * x},  // oxygen
                       {0.934, 1.0},                                       // argon
                       {0.036, 1.15}};                                     // carbon dioxide
  double all = 0.0, sum = 0.0;
  for (const Gas& gas : gases) {
    all += gas.percent;
    sum += gas.percent * gas.king_factor;
  }
  const double king_factor = sum / all;
  return 6.0 * (king_factor - 1.0) / (7.0 * king_factor + 3.0);
}

ScatteringMatrix SphereMatrix(const SphereRatios& ratios, double phase_per_sr,
                              double cos_scattering) {
  const std::size_t intervals = ratios.a3.size() - 1;
  const double position =
      std::acos(std::clamp(cos_scattering, -1.0, 1.0)) / kPi * static_cast<double>(intervals);
  const std::size_t i = std::min(static_cast<std::size_t>(position), intervals - 1);
  const auto at = [&](const std::vector<double>& ratio) {
    return phase_per_sr * std::lerp(ratio[i], ratio[i + 1], position - static_cast<double>(i));
  };
  ScatteringMatrix matrix{.a1 = phase_per_sr, .a2 = phase_per_sr};
  matrix.a3 = matrix.a4 = at(ratios.a3);
  matrix.b1 = at(ratios.b1);
  matrix.b2 = at(ratios.b2);
  return matrix;
}

bool PhaseFunction::operator==(const PhaseFunction& other) const {
  const bool same_table = table == other.table || (table && other.table && *table == *other.table);
  const auto parameters = PhaseParameters();
  return kind == other.kind && same_table &&
         std::all_of(parameters.begin(), parameters.end(), [&](const PhaseParameter& parameter) {
           return this->*parameter.member == other.*parameter.member;
         });
}

double Phase(const PhaseFunction& phase, double cos_scattering) {
  return FormOf(phase.kind).value(phase, cos_scattering);
}

double MeanCosine(const PhaseFunction& phase) { return FormOf(phase.kind).mean_cosine(phase); }

double SampleCosine(const PhaseFunction& phase, double u) {
  return std::clamp(FormOf(phase.kind).sample(phase, u), -1.0, 1.0);
}

PhaseFunction DropletPhase(double droplet_diameter_um, const std::string& key) {
  const double d =
      RequireInRange(droplet_diameter_um, kSmallestDroplet_um, kLargestDroplet_um, key);
  return {.kind = PhaseKind::kHenyeyGreensteinDraine,
          .g = shared::DropletForwardG(d),
          .g_back = shared::DropletDraineG(d),
          .back_weight = shared::DropletDraineWeight(d),
          .alpha = shared::DropletDraineAlpha(d)};
}

}  // namespace alpenglow::atmosphere
