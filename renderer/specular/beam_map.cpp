// SPDX-License-Identifier: MIT
#include "renderer/specular/beam_map.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

// Boxes of longer pieces are mostly empty, and those of shorter ones many.
constexpr double kPieceRadii = 32.0;
// The middle of a chord stands for it: no chord in a piece is deeper.
constexpr double kPieceDepth = 0.5;
constexpr double kMostPieces = 4096.0;

/// A ray, relative to the axis of a cylinder.
struct Chord {
  RaySpan span;
  double along_m;  // place of its middle along the axis
};

/// Returns the chord of a ray in a piece of a beam.
std::optional<Chord> ChordIn(const PhotonBeam& beam, const RaySpan& piece, double radius_m,
                             const glm::dvec3& origin, const glm::dvec3& direction,
                             double length_m) {
  const glm::dvec3 from = origin - beam.origin;
  const double from_along = glm::dot(from, beam.direction);
  const double cosine = glm::dot(direction, beam.direction);
  const glm::dvec3 from_across = from - from_along * beam.direction;
  const glm::dvec3 across = direction - cosine * beam.direction;
  const double sine2 = glm::dot(across, across);
  double begin = 0.0, end = length_m;
  // Below, the distance between the ray and the axis would be lost in rounding.
  constexpr double kParallel = 1e-24;
  const double nearest_m = sine2 > kParallel ? -glm::dot(from_across, across) / sine2 : 0.0;
  const glm::dvec3 apart = from_across + nearest_m * across;
  const double half2 = radius_m * radius_m - glm::dot(apart, apart);
  if (half2 <= 0.0) return std::nullopt;
  if (sine2 > kParallel) {
    const double half = std::sqrt(half2 / sine2);
    begin = std::max(begin, nearest_m - half);
    end = std::min(end, nearest_m + half);
  }
  // The ends of the piece.
  if (std::abs(cosine) > 1e-12) {
    const double a = (piece.begin_m - from_along) / cosine;
    const double b = (piece.end_m - from_along) / cosine;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  } else if (from_along < piece.begin_m || from_along >= piece.end_m) {
    return std::nullopt;
  }
  if (!(begin < end)) return std::nullopt;
  return Chord{{begin, end}, from_along + 0.5 * (begin + end) * cosine};
}

}  // namespace

BeamMap::BeamMap(std::vector<PhotonBeam> beams, LocalMedia media, double radius_m)
    : beams_(std::move(beams)),
      media_(std::move(media)),
      radius_m_(RequireInRange(radius_m, std::numeric_limits<double>::min(),
                               std::numeric_limits<double>::max(), "the radius of beams [m]")),
      pieces_(Cut()),
      tree_(Boxes()) {}

BeamMap::Pieces BeamMap::Cut() const {
  Pieces pieces;
  const MediaList& all = media_.all();
  std::vector<double> before(all.size()), start(all.size());
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const PhotonBeam& beam = beams_[i];
    if (beam.leg == 0) std::ranges::fill(before, 0.0);
    start = before;
    const double count = std::clamp(std::ceil(std::max(beam.length_m / (kPieceRadii * radius_m_),
                                                       LargestDepth(media_, beam) / kPieceDepth)),
                                    1.0, kMostPieces);
    const auto add_knot = [&](double along_m) {
      for (std::size_t m = 0; m < all.size(); ++m) {
        before[m] = start[m] + all[m]->Column(beam.origin, beam.direction, along_m);
        pieces.column_m.push_back(before[m]);
      }
    };
    const auto knots = [&] { return all.empty() ? 2 : pieces.column_m.size() / all.size(); };
    add_knot(0.0);
    for (double piece = 0.0; piece < count; ++piece) {
      const double begin_m = beam.length_m * (piece / count);
      const double end_m = beam.length_m * ((piece + 1.0) / count);
      add_knot(end_m);
      pieces.all.push_back(
          {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(knots() - 2), begin_m, end_m});
    }
  }
  return pieces;
}

std::vector<Box> BeamMap::Boxes() const {
  std::vector<Box> boxes;
  boxes.reserve(pieces_.all.size());
  for (const Piece& piece : pieces_.all) {
    const PhotonBeam& beam = beams_[piece.beam];
    const glm::dvec3 a = beam.origin + piece.begin_m * beam.direction;
    const glm::dvec3 b = beam.origin + piece.end_m * beam.direction;
    // A disk across the beam is narrower along its axis.
    const glm::dvec3 half =
        radius_m_ * glm::sqrt(glm::max(1.0 - beam.direction * beam.direction, glm::dvec3(0.0)));
    boxes.push_back({glm::min(a, b) - half, glm::max(a, b) + half});
  }
  return boxes;
}

double BeamMap::ColumnAt(const Piece& piece, std::size_t medium, double along_m) const {
  const std::size_t media = media_.all().size();
  const double share = (along_m - piece.begin_m) / (piece.end_m - piece.begin_m);
  return (1.0 - share) * pieces_.column_m[piece.knot * media + medium] +
         share * pieces_.column_m[(piece.knot + 1) * media + medium];
}

SpectrumOf<double> BeamMap::Radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double length_m) const {
  const double per_area = 1.0 / (kPi * radius_m_ * radius_m_);
  const auto add = [&](std::uint32_t number, const ColumnsOnRay& on_ray,
                       std::vector<double>& columns_m, ScatteredLight& light) {
    const Piece& piece = pieces_.all[number];
    const PhotonBeam& beam = beams_[piece.beam];
    const auto chord =
        ChordIn(beam, {piece.begin_m, piece.end_m}, radius_m_, origin, direction, length_m);
    if (!chord) return;
    const double middle_m = 0.5 * (chord->span.begin_m + chord->span.end_m);
    for (std::size_t m = 0; m < columns_m.size(); ++m)
      columns_m[m] = on_ray.At(m, middle_m) + ColumnAt(piece, m, chord->along_m);
    const double weight = beam.area_m2 * per_area * (chord->span.end_m - chord->span.begin_m);
    light.Add(
        {origin + middle_m * direction, -glm::dot(beam.direction, direction), weight, columns_m});
  };
  return LightOfBoxes(tree_, media_, {origin, direction, length_m}, add);
}

}  // namespace alpenglow::renderer
