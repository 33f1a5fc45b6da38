// SPDX-License-Identifier: MIT
#include "renderer/terrain/seen_chunks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace alpenglow::renderer {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double Along(const glm::dvec3& p) { return std::sqrt(p.x * p.x + p.y * p.y); }

// Returns the azimuth, clockwise from north, in units of 1/`bins` of the circle.
double BinOf(const glm::dvec3& p, int bins) { return std::atan2(p.x, p.y) / kTurn * bins; }

int Wrapped(int bin, int bins) { return ((bin % bins) + bins) % bins; }

// Lower bound for the tangent of the elevation of the segment between two vertices, and its
// farthest distance.
struct Piece {
  double tangent, farthest_m;
};

Piece LeastOf(const LandSkyline::Between& a, const LandSkyline::Between& b) {
  const double low = std::min({a.one.z, a.other.z, b.one.z, b.other.z});
  const std::array<double, 4> along{Along(a.one), Along(a.other), Along(b.one), Along(b.other)};
  const double far = *std::max_element(along.begin(), along.end());
  if (low >= 0.0) return {low / far, far};
  const double length = std::max({Along(a.one - b.one), Along(a.one - b.other),
                                  Along(a.other - b.one), Along(a.other - b.other)});
  const double near = far - length;
  return {near > 0.0 ? low / near : -1e30, far};
}

/// Returns an upper bound for the apparent rise [m], by rays of this curvature, of land at a
/// distance.
double MostRise(double bends_per_m, double distance_m) {
  return 0.5 * bends_per_m * distance_m * distance_m;
}

// Returns the distance of the farthest corner of a box from the eye.
double FarthestCorner(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& from) {
  return glm::length(glm::max(glm::abs(low - from), glm::abs(high - from)));
}

// The four side planes of the view frustum and a plane through the eye across the view direction.
// Inside is positive.
class ViewPyramid {
 public:
  ViewPyramid(const FrameTransform& eye, const LandView& view)
      : at_(eye.origin_m()), up_(eye.axes()[2]), bends_per_m_(view.bends_per_m) {
    const double wide = glm::length(view.axes.right), high = glm::length(view.axes.up);
    const glm::dvec3 forward = eye.Along(view.axes.forward);
    const glm::dvec3 right = eye.Along(view.axes.right) / wide, up = eye.Along(view.axes.up) / high;
    planes_ = {wide * forward + right, wide * forward - right, high * forward + up,
               high * forward - up, forward};
  }
  // Returns whether any point of a box may be inside, raised by refraction or not.
  [[nodiscard]] bool Touches(const glm::dvec3& low, const glm::dvec3& high) const {
    const double rise_m = MostRise(bends_per_m_, FarthestCorner(low, high, at_));
    return std::all_of(planes_.begin(), planes_.end(), [&](const glm::dvec3& plane) {
      const glm::dvec3 corner{plane.x > 0.0 ? high.x : low.x, plane.y > 0.0 ? high.y : low.y,
                              plane.z > 0.0 ? high.z : low.z};
      return glm::dot(plane, corner - at_) + rise_m * std::max(glm::dot(plane, up_), 0.0) > 0.0;
    });
  }

 private:
  glm::dvec3 at_, up_;
  double bends_per_m_;
  std::array<glm::dvec3, 5> planes_;
};

// Returns whether the chunk has all its triangles.
bool IsFull(const LandChunk& chunk) { return chunk.triangles.size() == kChunkIndices; }

// Adds lines of the surface along every eighth row and column of a chunk.
void AddCrests(LandSkyline& skyline, const LandChunk& chunk, const FrameTransform& eye) {
  constexpr int kStride = kChunkCells / 2;
  const auto between = [&](int i, int j) {
    const auto v = static_cast<std::size_t>(j * kChunkSide + i);
    const glm::dvec3 own(chunk.own[v].position_m);
    if (chunk.coarse.empty()) return LandSkyline::Between{eye.PointBack(own), eye.PointBack(own)};
    const auto [first, second] = chunk.ends[v];
    const glm::dvec3 coarse = 0.5 * (glm::dvec3(chunk.coarse[first].position_m) +
                                     glm::dvec3(chunk.coarse[second].position_m));
    return LandSkyline::Between{eye.PointBack(own), eye.PointBack(coarse)};
  };
  for (int line = 0; line <= kChunkCells; line += kStride) {
    std::array<LandSkyline::Between, kChunkSide> row, column;
    for (int k = 0; k < kChunkSide; ++k) {
      row[static_cast<std::size_t>(k)] = between(k, line);
      column[static_cast<std::size_t>(k)] = between(line, k);
    }
    skyline.Add(row);
    skyline.Add(column);
  }
}

// A part of a chunk, with the bounds that LandSkyline::Hides needs.
struct SeenPart {
  std::size_t chunk;  // index among the chunks in view
  glm::dvec3 middle;  // in the eye's frame
  double radius_m, highest_m, nearest_m;
};

// Returns the bounds of a part. Refraction raises the part but not the crests that may hide it,
// which is conservative.
SeenPart PartOf(const ChunkBox& box, std::size_t chunk, const FrameTransform& eye,
                double bends_per_m) {
  const glm::dvec3 low(box.low), high(box.high);
  const glm::dvec3 middle = eye.PointBack(0.5 * (low + high));
  const glm::dvec3 half = 0.5 * (high - low);
  // The box is tilted in the eye's frame, so its highest corner is used.
  const glm::dvec3 rise = glm::abs(eye.axes()[2]) * half;
  const double radius =
      std::hypot(half.x, half.y) + half.z * std::hypot(eye.axes()[2].x, eye.axes()[2].y);
  const double lifted_m = MostRise(bends_per_m, glm::length(middle) + radius);
  return {chunk, middle, radius, middle.z + rise.x + rise.y + rise.z + lifted_m,
          LandSkyline::NearestOf(middle, radius)};
}

// Returns for each chunk whether it has a part that nearer land does not hide.
std::vector<char> NotHidden(const std::vector<SeenChunk>& chunks, const FrameTransform& eye,
                            double bends_per_m) {
  std::vector<SeenPart> parts;
  for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk)
    for (const ChunkBox& box : chunks[chunk].chunk->parts)
      if (box.low.x <= box.high.x) parts.push_back(PartOf(box, chunk, eye, bends_per_m));
  std::sort(parts.begin(), parts.end(),
            [](const SeenPart& a, const SeenPart& b) { return a.nearest_m < b.nearest_m; });
  LandSkyline skyline;
  std::vector<char> is_seen(chunks.size(), 0);
  for (const SeenPart& part : parts) {
    if (is_seen[part.chunk] != 0) continue;
    if (skyline.Hides(part.middle, part.radius_m, part.highest_m)) continue;
    is_seen[part.chunk] = 1;
    if (IsFull(*chunks[part.chunk].chunk)) AddCrests(skyline, *chunks[part.chunk].chunk, eye);
  }
  return is_seen;
}

}  // namespace

// Collects the bins that a line covers completely, while its azimuth is monotonic.
class LandSkyline::CrestMaker {
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

void LandSkyline::Add(std::span<const Between> line) {
  CrestMaker maker;
  double from = BinOf(line.front().one, kBins);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double to = from + std::remainder(BinOf(line[i].one, kBins) - from, kBins);
    // A nearby segment that spans a wide azimuth hides nothing. The line continues after it.
    constexpr double kWidest = kBins / 8.0;
    Piece piece = LeastOf(line[i - 1], line[i]);
    if (std::abs(to - from) > kWidest) piece.tangent = -1e30;
    maker.Add(from, to, piece);
    from = to;
  }
  for (Crest& crest : maker.Finish()) waiting_.push(std::move(crest));
}

void LandSkyline::Raise(double up_to_m) {
  while (!waiting_.empty() && waiting_.top().farthest_m <= up_to_m) {
    for (const auto& [bin, tangent] : waiting_.top().steps) {
      double& highest = tangent_[static_cast<std::size_t>(Wrapped(bin, kBins))];
      highest = std::max(highest, tangent);
    }
    waiting_.pop();
  }
}

double LandSkyline::NearestOf(const glm::dvec3& point, double radius_m) {
  return Along(point) - radius_m;
}

bool LandSkyline::Hides(const glm::dvec3& point, double radius_m, double highest_m) {
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

std::vector<SeenChunk> InView(std::vector<SeenChunk> chunks, const FrameTransform& eye,
                              const LandView& view) {
  const ViewPyramid pyramid(eye, view);
  std::erase_if(chunks, [&](const SeenChunk& drawn) {
    return !pyramid.Touches(drawn.chunk->low, drawn.chunk->high);
  });
  return chunks;
}

std::vector<SeenChunk> WithoutHidden(const std::vector<SeenChunk>& chunks,
                                     const FrameTransform& eye, double bends_per_m) {
  const std::vector<char> is_seen = NotHidden(chunks, eye, bends_per_m);
  std::vector<SeenChunk> seen;
  for (std::size_t i = 0; i < chunks.size(); ++i)
    if (is_seen[i] != 0) seen.push_back(chunks[i]);
  return seen;
}

double FarthestOf(const std::vector<SeenChunk>& chunks, const FrameTransform& eye) {
  double farthest_m = 0.0;
  for (const SeenChunk& drawn : chunks)
    farthest_m =
        std::max(farthest_m, FarthestCorner(drawn.chunk->low, drawn.chunk->high, eye.origin_m()));
  return farthest_m;
}

}  // namespace alpenglow::renderer
