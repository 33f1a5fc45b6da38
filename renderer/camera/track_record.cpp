// SPDX-License-Identifier: MIT
#include "renderer/camera/track_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "atmosphere/math/constants.h"
#include "renderer/camera/along_way.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/odd_points.h"

namespace alpenglow::renderer {
namespace {

/// A point with its place, and its segment.
struct PlacedPoint {
  RecordedPoint recorded;
  int segment = 0;
};

struct Counts {
  std::size_t points = 0, lost_fixes = 0, odd_places = 0, heights = 0, odd_heights = 0,
              odd_times = 0, times = 0;
  bool times_dropped = false, times_contradict = false;
};

std::vector<UtcTime> TimesOf(const RecordedSegment& segment) {
  std::vector<UtcTime> times;
  for (const RecordedPoint& point : segment) {
    if (point.utc) times.push_back(*point.utc);
  }
  return times;
}

bool IsBefore(const UtcTime& one, const UtcTime& other) { return SecondsBetween(one, other) > 0.0; }

/// Returns whether most of its times precede the time before them.
bool RunsBackwards(const RecordedSegment& segment) {
  const std::vector<UtcTime> times = TimesOf(segment);
  int steps = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps += IsBefore(times[i - 1], times[i]) ? 1 : IsBefore(times[i], times[i - 1]) ? -1 : 0;
  }
  return steps < 0 && times.size() > 2;
}

/// Returns the median time, which a single wrong time does not shift.
UtcTime MedianTime(const RecordedSegment& segment) {
  std::vector<UtcTime> times = TimesOf(segment);
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end(), IsBefore);
  return *middle;
}

/// Returns the points with a place; a mark of a pause ends a segment.
std::vector<RecordedSegment> WithPlaces(const RecordedSegment& segment) {
  std::vector<RecordedSegment> placed(1);
  for (const RecordedPoint& point : segment) {
    if (point.place) placed.back().push_back(point);
    if (point.is_pause) placed.emplace_back();
  }
  std::erase_if(placed, [](const RecordedSegment& part) { return part.empty(); });
  return placed;
}

std::vector<RecordedSegment> InOrder(std::vector<RecordedSegment> segments) {
  for (RecordedSegment& segment : segments) {
    if (RunsBackwards(segment)) std::reverse(segment.begin(), segment.end());
  }
  const bool all_timed =
      std::all_of(segments.begin(), segments.end(),
                  [](const RecordedSegment& segment) { return !TimesOf(segment).empty(); });
  if (!all_timed) return segments;
  std::vector<std::pair<UtcTime, std::size_t>> order;
  for (std::size_t i = 0; i < segments.size(); ++i) order.emplace_back(MedianTime(segments[i]), i);
  std::stable_sort(order.begin(), order.end(), [](const auto& one, const auto& other) {
    return IsBefore(one.first, other.first);
  });
  std::vector<RecordedSegment> ordered;
  for (const auto& [time, i] : order) ordered.push_back(std::move(segments[i]));
  return ordered;
}

std::vector<PlacedPoint> PlacedPointsOf(const std::vector<RecordedSegment>& segments,
                                        Counts& counts) {
  std::vector<RecordedSegment> placed;
  for (const RecordedSegment& segment : segments) {
    counts.points += segment.size();
    counts.lost_fixes += segment.size();
    for (RecordedSegment& part : WithPlaces(segment)) {
      counts.lost_fixes -= part.size();
      placed.push_back(std::move(part));
    }
  }
  std::vector<PlacedPoint> points;
  int number = 0;
  for (const RecordedSegment& segment : InOrder(std::move(placed))) {
    for (const RecordedPoint& point : segment) points.push_back({point, number});
    ++number;
  }
  return points;
}

/// Returns the indices of the longest subsequence with increasing times, in seconds since the
/// first; points without a time are excluded.
std::vector<std::size_t> LongestGrowing(const std::vector<std::optional<double>>& times_s) {
  std::vector<std::size_t> ends;  // entry k: end of the run of k + 1 points that ends earliest
  std::vector<std::size_t> before(times_s.size());
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    if (!times_s[i]) continue;
    const auto at =
        std::lower_bound(ends.begin(), ends.end(), *times_s[i],
                         [&](std::size_t end, double time_s) { return *times_s[end] < time_s; });
    before[i] = at == ends.begin() ? i : *std::prev(at);
    if (at == ends.end()) {
      ends.push_back(i);
    } else {
      *at = i;
    }
  }
  std::vector<std::size_t> run;
  if (ends.empty()) return run;
  for (std::size_t i = ends.back();; i = before[i]) {
    run.push_back(i);
    if (before[i] == i) break;
  }
  std::reverse(run.begin(), run.end());
  return run;
}

/// Keeps the larger part of a run at each step of a year and more: a clock that was not set shows
/// the year 1970, 1980 or 2000, and one whose count of weeks has overflowed is 20 years behind.
void CutOtherYears(const std::vector<std::optional<double>>& times_s,
                   std::vector<std::size_t>& run) {
  constexpr double kYear_s = 365.0 * kSecondsPerDay;
  for (std::size_t k = 1; k < run.size();) {
    if (*times_s[run[k]] - *times_s[run[k - 1]] < kYear_s) {
      ++k;
    } else if (2 * k <= run.size()) {
      run.erase(run.begin(), run.begin() + static_cast<std::ptrdiff_t>(k));
      k = 1;
    } else {
      run.resize(k);
    }
  }
}

/// Removes end points that lie far in time from the rest.
void CutFarEnds(const std::vector<std::optional<double>>& times_s, std::vector<std::size_t>& run) {
  constexpr double kFar_s = kSecondsPerDay;
  constexpr double kLengths = 100.0;
  const auto is_far = [&](double step_s, double rest_s) {
    return step_s > std::max(kFar_s, kLengths * rest_s);
  };
  const auto time = [&](std::size_t i) { return *times_s[run[i]]; };
  if (run.size() < 3) return;
  const std::size_t last = run.size() - 1;
  if (is_far(time(1) - time(0), time(last) - time(1))) {
    run.erase(run.begin());
  } else if (is_far(time(last) - time(last - 1), time(last - 1) - time(0))) {
    run.pop_back();
  }
}

std::vector<std::optional<double>> SecondsOf(const std::vector<PlacedPoint>& points) {
  std::vector<std::optional<double>> times_s(points.size());
  const auto first = std::find_if(points.begin(), points.end(), [](const PlacedPoint& point) {
    return point.recorded.utc.has_value();
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].recorded.utc)
      times_s[i] = SecondsBetween(*first->recorded.utc, *points[i].recorded.utc);
  }
  return times_s;
}

bool IsSamePlace(const RecordedPoint& one, const RecordedPoint& other) {
  return DistanceBetween(*one.place, *other.place) < kSamePlace_m;
}

void DropTimes(std::vector<PlacedPoint>& points) {
  for (PlacedPoint& point : points) point.recorded.utc.reset();
}

/// Returns the points with increasing times, and the points without a time. If these are fewer than
/// half of the times, it returns all points, without times.
std::vector<PlacedPoint> WithoutOddTimes(const std::vector<PlacedPoint>& points, Counts& counts) {
  const std::vector<std::optional<double>> times_s = SecondsOf(points);
  std::vector<std::size_t> run = LongestGrowing(times_s);
  CutOtherYears(times_s, run);
  CutFarEnds(times_s, run);
  std::vector<PlacedPoint> kept;
  std::size_t next = 0, fitting = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_next = next < run.size() && run[next] == i;
    if (is_next) ++next;
    if (is_next || !times_s[i]) {
      kept.push_back(points[i]);
      continue;
    }
    const auto repeats = [&](std::size_t other) {
      return other < points.size() && times_s[i] == times_s[other] &&
             IsSamePlace(points[i].recorded, points[other].recorded);
    };
    if (repeats(i + 1) || (i > 0 && repeats(i - 1))) {
      ++fitting;
    } else {
      ++counts.odd_times;
    }
  }
  if (counts.odd_times <= run.size() + fitting) return kept;
  counts.odd_times = 0;
  counts.times_contradict = true;
  kept = points;
  DropTimes(kept);
  return kept;
}

PlacesInTime PlacesInTimeOf(const std::vector<PlacedPoint>& points) {
  PlacesInTime all{{}, SecondsOf(points)};
  for (const PlacedPoint& point : points) all.places.push_back(*point.recorded.place);
  return all;
}

std::vector<PlacedPoint> WithoutOddPlaces(std::vector<PlacedPoint> points, Counts& counts) {
  const std::vector<bool> odd = OddPlaces(PlacesInTimeOf(points));
  std::vector<PlacedPoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!odd[i]) kept.push_back(points[i]);
  }
  counts.odd_places = points.size() - kept.size();
  return kept;
}

void DropOddHeights(std::vector<PlacedPoint>& points, Counts& counts) {
  std::vector<std::optional<double>> heights_m;
  for (const PlacedPoint& point : points) heights_m.push_back(point.recorded.height_m);
  const std::vector<bool> odd = OddHeights(PlacesInTimeOf(points), heights_m);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!odd[i]) continue;
    points[i].recorded.height_m.reset();
    ++counts.odd_heights;
  }
}

/// Returns the distance along the points from the first [m].
std::vector<double> WayOf(const std::vector<PlacedPoint>& points) {
  std::vector<double> way_m{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    way_m.push_back(way_m.back() +
                    DistanceBetween(*points[i - 1].recorded.place, *points[i].recorded.place));
  }
  return way_m;
}

void CompleteHeights(std::vector<PlacedPoint>& points, Counts& counts) {
  const std::vector<double> way_m = WayOf(points);
  std::vector<std::optional<double>> known;
  for (const PlacedPoint& point : points) known.push_back(point.recorded.height_m);
  counts.heights = static_cast<std::size_t>(std::count(known.begin(), known.end(), std::nullopt)) -
                   counts.odd_heights;
  const std::vector<double> heights_m =
      CompletedAlong(way_m, known, [&](std::size_t i, std::size_t near, std::size_t next) {
        const double step_m = std::abs(way_m[next] - way_m[near]);
        if (!(step_m > 0.0)) return *known[near];
        const double share = std::min(std::abs(way_m[i] - way_m[near]) / step_m, 1.0);
        return *known[near] + share * (*known[near] - *known[next]);
      });
  for (std::size_t i = 0; i < points.size(); ++i) points[i].recorded.height_m = heights_m[i];
}

void CompleteTimes(std::vector<PlacedPoint>& points, Counts& counts) {
  const std::vector<double> way_m = WayOf(points);
  const std::vector<std::optional<double>> known = SecondsOf(points);
  const auto first = std::find_if(points.begin(), points.end(), [](const PlacedPoint& point) {
    return point.recorded.utc.has_value();
  });
  const UtcTime origin = *first->recorded.utc;
  counts.times = static_cast<std::size_t>(std::count(known.begin(), known.end(), std::nullopt));
  const std::vector<double> times_s =
      CompletedAlong(way_m, known, [&](std::size_t i, std::size_t near, std::size_t next) {
        const double step_m = way_m[next] - way_m[near];
        if (step_m == 0.0) return *known[near];
        return *known[near] + (way_m[i] - way_m[near]) * (*known[next] - *known[near]) / step_m;
      });
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!known[i]) points[i].recorded.utc = AddSeconds(origin, times_s[i]);
  }
}

std::string NoteOf(const Counts& counts) {
  std::vector<std::string> parts;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) parts.push_back(fmt::format("{} of {} points {}", count, counts.points, what));
  };
  add(counts.lost_fixes, "have no place (a lost fix) and are left out");
  add(counts.odd_times, "have a time that does not fit the others' and are left out");
  add(counts.odd_places, "have a place that does not fit the others' and are left out");
  add(counts.heights, "have no height, which is interpolated");
  add(counts.odd_heights, "have a height that does not fit the others', which is interpolated");
  add(counts.times, "have no time, which is interpolated");
  if (counts.times_dropped)
    parts.emplace_back("fewer than two points have a time: the track is flown with an even speed");
  if (counts.times_contradict)
    parts.emplace_back("most times contradict each other: the track is flown with an even speed");
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

Track TrackOf(const std::vector<RecordedSegment>& segments, TrackHeights heights) {
  Counts counts;
  std::vector<PlacedPoint> points = PlacedPointsOf(segments, counts);
  const auto has = [&](auto member) {
    return std::count_if(points.begin(), points.end(), [&](const PlacedPoint& point) {
      return (point.recorded.*member).has_value();
    });
  };
  if (has(&RecordedPoint::utc) > 1) points = WithoutOddTimes(points, counts);
  points = WithoutOddPlaces(std::move(points), counts);
  if (heights != TrackHeights::kOnGround) DropOddHeights(points, counts);
  if (has(&RecordedPoint::utc) > 1) {
    CompleteTimes(points, counts);
  } else if (has(&RecordedPoint::utc) == 1 && points.size() > 1) {
    counts.times_dropped = true;
    DropTimes(points);
  }
  Track track;
  const bool has_heights = has(&RecordedPoint::height_m) > 0;
  const bool lies_on_ground = heights == TrackHeights::kSea && !has_heights;
  track.heights = lies_on_ground ? TrackHeights::kOnGround : heights;
  if (has_heights && heights != TrackHeights::kOnGround) CompleteHeights(points, counts);
  for (const PlacedPoint& point : points) {
    TrackPoint added{*point.recorded.place, point.recorded.utc, point.segment};
    added.place.height_m = point.recorded.height_m.value_or(0.0);
    track.points.push_back(added);
  }
  track.note = NoteOf(counts);
  return track;
}

}  // namespace alpenglow::renderer
