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

constexpr int kMostParts = 8;          // along a side
constexpr int kGlowRays = 24;          // along a side of the raster of a direction
constexpr int kGlowSteps = 48;         // over the diagonal of the box
constexpr double kLargestPart = 0.25;  // radius of a part, relative to its distance
constexpr double kOpaqueDepth = 20.0;

/// Returns the number of a part in a grid.
std::size_t PartNumber(const std::array<int, 3>& count, const std::array<int, 3>& part) {
  return static_cast<std::size_t>((part[2] * count[1] + part[1]) * count[0] + part[0]);
}

/// Folds the lower half of the octahedron over the corners of the square, or back.
glm::dvec2 Folded(const glm::dvec2& at) {
  return {std::copysign(1.0 - std::abs(at.y), at.x), std::copysign(1.0 - std::abs(at.x), at.y)};
}

/// Returns the part of [0, kTurns]^2 that an axis of a direction maps to.
glm::dvec2 OctahedralPlace(const glm::dvec3& direction, int turns) {
  const double sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  glm::dvec2 at(direction.x / sum, direction.y / sum);
  if (direction.z < 0.0) at = Folded(at);
  return 0.5 * turns * (at + 1.0);
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
  levels_.push_back(Finest());
  Gather(towards);
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

GlowField::Level GlowField::Finest() const {
  const glm::dvec3& size_m = body_.placement().size_m;
  const double longest_m = std::max({size_m.x, size_m.y, size_m.z});
  Level level;
  glm::dvec3 part_m(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    int& count = level.count[static_cast<std::size_t>(axis)];
    while (count < kMostParts && 1.5 * count * longest_m < kMostParts * size_m[axis]) count *= 2;
    part_m[axis] = size_m[axis] / count;
  }
  level.radius_m = 0.5 * glm::length(part_m);
  level.least_m = std::cbrt(0.75 / kPi * part_m.x * part_m.y * part_m.z);
  const auto parts = static_cast<std::size_t>(level.count[0] * level.count[1] * level.count[2]);
  level.intensity.resize(parts * kDirections * bands_);
  level.middle.resize(parts);
  level.shines.resize(parts);
  return level;
}

void GlowField::Gather(const std::function<SourceAt(const glm::dvec3& travel)>& towards) {
  Level& level = levels_.front();
  const std::size_t parts = level.middle.size();
  std::vector<glm::dvec4> places(parts * kDirections, glm::dvec4(0.0));
  tbb::parallel_for(std::size_t{0}, kDirections, [&](std::size_t node) {
    GatherAlong(node, towards(DirectionOf(node)), places);
  });
  for (std::size_t part = 0; part < parts; ++part) {
    glm::dvec4 sum(0.0);
    for (std::size_t node = 0; node < kDirections; ++node) sum += places[part * kDirections + node];
    level.shines[part] = sum.w > 0.0;
    if (sum.w > 0.0) level.middle[part] = glm::dvec3(sum) / sum.w;
  }
}

void GlowField::GatherAlong(std::size_t node, const SourceAt& source,
                            std::vector<glm::dvec4>& places) {
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
  const double diagonal_m = glm::length(box.size_m);
  const double area_m2 = 4.0 * half_side_m * half_other_m / (kGlowRays * kGlowRays);
  Level& level = levels_.front();
  for (int ray = 0; ray < kGlowRays * kGlowRays; ++ray) {
    const double u = 2.0 * (ray % kGlowRays + 0.5) / kGlowRays - 1.0;
    const double v = 2.0 * (ray / kGlowRays + 0.5) / kGlowRays - 1.0;
    const glm::dvec3 origin =
        body_.Middle() + u * half_side_m * side + v * half_other_m * other + diagonal_m * travel;
    SpectrumOf<double> passed(bands_);
    for (const DensePiece& piece : body_.PiecesAlong(origin, -travel, 2.0 * diagonal_m)) {
      const double length_m = piece.end_m - piece.begin_m;
      const int steps = static_cast<int>(std::ceil(length_m / diagonal_m * kGlowSteps));
      for (int step = 0; step < steps; ++step) {
        const glm::dvec3 point =
            origin - (piece.begin_m + length_m * (step + 0.5) / steps) * travel;
        const double column_m = body_.DensityAt(point) * length_m / steps;
        if (column_m == 0.0) continue;
        const glm::dvec3 unit = body_.UnitFromFrame(point);
        std::array<int, 3> part{};
        for (int axis = 0; axis < 3; ++axis) {
          const int count = level.count[static_cast<std::size_t>(axis)];
          part[static_cast<std::size_t>(axis)] =
              std::clamp(static_cast<int>(unit[axis] * count), 0, count - 1);
        }
        const std::size_t slot = PartNumber(level.count, part) * kDirections + node;
        const Source here = source(point);
        for (std::size_t band = 0; band < bands_; ++band) {
          const double depth = column_m * here.extinction_per_m[band];
          const double mean = depth > 1e-6 ? -std::expm1(-depth) / depth : 1.0;
          const double sent = area_m2 * column_m * static_cast<double>(here.light_per_m[band]) *
                              mean * std::exp(-passed[band]);
          passed[band] += depth;
          level.intensity[slot * bands_ + band] += static_cast<float>(sent);
          places[slot] += sent * glm::dvec4(point, 1.0);
        }
      }
      const auto is_opaque = [](double depth) { return depth > kOpaqueDepth; };
      if (std::ranges::all_of(passed.values(), is_opaque)) break;
    }
  }
}

GlowField::Level GlowField::Merged(const Level& fine) const {
  Level coarse;
  coarse.radius_m = coarse.least_m = 0.0;
  glm::dvec3 part_m(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    coarse.count[axis] = std::max(fine.count[axis] / 2, 1);
    part_m[static_cast<glm::length_t>(axis)] =
        body_.placement().size_m[static_cast<glm::length_t>(axis)] / coarse.count[axis];
  }
  coarse.radius_m = 0.5 * glm::length(part_m);
  coarse.least_m = std::cbrt(0.75 / kPi * part_m.x * part_m.y * part_m.z);
  const auto parts = static_cast<std::size_t>(coarse.count[0] * coarse.count[1] * coarse.count[2]);
  coarse.intensity.resize(parts * kDirections * bands_);
  coarse.middle.resize(parts);
  coarse.shines.resize(parts);
  std::vector<double> weights(parts, 0.0);
  for (std::size_t from = 0; from < fine.middle.size(); ++from) {
    if (!fine.shines[from]) continue;
    const int number = static_cast<int>(from);
    std::array<int, 3> part{number % fine.count[0], number / fine.count[0] % fine.count[1],
                            number / (fine.count[0] * fine.count[1])};
    for (std::size_t axis = 0; axis < 3; ++axis)
      part[axis] = part[axis] * coarse.count[axis] / fine.count[axis];
    const std::size_t to = PartNumber(coarse.count, part);
    double weight = 0.0;
    for (std::size_t i = 0; i < kDirections * bands_; ++i) {
      const float value = fine.intensity[from * kDirections * bands_ + i];
      coarse.intensity[to * kDirections * bands_ + i] += value;
      weight += static_cast<double>(value);
    }
    coarse.middle[to] += weight * fine.middle[from];
    weights[to] += weight;
    coarse.shines[to] = true;
  }
  for (std::size_t part = 0; part < parts; ++part) {
    if (coarse.shines[part]) coarse.middle[part] /= weights[part];
  }
  return coarse;
}

void GlowField::AddIntensity(const Level& level, std::size_t part, const glm::dvec3& travel,
                             double factor, Spectrum& sum) const {
  const VolumePlacement& box = body_.placement();
  const glm::dvec2 at = OctahedralPlace(
      {glm::dot(travel, box.across), glm::dot(travel, box.ahead), glm::dot(travel, box.up)},
      kTurns);
  const int i = std::clamp(static_cast<int>(at.x), 0, kTurns - 1);
  const int j = std::clamp(static_cast<int>(at.y), 0, kTurns - 1);
  const double p = at.x - i, q = at.y - j;
  const std::array<double, 4> weight{(1.0 - p) * (1.0 - q), p * (1.0 - q), (1.0 - p) * q, p * q};
  for (std::size_t corner = 0; corner < weight.size(); ++corner) {
    const auto node = static_cast<std::size_t>((j + static_cast<int>(corner / 2)) * (kTurns + 1) +
                                               i + static_cast<int>(corner % 2));
    const float* values = level.intensity.data() + (part * kDirections + node) * bands_;
    const auto share = static_cast<float>(factor * weight[corner]);
    for (std::size_t band = 0; band < bands_; ++band) sum[band] += share * values[band];
  }
}

void GlowField::AddPart(std::size_t level_number, const std::array<int, 3>& part, const View& view,
                        bool is_tested, Spectrum& sum) const {
  const Level& level = levels_[level_number];
  const std::size_t number = PartNumber(level.count, part);
  if (!level.shines[number]) return;
  const bool is_finest = level_number + 1 == levels_.size();
  const glm::dvec3 way = level.middle[number] - view.point;
  const double distance_m = std::max(glm::length(way), 1e-9);
  const double over_m = glm::dot(way, view.normal);
  if (over_m <= (is_finest ? 0.0 : -2.0 * level.radius_m)) return;
  // A part that reaches below the surface is divided, too.
  const bool is_small = level.radius_m < kLargestPart * distance_m && over_m > level.radius_m;
  constexpr std::size_t kTestedLevel = 1;
  if (!is_tested && (is_small || is_finest || level_number == kTestedLevel)) {
    if (!view.sees(level.middle[number])) return;
    is_tested = true;
  }
  if (is_small || is_finest) {
    const double counted_m = std::max(distance_m, level.least_m);
    AddIntensity(level, number, way / -distance_m, over_m / (distance_m * counted_m * counted_m),
                 sum);
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
