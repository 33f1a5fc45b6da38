// SPDX-License-Identifier: MIT
#include "renderer/camera/track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <iterator>
#include <optional>
#include <span>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/camera/camera_path.h"

namespace alpenglow::renderer {
namespace {

/// Duration of the chord that the camera looks along.
constexpr double kChord_s = 4.0;
/// Half-width in time of the smoothing of speed and bank.
constexpr double kSmooth_s = 4.0;

bool HasTimes(const Track& track) {
  return std::all_of(track.points.begin(), track.points.end(),
                     [](const TrackPoint& point) { return point.utc.has_value(); });
}

/// Marks the points after pauses of a track with times.
void MarkPauses(std::vector<CameraPathPoint>& knots) {
  constexpr double kLong_s = 600.0, kTimesLonger = 100.0;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < knots.size(); ++i)
    steps_s.push_back(knots[i].time_s - knots[i - 1].time_s);
  std::vector<double> sorted_s = steps_s;
  const auto middle = sorted_s.begin() + static_cast<std::ptrdiff_t>(sorted_s.size() / 2);
  std::nth_element(sorted_s.begin(), middle, sorted_s.end());
  const double pause_s = std::max(kLong_s, kTimesLonger * *middle);
  for (std::size_t i = 1; i < knots.size(); ++i)
    knots[i].after_gap = knots[i].after_gap || steps_s[i - 1] > pause_s;
}

/// Returns the points with their times.
std::vector<CameraPathPoint> Knots(const Track& track, const TrackStyle& style) {
  const bool timed = HasTimes(track);
  std::vector<CameraPathPoint> knots;
  int segment = 0;
  for (const TrackPoint& point : track.points) {
    CameraPathPoint knot;
    knot.pose.place = point.place;
    knot.utc = timed ? point.utc : std::nullopt;
    if (!knots.empty()) {
      const double way_m = DistanceBetween(point.place, knots.back().pose.place);
      if (!timed && way_m < kSamePlace_m) continue;
      knot.time_s = timed ? SecondsBetween(*knots.front().utc, *point.utc)
                          : knots.back().time_s + way_m / style.speed_m_per_s;
      if (!(knot.time_s > knots.back().time_s)) continue;
      knot.after_gap = point.segment != segment;
    }
    knots.push_back(knot);
    segment = point.segment;
  }
  if (knots.size() < 2) {
    throw InputError(fmt::format("{}: the track has fewer than two points apart{}",
                                 track.file.empty() ? "a track" : track.file,
                                 track.note.empty() ? "" : fmt::format(" ({})", track.note)));
  }
  if (timed) MarkPauses(knots);
  return knots;
}

/// Sets the heights above the sea of points at equal time steps, from heights over the ground
/// smoothed over 5 points.
void LiftOverGround(const Track& track, const TrackStyle& style, const GroundHeight& ground,
                    std::vector<CameraPathPoint>& points) {
  constexpr std::size_t kReach = 2;
  std::vector<double> ground_m, wanted_m;
  for (const CameraPathPoint& point : points) {
    const double over_m =
        track.heights == TrackHeights::kOnGround ? style.over_ground_m : point.pose.place.height_m;
    ground_m.push_back(ground(point.pose.place));
    wanted_m.push_back(ground_m.back() + over_m);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t first = i - std::min(i, kReach);
    const std::size_t last = std::min(i + kReach, points.size() - 1);
    double sum_m = 0.0;
    for (std::size_t k = first; k <= last; ++k) sum_m += wanted_m[k];
    // Keep at least half of the wanted height above the ground.
    points[i].pose.place.height_m =
        std::max(sum_m / static_cast<double>(last - first + 1), 0.5 * (ground_m[i] + wanted_m[i]));
  }
}

/// Returns the vector between two places, in the frame at their middle.
glm::dvec3 Chord(const Place& from, const Place& to, const Place& middle) {
  const LocalFrame frame(kWgs84, middle);
  return frame.EnuFromGeodetic(to).xyz - frame.EnuFromGeodetic(from).xyz;
}

/// Orients the camera along the chords. While it stands, it keeps its last direction; before it
/// first moves, it has the direction of its first movement.
void LookAlong(const CameraPath& places, std::vector<CameraPathPoint>& points) {
  constexpr double kStands_m = 1.0;
  std::optional<std::size_t> first;  // index of the first moving point
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = points[i].time_s;
    CameraPose& pose = points[i].pose;
    const Place from = places.PoseAt(std::max(t - 0.5 * kChord_s, places.begin_s())).place;
    const Place to = places.PoseAt(std::min(t + 0.5 * kChord_s, places.end_s())).place;
    const glm::dvec3 chord = Chord(from, to, pose.place);
    const double level_m = std::hypot(chord.x, chord.y);
    if (level_m > kStands_m) {
      pose.heading_rad = std::atan2(chord.x, chord.y);
      pose.pitch_rad = std::atan2(chord.z, level_m);
      if (!first) first = i;
    } else if (i > 0) {
      pose.heading_rad = points[i - 1].pose.heading_rad;
    }
  }
  for (std::size_t i = 0; i < first.value_or(0); ++i)
    points[i].pose.heading_rad = points[*first].pose.heading_rad;
}

/// Returns for each point the number of points within kSmooth_s on either side, equal before and
/// after.
std::vector<int> ReachOf(std::span<const CameraPathPoint> points) {
  const auto last = static_cast<int>(points.size()) - 1;
  const double step_s = (points.back().time_s - points.front().time_s) / last;
  const int most = static_cast<int>(std::lround(kSmooth_s / step_s));
  std::vector<int> reach;
  for (int i = 0; i <= last; ++i) reach.push_back(std::min({most, i, last - i}));
  return reach;
}

/// Returns weighted means of `values` around each point. `weight` depends on the step from the
/// point; weights are normalised.
template <typename Weight>
std::vector<double> Smoothed(const std::vector<double>& values, const std::vector<int>& reach,
                             const Weight& weight) {
  std::vector<double> smooth;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double sum = 0.0, weights = 0.0;
    for (int j = -reach[i]; j <= reach[i]; ++j) {
      const double w = weight(reach[i], j);
      sum += w * values[static_cast<std::size_t>(static_cast<int>(i) + j)];
      weights += w;
    }
    smooth.push_back(sum / weights);
  }
  return smooth;
}

/// Returns the weight of the least-squares parabola through 2 m + 1 equally spaced points,
/// evaluated at its middle (Savitzky and Golay 1964, Anal. Chem. 36, 1627). Constant acceleration
/// passes unchanged.
double WeightOfParabola(int m, int j) { return 3.0 * m * (m + 1.0) - 1.0 - 5.0 * j * j; }

/// Returns the weight of a Hann window, which falls to 0 at its ends.
double WeightOfHann(int m, int j) { return 1.0 + std::cos(kPi * j / (m + 1.0)); }

struct LongStep {
  double from_s, to_s;
};

/// Returns the steps in which the receiver recorded nothing for longer than the smoothing of the
/// speed.
std::vector<LongStep> LongStepsOf(const CameraPath& way) {
  std::vector<LongStep> steps;
  for (std::size_t k = 1; k < way.points().size(); ++k) {
    const LongStep step{way.points()[k - 1].time_s, way.points()[k].time_s};
    if (step.to_s - step.from_s > kSmooth_s) steps.push_back(step);
  }
  return steps;
}

/// Returns the smoothing width of the speed around each point. For a track with times, smoothing
/// does not reach into long steps, so that their end points are kept. A track without times already
/// has constant speed.
std::vector<int> ReachOfSpeed(const CameraPath& way, const std::vector<CameraPathPoint>& points) {
  std::vector<int> reach = ReachOf(points);
  if (!way.points().front().utc) return reach;
  const std::vector<LongStep> steps = LongStepsOf(way);
  const double spacing_s = points[1].time_s - points[0].time_s;
  std::size_t next = 0;  // the first step that has not ended
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double time_s = points[i].time_s;
    while (next < steps.size() && steps[next].to_s < time_s) ++next;
    double clear_s = kSmooth_s;
    if (next < steps.size()) clear_s = std::clamp(steps[next].from_s - time_s, 0.0, clear_s);
    if (next > 0) clear_s = std::min(clear_s, time_s - steps[next - 1].to_s);
    reach[i] = std::min(reach[i], static_cast<int>(clear_s / spacing_s));
  }
  return reach;
}

/// Smooths the speed along an unchanged curve: each point moves along the curve, by no more than
/// its position would change kShift_s sooner or later. Points at rest do not move.
void SmoothSpeed(const CameraPath& way, std::vector<CameraPathPoint>& points) {
  constexpr double kShift_s = 2.0;
  std::vector<double> gone_m{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    gone_m.push_back(gone_m.back() +
                     DistanceBetween(points[i - 1].pose.place, points[i].pose.place));
  }
  const auto shift = static_cast<std::size_t>(
      std::max(std::lround(kShift_s / (points[1].time_s - points[0].time_s)), 1L));
  const std::vector<double> smooth_m =
      Smoothed(gone_m, ReachOfSpeed(way, points), WeightOfParabola);
  std::vector<double> times_s;
  for (const CameraPathPoint& point : points) times_s.push_back(point.time_s);
  double farthest_m = 0.0;
  std::size_t next = 1;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double least_m = gone_m[i - std::min(i, shift)];
    const double most_m = gone_m[std::min(i + shift, points.size() - 1)];
    farthest_m = std::max(farthest_m, std::clamp(smooth_m[i], least_m, most_m));  // never backwards
    while (next + 1 < gone_m.size() && gone_m[next] < farthest_m) ++next;
    const double span_m = gone_m[next] - gone_m[next - 1];
    const double share = span_m > 0.0 ? (farthest_m - gone_m[next - 1]) / span_m : 1.0;
    const double time_s = times_s[next - 1] + share * (times_s[next] - times_s[next - 1]);
    points[i].pose.place = way.PoseAt(time_s).place;
  }
}

/// Sets the roll as an aircraft banks in the turns of the headings, with gradual onset.
void Bank(std::span<CameraPathPoint> points) {
  constexpr double kMost_rad = 35.0 * kRadiansPerDegree;
  std::vector<double> bank_rad(points.size(), 0.0);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const CameraPathPoint &before = points[i - 1], &after = points[i + 1];
    const double seconds = after.time_s - before.time_s;
    const double turn = std::remainder(after.pose.heading_rad - before.pose.heading_rad, 2.0 * kPi);
    const double speed = DistanceBetween(before.pose.place, after.pose.place) / seconds;
    bank_rad[i] = std::clamp(std::atan(speed * turn / seconds / kStandardGravity_m_per_s2),
                             -kMost_rad, kMost_rad);
  }
  // Near its ends only half of a turn is available, so the bank is copied from a little farther
  // inside.
  const auto reach = static_cast<std::size_t>(
      std::clamp(std::lround(kSmooth_s / (points[1].time_s - points[0].time_s)), 1L,
                 static_cast<long>(points.size()) / 2 - 1));
  std::fill_n(bank_rad.begin(), reach, bank_rad[reach]);
  std::fill_n(bank_rad.rbegin(), reach, bank_rad[points.size() - 1 - reach]);
  const std::vector<double> smooth_rad = Smoothed(bank_rad, ReachOf(points), WeightOfHann);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].pose.roll_rad = smooth_rad[i];
}

/// Returns the segments between gaps.
std::vector<CameraPath> SegmentsOf(const std::vector<CameraPathPoint>& knots) {
  std::vector<CameraPath> segments;
  for (auto begin = knots.begin(); begin != knots.end();) {
    const auto end = std::find_if(std::next(begin), knots.end(),
                                  [](const CameraPathPoint& knot) { return knot.after_gap; });
    std::vector<CameraPathPoint> part(begin, end);
    part.front().after_gap = false;
    segments.emplace_back(std::move(part));
    begin = end;
  }
  return segments;
}

/// Returns the number of steps into which each segment is divided.
std::vector<int> StepsOf(const std::vector<CameraPath>& segments) {
  constexpr double kMost = 200e3, kLeastInAll = 200.0, kLeast = 8.0, kStepsPerKnot = 2.0;
  double total_s = 0.0;
  for (const CameraPath& segment : segments) total_s += segment.end_s() - segment.begin_s();
  const double per_s = std::min(kMost / std::max(total_s, 1.0), 1.0);
  const double least = std::max(kLeast, kLeastInAll / static_cast<double>(segments.size()));
  std::vector<int> steps;
  for (const CameraPath& segment : segments) {
    const double span_s = segment.end_s() - segment.begin_s();
    const double recorded = kStepsPerKnot * static_cast<double>(segment.points().size());
    const double wanted =
        std::max(std::ceil(span_s * per_s), std::min(std::ceil(span_s), recorded));
    steps.push_back(span_s > 0.0 ? static_cast<int>(std::max(wanted, std::ceil(least))) : 0);
  }
  return steps;
}

/// Returns points at equal steps of time, both ends included.
std::vector<CameraPathPoint> EvenPoints(const CameraPath& knots, const TrackStyle& style,
                                        int steps) {
  const double span_s = knots.end_s() - knots.begin_s();
  std::vector<CameraPathPoint> points;
  for (int i = 0; i <= steps; ++i) {
    const double time_s = i == steps ? knots.end_s() : knots.begin_s() + span_s * i / steps;
    CameraPose pose = knots.PoseAt(time_s);
    pose.fov_rad = style.fov_rad;
    points.push_back({time_s, pose, knots.UtcAt(time_s)});
  }
  return points;
}

/// Returns the points of a segment, level and not yet turned.
std::vector<CameraPathPoint> PlacesOf(const CameraPath& knots, const TrackStyle& style, int steps) {
  std::vector<CameraPathPoint> points = EvenPoints(knots, style, steps);
  if (steps > 0) SmoothSpeed(knots, points);
  return points;
}

/// Returns the points between two segments, without its ends: on a straight line.
std::vector<CameraPathPoint> PlacesBetween(const CameraPathPoint& from, const CameraPathPoint& to,
                                           const TrackStyle& style, std::size_t gaps) {
  constexpr double kMost = 100.0, kMostInAll = 100e3;
  CameraPathPoint end = to;
  end.after_gap = true;
  const double most = std::min(kMost, std::ceil(kMostInAll / static_cast<double>(gaps)));
  const auto steps = static_cast<int>(std::clamp(std::floor(end.time_s - from.time_s), 1.0, most));
  std::vector<CameraPathPoint> points = EvenPoints(CameraPath({from, end}), style, steps);
  return {points.begin() + 1, points.end() - 1};
}

/// A stretch of the path with even steps.
struct Part {
  std::size_t begin, end;  // indices of points
};

}  // namespace

CameraPath PathAlong(const Track& track, const TrackStyle& style, const GroundHeight& ground) {
  RequireInRange(style.speed_m_per_s, 0.1, 1e5, "speed of the track");
  RequireInRange(style.over_ground_m, 0.0, 1e6, "height over the ground of the track");
  const std::vector<CameraPath> segments = SegmentsOf(Knots(track, style));
  const std::vector<int> steps = StepsOf(segments);
  std::vector<CameraPathPoint> points;
  std::vector<Part> banked;
  const auto append = [&](std::vector<CameraPathPoint> part) {
    if (track.heights != TrackHeights::kSea) LiftOverGround(track, style, ground, part);
    points.insert(points.end(), part.begin(), part.end());
  };
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (i > 0) {
      const std::size_t begin = points.size();
      append(PlacesBetween(segments[i - 1].points().back(), segments[i].points().front(), style,
                           segments.size() - 1));
      for (std::size_t k = begin; k < points.size(); ++k) points[k].after_gap = true;
    }
    const std::size_t begin = points.size();
    append(PlacesOf(segments[i], style, steps[i]));
    points[begin].after_gap = i > 0;
    if (steps[i] > 0) banked.push_back({begin, points.size()});
  }
  LookAlong(CameraPath(points), points);
  for (const Part& part : banked)
    Bank(std::span(points).subspan(part.begin, part.end - part.begin));
  return CameraPath(std::move(points));
}

}  // namespace alpenglow::renderer
