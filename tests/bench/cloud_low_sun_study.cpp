// SPDX-License-Identifier: MIT
// Measures the map of a low sun (renderer/cloud_light/cloud_low_sun_map.h) relative to beams in short
// steps, in clouds and in a plane at half their height:
//   cloud_low_sun_study [GENUS [SUN_DEG [PERIOD_KM]]]
// Times are of the processor, for all threads together.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_low_sun_map.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/layer.h"
#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/report/cloud_views.h"
#include "tests/bench/processor_time.h"

namespace alpenglow::renderer {
namespace {

constexpr int kPoints = 5000;
// Light of the medium without forward peak follows this power of the transmittance.
constexpr double kScaledPower = 0.4;

/// Returns points of a box, with cloud or anywhere.
std::vector<glm::dvec3> PointsIn(const CloudBox& box, const CloudField& field, bool with_cloud) {
  std::vector<glm::dvec3> points;
  for (int i = 1; points.size() < kPoints; ++i) {
    const glm::dvec3 share(Halton(i, 2), Halton(i, 3), Halton(i, 5));
    const glm::dvec3 point = box.low + share * (box.high - box.low);
    if (!with_cloud || field.Extinction_per_m(point) > 0.0) points.push_back(point);
  }
  return points;
}

/// Returns values at points and the time of one [us].
template <typename Value>
std::vector<double> At(const std::vector<glm::dvec3>& points, const Value& value, double& us) {
  const std::clock_t begin = std::clock();
  std::vector<double> values;
  for (const glm::dvec3& point : points) values.push_back(value(point));
  us = 1e6 * tests::ProcessorSecondsSince(begin) / static_cast<double>(points.size());
  return values;
}

double MeanOf(const std::vector<double>& values, double power) {
  double sum = 0.0;
  for (const double value : values) sum += std::pow(value, power);
  return sum / static_cast<double>(values.size());
}

void RunStudy(const std::string& genus, double sun_deg, double period_km) {
  CloudOptions options = DefaultCloudOptions(CloudGenusNamed(genus));
  options.period_m = 1000.0 * period_km;
  const CloudField field = MakeCloudField(options);
  const CloudLowSunOptions of_pictures = LowSunOver(field, CloudLowSunOptions().planet_radius_m);
  CloudLowSunOptions in_short_steps = of_pictures;
  in_short_steps.step_m = 5.0;
  const glm::dvec3 to_sun = TowardsAzimuth(20.0, sun_deg);
  const CloudLowSun beams(field, to_sun, of_pictures), exact(field, to_sun, in_short_steps);
  const std::clock_t begin = std::clock();
  const CloudLowSunMap map(field, beams);
  const double map_s = tests::ProcessorSecondsSince(begin);
  double us = 0.0, beam_us = 0.0, depth_us = 0.0, around_us = 0.0;
  const CloudBox box = field.Bounds();
  const std::vector<glm::dvec3> inside = PointsIn(box, field, true);
  const auto true_light = At(
      inside, [&](const glm::dvec3& p) { return std::exp(-exact.OpticalDepth(p)); }, us);
  const auto by_beams = At(
      inside, [&](const glm::dvec3& p) { return std::exp(-beams.OpticalDepth(p)); }, beam_us);
  const auto by_map = At(
      inside, [&](const glm::dvec3& p) { return std::exp(-map.OpticalDepth(p)); }, depth_us);
  double squares = 0.0;
  for (std::size_t i = 0; i < inside.size(); ++i)
    squares += std::pow(by_map[i] - true_light[i], 2) / static_cast<double>(inside.size());
  CloudBox plane = box;
  plane.low.z = plane.high.z = 0.5 * (box.low.z + box.high.z);
  const std::vector<glm::dvec3> anywhere = PointsIn(plane, field, false);
  const auto in_plane = At(
      anywhere, [&](const glm::dvec3& p) { return std::exp(-exact.OpticalDepth(p)); }, us);
  const auto plane_by_map = At(
      anywhere, [&](const glm::dvec3& p) { return map.Transmittance(p); }, us);
  At(
      anywhere, [&](const glm::dvec3& p) { return map.TransmittanceAround(p); }, around_us);
  const auto percent = [](double found, double truth) { return 100.0 * (found / truth - 1.0); };
  fmt::print(
      "| {}, {} degrees | {:.1f} s, {:.0f} MB | {:.1f}, {:.1f}, {:.2f} | {:.3f} | {:+.1f} % "
      "| {:.3f}, {:.3f} |\n",
      genus, sun_deg, map_s, static_cast<double>(map.bytes()) / 1e6, beam_us, depth_us, around_us,
      std::sqrt(squares), percent(MeanOf(by_map, kScaledPower), MeanOf(true_light, kScaledPower)),
      MeanOf(in_plane, 1.0), MeanOf(plane_by_map, 1.0));
  fmt::print("mean T in clouds {:.4f}; steps of pictures {:+.1f} %, map {:+.1f} %\n",
             MeanOf(true_light, 1.0), percent(MeanOf(by_beams, 1.0), MeanOf(true_light, 1.0)),
             percent(MeanOf(by_map, 1.0), MeanOf(true_light, 1.0)));
}

}  // namespace
}  // namespace alpenglow::renderer

int main(int count, char** arguments) {
  using alpenglow::atmosphere::ParseNumber;
  const auto number = [&](int i, double otherwise) {
    return i < count ? ParseNumber(arguments[i]).value_or(otherwise) : otherwise;
  };
  alpenglow::renderer::RunStudy(count > 1 ? arguments[1] : "cumulus", number(2, 2.6),
                                number(3, 20.48));
}
