// SPDX-License-Identifier: MIT
// Measures fields of clouds of 20.48 km, with all threads: time and memory of a field and of the map
// of its sunlight, and the time of one optical depth to the sun on one thread. Run by hand; results
// are in README.md.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/cloud_light/cloud_sun_map.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kBytesPerMegabyte = 1e6;

const CloudField& FieldOfGenus(int genus) {
  static const std::vector<CloudField> kFields = [] {
    std::vector<CloudField> made;
    for (const CloudGenus each : {CloudGenus::kCumulus, CloudGenus::kStratocumulus,
                                  CloudGenus::kAltocumulus, CloudGenus::kCirrus}) {
      made.push_back(MakeCloudField(DefaultCloudOptions(each)));
    }
    return made;
  }();
  return kFields[static_cast<std::size_t>(genus)];
}

glm::dvec3 ToSun(double elevation_deg) {
  const double e = elevation_deg * kRadiansPerDegree;
  return {std::cos(e) * std::cos(0.35), std::cos(e) * std::sin(0.35), std::sin(e)};
}

/// Returns points in cloud.
std::vector<glm::dvec3> PointsInCloud(const CloudField& field) {
  constexpr std::size_t kPoints = 1000;
  const CloudBox box = field.Bounds();
  std::vector<glm::dvec3> points;
  for (int i = 1; points.size() < kPoints; ++i) {
    const glm::dvec3 point =
        box.low + glm::dvec3(Halton(i, 2), Halton(i, 3), Halton(i, 5)) * (box.high - box.low);
    if (field.Extinction_per_m(point) > 0.0) points.push_back(point);
  }
  return points;
}

// The argument is the genus.
void CloudFieldMade(benchmark::State& state) {
  (void)FieldOfGenus(0);  // makes the noise
  const auto genus = static_cast<CloudGenus>(state.range(0));
  for (auto unused : state) {
    const CloudField field = MakeCloudField(DefaultCloudOptions(genus));
    state.counters["MB"] = static_cast<double>(field.bytes()) / kBytesPerMegabyte;
  }
  state.SetLabel(std::string(kCloudGenusNames.Of(genus)));
}
BENCHMARK(CloudFieldMade)
    ->DenseRange(0, 3)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

// The arguments are the genus and the elevation of the sun [degrees].
void CloudSunMapMade(benchmark::State& state) {
  const CloudField& field = FieldOfGenus(static_cast<int>(state.range(0)));
  for (auto unused : state) {
    const CloudSunMap map(field, ToSun(static_cast<double>(state.range(1))));
    state.counters["MB"] = static_cast<double>(map.bytes()) / kBytesPerMegabyte;
  }
}
BENCHMARK(CloudSunMapMade)
    ->ArgsProduct({{0}, {35, 12, 3}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

// The arguments are the genus and the elevation of the sun [degrees]. Below 3 degrees there is no map.
void CloudDepthToSun(benchmark::State& state) {
  const CloudField& field = FieldOfGenus(static_cast<int>(state.range(0)));
  const CloudSunDepths sun(field, ToSun(static_cast<double>(state.range(1))));
  const std::vector<glm::dvec3> points = PointsInCloud(field);
  std::size_t i = 0;
  for (auto unused : state) {
    benchmark::DoNotOptimize(sun.OpticalDepth(points[i]));
    i = (i + 1) % points.size();
  }
}
BENCHMARK(CloudDepthToSun)
    ->ArgsProduct({{0, 3}, {35, 12, 1, 0, -1}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace alpenglow::renderer
