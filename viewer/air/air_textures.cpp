// SPDX-License-Identifier: MIT
#include "viewer/air/air_textures.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <tuple>
#include <utility>

#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/viewer_texts.h"

namespace alpenglow::viewer {
namespace {

enum Table : std::size_t { kSky, kThrough, kExtinction, kSingle, kDiffuse, kPhase, kToSun };

struct Slot {
  const char* sampler;
  GLenum target;
};
constexpr std::array<Slot, AirTextures::kUnits> kSlots{{{"air_sky", GL_TEXTURE_2D},
                                                        {"air_through", GL_TEXTURE_1D},
                                                        {"air_extinction", GL_TEXTURE_2D},
                                                        {"air_single", GL_TEXTURE_3D},
                                                        {"air_diffuse", GL_TEXTURE_3D},
                                                        {"air_phase", GL_TEXTURE_2D},
                                                        {"air_to_sun", GL_TEXTURE_2D}}};

// In place where the texture has this size already.
void UploadTexels(const GlTexture& texture, GLenum target, const AirTexels& texels,
                  bool same_size) {
  glBindTexture(target, texture.id());
  const void* data = texels.texel.data();
  const auto [width, height, depth] = std::tuple(texels.width, texels.height, texels.depth);
  if (target == GL_TEXTURE_1D) {
    glTexImage1D(target, 0, GL_RGBA32F, width, 0, GL_RGBA, GL_FLOAT, data);
  } else if (target == GL_TEXTURE_2D && same_size) {
    glTexSubImage2D(target, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, data);
  } else if (target == GL_TEXTURE_2D) {
    glTexImage2D(target, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, data);
  } else if (same_size) {
    glTexSubImage3D(target, 0, 0, 0, 0, width, height, depth, GL_RGBA, GL_FLOAT, data);
  } else {
    glTexImage3D(target, 0, GL_RGBA32F, width, height, depth, 0, GL_RGBA, GL_FLOAT, data);
  }
  ClampAndFilter(target, true);
  glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

// The aerosol's phase function twice: alone, and as the sky's rows have it, which AirTables bring.
AirTexels WithRowOfSky(const AirTexels& phase) {
  AirTexels both(phase.width, 2);
  for (const int row : {0, 1})
    std::copy(phase.texel.begin(), phase.texel.end(), both.texel.begin() + row * phase.width);
  return both;
}

/// First texel of an axis and the width of all, in texture coordinates: n nodes from `first` on of
/// `all`.
struct Axis {
  Axis(int first, int n, int all)
      : begin((static_cast<float>(first) + 0.5F) / static_cast<float>(all)),
        width(static_cast<float>(n - 1) / static_cast<float>(all)) {}
  float begin, width;
};

glm::vec4 RowsOf(int sky, int ground) {
  const Axis up(0, sky, sky + ground);
  const Axis down(sky, ground, sky + ground);
  return {up.begin, up.width, down.begin, down.width};
}

glm::vec4 AxesOf(int one, int other) {
  const Axis a(0, one, one);
  const Axis b(0, other, other);
  return {a.begin, a.width, b.begin, b.width};
}

}  // namespace

std::vector<ShaderPiece> AirTableTexts() {
  return WithViewerPieces({}, {"viewer/air/air_map.glsl", "viewer/shaders/air_tables.glsl"});
}

AirTextures::AirTextures() = default;

void AirTextures::Upload(const MediumTables& tables) {
  UploadTexels(texture_[kPhase], kSlots[kPhase].target, WithRowOfSky(tables.phase), false);
  UploadTexels(texture_[kToSun], kSlots[kToSun].target, tables.to_sun, false);
  const Axis phase(0, tables.phase.width, tables.phase.width);
  values_.phase_nodes = {phase.begin, phase.width, 0.0F, 0.0F};
  CheckGl("AirTextures::Upload");
}

void AirTextures::Upload(const AirTables& tables) {
  const bool same_size = std::exchange(size_, tables.size) == tables.size;
  const auto upload = [&](Table table, const AirTexels& texels) {
    UploadTexels(texture_[table], kSlots[table].target, texels, same_size);
  };
  upload(kSky, tables.sky);
  glBindTexture(GL_TEXTURE_2D, texture_[kPhase].id());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 1, tables.sky_phase.width, 1, GL_RGBA, GL_FLOAT,
                  tables.sky_phase.texel.data());
  upload(kThrough, tables.to_space);
  upload(kExtinction, tables.extinction);
  upload(kSingle, tables.single);
  upload(kDiffuse, tables.diffuse);
  const AirMap& map = tables.map;
  const AirTablesSize& size = tables.size;
  values_.shell = {map.altitude, map.ceiling, map.top, map.radius};
  const auto half_tangent = [](double angle) { return std::tan(0.5 * angle); };
  values_.ranges = {half_tangent(map.sky_range), half_tangent(map.air_sky_range),
                    half_tangent(map.ground_range), map.altitude > map.top ? 1.0 : 0.0};
  values_.crowding = {map.sky_crowding, map.ground_crowding, map.twilight_fall,
                      map.twilight_reference};
  values_.columns = AxesOf(size.sky_columns, size.columns);
  values_.sky_rows = RowsOf(size.sky_rows, size.sky_ground_rows);
  values_.through_rows = RowsOf(size.through_rows, size.through_ground_rows);
  values_.way_rows = RowsOf(size.rows, size.ground_rows);
  values_.extinction_rows = RowsOf(size.extinction_rows, size.extinction_ground_rows);
  values_.distances = AxesOf(size.distances, size.extinction_distances);
  values_.sky_mix = tables.sky_mix;
  values_.single_mix = tables.single_mix;
  CheckGl("AirTextures::Upload");
}

void AirTextures::SetView(double altitude_m, const SkySun& sun) {
  const double h = std::max(altitude_m, 0.0) / 1000.0;
  const auto radius = static_cast<double>(values_.shell.w);
  const double horizon = shared::HorizonCosine<double>(h, radius);
  const double flat = std::hypot(sun.for_air.x, sun.for_air.y);
  const glm::dvec2 azimuth = flat > 1e-9 ? glm::dvec2(sun.for_air) / flat : glm::dvec2(0.0, 1.0);
  values_.sun = {sun.for_air, 0.0};
  values_.sun_seen = {sun.seen, 0.0};
  values_.frame = {azimuth, -horizon, std::sqrt((1.0 - horizon) * (1.0 + horizon))};
}

void AirTextures::Prepare(const ShaderProgram& program, int first_unit, GLuint binding) {
  for (std::size_t i = 0; i < kSlots.size(); ++i)
    program.BindSampler(kSlots[i].sampler, first_unit + static_cast<int>(i));
  program.BindBlock("AirTables", binding);
}

void AirTextures::Bind(int first_unit, GLuint binding) const {
  for (std::size_t i = 0; i < kSlots.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(first_unit) + static_cast<GLenum>(i));
    glBindTexture(kSlots[i].target, texture_[i].id());
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, block_.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(values_), &values_, GL_DYNAMIC_DRAW);
}

}  // namespace alpenglow::viewer
