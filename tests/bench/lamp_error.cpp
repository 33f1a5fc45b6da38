// SPDX-License-Identifier: MIT
// Error of airlight against the judge, by number of samples and rule: root mean square, 99th
// percentile and maximum of the relative error over random lamps in homogeneous fog and in fog of
// exponential density, and the time of an evaluation. Run by hand; results are in README.md.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include <glm/geometric.hpp>

#include "atmosphere/airlight.h"
#include "atmosphere/airlight_judge.h"
#include "atmosphere/constants.h"
#include "atmosphere/halton.h"
#include "atmosphere/quadrature.h"

namespace alpenglow {
namespace {

double Logarithmic(double low, double high, double u) { return low * std::pow(high / low, u); }

struct Work {
  LampAir air;
  Lamp lamp;
  LampSegment segment;
  double truth = 0.0;
};

struct Kind {
  const char* name;
  double g;
  double scale_height_m;
  bool beam;
};

// Extinction 1e-4 to 0.1 per metre, distance of the lamp from the ray 0.1 to 100 m, segments of 10
// to 1000 m, the lamp beside, before or behind the segment.
Work WorkNumber(int i, const Kind& kind) {
  Work work;
  const double sigma = Logarithmic(1e-4, 0.1, Halton(i, 2));
  const double length = Logarithmic(10.0, 1000.0, Halton(i, 3));
  const double across = Logarithmic(0.1, 100.0, Halton(i, 5));
  const double along = length * (1.4 * Halton(i, 7) - 0.2);
  const double pitch = std::asin(2.0 * Halton(i, 11) - 1.0);
  const double turn = 2.0 * kPi * Halton(i, 13);
  work.air =
      HomogeneousAir(0.9 * sigma, sigma, {.kind = PhaseKind::kHenyeyGreenstein, .g = kind.g});
  work.air.layers[0].scale_height_m = kind.scale_height_m;
  const glm::dvec3 forward(std::cos(pitch), 0.0, std::sin(pitch));
  const glm::dvec3 lift(-std::sin(pitch), 0.0, std::cos(pitch));
  const glm::dvec3 off = std::cos(turn) * lift + std::sin(turn) * glm::dvec3(0.0, 1.0, 0.0);
  // Nothing lies lower than the altitude at which sigma was given.
  work.segment = {glm::dvec3(0.0), forward, 0.0, length};
  work.lamp.position_m = along * forward + across * off;
  const double lowest = std::min({0.0, length * forward.z, work.lamp.position_m.z});
  work.air.altitude_at_origin_m = -lowest;
  if (kind.beam) {
    work.lamp.profile.kind = LampProfile::Kind::kCone;
    work.lamp.profile.inner_rad = 0.05 + 0.3 * Halton(i, 17);
    work.lamp.profile.outer_rad = 0.1 + 0.6 * Halton(i, 17);
    const double z = 2.0 * Halton(i, 19) - 1.0;
    const double azimuth = 2.0 * kPi * Halton(i, 23);
    const double r = std::sqrt(1.0 - z * z);
    work.lamp.axis = {r * std::cos(azimuth), r * std::sin(azimuth), z};
    work.lamp.side = glm::normalize(glm::cross(work.lamp.axis, glm::dvec3(0.3, -0.5, 0.8)));
  }
  const judge::LampLight truth = judge::AirlightAlong(work.air, work.lamp, work.segment);
  work.truth = truth.radiance[0];
  if (!truth.converged && work.truth > 0.0) {
    fmt::print("# the judge misses by {} in case {}\n", truth.error, i);
  }
  return work;
}

using Rule = std::function<double(const Work&, int)>;

struct Errors {
  double rms, p99, most;
  int worst;
};

Errors ErrorsOf(const std::vector<Work>& works, const Rule& rule, int nodes) {
  std::vector<double> errors;
  double sum = 0.0;
  int worst = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < works.size(); ++i) {
    if (!(works[i].truth > 0.0)) continue;
    const double error = std::abs(rule(works[i], nodes) / works[i].truth - 1.0);
    if (error > most) {
      most = error;
      worst = static_cast<int>(i) + 1;
    }
    errors.push_back(error);
    sum += error * error;
  }
  std::sort(errors.begin(), errors.end());
  return {std::sqrt(sum / static_cast<double>(errors.size())), errors[errors.size() * 99 / 100],
          errors.back(), worst};
}

double ByMap(const Work& work, int nodes) {
  return Airlight(work.air, work.lamp, work.segment, nodes)[0];
}

// The published maps on the whole segment, lamps without a beam: Gauss in w = tan(theta / 2) = tanh
// (x / 2), or in x = asinh((t - t_c) / D).
double ByGauss(const Work& work, int nodes, bool half_angle) {
  const glm::dvec3 to_lamp = work.lamp.position_m - work.segment.origin_m;
  const double nearest = glm::dot(to_lamp, work.segment.direction);
  const double approach = glm::length(to_lamp - nearest * work.segment.direction);
  const auto x_of = [&](double t) { return std::asinh((t - nearest) / approach); };
  const double x0 = x_of(0.0), x1 = x_of(work.segment.end_m);
  const double low = half_angle ? std::tanh(0.5 * x0) : x0;
  const double high = half_angle ? std::tanh(0.5 * x1) : x1;
  const GaussRule& rule = GaussLegendre(nodes);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double v = low + (high - low) * rule.node[i];
    const double x = half_angle ? 2.0 * std::atanh(v) : v;
    const double slope = half_angle ? 2.0 / ((1.0 - v) * (1.0 + v)) : 1.0;
    const double t = nearest + approach * std::sinh(x);
    const glm::dvec3 point = work.segment.origin_m + t * work.segment.direction;
    const double transmittance = TransmittanceBetween(work.air, work.segment.origin_m, point)[0] *
                                 TransmittanceBetween(work.air, point, work.lamp.position_m)[0];
    const LampLayer& layer = work.air.layers[0];
    sum += rule.weight[i] * (high - low) * slope / (approach * std::cosh(x)) * transmittance *
           layer.scattering_per_m[0] *
           std::exp(-work.air.AltitudeOf(point) / layer.scale_height_m) *
           Phase(layer.phase, -std::tanh(x));
  }
  return sum;
}

double Nanoseconds(const std::vector<Work>& works, const Rule& rule, int nodes) {
  double best = 1e300;
  double kept = 0.0;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (const Work& work : works) kept += rule(work, nodes);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / static_cast<double>(works.size()));
  }
  return kept >= 0.0 ? best : 0.0;
}

}  // namespace
}  // namespace alpenglow

int main(int argc, char** argv) {
  using namespace alpenglow;
  const int cases = argc > 1 ? std::atoi(argv[1]) : 3000;
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<Kind> kinds{
      {"g 0", 0.0, infinite, false},           {"g 0.8", 0.8, infinite, false},
      {"g 0.95", 0.95, infinite, false},       {"H 30 m, g 0.8", 0.8, 30.0, false},
      {"H 5 m, g 0.8", 0.8, 5.0, false},       {"beam, g 0.8", 0.8, infinite, true},
      {"beam, H 30 m, g 0.8", 0.8, 30.0, true}};
  struct Named {
    const char* name;
    Rule rule;
    bool beams;
  };
  const std::vector<Named> rules{
      {"here", ByMap, true},
      {"tan(theta/2)", [](const Work& w, int n) { return ByGauss(w, n, true); }, false},
      {"asinh", [](const Work& w, int n) { return ByGauss(w, n, false); }, false}};
  for (const Kind& kind : kinds) {
    std::vector<Work> works;
    for (int i = 1; i <= cases; ++i) works.push_back(WorkNumber(i, kind));
    fmt::print("\n{}\n{:14} {:>5} {:>9} {:>9} {:>9} {:>6} {:>8}\n", kind.name, "rule", "nodes",
               "rms", "99 %", "most", "case", "ns");
    for (const Named& named : rules) {
      if (kind.beam && !named.beams) continue;
      for (const int nodes : {8, 12, 16, 24, 32, 48}) {
        const Errors errors = ErrorsOf(works, named.rule, nodes);
        fmt::print("{:14} {:>5} {:>9.1e} {:>9.1e} {:>9.1e} {:>6} {:>8.0f}\n", named.name, nodes,
                   errors.rms, errors.p99, errors.most, errors.worst,
                   Nanoseconds(works, named.rule, nodes));
      }
    }
  }
}
