// SPDX-License-Identifier: MIT
#include "renderer/ground/bent_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/ground/scene_geometry.h"

namespace alpenglow {
namespace {

// Where air bends a ten-thousandth of what it does at the ground rays are straight.
constexpr double kScaleHeightsThatBend = 9.0;
// The share x of a scale height that a piece may rise or sink: the midpoint rule is then within x^2 / 24 = 0.3 %
// of the bending.
constexpr double kHeightOfPiece = 0.25;

glm::dvec3 CentreUp(const glm::dvec3& point, double radius_m) {
  return glm::normalize(point + glm::dvec3(0.0, 0.0, radius_m));
}

}  // namespace

BentPath::BentPath(const BendingAir& air, const glm::dvec3& origin, const glm::dvec3& direction,
                   double off_rad)
    : air_(air),
      at_(origin),
      direction_(direction),
      off_rad_(off_rad),
      steepest_per_m_(std::abs(RefractivitySlopeAt(air, 0.0))) {}

double BentPath::HeightHere() const { return AltitudeOverSphere(at_, air_.planet_radius_m); }

bool BentPath::Rises() const {
  return glm::dot(direction_, CentreUp(at_, air_.planet_radius_m)) >= 0.0;
}

glm::dvec3 BentPath::Turn(const glm::dvec3& at, const glm::dvec3& direction) const {
  const double height_m = AltitudeOverSphere(at, air_.planet_radius_m);
  const glm::dvec3 up = CentreUp(at, air_.planet_radius_m);
  return CurvaturePerMetreAt(air_, height_m) * (up - glm::dot(up, direction) * direction);
}

double BentPath::PieceLength(double nothing_before_m) const {
  const glm::dvec3 up = CentreUp(at_, air_.planet_radius_m);
  const double sine = glm::dot(direction_, up);
  const double bends_below_m = kScaleHeightsThatBend * air_.UpperScaleHeight();
  const double height_m = HeightHere();
  const double over_m = height_m - bends_below_m;
  // Straight down to where the air bends.
  if (over_m > 0.0 && sine < 0.0) {
    const double radius_m = air_.planet_radius_m + height_m;
    const double enters = radius_m * radius_m * sine * sine - over_m * (2.0 * radius_m - over_m);
    if (enters > 0.0) return -radius_m * sine - std::sqrt(enters) + 1.0;
  }
  // c L^2 / 8 - off L / 2 - off d = 0.
  const double b = 4.0 * off_rad_ / std::max(steepest_per_m_, 1e-15);
  const double by_chord_m = 0.5 * b + std::sqrt(0.25 * b * b + 2.0 * b * gone_m_);
  // Steeply, and level rays, which rise with the square of their length.
  const double may_rise_m = kHeightOfPiece * air_.UpperScaleHeight();
  const double by_height_m =
      may_rise_m / std::max(std::abs(sine), std::sqrt(may_rise_m / (2.0 * air_.planet_radius_m)));
  return std::min(std::max(by_chord_m, nothing_before_m - gone_m_), by_height_m);
}

RayPiece BentPath::Next(double nothing_before_m) {
  const double length_m = PieceLength(nothing_before_m);
  const glm::dvec3 turn = Turn(at_, direction_);
  const glm::dvec3 half = glm::normalize(direction_ + 0.5 * length_m * turn);
  const glm::dvec3 middle = at_ + 0.25 * length_m * (direction_ + half);
  const glm::dvec3 half_turn = Turn(middle, half);
  // The mean of directions along a piece whose turn changes evenly.
  const glm::dvec3 chord = glm::normalize(direction_ + length_m / 6.0 * (turn + 2.0 * half_turn));
  const RayPiece piece{at_, chord, length_m, gone_m_};
  direction_ = glm::normalize(direction_ + length_m * half_turn);
  at_ += length_m * chord;
  gone_m_ += length_m;
  return piece;
}

}  // namespace alpenglow
