// SPDX-License-Identifier: MIT
// The interface of everything besides the air that scatters, absorbs or emits light: where it is
// and how dense (LocalMedium), what it consists of (MediumOptics), and how light is found in it
// (LitMedium, lit_medium.h).
//
//   extinction(p) = density(p) sigma_t       scattering(p) = density(p) sigma_s
//   emission(p)   = density(p) epsilon
//
// Media of a scene are a list in any order (LocalMedia). Where they overlap, they add up, and one
// march integrates the light of all of them along a ray (media_march.h).
//
// A medium is a body or a layer. A body (smoke, a bank of fog, a fire) is bounded. A layer (fog over
// the whole scene) is the same at all places of one altitude. Layers are also part of the air around
// lamps (LampStage), so light of lamps is attenuated there and not by the march.
//
// A new body is a subclass of LocalBody (local_body.h). Another kind of medium is a subclass of
// LocalMedium with one of LitMedium. Both need an entry in the constructor of LocalMedia.
// renderer/README.md lists what its section of scene.toml needs.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/medium/phase.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/layer.h"
#include "renderer/scene/volume_grid.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

class LitMedium;
struct MediaSources;

/// Optical properties at density 1, band by band.
struct MediumOptics {
  SpectrumOf<double> extinction_per_m;
  SpectrumOf<double> scattering_per_m;
  SpectrumOf<double> emission_per_m;  // W m^-2 sr^-1 nm^-1 per metre
  PhaseFunction phase;
};

/// Returns a value for each band from a list with one value, or one per band.
[[nodiscard]] SpectrumOf<double> InBands(const std::vector<double>& values, std::size_t bands);
/// Returns optical properties without emission. The lists have one value, or one per band.
[[nodiscard]] MediumOptics OpticsFromLists(const std::vector<double>& extinction_per_m,
                                           const std::vector<double>& albedo,
                                           const PhaseFunction& phase, std::size_t bands);

/// Immutable; safe to use from many threads. Points are in the frame of SceneGround; directions are
/// unit vectors.
class LocalMedium {
 public:
  explicit LocalMedium(MediumOptics optics) : optics_(std::move(optics)) {}
  LocalMedium(const LocalMedium&) = delete;
  LocalMedium& operator=(const LocalMedium&) = delete;
  virtual ~LocalMedium() = default;

  [[nodiscard]] const MediumOptics& optics() const { return optics_; }
  /// Returns whether the medium is a layer; else it is a body.
  [[nodiscard]] virtual bool IsLayer() const { return false; }

  /// Returns the density at a point; 0 outside.
  [[nodiscard]] virtual double DensityAt(const glm::dvec3& point) const = 0;
  /// Returns the intervals of a line within [0, length_m] where there is density, in order and
  /// without overlaps: the bounds of the medium. Space between them costs nothing.
  [[nodiscard]] virtual std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                            const glm::dvec3& direction,
                                                            double length_m) const = 0;
  /// Returns an upper bound of the density between two points of a piece. @param largest  of the
  /// piece.
  [[nodiscard]] virtual double LargestBetween(const glm::dvec3& /*from*/, const glm::dvec3& /*to*/,
                                              double largest) const {
    return largest;
  }
  /// Returns the integral of the density over a line [m]. @param length_m  may be infinite.
  [[nodiscard]] virtual double Column(const glm::dvec3& origin, const glm::dvec3& direction,
                                      double length_m) const = 0;

  /// Returns the light in this medium. The sources must outlive it.
  [[nodiscard]] virtual std::unique_ptr<const LitMedium> LitBy(
      const MediaSources& sources) const = 0;

 private:
  MediumOptics optics_;
};

using MediaList = std::vector<std::shared_ptr<const LocalMedium>>;

/// Returns the height of the highest terrain over x and y in the frame of the ground [m along z]; no
/// value without terrain there.
[[nodiscard]] std::optional<double> TerrainTop(const SceneGround& ground, double x, double y);

}  // namespace alpenglow::renderer
