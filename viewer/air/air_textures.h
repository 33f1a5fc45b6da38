// SPDX-License-Identifier: MIT
// The tables of air_tables.h on the graphics card, for air_tables.glsl.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "viewer/air/air_tables.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

/// Where a sun stands, as unit vectors in the frame of the eye, east, north, up, and where its straight
/// rays light the air from (SunForAir of sun.h).
struct SkySun {
  glm::dvec3 seen, for_air;
  bool operator==(const SkySun&) const = default;
};

/// `block AirTables` of air_tables.glsl.
struct AirTablesBlock {
  glm::vec4 sun, sun_seen, frame, shell, ranges, crowding, columns;
  glm::vec4 sky_rows, through_rows, way_rows, extinction_rows, distances, phase_nodes;
  std::array<glm::vec4, 3> sky_mix;
  std::array<glm::vec4, 2> single_mix;
};
static_assert(sizeof(AirTablesBlock) == 18 * sizeof(glm::vec4));

/// Pieces of a shader that calls the functions of air_tables.glsl, after SharedTexts().
[[nodiscard]] std::vector<ShaderPiece> AirTableTexts();

/// Belongs to the context that is current when it is made.
class AirTextures {
 public:
  static constexpr int kUnits = 7;

  AirTextures();

  void Upload(const MediumTables& tables);
  void Upload(const AirTables& tables);

  /// What is uploaded as an eye sees it that has moved since, by less than what asks for new tables:
  /// rows count from its own horizon, azimuths from its own sun.
  void SetView(double altitude_m, const SkySun& sun);

  /// Once a program: its samplers read from units first_unit to first_unit + kUnits - 1, its block
  /// from `binding`.
  static void Prepare(const ShaderProgram& program, int first_unit, GLuint binding);

  /// For draws of prepared programs.
  void Bind(int first_unit, GLuint binding) const;

 private:
  std::array<GlTexture, kUnits> texture_;
  std::optional<AirTablesSize> size_;  // of what is uploaded
  GlBuffer block_;
  AirTablesBlock values_{};
};

}  // namespace alpenglow::viewer
