// SPDX-License-Identifier: MIT
#include "renderer/media/glow_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr int kMostParts = 8;         // along a side
constexpr int kGlowRays = 18;         // along a side of the raster of a direction
constexpr int kGlowSteps = 32;        // over the diagonal of the box
constexpr double kLargestPart = 0.1;  // radius of a part, relative to its distance
constexpr double kLowPart = 0.02;     // the same, for parts that reach below the surface
constexpr double kBelow = 0.05;       // fraction of a part that may lie below it
constexpr double kOpaqueDepth = 20.0;

/// Returns the number of a part in a grid.
std::size_t PartNumber(const std::array<int, 3>& count, const std::array<int, 3>& part) {
  return static_cast<std::size_t>((part[2] * count[1] + part[1]) * count[0] + part[0]);
}

/// Folds the lower half of the octahedron over the corners of the square, or back.
glm::dvec2 Folded(const glm::dvec2& at) {
  return {std::copysign(1.0 - std::abs(at.y), at.x), std::copysign(1.0 - std::abs(at.x), at.y)};
}

/// Returns the place of a direction on the octahedral map, in [0, turns]^2. The third component is up.
glm::dvec2 OctahedralPlace(const glm::dvec3& direction, int turns) {
  const double sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  glm::dvec2 at(direction.x / sum, direction.y / sum);
  if (direction.z < 0.0) at = Folded(at);
  return 0.5 * turns * (at + 1.0);
}

/// A node of the octahedral map and its weight.
struct MapWeight {
  int x, y;
  double weight;

  [[nodiscard]] std::size_t Number(int turns) const {
    return static_cast<std::size_t>(y * (turns + 1) + x);
  }
};

/// Returns the weight of a node in means over directions: the edge of the square has each direction
/// twice, and its corners are one direction.
double MapShare(std::size_t node, int turns) {
  const auto side = static_cast<std::size_t>(turns + 1);
  double share = 1.0;
  for (const std::size_t at : {node % side, node / side}) {
    if (at == 0 || at + 1 == side) share *= 0.5;
  }
  return share;
}

/// Returns the numbers of the smallest parts across, ahead and up.
std::array<int, 3> FinestCount(const glm::dvec3& size_m) {
  const double longest_m = std::max({size_m.x, size_m.y, size_m.z});
  std::array<int, 3> counts{1, 1, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    int& count = counts[axis];
    const double side_m = size_m[static_cast<glm::length_t>(axis)];
    while (count < kMostParts && 1.5 * count * longest_m < kMostParts * side_m) count *= 2;
  }
  return counts;
}

/// Returns the nodes of the triangle around a place. Triangles end at the edges of the octahedron, where
/// the intensity of boxes has creases.
std::array<MapWeight, 3> MapWeightsAt(const glm::dvec2& at, int turns) {
  const int x = std::clamp(static_cast<int>(at.x), 0, turns - 1);
  const int y = std::clamp(static_cast<int>(at.y), 0, turns - 1);
  double p = at.x - x, q = at.y - y;
  // Where both coordinates have the same sign the fold falls from left to right, else it rises.
  const bool falls = (2 * x < turns) == (2 * y < turns);
  const int left = falls ? x : x + 1, right = falls ? x + 1 : x;
  if (!falls) p = 1.0 - p;
  if (p + q <= 1.0) return {{{left, y, 1.0 - p - q}, {right, y, p}, {left, y + 1, q}}};
  return {{{right, y + 1, p + q - 1.0}, {left, y + 1, 1.0 - p}, {right, y, 1.0 - q}}};
}

}  // namespace

struct GlowField::View {
  const glm::dvec3& point;
  const glm::dvec3& normal;
  const std::function<bool(const glm::dvec3& place)>& sees;
};

GlowField::GlowField(const LocalBody& body,
                     const std::function<SourceAt(const glm::dvec3& travel)>& towards)
    : body_(body), bands_(body.optics().extinction_per_m.size()) {
  levels_.push_back(LevelOf(FinestCount(body.placement().size_m)));
  Gather(towards);
  FindMiddles(levels_.front());
  while (levels_.front().middle.size() > 1)
    levels_.insert(levels_.begin(), Merged(levels_.front()));
}

glm::dvec3 GlowField::DirectionOf(std::size_t node) const {
  const glm::dvec2 at = 2.0 / kTurns * glm::dvec2(node % (kTurns + 1), node / (kTurns + 1)) - 1.0;
  const double up = 1.0 - std::abs(at.x) - std::abs(at.y);
  const glm::dvec2 level = up < 0.0 ? Folded(at) : at;
  const VolumePlacement& place = body_.placement();
  return glm::normalize(level.x * place.across + level.y * place.ahead + up * place.up);
}

GlowField::Level GlowField::LevelOf(const std::array<int, 3>& count) const {
  Level level;
  level.count = count;
  const glm::dvec3 part_m = body_.placement().size_m / glm::dvec3(count[0], count[1], count[2]);
  level.radius_m = 0.5 * glm::length(part_m);
  level.least_m = std::cbrt(0.75 / kPi * part_m.x * part_m.y * part_m.z);
  const auto parts = static_cast<std::size_t>(count[0] * count[1] * count[2]);
  level.intensity.resize(parts * kDirections * bands_);
  level.places.resize(parts * kDirections, glm::vec4(0.0F));
  level.middle.resize(parts);
  level.shines.resize(parts);
  return level;
}

void GlowField::Gather(const std::function<SourceAt(const glm::dvec3& travel)>& towards) {
  tbb::parallel_for(std::size_t{0}, kDirections,
                    [&](std::size_t node) { GatherAlong(node, towards(DirectionOf(node))); });
}

void GlowField::GatherAlong(std::size_t node, const SourceAt& source) {
  const glm::dvec3 travel = DirectionOf(node);
  const VolumePlacement& box = body_.placement();
  const glm::dvec3 side =
      glm::normalize(glm::cross(travel, box.across + 0.6 * box.ahead + 0.3 * box.up));
  const glm::dvec3 other = glm::cross(travel, side);
  const auto half_m = [&](const glm::dvec3& axis) {
    const glm::dvec3 along(glm::dot(axis, box.across), glm::dot(axis, box.ahead),
                           glm::dot(axis, box.up));
    return 0.5 * glm::dot(glm::abs(along), box.size_m);
  };
  const double half_side_m = half_m(side), half_other_m = half_m(other);
  const glm::dvec3 start = body_.Middle() + glm::length(box.size_m) * travel;
  for (int ray = 0; ray < kGlowRays * kGlowRays; ++ray) {
    const double u = 2.0 * (ray % kGlowRays + 0.5) / kGlowRays - 1.0;
    const double v = 2.0 * (ray / kGlowRays + 0.5) / kGlowRays - 1.0;
    GatherOnRay(start + u * half_side_m * side + v * half_other_m * other, node,
                4.0 * half_side_m * half_other_m / (kGlowRays * kGlowRays), source);
  }
}

std::size_t GlowField::PartAt(const glm::dvec3& point) const {
  const std::array<int, 3>& count = levels_.front().count;
  const glm::dvec3 unit = body_.UnitFromFrame(point);
  std::array<int, 3> part{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    part[axis] = std::clamp(static_cast<int>(unit[static_cast<glm::length_t>(axis)] * count[axis]),
                            0, count[axis] - 1);
  return PartNumber(count, part);
}

// The ray begins where the light leaves the body and runs against it.
void GlowField::GatherOnRay(const glm::dvec3& origin, std::size_t node, double area_m2,
                            const SourceAt& source) {
  const glm::dvec3 travel = DirectionOf(node);
  const double diagonal_m = glm::length(body_.placement().size_m);
  Level& level = levels_.front();
  SpectrumOf<double> passed(bands_);
  const auto is_opaque = [](double depth) { return depth > kOpaqueDepth; };
  for (const DensePiece& piece : body_.PiecesAlong(origin, -travel, 2.0 * diagonal_m)) {
    const double length_m = piece.end_m - piece.begin_m;
    const int steps = static_cast<int>(std::ceil(length_m / diagonal_m * kGlowSteps));
    for (int step = 0; step < steps; ++step) {
      const glm::dvec3 point = origin - (piece.begin_m + length_m * (step + 0.5) / steps) * travel;
      const double column_m = body_.DensityAt(point) * length_m / steps;
      if (column_m == 0.0) continue;
      const std::size_t slot = PartAt(point) * kDirections + node;
      const Source here = source(point);
      double all = 0.0;
      for (std::size_t band = 0; band < bands_; ++band) {
        const double depth = column_m * here.extinction_per_m[band];
        const double mean = depth > 1e-6 ? -std::expm1(-depth) / depth : 1.0;
        const double sent = area_m2 * column_m * static_cast<double>(here.light_per_m[band]) *
                            mean * std::exp(-passed[band]);
        passed[band] += depth;
        level.intensity[slot * bands_ + band] += static_cast<float>(sent);
        all += sent;
      }
      level.places[slot] += glm::vec4(all * glm::dvec4(point - body_.Middle(), 1.0));
    }
    if (std::ranges::all_of(passed.values(), is_opaque)) return;
  }
}

void GlowField::FindMiddles(Level& level) const {
  for (std::size_t part = 0; part < level.middle.size(); ++part) {
    glm::dvec4 sum(0.0);
    for (std::size_t node = 0; node < kDirections; ++node)
      sum += MapShare(node, kTurns) * glm::dvec4(level.places[part * kDirections + node]);
    level.shines[part] = sum.w > 0.0;
    if (sum.w > 0.0) level.middle[part] = body_.Middle() + glm::dvec3(sum) / sum.w;
  }
}

GlowField::Level GlowField::Merged(const Level& fine) const {
  std::array<int, 3> count = fine.count;
  for (int& side : count) side = std::max(side / 2, 1);
  Level coarse = LevelOf(count);
  for (std::size_t from = 0; from < fine.middle.size(); ++from) {
    if (!fine.shines[from]) continue;
    const int number = static_cast<int>(from);
    std::array<int, 3> part{number % fine.count[0], number / fine.count[0] % fine.count[1],
                            number / (fine.count[0] * fine.count[1])};
    for (std::size_t axis = 0; axis < 3; ++axis)
      part[axis] = part[axis] * count[axis] / fine.count[axis];
    const std::size_t to = PartNumber(count, part);
    for (std::size_t node = 0; node < kDirections; ++node)
      coarse.places[to * kDirections + node] += fine.places[from * kDirections + node];
    for (std::size_t i = 0; i < kDirections * bands_; ++i)
      coarse.intensity[to * kDirections * bands_ + i] +=
          fine.intensity[from * kDirections * bands_ + i];
  }
  FindMiddles(coarse);
  return coarse;
}

void GlowField::AddLight(const Level& level, std::size_t part, const View& view,
                         Spectrum& sum) const {
  // The light of opaque balls comes from their middles, and that of opaque faces from the mean place
  // of the light in its direction, which follows from the place. Half way between them the error is
  // smallest.
  constexpr int kRounds = 2;
  const VolumePlacement& box = body_.placement();
  glm::dvec3 way = level.middle[part] - view.point;
  std::array<MapWeight, 3> nodes{};
  for (int round = 0; round < kRounds; ++round) {
    const glm::dvec3 travel = -way / std::max(glm::length(way), 1e-9);
    nodes = MapWeightsAt(OctahedralPlace({glm::dot(travel, box.across), glm::dot(travel, box.ahead),
                                          glm::dot(travel, box.up)},
                                         kTurns),
                         kTurns);
    glm::dvec4 place(0.0);
    for (const MapWeight& node : nodes)
      place += node.weight * glm::dvec4(level.places[part * kDirections + node.Number(kTurns)]);
    if (place.w <= 0.0) return;
    const glm::dvec3 in_direction = body_.Middle() + glm::dvec3(place) / place.w;
    way = 0.5 * (level.middle[part] + in_direction) - view.point;
  }
  const double distance_m = std::max(glm::length(way), level.least_m);
  const double factor =
      std::max(glm::dot(way, view.normal), 0.0) / (distance_m * distance_m * distance_m);
  for (const MapWeight& node : nodes) {
    const float* values =
        level.intensity.data() + (part * kDirections + node.Number(kTurns)) * bands_;
    const auto share = static_cast<float>(factor * node.weight);
    for (std::size_t band = 0; band < bands_; ++band) sum[band] += share * values[band];
  }
}

std::pair<double, double> GlowField::HeightsOf(const Level& level, const std::array<int, 3>& part,
                                               const View& view) const {
  const VolumePlacement& box = body_.placement();
  const glm::dvec3 count(level.count[0], level.count[1], level.count[2]);
  const glm::dvec3 middle =
      body_.FrameFromUnit((glm::dvec3(part[0], part[1], part[2]) + 0.5) / count);
  const glm::dvec3 along(glm::dot(view.normal, box.across), glm::dot(view.normal, box.ahead),
                         glm::dot(view.normal, box.up));
  const double half_m = 0.5 * glm::dot(glm::abs(along), box.size_m / count);
  const double middle_m = glm::dot(middle - view.point, view.normal);
  return {middle_m - half_m, middle_m + half_m};
}

void GlowField::AddPart(std::size_t level_number, const std::array<int, 3>& part, const View& view,
                        bool is_tested, Spectrum& sum) const {
  const Level& level = levels_[level_number];
  const std::size_t number = PartNumber(level.count, part);
  if (!level.shines[number]) return;
  const bool is_finest = level_number + 1 == levels_.size();
  const double distance_m = glm::length(level.middle[number] - view.point);
  const auto [low_m, high_m] = HeightsOf(level, part, view);
  if (high_m <= 0.0) return;
  // A part that reaches below the surface is divided, too, unless it is low over the horizon.
  const bool is_whole =
      low_m > -kBelow * (high_m - low_m) || level.radius_m < kLowPart * distance_m;
  const bool is_small = level.radius_m < kLargestPart * distance_m && is_whole;
  constexpr std::size_t kTestedLevel = 1;
  if (!is_tested && (is_small || is_finest || level_number == kTestedLevel)) {
    if (!view.sees(level.middle[number])) return;
    is_tested = true;
  }
  if (is_small || is_finest) {
    AddLight(level, number, view, sum);
    return;
  }
  const Level& fine = levels_[level_number + 1];
  std::array<int, 3> times{};
  for (std::size_t axis = 0; axis < 3; ++axis) times[axis] = fine.count[axis] / level.count[axis];
  for (int child = 0; child < times[0] * times[1] * times[2]; ++child) {
    AddPart(
        level_number + 1,
        {part[0] * times[0] + child % times[0], part[1] * times[1] + child / times[0] % times[1],
         part[2] * times[2] + child / (times[0] * times[1])},
        view, is_tested, sum);
  }
}

Spectrum GlowField::On(const glm::dvec3& point, const glm::dvec3& normal,
                       const std::function<bool(const glm::dvec3& place)>& sees) const {
  Spectrum sum(bands_);
  AddPart(0, {0, 0, 0}, {point, normal, sees}, false, sum);
  return sum;
}

}  // namespace alpenglow::renderer
