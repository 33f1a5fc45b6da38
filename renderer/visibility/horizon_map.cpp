// SPDX-License-Identifier: MIT
#include "renderer/visibility/horizon_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr float kSteps = 65535.0F;
constexpr float kRange = 1.0F - HorizonMap::kLowest;

std::uint16_t Packed(double sine) {
  const double share =
      (sine - static_cast<double>(HorizonMap::kLowest)) / static_cast<double>(kRange);
  return static_cast<std::uint16_t>(
      std::lround(std::clamp(share, 0.0, 1.0) * static_cast<double>(kSteps)));
}

/// The upper convex hull of a line as seen from its end, nearest point last.
class Hull {
 public:
  void Clear() { points_.clear(); }

  /// Adds a point in front of all others. Returns the tangent of the horizon's elevation from it;
  /// kNone without other points. Distances decrease from point to point.
  [[nodiscard]] double TangentFrom(double distance, double height) {
    const Point here{distance, height};
    while (points_.size() >= 2 && !StandsOver(points_.back(), points_[points_.size() - 2], here))
      points_.pop_back();
    const double tangent =
        points_.empty() ? kNone
                        : (points_.back().height - height) / (points_.back().distance - distance);
    points_.push_back(here);
    return tangent;
  }

  static constexpr double kNone = -1e9;

 private:
  struct Point {
    double distance, height;
  };
  // Returns whether p appears higher than q from `eye`.
  static bool StandsOver(const Point& p, const Point& q, const Point& eye) {
    return (p.height - eye.height) * (q.distance - eye.distance) >
           (q.height - eye.height) * (p.distance - eye.distance);
  }
  std::vector<Point> points_;
};

/// A sweep over a grid along one direction: `along` counts steps of the axis nearest to the
/// direction; lines are adjacent across it and shift by `shift` with every step.
class Sweep {
 public:
  Sweep(const HeightRaster& heights, double planet_radius_m, double azimuth)
      : heights_(heights),
        radius_m_(planet_radius_m),
        x_(std::cos(azimuth)),
        y_(std::sin(azimuth)),
        along_x_(std::abs(x_) >= std::abs(y_)),
        steps_(along_x_ ? heights.columns : heights.rows),
        width_(along_x_ ? heights.rows : heights.columns),
        forwards_((along_x_ ? x_ : y_) > 0.0),
        shift_(along_x_ ? y_ / x_ : x_ / y_),
        step_m_(heights.cell_m * std::sqrt(1.0 + shift_ * shift_)) {
    // Line j is at `across` = j + shift along; all nodes lie between lines.
    const double last = shift_ * (steps_ - 1);
    first_line_ = static_cast<int>(std::floor(std::min(0.0, -last)));
    const int last_line = static_cast<int>(std::ceil(std::max(0.0, -last))) + width_ - 1;
    lines_ = last_line - first_line_ + 2;
    tangent_.assign(static_cast<std::size_t>(lines_) * static_cast<std::size_t>(steps_),
                    static_cast<float>(Hull::kNone));
    Hull hull;
    for (int line = 0; line < lines_; ++line) WalkLine(line, hull);
  }

  /// Returns the sine of the horizon's elevation at a node.
  [[nodiscard]] double SineAt(int column, int row) const {
    const int along = along_x_ ? column : row;
    const double across = (along_x_ ? row : column) - shift_ * along - first_line_;
    const int line = std::clamp(static_cast<int>(across), 0, lines_ - 2);
    const double share = across - line;
    const double low = Tangent(line, along), high = Tangent(line + 1, along);
    // A line beyond the rim has no horizon: the other line is used for both.
    const double tangent = low <= Hull::kNone    ? high
                           : high <= Hull::kNone ? low
                                                 : low + share * (high - low);
    if (tangent <= Hull::kNone) return -1.0;
    const auto [x, y] = heights_.Place(column, row);
    const double tilt = (x * x_ + y * y_) / radius_m_;  // tilt of the local vertical against the
                                                        // frame's z
    const double local = tangent + tilt * (1.0 + tangent * tangent);
    return local / std::sqrt(1.0 + local * local);
  }

 private:
  [[nodiscard]] double Tangent(int line, int along) const {
    return static_cast<double>(
        tangent_[static_cast<std::size_t>(line) * static_cast<std::size_t>(steps_) +
                 static_cast<std::size_t>(along)]);
  }

  void WalkLine(int line, Hull& hull) {
    hull.Clear();
    for (int step = 0; step < steps_; ++step) {
      const int along = forwards_ ? steps_ - 1 - step : step;
      const double across = line + first_line_ + shift_ * along;
      const int node = static_cast<int>(std::floor(across));
      if (node < 0 || node + 1 >= width_ + (across == node ? 1 : 0)) continue;
      const double share = across - node;
      const double low = static_cast<double>(Height(along, node));
      const double high = share > 0.0 ? static_cast<double>(Height(along, node + 1)) : low;
      if (std::min(low, high) <= static_cast<double>(HeightRaster::kNothing)) continue;
      const double height = low + share * (high - low);
      // Distances decrease towards the end of the sweep.
      const double distance = -step * step_m_;
      tangent_[static_cast<std::size_t>(line) * static_cast<std::size_t>(steps_) +
               static_cast<std::size_t>(along)] =
          static_cast<float>(hull.TangentFrom(distance, height));
    }
  }

  [[nodiscard]] float Height(int along, int across) const {
    return along_x_ ? heights_.at(along, across) : heights_.at(across, along);
  }

  const HeightRaster& heights_;
  double radius_m_, x_, y_;
  bool along_x_;
  int steps_, width_;
  bool forwards_;
  double shift_, step_m_;
  int first_line_ = 0, lines_ = 0;
  std::vector<float> tangent_;  // line by line
};

}  // namespace

double HorizonAzimuth(std::size_t i) {
  return 2.0 * kPi * static_cast<double>(i) / static_cast<double>(kHorizonAzimuths);
}

BetweenAzimuths::BetweenAzimuths(double azimuth_rad) {
  const double turn = azimuth_rad / (2.0 * kPi);
  const double at = (turn - std::floor(turn)) * static_cast<double>(kHorizonAzimuths);
  along = at - std::floor(at);
  before = static_cast<std::size_t>(at) % kHorizonAzimuths;
  after = (before + 1) % kHorizonAzimuths;
}

HorizonMap::HorizonMap(const HeightRaster& heights, double planet_radius_m)
    : grid_{heights.first_x_m, heights.first_y_m, heights.cell_m,
            heights.columns,   heights.rows,      {}},
      sine_(heights.z_m.size() * kHorizonAzimuths) {
  tbb::parallel_for(std::size_t{0}, kHorizonAzimuths, [&](std::size_t azimuth) {
    const Sweep sweep(heights, planet_radius_m, HorizonAzimuth(azimuth));
    for (int row = 0; row < grid_.rows; ++row) {
      for (int column = 0; column < grid_.columns; ++column) {
        sine_[grid_.index(column, row) * kHorizonAzimuths + azimuth] =
            Packed(sweep.SineAt(column, row));
      }
    }
  });
}

HeightRaster HorizonMap::Towards(double azimuth_rad) const {
  const BetweenAzimuths azimuths(azimuth_rad);
  const auto along = static_cast<float>(azimuths.along);
  HeightRaster sines = grid_;
  sines.z_m.resize(sine_.size() / kHorizonAzimuths);
  for (std::size_t node = 0; node < sines.z_m.size(); ++node) {
    const std::uint16_t* of_node = &sine_[node * kHorizonAzimuths];
    const auto before = static_cast<float>(of_node[azimuths.before]);
    const auto after = static_cast<float>(of_node[azimuths.after]);
    sines.z_m[node] = kLowest + kRange / kSteps * (before + along * (after - before));
  }
  return sines;
}

Horizons HorizonMap::At(const glm::dvec3& point) const {
  const GridCell cell = CellAt(grid_, point.x, point.y);
  const std::array<float, 4> weight{(1.0F - cell.x) * (1.0F - cell.y), cell.x * (1.0F - cell.y),
                                    (1.0F - cell.x) * cell.y, cell.x * cell.y};
  const std::uint16_t* low = &sine_[grid_.index(cell.column, cell.row) * kHorizonAzimuths];
  const std::uint16_t* high = low + static_cast<std::size_t>(grid_.columns) * kHorizonAzimuths;
  Horizons horizons;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const float sum = weight[0] * static_cast<float>(low[i]) +
                      weight[1] * static_cast<float>(low[i + kHorizonAzimuths]) +
                      weight[2] * static_cast<float>(high[i]) +
                      weight[3] * static_cast<float>(high[i + kHorizonAzimuths]);
    horizons[i] = kLowest + kRange / kSteps * sum;
  }
  return horizons;
}

}  // namespace alpenglow::renderer
