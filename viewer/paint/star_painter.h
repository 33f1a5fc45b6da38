// SPDX-License-Identifier: MIT
// Stars and planets over a picture: points whose light is spread over the pixels around them as
// star_pixels.h of the renderer does, so that their lux is the same at every size. At the border of
// a tile of a larger picture the two pixels next to it may miss the light of a star beyond.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "atmosphere/sun/moon_disk.h"
#include "renderer/light/star_light.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/paint/painted_view.h"

namespace alpenglow {

/// A star as star.vert.glsl reads it.
struct StarVertex {
  std::array<float, 3> direction;   // unit, east, north, up of the eye
  std::array<float, 4> irradiance;  // W m^-2 nm^-1, by band
};
static_assert(sizeof(StarVertex) == 28);

class StarPainter {
 public:
  /// @param program  of star.vert.glsl and star.frag.glsl, connected.
  explicit StarPainter(ShaderProgram program);

  /// The stars over a view. New where two seconds or a kilometre have passed: a quarter of a pixel
  /// at 60 degrees over 2000 pixels.
  void Prepare(const PaintedView& view, const MoonDisk& moon, const SolvedAir& air);
  /// None: the program alone is made ready.
  void PrepareNone();
  /// Adds them to what is bound, beside land. @param width, height  of the picture.
  void Paint(int width, int height) const;
  [[nodiscard]] bool HasPainted() const { return has_painted_; }

 private:
  void Upload(const std::vector<StarVertex>& stars);

  ShaderProgram program_;
  GlBuffer buffer_;
  GlVertexArray layout_;
  int count_ = 0;
  mutable bool has_painted_ = false;
  struct Known {
    Eye eye;
    UtcInstant now;
  };
  std::optional<Known> known_;
  std::optional<BandColour> colour_;
  std::vector<double> wavelengths_nm_;  // of colour_
};

}  // namespace alpenglow
