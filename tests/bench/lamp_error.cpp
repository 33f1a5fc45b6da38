// SPDX-License-Identifier: MIT
// Measures the error of airlight relative to the reference solution, by number of samples and
// quadrature rule: root mean square, 99th percentile and maximum of the relative error over random
// lamps in homogeneous fog and in fog of exponential density, and the time of an evaluation. Run by
// hand; results are in README.md.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include "atmosphere/lamp/airlight.h"
#include "renderer/report/lamp_test_cases.h"

namespace alpenglow::renderer {
namespace {

using Work = LampTestCase;

Work CheckedWork(int i, const LampTestKind& kind) {
  Work work = LampTestCaseNumber(i, kind);
  if (!work.converged && work.truth > 0.0)
    fmt::print("# the reference solution misses in case {}\n", i);
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
}  // namespace alpenglow::renderer

int main(int argc, char** argv) {
  using namespace alpenglow::renderer;
  const int cases = argc > 1 ? std::atoi(argv[1]) : 3000;
  struct Kind {
    const char* name;
    LampTestKind of;
  };
  const std::vector<Kind> kinds{
      {"g 0", {.g = 0.0}},
      {"g 0.8", {}},
      {"g 0.95", {.g = 0.95}},
      {"H 30 m, g 0.8", {.scale_height_m = 30.0}},
      {"H 5 m, g 0.8", {.scale_height_m = 5.0}},
      {"beam, g 0.8", {.beam = true}},
      {"beam, H 30 m, g 0.8", {.scale_height_m = 30.0, .beam = true}},
      {"H 30 m under clear air", {.scale_height_m = 30.0, .clear_air = true}},
      {"through the lamp, H 30 m", {.scale_height_m = 30.0, .through = true}}};
  struct Named {
    const char* name;
    Rule rule;
    bool beams;
  };
  const std::vector<Named> rules{
      {"here", ByMap, true},
      {"tan(theta/2)",
       [](const Work& w, int n) { return AirlightByRule(LampRule::kHalfAngle, w, n); }, false},
      {"asinh", [](const Work& w, int n) { return AirlightByRule(LampRule::kAsinh, w, n); },
       false}};
  for (const Kind& kind : kinds) {
    std::vector<Work> works;
    for (int i = 1; i <= cases; ++i) works.push_back(CheckedWork(i, kind.of));
    fmt::print("\n{}\n{:14} {:>5} {:>9} {:>9} {:>9} {:>6} {:>8}\n", kind.name, "rule", "nodes",
               "rms", "99 %", "most", "case", "ns");
    for (const Named& named : rules) {
      if (kind.of.beam && !named.beams) continue;
      for (const int nodes : {8, 12, 16, 24, 32, 48}) {
        const Errors errors = ErrorsOf(works, named.rule, nodes);
        fmt::print("{:14} {:>5} {:>9.1e} {:>9.1e} {:>9.1e} {:>6} {:>8.0f}\n", named.name, nodes,
                   errors.rms, errors.p99, errors.most, errors.worst,
                   Nanoseconds(works, named.rule, nodes));
      }
    }
  }
}
