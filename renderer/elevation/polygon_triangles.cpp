// SPDX-License-Identifier: MIT
#include "renderer/elevation/polygon_triangles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <tuple>
#include <utility>

namespace alpenglow::renderer {
namespace {

/// Returns the exact sign of a b - c d. Rounding preserves the order of the products; if they are
/// rounded to one number, their exact errors decide.
int SignOfDifference(double a, double b, double c, double d) {
  const double first = a * b, second = c * d;
  if (first != second) return first > second ? 1 : -1;
  const double first_error = std::fma(a, b, -first), second_error = std::fma(c, d, -second);
  return int{first_error > second_error} - int{first_error < second_error};
}

/// Returns 1 if a, b, c turn left, -1 if they turn right, 0 if they lie on a line.
int Turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return SignOfDifference(b.x - a.x, c.y - a.y, b.y - a.y, c.x - a.x);
}

bool Cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  return Turn(a, b, c) * Turn(a, b, d) < 0 && Turn(c, d, a) * Turn(c, d, b) < 0;
}

/// Returns Newell's normal: twice the area of the polygon seen along each axis. If the parts of a
/// figure of eight cancel, its largest part is used instead.
glm::dvec3 NormalOf(const std::vector<glm::dvec3>& corners) {
  constexpr double kCancelled = 1e-9;
  glm::dvec3 sum(0.0), largest(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::dvec3 part = glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    sum += part;
    if (glm::dot(part, part) > glm::dot(largest, largest)) largest = part;
  }
  return glm::length(sum) > kCancelled * glm::length(largest) ? sum : largest;
}

/// Returns the polygon projected along the axis nearest to its normal, seen from the side on which
/// it is wound counter-clockwise.
std::vector<glm::dvec2> Flattened(const std::vector<glm::dvec3>& corners) {
  const glm::dvec3 normal = NormalOf(corners);
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.z >= std::max(size.x, size.y) ? 2 : size.y >= size.x ? 1 : 0;
  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (const glm::dvec3& corner : corners) {
    const glm::dvec2 seen(corner[(axis + 1) % 3], corner[(axis + 2) % 3]);
    flat.push_back(normal[axis] < 0.0 ? glm::dvec2(seen.y, seen.x) : seen);
  }
  return flat;
}

struct FlatBox {
  glm::dvec2 low, high;

  [[nodiscard]] bool Holds(const glm::dvec2& point) const {
    return point.x >= low.x && point.x <= high.x && point.y >= low.y && point.y <= high.y;
  }
  [[nodiscard]] bool Meets(const FlatBox& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
           other.low.y <= high.y;
  }
};

FlatBox BoxOf(const glm::dvec2& a, const glm::dvec2& b) { return {glm::min(a, b), glm::max(a, b)}; }

bool CrossesItself(const std::vector<glm::dvec2>& at) {
  const std::size_t count = at.size();
  for (std::size_t i = 0; i + 2 < count; ++i) {
    const FlatBox box = BoxOf(at[i], at[i + 1]);
    for (std::size_t k = i + 2; k < count; ++k) {
      const glm::dvec2& end = at[k + 1 < count ? k + 1 : 0];
      if (box.Meets(BoxOf(at[k], end)) && Cross(at[i], at[i + 1], at[k], end)) return true;
    }
  }
  return false;
}

/// A ring of corners from which triangles are cut off. A corner whose triangle contains another
/// corner is evaluated again only when that corner is removed, starting at that place in the ring.
/// Each triangle is therefore tested against each corner once, and the time is quadratic in the
/// number of corners.
class EarCutter {
 public:
  EarCutter(const std::vector<glm::dvec3>& corners, const std::vector<glm::dvec2>& flat)
      : corners_(corners), flat_(flat) {
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      if (!ring_.empty() && corners[ring_.back()] == corners[i]) continue;
      ring_.push_back(i);
    }
    while (ring_.size() > 1 && corners[ring_.front()] == corners[ring_.back()]) ring_.pop_back();
  }

  PolygonTriangles Cut() {
    ears_.resize(ring_.size());
    if (ring_.size() < 3) return {};
    for (std::size_t i = 0; i < ring_.size(); ++i) ears_[i] = EarAt(i);
    while (ring_.size() >= 3) CutOff(BestEar());
    return std::move(cut_);
  }

 private:
  /// Order in which corners are cut off, the best first.
  enum class Rank {
    kGood,      // the triangle contains nothing else
    kThin,      // as before, but its area may be due to rounding
    kFlat,      // the corner lies on a line with its neighbours
    kTouching,  // other corners lie on the triangle's edges
    kCovering,  // other parts of the polygon lie in the triangle
    kReflex,
  };
  struct Ear {
    Rank rank;
    double base2_m2;                // square of the edge that cutting makes
    Rank otherwise = Rank::kGood;   // rank by the corners before `covered`
    std::uint32_t covered = kNone;  // the first corner in the triangle

    bool operator<(const Ear& other) const {
      return std::tie(rank, base2_m2) < std::tie(other.rank, other.base2_m2);
    }
  };
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  using Places = std::array<std::size_t, 3>;  // of the corners of a triangle in the ring

  [[nodiscard]] std::size_t Before(std::size_t i) const { return (i ? i : ring_.size()) - 1; }
  [[nodiscard]] std::size_t After(std::size_t i) const { return i + 1 < ring_.size() ? i + 1 : 0; }
  [[nodiscard]] const glm::dvec2& At(std::size_t i) const { return flat_[ring_[i]]; }

  [[nodiscard]] std::size_t BestEar() const {
    return static_cast<std::size_t>(std::min_element(ears_.begin(), ears_.end()) - ears_.begin());
  }

  [[nodiscard]] Ear EarAt(std::size_t i) const {
    const glm::dvec2 &a = At(Before(i)), &b = At(i), &c = At(After(i));
    const glm::dvec3 base = corners_[ring_[After(i)]] - corners_[ring_[Before(i)]];
    const Ear ear{Rank::kGood, glm::dot(base, base)};
    const int turn = Turn(a, b, c);
    if (turn < 0) return {Rank::kReflex, ear.base2_m2};
    if (turn == 0) return {Rank::kFlat, ear.base2_m2};
    return Evaluated(i, {ear.rank, ear.base2_m2, IsThin(a, b, c) ? Rank::kThin : Rank::kGood}, 0);
  }

  /// Returns the ear after tests against the corners of the ring from `from` on.
  [[nodiscard]] Ear Evaluated(std::size_t i, Ear ear, std::size_t from) const {
    const Places triangle{Before(i), i, After(i)};
    const auto [a, b, c] = triangle;
    const FlatBox base = BoxOf(At(a), At(c));
    const FlatBox box{glm::min(base.low, At(b)), glm::max(base.high, At(b))};
    for (std::size_t other = from; other < ring_.size(); ++other) {
      if (!box.Holds(At(other)) || other == a || other == b || other == c) continue;
      const Rank beside = RankBeside(triangle, other);
      if (beside == Rank::kCovering) {
        return {Rank::kCovering, ear.base2_m2, ear.otherwise, ring_[other]};
      }
      ear.otherwise = std::max(ear.otherwise, beside);
    }
    return {ear.otherwise, ear.base2_m2, ear.otherwise};
  }

  [[nodiscard]] static bool IsThin(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    constexpr double kThinnest = 1e-6;  // above the rounding error of corners on a line
    const glm::dvec2 u = b - a, v = c - a;
    return u.x * v.y - u.y * v.x <= kThinnest * (glm::dot(u, u) + glm::dot(v, v));
  }

  /// Returns the best rank that another corner allows for a triangle: kGood if it is outside.
  [[nodiscard]] Rank RankBeside(const Places& triangle, std::size_t other) const {
    int least = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec2& from = At(triangle[k]);
      const glm::dvec2& to = At(triangle[(k + 1) % 3]);
      if (At(other) == from) return RankOfTwin(triangle, k, other);
      least = std::min(least, Turn(from, to, At(other)));
    }
    if (least < 0) return Rank::kGood;
    return least > 0 ? Rank::kCovering : Rank::kTouching;
  }

  /// Returns the rank for a corner that coincides with a corner of the triangle. It obstructs the
  /// triangle if an edge from it leads into the triangle. An edge along an edge of the triangle
  /// belongs to a slit and does not obstruct.
  [[nodiscard]] Rank RankOfTwin(const Places& triangle, std::size_t k, std::size_t twin) const {
    const glm::dvec2& here = At(triangle[k]);
    const glm::dvec2& next = At(triangle[(k + 1) % 3]);
    const glm::dvec2& last = At(triangle[(k + 2) % 3]);
    for (const std::size_t end : {Before(twin), After(twin)}) {
      if (Turn(here, next, At(end)) > 0 && Turn(last, here, At(end)) > 0) return Rank::kCovering;
    }
    return Rank::kGood;
  }

  void CutOff(std::size_t i) {
    const std::size_t a = Before(i), c = After(i);
    const std::array<std::uint32_t, 3> triangle{ring_[a], ring_[i], ring_[c]};
    if (!IsWithoutArea(corners_[triangle[0]], corners_[triangle[1]], corners_[triangle[2]]))
      cut_.triangles.push_back(triangle);
    // A triangle of reversed winding that is larger than rounding errors is a loop of the polygon.
    if (ears_[i].rank == Rank::kReflex && !IsThin(At(c), At(i), At(a))) cut_.crosses_itself = true;
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(i));
    ears_.erase(ears_.begin() + static_cast<std::ptrdiff_t>(i));
    if (ring_.size() < 3) return;
    const std::size_t after = i < ring_.size() ? i : 0;
    ears_[after] = EarAt(after);
    ears_[Before(after)] = EarAt(Before(after));
    Uncover(triangle[1], i);
  }

  /// @param gone  the corner that was at `place` in the ring.
  void Uncover(std::uint32_t gone, std::size_t place) {
    for (std::size_t i = 0; i < ears_.size(); ++i)
      if (ears_[i].covered == gone) ears_[i] = Evaluated(i, ears_[i], place);
  }

  const std::vector<glm::dvec3>& corners_;
  const std::vector<glm::dvec2>& flat_;
  std::vector<std::uint32_t> ring_;  // remaining corners, in order
  std::vector<Ear> ears_;            // one per corner of the ring
  PolygonTriangles cut_;
};

}  // namespace

PolygonTriangles TrianglesOfPolygon(const std::vector<glm::dvec3>& corners) {
  if (corners.size() == 3) {
    if (IsWithoutArea(corners[0], corners[1], corners[2])) return {};
    return {{{0, 1, 2}}};
  }
  const std::vector<glm::dvec2> flat = Flattened(corners);
  PolygonTriangles cut = EarCutter(corners, flat).Cut();
  cut.crosses_itself = cut.crosses_itself || CrossesItself(flat);
  return cut;
}

bool IsWithoutArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  constexpr double kLeast = 1e-9;
  const glm::dvec3 u = b - a, v = c - a;
  return !(glm::length(glm::cross(u, v)) > kLeast * (glm::dot(u, u) + glm::dot(v, v)));
}

}  // namespace alpenglow::renderer
