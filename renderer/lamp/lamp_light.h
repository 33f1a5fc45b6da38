// SPDX-License-Identifier: MIT
// What a picture needs of the lamps, tile by tile.
//
// The light of a scene's lamps in a picture, by all its ways:
//
//   lamp -> eye              the lamp itself, never smaller than a pixel
//   lamp -> air -> eye       Airlight, on the lit pieces of the ray where terrain casts shadows
//   lamp -> surface -> eye   inverse square, through the air, shadowed by terrain
//   lamp -> air -> surface   LampGlow, over level ground at the lamp's foot, the flux of a beam
//                            spread evenly (terrain does not shade it)
//
// The air of a lamp is the scene's molecules and aerosol and its fog, of exponential density over
// the plane that touches the sphere halfway between eye and lamp.
//
// What a pixel costs depends on the cut of the tree of lamps (lamp_tree.h, tile_cut.h), not on the
// lamps that the scene has. Nodes that are far from a tile in angle shine smoothly over it: their
// light in the air is computed on a lattice of every fourth pixel and interpolated where the ends
// of the rays allow it.
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
#include "renderer/ground/scene_ground.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

struct LampSettings {
  int nodes = 12;  // of Airlight, see there
  /// Of a tile's lamp light: what standing for others and being left out may add up to.
  double share_of_error = 5e-3;
  double floor_cd_per_m2 = 0.0;  // errors below this do not matter
};

/// Nodes of the tree of lamps, by number.
using LampNodes = std::vector<std::uint32_t>;

/// What a tile of a picture sees of the lamps.
struct LampTile {
  LampNodes near_air;  // light in the air that varies between its pixels
  LampNodes far_air;   // light in the air that is smooth over it
  LampNodes surface;   // on surfaces
  LampNodes seen;      // lamps in the picture
  /// Of far_air, at (x0 + 4 i, y0 + 4 j); empty without any.
  std::vector<Bands<float>> lattice;
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

/// A ray from the eye, and where it meets something.
struct LampRayEnd {
  glm::dvec3 direction{0.0};
  double length_m = 0.0;
};

/// Where a ray of the camera ends [m]; infinite in the sky.
using RayTrace = std::function<double(const CameraRay& ray)>;

/// A surface point that lamps may light.
struct LitPoint {
  glm::dvec3 point{0.0};
  glm::dvec3 smooth_point{0.0};                // TerrainHit's, which shadow rays begin at
  glm::dvec3 normal{0.0, 0.0, 1.0};            // unit, of the shading
  glm::dvec3 geometric_normal{0.0, 0.0, 1.0};  // unit, of the triangle, which shadow rays leave
};

/// Immutable; safe to ask from many threads.
class LampLight {
 public:
  /// Reads the IES files of lamps. `ground` must outlive this. Throws InputError naming the lamp
  /// for a lamp below the ground, and what ReadIes refuses.
  LampLight(const Scene& scene, const SceneGround& ground, const Medium& medium,
            const BandColour& colour);
  ~LampLight();
  LampLight(LampLight&&) noexcept;

  /// The same lamps as a camera sees them: from its eye, spread by its lens. The constructor's eye
  /// is that of the scene's place, a pinhole.
  [[nodiscard]] LampLight SeenBy(const CameraRays& camera) const;

  [[nodiscard]] LampPlan PlanFor(const MovingCamera& camera, int width, int height,
                                 const LampSettings& settings, const RayTrace& trace) const;

  /// What the fog leaves of the light from a distance along a ray.
  [[nodiscard]] Bands<float> FogTransmittance(const glm::dvec3& direction, double length_m) const;

  /// Radiance of the air in front of the end of a ray through pixel (x, y) [W m^-2 sr^-1 nm^-1].
  /// Where a lamp is nearer to the ray than a pixel is wide, the mean over the pixel.
  [[nodiscard]] Bands<float> InAir(const LampPlan& plan, int x, int y, const LampRayEnd& ray,
                                   double pixel_angle_rad, int nodes) const;

  /// The same of these nodes, without a plan.
  [[nodiscard]] Bands<float> InAir(const LampNodes& lamps, const LampRayEnd& ray,
                                   double pixel_angle_rad, int nodes) const;

  /// Irradiance of a surface [W m^-2 nm^-1].
  [[nodiscard]] Bands<float> OnSurface(const LampNodes& lamps, const LitPoint& at) const;

  /// Radiance of the lamps themselves. A lamp smaller than a pixel is
  /// drawn as a soft disk of that size that has its light; a lens spreads
  /// it over the shape of its iris, where terrain does not stand between.
  /// @param left  what but air and fog leaves of light from a distance; null: all.
  [[nodiscard]] Bands<float> Seen(const LampNodes& lamps, const CameraRay& ray,
                                  double pixel_angle_rad,
                                  const std::function<Bands<float>(double)>& left = nullptr) const;

  /// One of the scene's lamps, by its number in All().
  struct SceneLamp {
    const Lamp& lamp;
    const Bands<float>& intensity;  // W sr^-1 nm^-1 in its brightest direction
    double candela;
  };
  [[nodiscard]] SceneLamp At(std::uint32_t number) const;
  /// Optical depth of air and fog between it and a point; infinite where terrain stands between.
  [[nodiscard]] Bands<double> DepthTo(std::uint32_t number, const glm::dvec3& point) const;

  /// Unit directions from the eye to the scene's lamps.
  [[nodiscard]] std::vector<glm::dvec3> Directions() const;

  /// The scene's lamps, one by one.
  [[nodiscard]] LampNodes All() const;

 private:
  struct State;
  explicit LampLight(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::renderer
