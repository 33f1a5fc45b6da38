// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/csv_reader.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {
namespace {

enum Column : std::size_t {
  kTime,
  kLatitude,
  kLongitude,
  kHeight,
  kHeading,
  kPitch,
  kRoll,
  kFov,
  kUtc
};
constexpr std::array<std::string_view, 9> kColumns{
    "t_s", "latitude", "longitude", "height_m", "heading", "pitch", "roll", "fov", "utc"};
constexpr std::size_t kNeeded = kHeading;

double Degrees(double radians) { return radians / kRadiansPerDegree; }

glm::dvec3 NormalAt(const Place& place) {
  const double c = std::cos(place.latitude_rad());
  return {c * std::cos(place.longitude_rad()), c * std::sin(place.longitude_rad()),
          std::sin(place.latitude_rad())};
}

Place PlaceOfNormal(const glm::dvec3& normal, double height_m) {
  return PlaceFromRadians(std::atan2(normal.z, std::hypot(normal.x, normal.y)),
                          std::atan2(normal.y, normal.x), height_m);
}

/// Returns the change of the heading of a direction that is carried along the great circle from one
/// place to another [rad]: the excess of the triangle with the pole (Napier's analogies). Over a
/// pole it is half a turn.
double TurnOfHeading(const Place& from, const Place& to) {
  const double half_east =
      0.5 * std::remainder(to.longitude_rad() - from.longitude_rad(), 2.0 * kPi);
  const double mean = 0.5 * (from.latitude_rad() + to.latitude_rad());
  const double half_north = 0.5 * (to.latitude_rad() - from.latitude_rad());
  return 2.0 * std::atan2(std::sin(mean) * std::sin(half_east),
                          std::cos(half_north) * std::cos(half_east));
}

/// Returns the cubic between two values with given slopes at both ends.
template <typename Value>
Value Hermite(const Value& a, const Value& slope_a, const Value& b, const Value& slope_b,
              double step, double share) {
  const double rest = 1.0 - share;
  return (1.0 + 2.0 * share) * rest * rest * a + share * share * (3.0 - 2.0 * share) * b +
         step * share * rest * (rest * slope_a - share * slope_b);
}

/// Returns the slope at a point between two steps: that of the parabola through the three points.
template <typename Value>
Value SlopeOfParabola(double step_before, const Value& before, double step_after,
                      const Value& after) {
  return (step_after * before + step_before * after) / (step_before + step_after);
}

/// Returns the parabola's slope for places, with its length limited: at most kMost times the lower
/// speed, less where the path turns by more than a right angle, and 0 where it turns back. A cubic
/// whose slopes are at most 3 times that of its chord does not overshoot (Fritsch and Carlson 1980,
/// SIAM J. Numer. Anal. 17, 238); a lower limit keeps it closer to the chord at a corner.
glm::dvec3 LimitedSlope(double step_before, const glm::dvec3& before, double step_after,
                        const glm::dvec3& after) {
  constexpr double kMost = 2.0;
  const glm::dvec3 slope = SlopeOfParabola(step_before, before, step_after, after);
  const double speed_before = glm::length(before), speed_after = glm::length(after);
  const double least = std::min(speed_before, speed_after);
  if (!(least > 0.0)) return glm::dvec3(0.0);
  const double cosine = glm::dot(before, after) / (speed_before * speed_after);
  const double most = kMost * least * std::clamp(1.0 + cosine, 0.0, 1.0);
  return slope * std::min(1.0, most / std::max(glm::length(slope), least));
}

/// Returns a slope without overshoot: Fritsch and Butland's harmonic mean, 0 at an extreme.
double SlopeWithoutOvershoot(double step_before, double before, double step_after, double after) {
  if (!(before * after > 0.0)) return 0.0;
  const double w_before = step_before + 2.0 * step_after;
  const double w_after = 2.0 * step_before + step_after;
  return (w_before + w_after) / (w_before / before + w_after / after);
}

/// Returns slopes at all points. At the ends and beside gaps, they are those of the adjacent step.
template <typename Value, typename Between>
std::vector<Value> SlopesOf(const std::vector<CameraPathPoint>& points,
                            const std::vector<Value>& values, const Between& between) {
  const std::size_t count = values.size();
  if (count == 1) return {Value(0.0)};
  const auto step = [&](std::size_t i) { return points[i + 1].time_s - points[i].time_s; };
  const auto slope = [&](std::size_t i) { return (values[i + 1] - values[i]) / step(i); };
  std::vector<Value> slopes{slope(0)};
  for (std::size_t i = 1; i + 1 < count; ++i) {
    if (points[i].after_gap || points[i + 1].after_gap) {
      slopes.push_back(slope(points[i].after_gap ? i : i - 1));
    } else {
      slopes.push_back(between(step(i - 1), slope(i - 1), step(i), slope(i)));
    }
  }
  slopes.push_back(slope(count - 2));
  return slopes;
}

/// Unwraps angles, so that each follows the previous one by the shorter way.
std::vector<double> Unwound(std::vector<double> angles) {
  for (std::size_t i = 1; i < angles.size(); ++i) {
    angles[i] = angles[i - 1] + std::remainder(angles[i] - angles[i - 1], 2.0 * kPi);
  }
  return angles;
}

void RequireOrder(const std::vector<CameraPathPoint>& points) {
  if (points.empty()) throw InputError("a camera path has no points");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].time_s) || (i > 0 && !(points[i].time_s > points[i - 1].time_s))) {
      throw InputError(fmt::format("point {} of the camera path is at {} s; times must grow", i + 1,
                                   points[i].time_s));
    }
    if (points[i].utc.has_value() != points[0].utc.has_value()) {
      throw InputError(fmt::format("point {} of the camera path {} utc; all points have it or none",
                                   i + 1, points[i].utc ? "has" : "has no"));
    }
  }
}

/// Throws InputError if two successive points are on opposite sides of the planet: no way between
/// them is the shortest.
void RequireWays(const std::vector<glm::dvec3>& normals) {
  constexpr double kOpposite = 1e-9;
  for (std::size_t i = 1; i < normals.size(); ++i) {
    if (glm::length(normals[i - 1] + normals[i]) < kOpposite) {
      throw InputError(fmt::format(
          "points {} and {} of the camera path are on opposite sides of the planet", i, i + 1));
    }
  }
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraPathPoint> points) : points_(std::move(points)) {
  RequireOrder(points_);
  Place last_place;
  double turned_rad = 0.0;  // of a direction that is carried along from the first point
  for (const CameraPathPoint& point : points_) {
    const CameraPose& pose = point.pose;
    if (!normals_.empty()) turned_rad += TurnOfHeading(last_place, pose.place);
    last_place = pose.place;
    normals_.push_back(NormalAt(pose.place));
    const std::array<double, kScalars> values{pose.place.height_m, pose.heading_rad - turned_rad,
                                              pose.pitch_rad, pose.roll_rad, pose.fov_rad};
    for (std::size_t k = 0; k < kScalars; ++k) scalars_[k].push_back(values[k]);
    if (point.utc) utc_s_.push_back(SecondsBetween(*points_[0].utc, *point.utc));
  }
  constexpr std::size_t kOfHeading = 1, kOfRoll = 3;
  for (const std::size_t k : {kOfHeading, kOfRoll}) scalars_[k] = Unwound(std::move(scalars_[k]));
  RequireWays(normals_);
  normal_slopes_ = SlopesOf(points_, normals_, LimitedSlope);
  for (std::size_t k = 0; k < kScalars; ++k) {
    scalar_slopes_[k] = SlopesOf(points_, scalars_[k], SlopeWithoutOvershoot);
  }
}

CameraPath::Span CameraPath::SpanAt(double time_s) const {
  const auto after = std::upper_bound(
      points_.begin(), points_.end(), time_s,
      [](double time, const CameraPathPoint& point) { return time < point.time_s; });
  if (after == points_.begin()) return {0, 0.0};
  const auto left = static_cast<std::size_t>(after - points_.begin()) - 1;
  if (after == points_.end()) return {left, 0.0};
  const double begin = points_[left].time_s;
  return {left, (time_s - begin) / (after->time_s - begin)};
}

template <typename Value>
Value CameraPath::Between(const std::vector<Value>& values, const std::vector<Value>& slopes,
                          const Span& span) const {
  const std::size_t i = span.left;
  if (span.share == 0.0) return values[i];
  if (points_[i + 1].after_gap) return values[i] + span.share * (values[i + 1] - values[i]);
  return Hermite(values[i], slopes[i], values[i + 1], slopes[i + 1],
                 points_[i + 1].time_s - points_[i].time_s, span.share);
}

CameraPose CameraPath::PoseAt(double time_s) const {
  const Span span = SpanAt(time_s);
  // At a point of the path, return its pose exactly, without rounding.
  if (span.share == 0.0) return points_[span.left].pose;
  const auto scalar = [&](std::size_t k) { return Between(scalars_[k], scalar_slopes_[k], span); };
  CameraPose pose;
  pose.place = PlaceOfNormal(glm::normalize(Between(normals_, normal_slopes_, span)), scalar(0));
  const CameraPose& left = points_[span.left].pose;
  const double turned_rad = scalar(1) - scalars_[1][span.left];
  pose.heading_rad = std::remainder(
      left.heading_rad + turned_rad + TurnOfHeading(left.place, pose.place), 2.0 * kPi);
  pose.pitch_rad = scalar(2);
  pose.roll_rad = std::remainder(scalar(3), 2.0 * kPi);
  pose.fov_rad = scalar(4);
  return pose;
}

std::optional<UtcTime> CameraPath::UtcAt(double time_s) const {
  if (utc_s_.empty()) return std::nullopt;
  const Span span = SpanAt(time_s);
  const double begin = utc_s_[span.left];
  if (span.share == 0.0) return points_[span.left].utc;
  return AddSeconds(*points_[0].utc, begin + span.share * (utc_s_[span.left + 1] - begin));
}

std::vector<CameraPose> CameraPath::PosesBetween(double from_s, double to_s, int count) const {
  if (count == 1) return {PoseAt(0.5 * (from_s + to_s))};
  std::vector<CameraPose> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(PoseAt(from_s + (to_s - from_s) * i / (count - 1)));
  }
  return poses;
}

CameraPath ReadCameraPath(const std::filesystem::path& file, const CameraPose& otherwise) {
  CsvReader lines(file, kColumns, {kNeeded, true, HasExtension(file, ".part")});
  const auto degrees = [&](Column column, double low, double high, double radians) {
    return lines.Has(column) ? lines.Number(column, low, high) : Degrees(radians);
  };
  std::vector<CameraPathPoint> points;
  while (lines.Next()) {
    CameraPathPoint point;
    point.time_s = lines.Number(kTime, -1e12, 1e12);
    if (!points.empty() && !(point.time_s > points.back().time_s)) {
      lines.Fail(lines.line(), fmt::format("t_s is {}; it must grow", point.time_s));
    }
    try {
      const Camera camera =
          CameraFromDegrees({}, degrees(kHeading, -360.0, 360.0, otherwise.heading_rad),
                            degrees(kPitch, -90.0, 90.0, otherwise.pitch_rad),
                            degrees(kRoll, -180.0, 180.0, otherwise.roll_rad),
                            degrees(kFov, 0.0, 360.0, otherwise.fov_rad));
      point.pose = {CheckedPlace({lines.Number(kLatitude, -90.0, 90.0),
                                  lines.Number(kLongitude, -180.0, 360.0),
                                  lines.Number(kHeight, -12000.0, 1e9)}),
                    camera.heading_rad, camera.pitch_rad, camera.roll_rad, camera.fov_rad};
      if (lines.Has(kUtc)) point.utc = ParseInstant(lines.Field(kUtc));
    } catch (const InputError& error) {
      const std::string text = error.what();
      if (text.starts_with(file.string())) throw;
      lines.Fail(lines.line(), text);
    }
    points.push_back(point);
  }
  return CameraPath(std::move(points));
}

std::string HeaderOfCameraPath(bool has_utc) {
  return fmt::format("{}\n", fmt::join(kColumns.begin(), kColumns.end() - (has_utc ? 0 : 1), ","));
}

std::string LineOf(const CameraPathPoint& point) {
  const CameraPose& pose = point.pose;
  const std::string line =
      fmt::format("{},{:.10f},{:.10f},{:.4f},{:.10f},{:.10f},{:.10f},{:.10f}", point.time_s,
                  pose.place.latitude_deg, pose.place.longitude_deg, pose.place.height_m,
                  Degrees(pose.heading_rad), Degrees(pose.pitch_rad), Degrees(pose.roll_rad),
                  Degrees(pose.fov_rad));
  return point.utc ? fmt::format("{},{}\n", line, FormatUtc(*point.utc, 6)) : line + "\n";
}

std::string TextOf(const CameraPath& path) {
  std::string text = HeaderOfCameraPath(path.points().front().utc.has_value());
  for (const CameraPathPoint& point : path.points()) text += LineOf(point);
  return text;
}

void CheckPoints(const CameraPath& path, const std::string& file,
                 const std::function<void(const Place&)>& check) {
  for (std::size_t i = 0; i < path.points().size(); ++i) {
    try {
      check(path.points()[i].pose.place);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: point {}: {}", file, i + 1, error.what()));
    }
  }
}

}  // namespace alpenglow::renderer
