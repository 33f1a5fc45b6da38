// SPDX-License-Identifier: MIT
// Pictures of sky and terrain on the graphics card, by the same formulas as SceneRenderer
// (render.h): the shared texts, the same quadrature, the same table of diffuse light.
//
// A frame is five passes: the terrain's shadow (when the sun has moved), distance and normal of the
// terrain, a map of the diffuse light around the eye, the linear picture, and its development for a
// display. Differences from SceneRenderer: shadows of terrain come from a map of
// TerrainSurface::kShadowSize texels instead of rays, diffuse light of sky rays from the map.
#pragma once

#include <optional>

#include "atmosphere/sun/sun.h"
#include "lut/diffuse/multiple_scattering.h"
#include "lut/picture/image.h"
#include "renderer/terrain/mesh.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/paint/developer.h"
#include "viewer/paint/terrain_surface.h"

namespace alpenglow {

class SkyPainter {
 public:
  /// @param medium  at most four wavelengths, else InputError.
  /// @param diffuse solved for `medium`.
  /// @param mesh    terrain in `frame`; without triangles there is the bare planet.
  /// @param relief  draw relief finer than the mesh (see MountainSurface).
  SkyPainter(const Medium& medium, const DiffuseLight& diffuse, const TriangleMesh& mesh,
             const LocalFrame& frame, bool relief);

  /// Paints the linear picture. The sphere under the eye osculates the ellipsoid there, if the
  /// medium follows WGS84; the instant says where the sun stands and what season it is.
  /// @param samples rays a pixel, a square number.
  void Paint(const Eye& eye, const UtcInstant& instant, int width, int height, int samples = 1);

  /// The picture painted last: linear sRGB [cd/m^2].
  [[nodiscard]] Image Read() const;
  /// What MeterEv100 makes of a small copy of the picture.
  [[nodiscard]] double MeteredEv100();
  /// Develops the picture into a framebuffer (0: the window) of the picture's size.
  void Develop(double ev100, GLuint framebuffer) const;

 private:
  void UploadView(const Eye& eye, const SunPosition& sun, int width, int height);
  void UploadGround(const Eye& eye, const UtcInstant& instant);
  void PaintDiffuseSky() const;
  void PaintPicture(const Eye& eye, const RenderTarget& target, float pixel_angle) const;

  Medium medium_;
  Ellipsoid ellipsoid_;
  TerrainSurface terrain_;
  GlVertexArray no_vertices_;
  GlBuffer air_block_, view_block_, moment_block_, phase_block_, ground_block_;
  ShaderProgram diffuse_sky_program_, picture_program_, average_program_;
  GlTexture diffuse_moments_, diffuse_sky_;
  Developer developer_{ToneCurve::kAgx};
  GlFramebuffer diffuse_sky_target_;
  std::optional<RenderTarget> surface_, samples_, picture_, meter_;
  bool relief_;
};

/// Everything that lights rays: shared texts, uniform blocks and the loops over them, for diffuse
/// light of this degree.
[[nodiscard]] std::vector<ShaderPiece> LightTexts(int degree);

}  // namespace alpenglow
