// SPDX-License-Identifier: MIT
// Light of clouds by paths, with the noise of neighbouring rays of a picture shared.
//
// The fast method has no noise, and its errors change slowly from pixel to pixel. With its light G and
// that by paths P, separately for sun, sky and ground, a ray i therefore has the light
//
//   L_i = G_i sum_j w_ij P_j / sum_j w_ij G_j
//   w_ij = exp(-d_ij^2 / 1.5 - (ln(G_j / G_i) / 0.35)^2 / 2 - (ln(D_j / D_i) / 0.02)^2 / 2)
//
// over the rays j through the middles of the pixels around it, d pixels away, whose clouds are at the
// distance D. It is a joint bilateral filter (Petschnigg et al. 2004, ACM Trans. Graph. 23, 664) of
// ratios: edges and details of G stay sharp. Where rays around are alike, the noise is 0.37 times that of
// one ray.
//
// Rays j are traced on demand and kept in blocks of 8 x 8 pixels. Their light depends on the ray alone,
// so that neither threads nor the order of pixels matter, nor whether a block is traced again.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "renderer/cloud_phase/phase_colours.h"

namespace alpenglow::renderer {

/// The clouds of one layer on one chord of a ray.
struct CloudRayPart {
  std::size_t layer = 0;
  int chord = 0;            // number of the chord in the layer
  double distance_m = 0.0;  // mean distance of the light on the ray
  double transmittance = 1.0, scaled_transmittance = 1.0;
  std::array<double, 3> fast{};   // light of sun, sky and ground by the fast method
  std::array<double, 3> light{};  // the same by the method of choice
  OnceScattered once{};           // sunlight of first order by the fast method
};

/// A part of a ray near another one.
struct CloudPartAround {
  const CloudRayPart* part;
  double squared_pixels;  // d^2
};

/// Returns the light L_i of a part; no value if no part around it is like it.
/// @param around  parts of the same layer and chord, that of the ray itself among them.
[[nodiscard]] std::optional<std::array<double, 3>> SharedLight(
    const CloudRayPart& part, const std::vector<CloudPartAround>& around);

/// The rays through the middles of the pixels of a picture.
struct PixelRays {
  struct Ray {
    glm::dvec3 direction;
    double length_m;  // may be infinite
  };

  int columns, rows;
  glm::dvec3 eye;
  std::function<Ray(int column, int row)> ray;
  /// Returns the point of the picture of a direction, from its upper left corner [pixels].
  std::function<std::optional<std::array<double, 2>>(const glm::dvec3& direction)> place;
};

/// Safe to use from many threads. Copies share the rays that they keep.
class SharedCloudLight {
 public:
  /// Returns the parts of a ray from the eye, in order. @param by_paths  whether they need `light`.
  using Trace = std::function<std::vector<CloudRayPart>(const PixelRays::Ray& ray, bool by_paths)>;

  explicit SharedCloudLight(PixelRays pixels);

  [[nodiscard]] const glm::dvec3& eye() const { return pixels_.eye; }

  /// Returns the parts of a ray from the eye with their light. A ray that leaves the picture, or to
  /// which no ray around it is alike, has the light of its own paths.
  [[nodiscard]] std::vector<CloudRayPart> Parts(const PixelRays::Ray& ray,
                                                const Trace& trace) const;

  static constexpr int kBlock = 8;  // pixels
  /// Returns the largest number of blocks in memory; all of the picture, if they are few.
  [[nodiscard]] std::size_t MostBlocks() const { return kept_->slot.size(); }

 private:
  struct Block;
  /// Blocks by their number modulo the number of slots.
  struct Kept {
    struct Slot {
      std::mutex taking;
      std::shared_ptr<Block> block;
    };
    explicit Kept(std::size_t slots) : slot(slots) {}
    std::vector<Slot> slot;
  };
  /// Blocks that one ray has asked for.
  class Around;

  [[nodiscard]] std::shared_ptr<Block> BlockOf(std::size_t number) const;

  PixelRays pixels_;
  std::size_t block_columns_;
  std::shared_ptr<Kept> kept_;
};

}  // namespace alpenglow::renderer
