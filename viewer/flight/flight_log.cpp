// SPDX-License-Identifier: MIT
#include "viewer/flight/flight_log.h"

#include "atmosphere/text/error.h"

namespace alpenglow::viewer {
namespace {

std::vector<CameraPathPoint> EverySecond(const std::vector<CameraPathPoint>& points) {
  std::vector<CameraPathPoint> kept;
  for (std::size_t i = 0; i < points.size(); i += 2) kept.push_back(points[i]);
  return kept;
}

}  // namespace

void FlightLog::Note(double elapsed_s, const Eye& eye, const UtcInstant& now) {
  last_ = CameraPathPoint{elapsed_s, PoseOf(eye), now};
  has_flown_ = has_flown_ || (!points_.empty() && !(EyeOf(points_.front().pose) == eye));
  if (!points_.empty() && !IsDue(elapsed_s, points_.back().time_s, interval_s_)) return;
  points_.push_back(*last_);
  if (points_.size() < most_) return;
  points_ = EverySecond(points_);
  interval_s_ *= 2.0;
}

CameraPath FlightLog::Path() const {
  if (!has_flown_) throw InputError("nothing has been flown yet");
  std::vector<CameraPathPoint> points = points_;
  if (last_->time_s > points.back().time_s) points.push_back(*last_);
  const double begin_s = points.front().time_s;
  for (CameraPathPoint& point : points) point.time_s -= begin_s;
  return CameraPath(std::move(points));
}

}  // namespace alpenglow::viewer
