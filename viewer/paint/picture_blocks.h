// SPDX-License-Identifier: MIT
// The uniform blocks of a picture: what its programs read of the air, the view and the ground, on
// its way to the card.
#pragma once

#include <glm/vec2.hpp>
#include <memory>

#include "atmosphere/sun/sun.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/paint/key_light.h"
#include "viewer/paint/painted_scene.h"
#include "viewer/paint/painted_view.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow::viewer {

/// Each call fills blocks and binds them (PictureBinding).
class PictureBlocks {
 public:
  void UploadAir(const PaintedScene& scene, const Eye& eye);
  /// @param ray  that is painted of each pixel.
  void UploadView(const PaintedScene& scene, const PaintedView& view, const KeyLight& key,
                  const PixelRay& ray) const;
  void UploadGround(const PaintedScene& scene, const PaintedView& view) const;
  void UploadGroundLight(const PaintedScene& scene, const PaintedView& view,
                         const KeyLight& light) const;
  /// Nothing where vertices have the sky's light.
  void UploadSkyByPixel(const PaintedScene& scene, const PaintedView& view,
                        const KeyLight& light) const;

 private:
  GlBuffer air_, view_, ground_, ground_light_, ground_surface_, sky_by_pixel_;
  // Of the air that was drawn last: colours of its bands take milliseconds.
  std::shared_ptr<const SolvedAir> known_air_;
  AirBlock air_block_{};
};

}  // namespace alpenglow::viewer
