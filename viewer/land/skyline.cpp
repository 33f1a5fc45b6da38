// SPDX-License-Identifier: MIT
#include "viewer/land/skyline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alpenglow::viewer {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double Along(const glm::dvec3& p) { return std::hypot(p.x, p.y); }

// Clockwise from north, in parts of `bins` once around.
double BinOf(const glm::dvec3& p, int bins) { return std::atan2(p.x, p.y) / kTurn * bins; }

int Wrapped(int bin, int bins) { return ((bin % bins) + bins) % bins; }

// The least elevation's tangent of a piece between two vertices, and how far it reaches.
struct Piece {
  double tangent, farthest_m;
};

Piece LeastOf(const Skyline::Between& a, const Skyline::Between& b) {
  const double low = std::min({a.one.z, a.other.z, b.one.z, b.other.z});
  const std::array<double, 4> along{Along(a.one), Along(a.other), Along(b.one), Along(b.other)};
  const double far = *std::max_element(along.begin(), along.end());
  if (low >= 0.0) return {low / far, far};
  const double length = std::max({Along(a.one - b.one), Along(a.one - b.other),
                                  Along(a.other - b.one), Along(a.other - b.other)});
  const double near = far - length;
  return {near > 0.0 ? low / near : -1e30, far};
}

}  // namespace

// Bins that a line covers whole, while its azimuth runs one way.
class Skyline::CrestMaker {
 public:
  void Add(double from, double to, const Piece& piece) {
    const double low = std::min(from, to), high = std::max(from, to);
    const int sense = to > from ? 1 : -1;
    if (sense != sense_ || steps_.empty()) Begin(sense);
    farthest_m_ = std::max(farthest_m_, piece.farthest_m);
    const int first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::floor(high));
    for (int k = 0; k <= last - first; ++k) {
      const int bin = sense > 0 ? first + k : last - k;
      const double share = std::min(high, bin + 1.0) - std::max(low, static_cast<double>(bin));
      if (steps_.empty() || steps_.back().bin != bin) {
        steps_.push_back({bin, piece.tangent});
        shares_.push_back(share);
      } else {
        steps_.back().tangent = std::min(steps_.back().tangent, piece.tangent);
        shares_.back() += share;
      }
    }
  }
  std::vector<Crest> Finish() {
    Begin(0);
    return std::move(crests_);
  }

 private:
  void Begin(int sense) {
    Crest crest{farthest_m_, {}};
    constexpr double kWhole = 1.0 - 1e-9;
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (shares_[i] >= kWhole) crest.steps.push_back(steps_[i]);
    if (!crest.steps.empty()) crests_.push_back(std::move(crest));
    steps_.clear();
    shares_.clear();
    farthest_m_ = 0.0;
    sense_ = sense;
  }

  int sense_ = 0;
  double farthest_m_ = 0.0;
  std::vector<Step> steps_;
  std::vector<double> shares_;
  std::vector<Crest> crests_;
};

void Skyline::Add(std::span<const Between> line) {
  CrestMaker maker;
  double from = BinOf(line.front().one, kBins);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double to = from + std::remainder(BinOf(line[i].one, kBins) - from, kBins);
    // A piece close by that turns far hides nothing, and the line goes on behind it.
    constexpr double kWidest = kBins / 8.0;
    Piece piece = LeastOf(line[i - 1], line[i]);
    if (std::abs(to - from) > kWidest) piece.tangent = -1e30;
    maker.Add(from, to, piece);
    from = to;
  }
  for (Crest& crest : maker.Finish()) waiting_.push(std::move(crest));
}

void Skyline::Raise(double up_to_m) {
  while (!waiting_.empty() && waiting_.top().farthest_m <= up_to_m) {
    for (const auto& [bin, tangent] : waiting_.top().steps) {
      double& highest = tangent_[static_cast<std::size_t>(Wrapped(bin, kBins))];
      highest = std::max(highest, tangent);
    }
    waiting_.pop();
  }
}

double Skyline::NearestOf(const glm::dvec3& point, double radius_m) {
  return Along(point) - radius_m;
}

bool Skyline::Hides(const glm::dvec3& point, double radius_m, double highest_m) {
  const double distance = Along(point);
  if (distance < 2.0 * radius_m) return false;
  Raise(distance - radius_m);
  const double tangent = highest_m / (highest_m > 0.0 ? distance - radius_m : distance + radius_m);
  const double middle = BinOf(point, kBins);
  const double half = std::asin(radius_m / distance) / kTurn * kBins;
  const int first = static_cast<int>(std::floor(middle - half));
  const int last = static_cast<int>(std::floor(middle + half));
  constexpr double kRounding = 1e-6;
  for (int bin = first; bin <= last; ++bin)
    if (tangent_[static_cast<std::size_t>(Wrapped(bin, kBins))] <= tangent + kRounding)
      return false;
  return true;
}

}  // namespace alpenglow::viewer
