// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_chords.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>

#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

struct Interval {
  double begin_m, end_m;
};

/// A ray in the vertical plane of its direction, seen from the centre of the planet.
struct RayOverSphere {
  double radius_m;    // of the planet
  double altitude_m;  // of the origin
  double mu;          // cosine between direction and vertical at the origin

  RayOverSphere(const glm::dvec3& origin, const glm::dvec3& direction, double planet_radius_m)
      : radius_m(planet_radius_m),
        altitude_m(AltitudeOverSphere(origin, planet_radius_m)),
        mu(glm::dot(direction, glm::normalize(origin + glm::dvec3(0.0, 0.0, planet_radius_m)))) {}

  /// Returns the part of the line below an altitude; no value if none is.
  [[nodiscard]] std::optional<Interval> Below(double height_m) const {
    const double from_centre_m = radius_m + altitude_m;
    const double half = from_centre_m * mu;
    // r^2 - (R + h)^2 without cancellation:
    const double c = (altitude_m - height_m) * (2.0 * radius_m + altitude_m + height_m);
    const double square = half * half - c;
    if (square <= 0.0) return std::nullopt;
    const double root = std::sqrt(square);
    const double far = half > 0.0 ? -half - root : root - half;
    const double near = far != 0.0 ? c / far : 0.0;
    return Interval{std::min(near, far), std::max(near, far)};
  }
};

}  // namespace

glm::dvec3 InFlatFrame(const glm::dvec3& point, double planet_radius_m) {
  const double from_centre_m = planet_radius_m + point.z;
  const double across_m2 = point.x * point.x + point.y * point.y;
  const double square = across_m2 / (from_centre_m * from_centre_m);
  // R arctan(t) / t by its series. At the bound of t^2 the next term is 6e-12 of the arc.
  constexpr double kMostOfSeries = 0.005;
  const auto arc_m = [&] {
    return planet_radius_m * std::atan2(std::sqrt(across_m2), from_centre_m);
  };
  if (across_m2 == 0.0) return {0.0, 0.0, AltitudeOverSphere(point, planet_radius_m)};
  const double stretch =
      from_centre_m > 0.0 && square < kMostOfSeries
          ? planet_radius_m / from_centre_m *
                (1.0 -
                 square * (1.0 / 3.0 - square * (1.0 / 5.0 - square * (1.0 / 7.0 - square / 9.0))))
          : arc_m() / std::sqrt(across_m2);
  return {stretch * point.x, stretch * point.y, AltitudeOverSphere(point, planet_radius_m)};
}

std::vector<double> CrossingsOf(double altitude_m, const glm::dvec3& origin,
                                const glm::dvec3& direction, double length_m,
                                double planet_radius_m) {
  std::vector<double> distances_m;
  const auto below = RayOverSphere(origin, direction, planet_radius_m).Below(altitude_m);
  if (!below) return distances_m;
  for (const double at_m : {below->begin_m, below->end_m}) {
    if (at_m > 0.0 && at_m < length_m) distances_m.push_back(at_m);
  }
  return distances_m;
}

std::vector<CloudChord> ChordsWithin(const AltitudeRange& range, const glm::dvec3& origin,
                                     const glm::dvec3& direction, double length_m,
                                     double planet_radius_m, double longest_m) {
  const RayOverSphere ray(origin, direction, planet_radius_m);
  std::vector<CloudChord> chords;
  const auto add = [&](double from_m, double to_m) {
    const double begin_m = std::max(from_m, 0.0), end_m = std::min(to_m, length_m);
    if (!(begin_m < end_m)) return;
    const int pieces = static_cast<int>(std::ceil((end_m - begin_m) / longest_m));
    const double step_m = (end_m - begin_m) / pieces;
    glm::dvec3 start = InFlatFrame(origin + begin_m * direction, planet_radius_m);
    for (int piece = 0; piece < pieces; ++piece) {
      const double stop_m = begin_m + (piece + 1) * step_m;
      const glm::dvec3 stop = InFlatFrame(origin + stop_m * direction, planet_radius_m);
      const double chord_m = glm::length(stop - start);
      if (chord_m > 0.0)
        chords.push_back({stop_m - step_m, stop_m, start, (stop - start) / chord_m, chord_m});
      start = stop;
    }
  };
  const std::optional<Interval> below_top = ray.Below(range.high_m);
  if (!below_top) return chords;
  const std::optional<Interval> below_base = ray.Below(range.low_m);
  if (!below_base) {
    add(below_top->begin_m, below_top->end_m);
  } else {
    add(below_top->begin_m, below_base->begin_m);
    add(below_base->end_m, below_top->end_m);
  }
  return chords;
}

}  // namespace alpenglow::renderer
