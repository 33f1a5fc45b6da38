// SPDX-License-Identifier: MIT
#include "renderer/surface/refracted_fan.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "atmosphere/math/constants.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

// Rays are straight above this number of scale heights, where air bends them by a ten-thousandth of
// the value at the ground.
constexpr double kScaleHeightsThatBend = 9.0;
// Greatest change of height in a step, in scale heights: the midpoint rule is then within 1 % of
// the bending.
constexpr double kHeightOfStep = 0.08;
// Air deeper than this is not needed: its density is held constant.
constexpr double kDeepest_m = -2000.0;

/// A ray in its vertical plane, relative to the eye: x along its initial direction, y upwards
/// across it.
struct InPlane {
  glm::dvec2 at, direction;
};

/// The ray equation in a plane through the planet's centre.
class PlaneOfRay {
 public:
  PlaneOfRay(const BendingAir& air, double height_m, double sine)
      : air_(air),
        centre_(-(air.planet_radius_m + height_m) *
                glm::dvec2(sine, std::sqrt(std::max(1.0 - sine * sine, 0.0)))) {}

  [[nodiscard]] double HeightOf(const glm::dvec2& at) const {
    return glm::length(at - centre_) - air_.planet_radius_m;
  }
  [[nodiscard]] glm::dvec2 Turn(const InPlane& ray) const {
    const glm::dvec2 up = glm::normalize(ray.at - centre_);
    const double height_m = std::max(HeightOf(ray.at), kDeepest_m);
    return CurvaturePerMetreAt(air_, height_m) * (up - glm::dot(up, ray.direction) * ray.direction);
  }
  /// Follows a ray up to a distance along its initial direction.
  [[nodiscard]] InPlane Followed(InPlane ray, double along_m) const {
    const double may_rise_m = kHeightOfStep * air_.UpperScaleHeight();
    const double least_sine = std::sqrt(may_rise_m / (2.0 * air_.planet_radius_m));
    while (ray.at.x < along_m) {
      const double left_m = (along_m - ray.at.x) / ray.direction.x;
      const double height_m = HeightOf(ray.at);
      const bool bends =
          height_m > kDeepest_m && height_m < kScaleHeightsThatBend * air_.UpperScaleHeight();
      const double sine = std::abs(glm::dot(ray.direction, glm::normalize(ray.at - centre_)));
      const double by_height_m = may_rise_m / std::max(sine, least_sine);
      ray = Stepped(ray, bends ? std::min(left_m, by_height_m) : left_m, bends);
      if (left_m <= by_height_m || !bends) break;
    }
    return ray;
  }

 private:
  [[nodiscard]] InPlane Stepped(const InPlane& ray, double step_m, bool bends) const {
    if (!bends) return {ray.at + step_m * ray.direction, ray.direction};
    const glm::dvec2 half = glm::normalize(ray.direction + 0.5 * step_m * Turn(ray));
    const glm::dvec2 middle = ray.at + 0.5 * step_m * half;
    return {ray.at + step_m * half, glm::normalize(ray.direction + step_m * Turn({middle, half}))};
  }

  const BendingAir& air_;
  glm::dvec2 centre_;
};

double SineOfGrazing(const BendingAir& air, double height_m) {
  return std::sin(GrazingElevation(air, std::max(height_m, 0.0)));
}

}  // namespace

// Nodes are densest around the ray that grazes the ground, within the angle that half a scale
// height subtends at the far end of a ray.
RefractedFan::RefractedFan(const BendingAir& air, const glm::dvec3& eye, const glm::dvec3& up,
                           double reach_m)
    : air_(air),
      up_(up),
      height_m_(AltitudeOverSphere(eye, air.planet_radius_m)),
      reach_m_(reach_m),
      most_curvature_per_m_(std::abs(RefractivitySlopeAt(air, 0.0))),
      grazing_sine_(SineOfGrazing(air, height_m_)),
      scale_(std::min(0.5 * air.UpperScaleHeight() / reach_m, 1.0)),
      first_(std::asinh((-1.0 - grazing_sine_) / scale_)),
      last_(std::asinh((1.0 - grazing_sine_) / scale_)),
      g_per_m_(static_cast<std::size_t>(kElevations) * (kDistances + 1)) {
  tbb::parallel_for(0, kElevations, [&](int i) {
    const double u = first_ + (last_ - first_) * i / (kElevations - 1);
    FillRow(std::clamp(grazing_sine_ + scale_ * std::sinh(u), -1.0, 1.0),
            &g_per_m_[static_cast<std::size_t>(i) * (kDistances + 1)]);
  });
}

double RefractedFan::EntersAir(double sine) const {
  const double bends_below_m = kScaleHeightsThatBend * air_.UpperScaleHeight();
  const double over_m = height_m_ - bends_below_m;
  if (over_m <= 0.0) return 0.0;
  const double radius_m = air_.planet_radius_m + height_m_;
  const double enters = radius_m * radius_m * sine * sine - over_m * (2.0 * radius_m - over_m);
  if (sine >= 0.0 || enters <= 0.0) return std::numeric_limits<double>::infinity();
  return -radius_m * sine - std::sqrt(enters);
}

void RefractedFan::FillRow(double sine, float* row) const {
  const double enters_m = EntersAir(sine);
  if (!(enters_m < reach_m_)) return;
  const PlaneOfRay plane(air_, height_m_, sine);
  InPlane ray{{enters_m, 0.0}, {1.0, 0.0}};
  row[0] = static_cast<float>(-0.5 * plane.Turn(ray).y);
  for (int i = 1; i <= kDistances; ++i) {
    const double share = static_cast<double>(i) / kDistances;
    const double along_m = share * share * reach_m_;
    ray = plane.Followed(ray, enters_m + along_m);
    row[i] = static_cast<float>(-ray.at.y / (along_m * along_m));
  }
}

double RefractedFan::RowOf(double sine) const {
  const double u = std::asinh((sine - grazing_sine_) / scale_);
  return std::clamp((u - first_) / (last_ - first_), 0.0, 1.0) * (kElevations - 1);
}

double RefractedFan::ChordFrom(double along_m, double off_rad) const {
  const double b = 4.0 * off_rad / std::max(most_curvature_per_m_, 1e-15);
  return 0.5 * b + std::sqrt(0.25 * b * b + 2.0 * b * along_m);
}

double RefractedFan::EndOfChord(double off_rad) const {
  return 2.0 * off_rad / std::max(most_curvature_per_m_, 1e-15);
}

// A refracted ray never lies above its initial direction, and this line does not lie above the
// parabola, up to terms of third order.
double RefractedFan::SinksBelow(const FanRay& ray, double height_m) const {
  constexpr double kMargin = 1.05;
  const double a = (1.0 - ray.sine() * ray.sine()) / (2.0 * (air_.planet_radius_m + height_m_));
  const double over_m = height_m_ - height_m;
  const double root = ray.sine() * ray.sine() - 4.0 * a * over_m;
  if (ray.sine() >= 0.0 || root < 0.0) return std::numeric_limits<double>::infinity();
  return kMargin * 2.0 * std::max(over_m, 0.0) / (std::sqrt(root) - ray.sine());
}

// Gently bending air bends rays less than the ground curves: the sine of a rising ray keeps
// growing.
double RefractedFan::RisesAbove(const FanRay& ray, double height_m) const {
  if (ray.sine() <= 0.0) return std::numeric_limits<double>::infinity();
  return std::max(height_m - height_m_, 0.0) / ray.sine();
}

FanRay::FanRay(const RefractedFan& fan, const glm::dvec3& origin, const glm::dvec3& direction)
    : fan_(&fan),
      origin_(origin),
      direction_(direction),
      sine_(std::clamp(glm::dot(direction, fan.up_), -1.0, 1.0)),
      enters_m_(fan.EntersAir(sine_)) {
  const glm::dvec3 across = fan.up_ - sine_ * direction;
  across_ = across / std::max(glm::length(across), 1e-9);  // rays to or from the zenith do not bend
  const double row = fan.RowOf(sine_);
  const int below = std::min(static_cast<int>(row), RefractedFan::kElevations - 2);
  share_ = static_cast<float>(row - below);
  row_ = &fan.g_per_m_[static_cast<std::size_t>(below) * (RefractedFan::kDistances + 1)];
}

glm::dvec3 FanRay::At(double along_m) const {
  const glm::dvec3 straight = origin_ + along_m * direction_;
  const double in_air_m = along_m - enters_m_;
  if (!(in_air_m > 0.0)) return straight;
  const double node =
      RefractedFan::kDistances * std::sqrt(std::min(in_air_m / fan_->reach_m_, 1.0));
  const int before = std::min(static_cast<int>(node), RefractedFan::kDistances - 1);
  const auto way = static_cast<float>(node - before);
  const float* here = row_ + before;
  const float* next = here + RefractedFan::kDistances + 1;
  const float g = (1.0F - way) * (here[0] + share_ * (next[0] - here[0])) +
                  way * (here[1] + share_ * (next[1] - here[1]));
  return straight - in_air_m * in_air_m * static_cast<double>(g) * across_;
}

}  // namespace alpenglow::renderer
