// SPDX-License-Identifier: MIT
// This header computes the light of a scene's lamps in a picture, tile by tile, along four paths:
//
//   lamp -> eye              the lamp itself, never smaller than a pixel
//   lamp -> air -> eye       Airlight, on the lit pieces of the ray where terrain casts shadows
//   lamp -> surface -> eye   inverse square, through the air, shadowed by terrain
//   lamp -> air -> surface   LampAirlightIrradiance, over level ground at the lamp's foot, the flux
// of a beam
//                            spread evenly over all directions (not shaded by terrain)
//
// The air around a lamp consists of the scene's molecules, aerosol and layers, with exponential
// density above the plane that touches the sphere halfway between eye and lamp.
//
// The cost of a pixel depends on the cut through the tree of lamps (lamp_tree.h, tile_cut.h), not
// on the number of lamps in the scene. Nodes far from a tile in angle illuminate it smoothly: their
// light in the air is computed on a lattice of every fourth pixel, and interpolated if the rays end
// at similar distances.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

struct LampSettings {
  int nodes = 12;  // nodes of Airlight
  /// Allowed sum of errors from clustering and omitting lamps, relative to a tile's lamp light.
  double share_of_error = 5e-3;
  double floor_cd_per_m2 = 0.0;  // errors below this are ignored
};

/// Nodes of the tree of lamps, by number.
using LampNodes = std::vector<std::uint32_t>;

/// The lamp nodes that a tile of a picture needs.
struct LampTile {
  LampNodes near_air;  // light in the air that varies between the tile's pixels
  LampNodes far_air;   // light in the air that is smooth over the tile
  LampNodes surface;   // light on surfaces
  LampNodes seen;      // lamps visible in the tile
  /// Light of far_air, at (x0 + 4 i, y0 + 4 j); empty if there are no such nodes.
  std::vector<Spectrum> lattice;
  std::vector<double> lattice_length_m;  // of the rays there; NaN where terrain shades lamps
};

struct LampPlan {
  static constexpr int kTile = 16;    // pixels
  static constexpr int kSpacing = 4;  // pixels
  static constexpr int kLattice = kTile / kSpacing + 1;
  int columns = 0;
  std::vector<LampTile> tiles;

  [[nodiscard]] const LampTile& At(int x, int y) const {
    return tiles[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(x / kTile)];
  }
};

/// A ray from the eye, and the distance to its end.
struct LampRayEnd {
  glm::dvec3 direction{0.0};
  double length_m = 0.0;
};

/// Returns the length of a camera ray [m]; infinite in the sky.
using RayTrace = std::function<double(const CameraRay& ray)>;

/// A surface point that lamps may light.
struct LitPoint {
  glm::dvec3 point{0.0};
  glm::dvec3 smooth_point{0.0};                // TerrainHit::smooth_point, where shadow rays start
  glm::dvec3 normal{0.0, 0.0, 1.0};            // unit shading normal
  glm::dvec3 geometric_normal{0.0, 0.0, 1.0};  // unit normal of the triangle
};

/// Light of all lamps of a scene for one eye. Immutable; safe to use from many threads.
class LampLight {
 public:
  /// Reads the IES files of lamps. `ground` must outlive this object. Throws InputError naming the
  /// lamp for a lamp below the ground, and for files that ReadIes rejects.
  LampLight(const Scene& scene, const SceneGround& ground, const Medium& medium,
            const BandColour& colour);
  ~LampLight();
  LampLight(LampLight&&) noexcept;

  /// Returns the same lamps for the eye of a camera, blurred by its lens. The constructor assumes
  /// the scene's own eye and a pinhole.
  [[nodiscard]] LampLight SeenBy(const CameraRays& camera) const;

  [[nodiscard]] LampPlan PlanFor(const MovingCamera& camera, int width, int height,
                                 const LampSettings& settings, const RayTrace& trace) const;

  /// Returns the transmittance of the scene's layers over a distance along a ray.
  [[nodiscard]] Spectrum LayerTransmittance(const glm::dvec3& direction, double length_m) const;

  /// Returns the radiance that the air in front of the end of a ray through pixel (x, y) scatters
  /// from lamps [W m^-2 sr^-1 nm^-1]. If a lamp is closer to the ray than the width of a pixel, it
  /// is the mean over the pixel.
  [[nodiscard]] Spectrum InAir(const LampPlan& plan, int x, int y, const LampRayEnd& ray,
                               double pixel_angle_rad, int nodes) const;

  /// Returns the radiance in the air from the given nodes, without a plan.
  [[nodiscard]] Spectrum InAir(const LampNodes& lamps, const LampRayEnd& ray,
                               double pixel_angle_rad, int nodes) const;

  /// Returns the irradiance of a surface [W m^-2 nm^-1].
  [[nodiscard]] Spectrum OnSurface(const LampNodes& lamps, const LitPoint& at) const;

  /// Returns the radiance of the lamps themselves. A lamp smaller than a pixel is drawn as a soft
  /// disk of a pixel's size with the same total light. A lens spreads it over the shape of its
  /// iris, except where terrain hides it.
  /// @param left  transmittance over a distance due to media other than air and layers; null: 1.
  [[nodiscard]] Spectrum Seen(const LampNodes& lamps, const CameraRay& ray, double pixel_angle_rad,
                              const std::function<Spectrum(double)>& left = nullptr) const;

  /// One of the scene's lamps, by its number in All().
  struct SceneLamp {
    const Lamp& lamp;
    const Spectrum& intensity;  // W sr^-1 nm^-1 in its brightest direction
    double candela;
  };
  [[nodiscard]] SceneLamp At(std::uint32_t number) const;
  /// Returns the optical depth of air and layers between a lamp and a point; infinite if terrain hides
  /// the lamp.
  [[nodiscard]] SpectrumOf<double> DepthTo(std::uint32_t number, const glm::dvec3& point) const;

  /// Returns whether terrain or the planet shades a surface from a place.
  [[nodiscard]] bool Shades(const glm::dvec3& place, const LitPoint& at) const;

  /// Returns unit directions from the eye to the scene's lamps.
  [[nodiscard]] std::vector<glm::dvec3> Directions() const;

  /// Returns the numbers of all lamps of the scene.
  [[nodiscard]] LampNodes All() const;
  /// Returns nodes for all lamps as a point far away sees them: lamps of a cluster lie within
  /// kFarCluster of its distance.
  [[nodiscard]] LampNodes FarFrom(const glm::dvec3& point) const;
  static constexpr double kFarCluster = 0.2;

 private:
  struct State;
  explicit LampLight(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::renderer
