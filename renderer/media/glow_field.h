// SPDX-License-Identifier: MIT
// The light that a body that glows (a fire, hot gas) sends to surfaces around it:
//
//   E(p, n) = sum over parts of the body  I(direction) max(cosine, 0) / distance^2
//
// The body is divided into at most 8 x 8 x 8 parts, and these into parts of twice, four and eight
// times their sides. Each part has its intensity I [W sr^-1 nm^-1] on 169 directions, at the nodes of an
// octahedral map (Cigolle et al. 2014, "A survey of efficient representations for independent unit
// vectors"), which includes what the body in front of it takes away. The intensities are sums over
// parallel rays through the body, so that all light that leaves the body in a direction is counted
// once. A point takes the light of parts that are small as it sees them.
//
// Against integrals over all directions, irradiance from a distance of half the body's size on is
// within 3 %, of bodies of optical depth 10 within 5 %. Opaque slabs that are six times as wide as they
// are deep are up to 25 % too bright near their plane: tests/renderer/media/glow_field_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <utility>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/media/local_body.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads. Directions are unit vectors.
class GlowField {
 public:
  /// Light of a body at a point and its attenuation, at density 1.
  struct Source {
    Spectrum light_per_m;  // W m^-2 sr^-1 nm^-1 per metre
    SpectrumOf<double> extinction_per_m;
  };
  using SourceAt = std::function<Source(const glm::dvec3& point)>;
  /// @param towards  returns the source of the light that travels in a direction; it is called from
  ///     many threads.
  GlowField(const LocalBody& body,
            const std::function<SourceAt(const glm::dvec3& travel)>& towards);

  /// Returns the irradiance of a surface [W m^-2 nm^-1].
  /// @param sees  returns whether nothing hides a place in the body from the point. At most eight
  ///     places are tested.
  [[nodiscard]] Spectrum On(const glm::dvec3& point, const glm::dvec3& normal,
                            const std::function<bool(const glm::dvec3& place)>& sees) const;
  /// Returns the mean place of the light.
  [[nodiscard]] const glm::dvec3& middle() const { return levels_.front().middle.front(); }

 private:
  static constexpr int kTurns = 12;  // of the octahedral map, along a side
  static constexpr std::size_t kDirections = (kTurns + 1) * (kTurns + 1);

  /// Parts of one size. The first level has one part.
  struct Level {
    std::array<int, 3> count{1, 1, 1};
    double radius_m = 0.0;         // of the ball around a part
    double least_m = 0.0;          // distances count as at least this
    std::vector<float> intensity;  // [part][direction][band]
    // [part][direction]: the sum of all bands (w), and that times the place of the light relative to
    // the middle of the body (x, y, z).
    std::vector<glm::vec4> places;
    std::vector<glm::dvec3> middle;  // [part], of the light in all directions
    std::vector<bool> shines;        // [part]
  };
  /// A view from a surface.
  struct View;

  [[nodiscard]] glm::dvec3 DirectionOf(std::size_t node) const;
  [[nodiscard]] Level LevelOf(const std::array<int, 3>& count) const;
  void Gather(const std::function<SourceAt(const glm::dvec3& travel)>& towards);
  void GatherAlong(std::size_t node, const SourceAt& source);
  void GatherOnRay(const glm::dvec3& origin, std::size_t node, double area_m2,
                   const SourceAt& source);
  [[nodiscard]] std::size_t PartAt(const glm::dvec3& point) const;
  [[nodiscard]] Level Merged(const Level& fine) const;
  void FindMiddles(Level& level) const;
  /// Returns the least and the largest height of a part over the plane of a surface [m].
  [[nodiscard]] std::pair<double, double> HeightsOf(const Level& level,
                                                    const std::array<int, 3>& part,
                                                    const View& view) const;
  void AddPart(std::size_t level, const std::array<int, 3>& part, const View& view, bool is_tested,
               Spectrum& sum) const;
  void AddLight(const Level& level, std::size_t part, const View& view, Spectrum& sum) const;

  const LocalBody& body_;
  std::size_t bands_;
  std::vector<Level> levels_;  // from the coarsest to the finest
};

}  // namespace alpenglow::renderer
