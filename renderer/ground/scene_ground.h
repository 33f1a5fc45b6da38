// SPDX-License-Identifier: MIT
// The ground of a scene: terrain ready for rays, in the frame of the eye.
#pragma once

#include <optional>
#include <string>

#include "lut/program/progress.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"
#include "renderer/terrain/terrain.h"

namespace alpenglow::renderer {

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

}  // namespace alpenglow::renderer
