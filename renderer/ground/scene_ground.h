// SPDX-License-Identifier: MIT
// The heights of the ground at a place. A mesh may have roofs, bridges and overhangs, so that the
// ground has several heights at one place: what is put on the ground stands on the highest, and
// only what is below the lowest is inside the ground.
//
// An elevation model as far as it may be seen: of models of the whole earth only what lies around
// the camera is read.
//
// The ground of a scene: terrain ready for rays, in the frame of the eye.
//
// Where the camera of a picture stands in the frame of the scene.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "atmosphere/sun/geodesy.h"
#include "lut/program/messages.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"
#include "renderer/terrain/elevation.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

/// Heights of the lowest and of the highest surface on one vertical.
struct GroundHeights {
  double lowest_m, highest_m;
};

/// Over a point, along a vertical.
/// @param up  unit.
/// @return nothing where no surface lies within 20 km of the point.
[[nodiscard]] std::optional<GroundHeights> GroundHeightsAlong(const Terrain& terrain,
                                                              const glm::dvec3& point,
                                                              const glm::dvec3& up);
/// Over the ellipsoid, whatever the height of the place.
/// @param frame  of the terrain's coordinates.
/// @return nothing where no surface lies within 20 km of the ellipsoid.
[[nodiscard]] std::optional<GroundHeights> GroundHeightsAt(const Terrain& terrain,
                                                           const LocalFrame& frame,
                                                           const GeodeticPosition& place);

/// The surface that something at a height is over.
struct SurfaceUnder {
  TerrainHit hit;
  double height_m;
};

/// The highest surface that is not above a point; where all are above it, the highest of them.
/// @param up  unit. The height is over the point.
/// @return nothing where no surface lies below the point or within 20 km above it.
[[nodiscard]] std::optional<SurfaceUnder> SurfaceUnderPoint(const Terrain& terrain,
                                                            const glm::dvec3& point,
                                                            const glm::dvec3& up);
/// Height over the ellipsoid of the surface that an eye at a place is over.
[[nodiscard]] std::optional<double> GroundUnderEye(const Terrain& terrain, const LocalFrame& frame,
                                                   const GeodeticPosition& place);

/// The angle of the horizon below the horizontal, which is also its distance on the earth's curve
/// [radians], on a sphere without air.
[[nodiscard]] double HorizonDip(double height_m);

/// The samples of a grid within a distance [radians of the earth's curve] of a place, at least
/// 2 x 2; of a place outside of it those nearest to it.
[[nodiscard]] GridWindow WindowAround(const ElevationGrid& grid, const GeodeticPosition& place,
                                      double distance_rad);

struct ModelInSight {
  ElevationModel model;
  ElevationGrid extent;  // of the whole model, without heights
  std::string message;   // what is told about what was read; empty: nothing
};

/// The elevation model of a scene. One of more than 2^25 samples that CanBeCut is read as far as
/// ground of any height may be seen from the camera. Throws InputError as ReadElevation does, and
/// where there is no valid sample in sight.
[[nodiscard]] ModelInSight ReadModelInSight(const Scene& scene);

struct SceneGround {
  LocalFrame frame;                // ENU at the foot of the eye on the ellipsoid
  std::optional<Terrain> terrain;  // nothing: the ellipsoid alone
  double eye_height_m;             // over the ellipsoid
  std::string message;             // what loading has to tell, empty if nothing
  bool is_one_surface;             // no overhangs: see IsOneSurface
  /// The eye is over one surface of an elevation model that has no holes: below it all is ground.
  bool is_solid = false;
};

/// The ellipsoid that the scene's planet has: WGS84, or a sphere of the medium's radius.
[[nodiscard]] Ellipsoid EllipsoidOf(const Medium& medium);

/// Loads or generates the terrain and stands the eye on it. Throws InputError for files that cannot
/// be read, for an eye below the ground (of several surfaces: below the lowest), and for one outside an elevation model that stands on the
/// ground or is too low to see anything of it.
/// @param progress  told what is prepared, if not null.
[[nodiscard]] SceneGround LoadGround(const Scene& scene, Progress* progress = nullptr);

/// The scene's own eye.
[[nodiscard]] CameraStand StandOfScene(const SceneGround& ground);

/// An eye at another place: the frame stays that of the scene. Throws InputError where it is below
/// the ground (of several surfaces: below the lowest), or more than 500 km from the scene's place.
[[nodiscard]] CameraStand StandAt(const SceneGround& ground, const GeodeticPosition& place);

/// Height over the ellipsoid [m] of a scene's ground under a place: the highest of it, and 0 where
/// there is none. Throws InputError more than 500 km from the scene's place.
[[nodiscard]] double GroundHeightUnder(const SceneGround& ground, const GeodeticPosition& place);

/// The scene's camera, or one with its lens that takes these poses one after the other.
[[nodiscard]] MovingCamera CameraOn(const SceneGround& ground, const Camera& camera,
                                    std::span<const CameraPose> poses, int width, int height);

}  // namespace alpenglow::renderer
