// SPDX-License-Identifier: MIT
// A ShadeMap on the graphics card, taken over line by line while the one before is in use.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/shade/shade_map.h"

namespace alpenglow::viewer {

/// How finely rays are stepped through: shade_march.glsl.
struct ShadeSteps {
  int pieces;  // of a ray's stretch, one look at the table of the air each
  int steps;   // of a piece, one look at the map each
};

class ShadeTexture {
 public:
  /// A map to take over; one that is being taken over is given up.
  void TakeOver(std::shared_ptr<const ShadeMap> map);
  /// Sends up to so many of its lines, by way of a texture unit; once all are there the map is in use. Nothing to do: nothing
  /// is done.
  /// Returns whether a map came into use.
  bool Upload(int most_lines, int unit);

  /// Whether there is a map in use, and it shades anything.
  [[nodiscard]] bool Shades() const { return used_.map && !used_.map->ShadesNothing(); }
  /// The map in use. Only where Shades().
  [[nodiscard]] const ShadeMap& map() const { return *used_.map; }

  /// Gives the program in use what shade_march.glsl reads. Only where Shades().
  /// @param map_from_eye  from metres in the frame (east, north, up) at the eye to those of the
  ///                      frame of the map's heights.
  void Bind(const ShaderProgram& program, int unit, const glm::dmat4& map_from_eye,
            const ShadeSteps& steps) const;

 private:
  struct Held {
    GlTexture texture;
    std::shared_ptr<const ShadeMap> map;
  };
  Held used_, coming_;
  int lines_sent_ = 0;
};

}  // namespace alpenglow::viewer
