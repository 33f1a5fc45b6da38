// SPDX-License-Identifier: MIT
#include "atmosphere/reference/airlight_reference.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere::reference {
namespace {

using Extended = long double;

struct ExtendedPoint {
  Extended x, y, z;
};

ExtendedPoint At(const glm::dvec3& origin, const glm::dvec3& direction, Extended t) {
  return {origin.x + t * direction.x, origin.y + t * direction.y, origin.z + t * direction.z};
}

Extended Altitude(const LampAir& air, const ExtendedPoint& p) {
  return air.altitude_at_origin_m + air.up.x * p.x + air.up.y * p.y + air.up.z * p.z;
}

// Returns the column of a layer over a length, from altitude a to altitude b.
Extended Column(const LampLayer& layer, Extended length, Extended a, Extended b) {
  const Extended h = layer.scale_height_m;
  if (std::isinf(layer.scale_height_m)) return length;
  const Extended x = (b - a) / h;
  const Extended mean = std::abs(x) < 1e-8L ? 1 - x / 2 : -std::expm1(-x) / x;
  return length * std::exp((layer.base_m - a) / h) * mean;
}

/// The ray, and the position of the lamp relative to it.
struct Geometry {
  Extended nearest, approach;  // distance along the ray to the nearest point; its distance
  ExtendedPoint across;        // unit vector, from the lamp to the ray's nearest point

  Geometry(const Lamp& lamp, const LampSegment& segment) {
    const glm::dvec3& o = segment.origin_m;
    const glm::dvec3& d = segment.direction;
    const Extended x = Extended(lamp.position_m.x) - o.x, y = Extended(lamp.position_m.y) - o.y,
                   z = Extended(lamp.position_m.z) - o.z;
    nearest = x * d.x + y * d.y + z * d.z;
    across = {nearest * d.x - x, nearest * d.y - y, nearest * d.z - z};
    const Extended distance =
        std::sqrt(across.x * across.x + across.y * across.y + across.z * across.z);
    approach = std::max({distance, Extended(lamp.radius_m), 1e-12L});
    if (distance > 0) {
      across = {across.x / distance, across.y / distance, across.z / distance};
    } else {
      const glm::dvec3 other = std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
      const glm::dvec3 any = glm::normalize(glm::cross(d, other));
      across = {any.x, any.y, any.z};
    }
  }
};

// Appends points on both sides of `centre`, at distances that grow by a factor of two from
// `finest`.
void AppendLadder(Extended centre, Extended finest, Extended begin, Extended end,
                  std::vector<double>& points) {
  for (Extended step = finest; step < end - begin; step *= 2) {
    for (const Extended t : {centre - step, centre + step}) {
      if (t > begin && t < end) points.push_back(static_cast<double>(t));
    }
  }
  if (centre > begin && centre < end) points.push_back(static_cast<double>(centre));
}

// Appends the points at which the profile of the lamp is not smooth. They are found by search: the
// sign of the difference between the cosine and the cosine of the cone is followed in small steps
// of angle, and its changes are bisected.
void AppendCone(const Lamp& lamp, const LampSegment& segment, const Geometry& geometry,
                double cone_cosine, std::vector<double>& points) {
  const auto excess = [&](double theta) {
    const double s = std::sin(theta), c = std::cos(theta);
    const glm::dvec3 across(static_cast<double>(geometry.across.x),
                            static_cast<double>(geometry.across.y),
                            static_cast<double>(geometry.across.z));
    return glm::dot(s * segment.direction + c * across, lamp.axis) - cone_cosine;
  };
  constexpr int kSteps = 2000;
  constexpr double kHalfTurn = 3.14159265358979323846;
  for (int i = 0; i < kSteps; ++i) {
    double low = kHalfTurn * ((i + 0.0) / kSteps - 0.5);
    double high = kHalfTurn * ((i + 1.0) / kSteps - 0.5);
    if ((excess(low) > 0.0) == (excess(high) > 0.0)) continue;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      ((excess(middle) > 0.0) == (excess(low) > 0.0) ? low : high) = middle;
    }
    points.push_back(
        static_cast<double>(geometry.nearest + geometry.approach * std::tan(Extended(low))));
  }
}

std::vector<double> Breakpoints(const Lamp& lamp, const LampSegment& segment,
                                const Geometry& geometry, double end) {
  std::vector<double> points{segment.begin_m, end};
  AppendLadder(geometry.nearest, geometry.approach / 4, segment.begin_m, end, points);
  const Extended finest = (Extended(end) - segment.begin_m) / 1024;
  AppendLadder(segment.begin_m, finest, segment.begin_m, end, points);
  AppendLadder(end, finest, segment.begin_m, end, points);
  const LampProfile& profile = lamp.profile;
  std::vector<double> cosines;
  if (profile.kind == LampProfile::Kind::kCone) {
    cosines = {std::cos(profile.inner_rad), std::cos(profile.outer_rad)};
  }
  if (profile.kind == LampProfile::Kind::kCosinePower) cosines = {0.0};
  if (profile.kind == LampProfile::Kind::kTable) {
    for (const double gamma : profile.table.gamma_rad) cosines.push_back(std::cos(gamma));
  }
  for (const double cosine : cosines) AppendCone(lamp, segment, geometry, cosine, points);
  std::sort(points.begin(), points.end());
  std::erase_if(points, [&](double t) { return t < segment.begin_m || t > end; });
  return points;
}

}  // namespace

LampLight AirlightAlong(const LampAir& air, const Lamp& lamp, const LampSegment& segment) {
  const Geometry geometry(lamp, segment);
  const std::size_t bands = air.bands();
  const ExtendedPoint lamp_place = At(lamp.position_m, {0.0, 0.0, 0.0}, 0);
  double end = segment.end_m;
  if (std::isinf(end)) {
    end = static_cast<double>(1e12L * (geometry.approach + std::abs(geometry.nearest)));
  }
  const auto source = [&](double distance) {
    const Extended t = distance;
    const ExtendedPoint p = At(segment.origin_m, segment.direction, t);
    const Extended z = Altitude(air, p);
    const Extended along = t - geometry.nearest;
    const Extended d = std::sqrt(along * along + geometry.approach * geometry.approach);
    const Extended sine = along / d, cosine = geometry.approach / d;
    const glm::dvec3 direction(
        static_cast<double>(sine * segment.direction.x + cosine * geometry.across.x),
        static_cast<double>(sine * segment.direction.y + cosine * geometry.across.y),
        static_cast<double>(sine * segment.direction.z + cosine * geometry.across.z));
    const Extended intensity = RelativeIntensity(lamp, direction);
    std::vector<double> value(bands, 0.0);
    for (std::size_t band = 0; band < bands; ++band) {
      Extended tau = 0, scattered = 0;
      for (const LampLayer& layer : air.layers) {
        const Extended column =
            Column(layer, t, Altitude(air, At(segment.origin_m, segment.direction, 0)), z) +
            Column(layer, d, Altitude(air, lamp_place), z);
        tau += layer.extinction_per_m[band] * column;
        scattered += layer.scattering_per_m[band] *
                     std::exp((layer.base_m - z) / layer.scale_height_m) *
                     Phase(layer.phase, static_cast<double>(-sine));
      }
      value[band] = static_cast<double>(scattered * intensity * std::exp(-tau) / (d * d));
    }
    return value;
  };
  const auto found =
      IntegrateAdaptively(source, bands, Breakpoints(lamp, segment, geometry, end), 1e-11, 20000);
  return {found.value, found.error, found.error < 1e-9};
}

}  // namespace alpenglow::atmosphere::reference
