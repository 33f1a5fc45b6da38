// SPDX-License-Identifier: MIT
#include "renderer/report/layer_cases.h"

#include <cmath>
#include <random>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr double kAirAbove = 0.17, kAirBelow = 0.05;  // optical depths
constexpr double kLeastAngle_deg = 3.0;               // from the sun

/// Returns the cosine of the angle between a direction and the sun's beam.
double CosineFromBeam(const LightWay& way, double mu_s) {
  const double sines = std::sqrt((1.0 - way.mu * way.mu) * (1.0 - mu_s * mu_s));
  return sines * std::cos(way.azimuth) - way.mu * mu_s;
}

void AddLooks(LayerCase& to, int looks, std::mt19937& engine) {
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (const double depth : to.depths) {
    for (int i = 0; i < looks; ++i) {
      const double mu = 2.0 * number(engine) - 1.0;
      const LightWay way{mu, kPi * number(engine)};
      const bool is_near =
          CosineFromBeam(way, to.mu_s) > std::cos(kLeastAngle_deg * kRadiansPerDegree);
      const bool is_above = depth == 0.0 && way.mu < 0.0;  // no light comes from there
      if (!is_near && !is_above) to.looks.push_back({depth, way});
    }
  }
}

}  // namespace

std::vector<double> MomentsOfLobe(double g) {
  std::vector<double> chi{1.0};
  while (std::abs(chi.back()) > 1e-9) chi.push_back(chi.back() * g);
  return chi;
}

std::vector<LayerOptics> CloudInAir(double depth, double g) {
  const std::vector<double> molecules{1.0, 0.0, 0.1};
  return {
      {kAirAbove, 1.0, molecules}, {depth, 0.9999, MomentsOfLobe(g)}, {kAirBelow, 1.0, molecules}};
}

std::vector<LayerCase> LayerCasesOf(double g, int looks) {
  std::vector<LayerCase> cases;
  std::mt19937 engine(3);
  for (const double cloud : {0.3, 1.0, 5.0, 20.0, 60.0}) {
    const double whole = kAirAbove + cloud + kAirBelow;
    for (const double ground : {0.1, 0.8}) {
      for (const double mu_s : {0.15, 0.5, 0.9}) {
        LayerCase one{cloud, ground, mu_s, CloudInAir(cloud, g), {}, {}};
        one.depths = {0.0,
                      kAirAbove,
                      kAirAbove + 0.1 * cloud,
                      kAirAbove + 0.5 * cloud,
                      kAirAbove + 0.9 * cloud,
                      whole - kAirBelow,
                      whole};
        AddLooks(one, looks, engine);
        cases.push_back(std::move(one));
      }
    }
  }
  return cases;
}

}  // namespace alpenglow::renderer
