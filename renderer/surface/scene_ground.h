// SPDX-License-Identifier: MIT
// This header prepares the ground of a scene: it reads the visible part of an elevation model,
// builds the terrain in the frame of the eye, finds heights of the ground, and places cameras.
//
// A mesh may have roofs, bridges and overhangs, so the ground can have several heights at one
// place. Objects placed on the ground stand on the highest surface, and only points below the
// lowest surface are inside the ground.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "atmosphere/time_place/geodesy.h"
#include "lut/cli/messages.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/elevation/elevation.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// Heights of the lowest and of the highest surface on one vertical.
struct GroundHeights {
  double lowest_m, highest_m;
};

/// Returns the heights above a point, along a vertical.
/// @param up  unit.
/// @return empty if no surface lies within 20 km of the point.
[[nodiscard]] std::optional<GroundHeights> GroundHeightsAlong(const Terrain& terrain,
                                                              const glm::dvec3& point,
                                                              const glm::dvec3& up);
/// Returns the heights above the ellipsoid, whatever the height of the place.
/// @param frame  of the terrain's coordinates.
/// @return empty if no surface lies within 20 km of the ellipsoid.
[[nodiscard]] std::optional<GroundHeights> GroundHeightsAt(const Terrain& terrain,
                                                           const LocalFrame& frame,
                                                           const Place& place);

/// The surface below a point, and its height.
struct SurfaceUnder {
  TerrainHit hit;
  double height_m;
};

/// Returns the highest surface that is not above a point; if all are above it, the highest of them.
/// The height is relative to the point.
/// @param up  unit.
/// @return empty if no surface lies below the point or within 20 km above it.
[[nodiscard]] std::optional<SurfaceUnder> SurfaceUnderPoint(const Terrain& terrain,
                                                            const glm::dvec3& point,
                                                            const glm::dvec3& up);
/// Returns the height above the ellipsoid of the surface below an eye at a place.
[[nodiscard]] std::optional<double> GroundUnderEye(const Terrain& terrain, const LocalFrame& frame,
                                                   const Place& place);

/// Returns the dip of the horizon below the horizontal, which is also its distance along the
/// earth's curve [radians], on a sphere without air.
[[nodiscard]] double HorizonDip(double height_m);

/// Returns the window of grid samples within a distance [radians of the earth's curve] of a place,
/// at least 2 x 2; for a place outside the grid, the nearest samples.
[[nodiscard]] GridWindow WindowAround(const ElevationGrid& grid, const Place& place,
                                      double distance_rad);

struct ModelInSight {
  ElevationModel model;
  ElevationGrid extent;  // of the whole model, without heights
  std::string message;   // message about what was read; empty: none
};

/// Reads the elevation model of a scene. A model of more than 2^25 samples for which CanBeCut holds
/// is read only as far as ground of any height may be visible from the camera. Several models
/// (TerrainSource::HasManyModels) are read as far, into one grid of at most 2^13 samples per side.
/// Throws InputError as ReadElevation and LandTiles do, and if there is no valid sample within this
/// distance.
[[nodiscard]] ModelInSight ReadModelInSight(const Scene& scene);

struct SceneGround {
  LocalFrame frame;                // ENU at the eye's foot point on the ellipsoid
  std::optional<Terrain> terrain;  // empty: the ellipsoid alone
  double eye_height_m;             // above the ellipsoid
  std::string message;             // message of the loading; empty if there is none
  bool is_one_surface;             // no overhangs: see IsOneSurface
  /// The eye is above a single surface of an elevation model without holes: all below it is ground.
  bool is_solid = false;
};

/// Returns the ellipsoid of the scene's planet: WGS84, or a sphere of the medium's radius.
[[nodiscard]] Ellipsoid EllipsoidOf(const Medium& medium);

/// Loads or generates the terrain and places the eye above it. Throws InputError for files that
/// cannot be read, for an eye below the ground (with several surfaces: below the lowest), for an eye
/// outside an elevation model that is placed relative to the ground or is too low to see the model,
/// and as RequireCloudsOverGround does, unless the terrain is a mesh file.
/// @param progress  receives the names of the steps, if not null.
[[nodiscard]] SceneGround LoadGround(const Scene& scene, Progress* progress = nullptr);

/// Throws InputError if an eye is below ground of this height above the ellipsoid [m].
void RequireOverGround(const Place& eye, double ground_m);

/// Returns the transform from the scene's own eye to the frame of the scene.
[[nodiscard]] FrameTransform FromSceneEye(const SceneGround& ground);

/// Returns the transform from an eye at another place to the frame of the scene. Throws InputError if the eye is
/// below the ground (with several surfaces: below the lowest), or more than 500 km from the scene's
/// place.
[[nodiscard]] FrameTransform FromEyeAt(const SceneGround& ground, const Place& place);

/// Returns the height of a scene's ground above the ellipsoid [m] at a place: that of the highest
/// surface, or 0 if there is none. Throws InputError more than 500 km from the scene's place.
[[nodiscard]] double GroundHeightUnder(const SceneGround& ground, const Place& place);

/// Returns a camera with the lens of `camera` that takes these poses one after the other; without
/// poses, the scene's camera.
[[nodiscard]] MovingCamera CameraOn(const SceneGround& ground, const Camera& camera,
                                    std::span<const CameraPose> poses, int width, int height);

}  // namespace alpenglow::renderer
