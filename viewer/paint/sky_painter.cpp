// SPDX-License-Identifier: MIT
#include "viewer/paint/sky_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "atmosphere/number/constants.h"
#include "atmosphere/number/quadrature.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/text/error.h"
#include "renderer/ground/surface.h"
#include "renderer/light/aerial_perspective.h"
#include "renderer/picture/render.h"
#include "viewer/gl/gl_context.h"
#include "viewer/paint/full_screen.h"

namespace alpenglow {
namespace {

constexpr GLuint kAirBinding = 0;
constexpr GLuint kViewBinding = 1;
constexpr GLuint kMomentBinding = 2;
constexpr GLuint kGroundBinding = 3;
constexpr GLuint kPhaseBinding = 4;

enum TextureUnit {
  kSurfaceUnit,
  kDiffuseMomentsUnit,
  kDiffuseSkyUnit,
  kSunShadowUnit,
  kPictureUnit,
};

constexpr int kSkyNodes = AerialPerspective::Nodes{}.sky;  // Gauss nodes of a panel of a ray
constexpr int kNearNodes = 4;                              // of one to terrain within 50 km
constexpr int kDiffuseSkySide = 96;   // texels of the map of diffuse light, azimuth and elevation
constexpr int kMomentSuns = 512;      // finer than DiffuseLight's nodes: bilinear for its cubic, in
constexpr int kMomentAltitudes = 96;  // twilight, where light falls by e a degree, to 5e-4

void UploadRules(const ShaderProgram& program) {
  std::vector<float> pairs;
  for (const int nodes : {kSkyNodes, kNearNodes}) {
    const GaussRule& rule = GaussLegendre(nodes);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      pairs.push_back(static_cast<float>(rule.node[i]));
      pairs.push_back(static_cast<float>(rule.weight[i]));
    }
  }
  program.Use();
  glUniform2fv(program.Uniform("gauss"), static_cast<GLsizei>(pairs.size() / 2), pairs.data());
}

void UploadBlock(const GlBuffer& buffer, GLuint binding, const void* bytes, std::size_t size) {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
  glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(size), bytes, GL_DYNAMIC_DRAW);
}

// Moments and sky irradiance as one layer a channel, resampled by DiffuseLight's own interpolation.
void UploadMoments(const DiffuseLight& diffuse) {
  const std::size_t layers = diffuse.channels();
  const std::size_t bands = diffuse.bands();
  constexpr std::size_t kTexels = std::size_t{kMomentSuns} * kMomentAltitudes;
  std::vector<glm::vec4> texels(layers * kTexels, glm::vec4(0.0F));
  for (int altitude = 0; altitude < kMomentAltitudes; ++altitude) {
    for (int sun = 0; sun < kMomentSuns; ++sun) {
      const std::vector<float> values =
          diffuse.ValuesAt(altitude / (kMomentAltitudes - 1.0), sun / (kMomentSuns - 1.0));
      const auto texel = static_cast<std::size_t>(altitude * kMomentSuns + sun);
      for (std::size_t layer = 0; layer < layers; ++layer) {
        glm::vec4& target = texels[layer * kTexels + texel];
        for (std::size_t band = 0; band < bands; ++band) {
          target[static_cast<glm::length_t>(band)] = values[layer * bands + band];
        }
      }
    }
  }
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, kMomentSuns, kMomentAltitudes,
               static_cast<GLsizei>(layers), 0, GL_RGBA, GL_FLOAT, texels.data());
  ClampAndFilter(GL_TEXTURE_2D_ARRAY, true);
}

void BindTexture(TextureUnit unit, GLenum target, const GlTexture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(target, texture.id());
}

// (Re)makes a target when it is missing or of another size.
void Fit(std::optional<RenderTarget>& target, int width, int height, RenderTarget::Depth depth) {
  if (target && target->width() == width && target->height() == height) return;
  target.emplace(width, height, depth);
}

}  // namespace

std::vector<ShaderPiece> LightTexts(int degree) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  pieces.push_back(
      {"constants", fmt::format("#define DEGREE {}\n#define SKY_RULE 0\n#define SKY_NODES {}\n"
                                "#define NEAR_RULE {}\n#define NEAR_NODES {}\n",
                                degree, kSkyNodes, kSkyNodes, kNearNodes)});
  for (const char* name : {"viewer/shaders/air_block.glsl", "viewer/shaders/view_block.glsl",
                           "viewer/shaders/air_ray.glsl", "viewer/shaders/diffuse_light.glsl",
                           "viewer/shaders/air_light.glsl", "viewer/shaders/diffuse_sky_map.glsl",
                           "viewer/shaders/sun_light.glsl", "viewer/shaders/ground.glsl"}) {
    pieces.push_back(ViewerPiece(name));
  }
  return pieces;
}

SkyPainter::SkyPainter(const Medium& medium, const DiffuseLight& diffuse, const TriangleMesh& mesh,
                       const LocalFrame& frame, bool relief)
    : medium_(medium),
      ellipsoid_(frame.ellipsoid()),
      terrain_(mesh, frame),
      diffuse_sky_program_(FullScreenProgram(LightTexts(diffuse.options().degree),
                                             "viewer/shaders/diffuse_sky.frag.glsl")),
      picture_program_(FullScreenProgram(LightTexts(diffuse.options().degree),
                                         "viewer/shaders/picture.frag.glsl")),
      average_program_(FullScreenProgram({}, "viewer/shaders/average.frag.glsl")),
      relief_(relief) {
  const MomentBlock moments = MomentBlockOf(medium, diffuse.options().degree);
  UploadBlock(moment_block_, kMomentBinding, moments.data(), moments.size() * sizeof(moments[0]));
  const PhaseBlock phase = PhaseBlockOf(medium);
  UploadBlock(phase_block_, kPhaseBinding, phase.data(), sizeof(phase));
  BindTexture(kDiffuseMomentsUnit, GL_TEXTURE_2D_ARRAY, diffuse_moments_);
  UploadMoments(diffuse);
  BindTexture(kDiffuseSkyUnit, GL_TEXTURE_2D_ARRAY, diffuse_sky_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, kDiffuseSkySide, kDiffuseSkySide, 2, 0, GL_RGBA,
               GL_FLOAT, nullptr);
  ClampAndFilter(GL_TEXTURE_2D_ARRAY, true);
  for (const ShaderProgram* program : {&diffuse_sky_program_, &picture_program_}) {
    UploadRules(*program);
    program->BindBlock("Air", kAirBinding);
    program->BindBlock("View", kViewBinding);
    program->BindBlock("Moments", kMomentBinding);
    program->BindBlock("Ground", kGroundBinding);
    program->BindBlock("PhaseTable", kPhaseBinding);
    program->BindSampler("diffuse_moments", kDiffuseMomentsUnit);
  }
  picture_program_.BindSampler("surface_map", kSurfaceUnit);
  picture_program_.BindSampler("diffuse_sky", kDiffuseSkyUnit);
  picture_program_.BindSampler("sun_shadow", kSunShadowUnit);
  average_program_.BindSampler("larger", kPictureUnit);
  CheckGl("SkyPainter");
}

void SkyPainter::UploadView(const Eye& eye, const SunPosition& sun, int width, int height) {
  Medium here = medium_;
  if (here.follows_wgs84) {
    here.planet_radius_m = OsculatingRadius(kWgs84, eye.place.latitude_rad);
  }
  const AirBlock air = AirBlockOf(here);
  UploadBlock(air_block_, kAirBinding, &air, sizeof(air));

  const ViewAxes axes = AxesOf(eye);
  const double half_width = std::tan(0.5 * eye.fov_rad);
  const double half_height = half_width * height / width;
  const double h = std::max(eye.place.height_m, 0.0) / 1000.0;
  const double radius = here.planet_radius_m / 1000.0;
  const double top = here.atmosphere_height_m / 1000.0;
  const double horizon = shared::HorizonCosine(h, radius);
  const double air_elevation =
      h > top ? std::asin(-std::sqrt((h - top) * (2.0 * radius + h + top)) / (radius + h))
              : 0.5 * kPi;
  glm::vec4 irradiance = GpuBandsOf(here.solar_irradiance);
  irradiance /= static_cast<float>(sun.distance_au * sun.distance_au);
  const ViewBlock view{{glm::vec3(half_width * axes.right), 0.0F},
                       {glm::vec3(half_height * axes.up), 0.0F},
                       {glm::vec3(axes.forward), 0.0F},
                       {glm::vec3(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz),
                        sun.angular_radius_rad},
                       irradiance,
                       {h, std::asin(horizon), air_elevation, 0.0}};
  UploadBlock(view_block_, kViewBinding, &view, sizeof(view));
}

void SkyPainter::UploadGround(const Eye& eye, const UtcInstant& instant) {
  const GeodeticPosition& origin = terrain_.frame().origin();
  const MountainSurface surface(medium_.wavelengths_nm,
                                CoverInSeason(origin.latitude_rad, instant.modified_julian_day));
  const double radius = medium_.follows_wgs84 ? OsculatingRadius(kWgs84, origin.latitude_rad)
                                              : medium_.planet_radius_m;
  const glm::dmat4 mesh_from_eye = terrain_.MeshFromEye(eye.place);
  const double east_m =
      origin.longitude_rad * std::cos(origin.latitude_rad) * radius + mesh_from_eye[3].x;
  const double north_m = origin.latitude_rad * radius + mesh_from_eye[3].y;
  GroundBlock block = GroundBlockOf(surface, east_m, north_m, relief_);
  // The columns are the eye's axes in the mesh's frame; the rows are the mesh's in the eye's.
  const auto row = [&](glm::length_t axis) {
    return glm::vec4(mesh_from_eye[0][axis], mesh_from_eye[1][axis], mesh_from_eye[2][axis], 0.0);
  };
  block.mesh_east = row(0);
  block.mesh_north = row(1);
  block.mesh_up = row(2);
  UploadBlock(ground_block_, kGroundBinding, &block, sizeof(block));
}

void SkyPainter::PaintDiffuseSky() const {
  glBindFramebuffer(GL_FRAMEBUFFER, diffuse_sky_target_.id());
  glViewport(0, 0, kDiffuseSkySide, kDiffuseSkySide);
  diffuse_sky_program_.Use();
  glUniform2f(diffuse_sky_program_.Uniform("map_size"), kDiffuseSkySide, kDiffuseSkySide);
  for (int layer = 0; layer < 2; ++layer) {
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, diffuse_sky_.id(), 0, layer);
    glUniform1f(diffuse_sky_program_.Uniform("layer"), static_cast<float>(layer));
    DrawFullScreen(diffuse_sky_program_, no_vertices_);
  }
}

void SkyPainter::PaintPicture(const Eye& eye, const RenderTarget& target, float pixel_angle) const {
  target.Bind();
  surface_->BindTexture(kSurfaceUnit);
  BindTexture(kDiffuseMomentsUnit, GL_TEXTURE_2D_ARRAY, diffuse_moments_);
  BindTexture(kDiffuseSkyUnit, GL_TEXTURE_2D_ARRAY, diffuse_sky_);
  terrain_.BindShadow(kSunShadowUnit);
  picture_program_.Use();
  const glm::mat4 shadow = terrain_.ShadowFromEye(eye.place);
  glUniformMatrix4fv(picture_program_.Uniform("shadow_from_eye"), 1, GL_FALSE,
                     glm::value_ptr(shadow));
  glUniform1f(picture_program_.Uniform("shadow_texel"), terrain_.shadow_texel_m());
  glUniform1f(picture_program_.Uniform("pixel_angle"), pixel_angle);
  glUniform1f(
      picture_program_.Uniform("sample_angle"),
      pixel_angle * static_cast<float>(picture_->width()) / static_cast<float>(target.width()));
  DrawFullScreen(picture_program_, no_vertices_);
}

void SkyPainter::Paint(const Eye& eye, const UtcInstant& instant, int width, int height,
                       int samples) {
  const SunPosition sun = ApparentSunAt(eye.place, instant);
  const int side = static_cast<int>(std::lround(std::sqrt(samples)));
  Fit(surface_, width * side, height * side, RenderTarget::Depth::k32Bit);
  Fit(picture_, width, height, RenderTarget::Depth::kNone);
  if (side > 1) Fit(samples_, width * side, height * side, RenderTarget::Depth::kNone);
  const RenderTarget& target = side > 1 ? *samples_ : *picture_;

  UploadView(eye, sun, width, height);
  UploadGround(eye, instant);
  const LocalFrame here(ellipsoid_, eye.place);
  terrain_.CastShadow(here.EcefFromEnu(DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad)));
  surface_->Bind();
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  terrain_.DrawSurface(eye.place, kViewBinding);
  PaintDiffuseSky();
  PaintPicture(eye, target, static_cast<float>(2.0 * std::tan(0.5 * eye.fov_rad) / width));
  if (side > 1) {
    picture_->Bind();
    samples_->BindTexture(kPictureUnit);
    average_program_.Use();
    glUniform1i(average_program_.Uniform("samples"), side);
    DrawFullScreen(average_program_, no_vertices_);
  }
  CheckGl("SkyPainter::Paint");
}

Image SkyPainter::Read() const {
  ALPENGLOW_ENSURE(picture_.has_value(), ==, true);
  return picture_->Read();
}

double SkyPainter::MeteredEv100() {
  ALPENGLOW_ENSURE(picture_.has_value(), ==, true);
  constexpr int kLongSide = 160;
  const int longest = std::max(picture_->width(), picture_->height());
  const auto shrunk = [&](int side) {
    return std::clamp(side * kLongSide / longest, 1, std::max(side, 1));
  };
  Fit(meter_, shrunk(picture_->width()), shrunk(picture_->height()), RenderTarget::Depth::kNone);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture_->framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, meter_->framebuffer());
  glBlitFramebuffer(0, 0, picture_->width(), picture_->height(), 0, 0, meter_->width(),
                    meter_->height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
  return MeterEv100(meter_->Read(), kSunDiskLuminance_cd_per_m2);
}

void SkyPainter::Develop(double ev100, GLuint framebuffer) const {
  ALPENGLOW_ENSURE(picture_.has_value(), ==, true);
  developer_.Develop(*picture_, ev100, {framebuffer, picture_->width(), picture_->height()});
}

}  // namespace alpenglow
