// SPDX-License-Identifier: MIT
// A map of photon beams in media, and the light that they scatter once along a ray.
//
// A beam is a cylinder of radius r over which its power P is spread evenly, P / (pi r^2) per area
// (Jarosz, Nowrouzezahrai, Sadeghi and Jensen 2011, ACM Trans. Graph. 30, 5: beams and rays with a
// two-dimensional blur). A ray crosses it over a chord; at a distance u of the axes, under the angle
// theta, this is the kernel 2 sqrt(r^2 - u^2) / (pi r^2 sin theta). A chord ends at the ends of beam
// and ray, so that rays along a beam have finite light. Power is conserved: the light of all parallel
// rays is that of an infinitely thin beam.
//
// Beams are cut into pieces for a tree of boxes. Radii blur: structures narrower than r are lost, and
// fewer beams than fill the picture leave noise. README.md has errors for both.
//
// Radiances are per irradiance by the light above the media at the spheres [1/sr].
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/specular/beam_media.h"
#include "renderer/specular/box_tree.h"
#include "renderer/specular/photon_beams.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class BeamMap {
 public:
  /// Throws InputError unless the radius is positive and finite.
  BeamMap(std::vector<PhotonBeam> beams, LocalMedia media, double radius_m);

  /// Returns the light that arrives at the origin of a ray.
  /// @param direction  unit, away from the origin. @param length_m  may be infinite.
  [[nodiscard]] SpectrumOf<double> Radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                            double length_m) const;

  [[nodiscard]] const std::vector<PhotonBeam>& beams() const { return beams_; }
  [[nodiscard]] double radius_m() const { return radius_m_; }
  /// Returns the memory of beams, pieces and tree [bytes].
  [[nodiscard]] std::size_t bytes() const {
    return beams_.size() * sizeof(PhotonBeam) + pieces_.all.size() * sizeof(Piece) +
           pieces_.column_m.size() * sizeof(double) + tree_.bytes();
  }

 private:
  struct Piece {
    std::uint32_t beam;
    std::uint32_t knot;  // of the columns at its beginning; those at its end follow
    double begin_m, end_m;
  };
  struct Pieces {
    std::vector<Piece> all;
    std::vector<double> column_m;  // [knot][medium], from where sunlight meets the first sphere
  };
  [[nodiscard]] Pieces Cut() const;
  [[nodiscard]] std::vector<Box> Boxes() const;
  [[nodiscard]] double ColumnAt(const Piece& piece, std::size_t medium, double along_m) const;

  std::vector<PhotonBeam> beams_;
  LocalMedia media_;
  double radius_m_;
  Pieces pieces_;
  BoxTree tree_;
};

}  // namespace alpenglow::renderer
