// SPDX-License-Identifier: MIT
#include "viewer/shade/shafts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/visibility/heights_around.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

// Returns a row that maps a point in the eye's frame to its component along an axis of the map's
// frame, scaled and shifted.
glm::vec4 Row(const glm::dmat4& map_from_eye, const glm::dvec3& axis, double scale, double shift) {
  const auto along = [&](int column) {
    return scale * glm::dot(glm::dvec3(map_from_eye[column]), axis);
  };
  return {along(0), along(1), along(2), along(3) + shift};
}

}  // namespace

void ShadeTexture::TakeOver(std::shared_ptr<const SunShadowMap> map) {
  ALPENGLOW_ENSURE(map != nullptr, ==, true);
  coming_.map = std::move(map);
  lines_sent_ = 0;
}

bool ShadeTexture::Upload(int most_lines, int unit) {
  if (!coming_.map) return false;
  const SunShadowMap& map = *coming_.map;
  if (!map.ShadesNothing()) {
    BindTexture(unit, GL_TEXTURE_2D, coming_.texture);
    if (lines_sent_ == 0) {
      UploadTexture(GL_TEXTURE_2D, coming_.texture,
                    {GL_RG32F, map.columns, map.lines, 1, GL_RG, GL_FLOAT, nullptr});
    }
    const int lines = std::min(most_lines, map.lines - lines_sent_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, lines_sent_, map.columns, lines, GL_RG, GL_FLOAT,
                    &map.at(0, lines_sent_));
    lines_sent_ += lines;
    CheckGl("ShadeTexture::Upload");
  }
  if (lines_sent_ < map.lines) return false;
  std::swap(used_, coming_);
  coming_.map = nullptr;
  return true;
}

void ShadeTexture::Bind(const ShaderProgram& program, int unit, const glm::dmat4& map_from_eye,
                        const ShadeSteps& steps) const {
  ALPENGLOW_ENSURE(Shades(), ==, true);
  const SunShadowMap& map = *used_.map;
  BindTexture(unit, GL_TEXTURE_2D, used_.texture);
  glUniform1i(program.Uniform("shade_map"), unit);
  const double across_u = 1.0 / (map.cell_m * map.columns);
  const double across_v = 1.0 / (map.cell_m * map.lines);
  // Nodes are at texel centres.
  const auto u = [&](double u_m) { return (u_m - map.first_u_m + 0.5 * map.cell_m) * across_u; };
  const auto v = [&](double v_m) { return (v_m - map.first_v_m + 0.5 * map.cell_m) * across_v; };
  const auto set = [&](const char* name, const glm::vec4& row) {
    glUniform4f(program.Uniform(name), row.x, row.y, row.z, row.w);
  };
  set("shade_u", Row(map_from_eye, map.sunwards, across_u, u(0.0)));
  set("shade_v", Row(map_from_eye, map.across, across_v, v(0.0)));
  set("shade_z", Row(map_from_eye, {0.0, 0.0, 1.0}, 1.0, 0.0));
  const glm::vec3 low(u(map.low_u_m), v(map.low_v_m), map.floor_m);
  const glm::vec3 high(u(map.high_u_m), v(map.high_v_m), map.ceiling_m);
  glUniform3f(program.Uniform("shade_low"), low.x, low.y, low.z);
  glUniform3f(program.Uniform("shade_high"), high.x, high.y, high.z);
  glUniform2f(program.Uniform("shade_first"), static_cast<float>(u(map.first_u_m)),
              static_cast<float>(map.tangent / across_u));
  glUniform1i(program.Uniform("shade_pieces"), steps.pieces);
  glUniform1i(program.Uniform("shade_steps"), steps.steps);
}

std::vector<ShaderPiece> ShaftPassTexts(std::vector<ShaderPiece> air, bool has_media) {
  air.push_back(
      {"media of shafts",
       fmt::format("#define HAS_MEDIA {}\n#define LEFT_BY_MEDIA(direction, km) {}\n",
                   has_media ? 1 : 0,
                   has_media ? "MediaTransmittance(direction, min(km, kOutOfMedia_km))" : "1.0")});
  std::vector<std::string> files{"viewer/shaders/shafts/march.glsl",
                                 "viewer/shaders/shafts/texel.glsl"};
  if (has_media) files.emplace_back("viewer/shaders/shafts/media_march.glsl");
  return WithViewerPieces(std::move(air), files);
}

std::vector<ShaderPiece> ShaftTexts() {
  return WithViewerPieces(
      {}, {"viewer/shaders/shafts/texel.glsl", "viewer/shaders/shafts/picture.glsl"});
}

ShaftPass::ShaftPass(std::vector<ShaderPiece> air, bool has_media)
    : has_media_(has_media),
      program_(FullScreenProgram(WithViewerPieces(ShaftPassTexts(std::move(air), has_media),
                                                  {"viewer/shaders/shafts/shafts.frag.glsl"}))) {}

void ShaftPass::Paint(const ShadeTexture& shade, const glm::dmat4& map_from_eye, int width,
                      int height, int surface_unit, int shade_unit, const ShaftDetail& detail) {
  ALPENGLOW_ENSURE(detail.scale, >=, 1);
  scale_ = detail.scale;
  const auto part = [&](int side) { return (side + scale_ - 1) / scale_; };
  if (!map_ || map_->width() != part(width) || map_->height() != part(height)) {
    const std::vector<PixelFormat> maps(has_media_ ? 2 : 1, PixelFormat::kRgba32F);
    map_.emplace(part(width), part(height), maps, RenderTarget::Depth::kNone);
  }
  map_->Bind();
  program_.Use();
  shade.Bind(program_, shade_unit, map_from_eye, detail.steps);
  glUniform1i(program_.Uniform("surface_map"), surface_unit);
  glUniform2i(program_.Uniform("picture_size"), width, height);
  glUniform1i(program_.Uniform("shaft_scale"), scale_);
  DrawFullScreen(program_, no_vertices_);
  CheckGl("ShaftPass::Paint");
}

void ShaftPass::Bind(const ShaderProgram& picture, int unit) const {
  ALPENGLOW_ENSURE(map_.has_value(), ==, true);
  map_->BindTexture(unit);
  if (has_media_) map_->BindTexture(unit + 1, 1);
  picture.Use();
  glUniform1i(picture.Uniform("shaft_map"), unit);
  glUniform1i(picture.Uniform("media_shaft_map"), unit + 1);
  const float step = 1.0F / static_cast<float>(scale_);
  const float first = 0.5F + static_cast<float>(scale_ / 2);  // pixel of the first ray
  glUniform2f(picture.Uniform("shaft_place"), step, -first * step);
}

namespace {

constexpr double kSunStep = 0.2;     // fraction of the disk's radius
constexpr double kMostStep = 2.0;    // the same, of a light that brings little
constexpr double kPlaceStep = 0.2;   // fraction of the ground's half width
constexpr int kLinesOfAFrame = 256;  // two megabytes for a thousand columns

bool AreOne(const LocalFrame& a, const LocalFrame& b) {
  return a.origin().latitude_deg == b.origin().latitude_deg &&
         a.origin().longitude_deg == b.origin().longitude_deg;
}

}  // namespace

class ShadeFollower::Maker {
 public:
  std::shared_ptr<const Made> operator()(const Request& request) {
    const auto begin = std::chrono::steady_clock::now();
    if (!IsKept(request)) Keep(request);
    SunShadowMap map = heights_ ? SunShadowMapOf(*heights_, request.to_light, request.radius_rad,
                                                 request.size.cells)
                                : SunShadowMap{};
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    return std::make_shared<const Made>(
        Made{request.frame, request.to_light, std::move(map), took.count()});
  }

 private:
  [[nodiscard]] bool IsKept(const Request& request) const {
    return kept_ && kept_->ground == request.ground && kept_->size == request.size &&
           AreOne(kept_->frame, request.frame);
  }
  void Keep(const Request& request) {
    kept_ = request;
    heights_.reset();
    if (!request.ground) return;
    const ShadeSize& size = request.size;
    const auto grid = (*request.ground)(request.frame.origin(), size.half_width_m, size.samples);
    if (grid)
      heights_ = HeightsAround(*grid, request.frame, size.half_width_m,
                               size.nodes_a_sample * size.samples);
  }

  std::optional<Request> kept_;
  std::optional<HeightRaster> heights_;
};

ShadeFollower::ShadeFollower(const Ellipsoid& ellipsoid)
    : ellipsoid_(ellipsoid), maker_(Maker(), Suits) {}

void ShadeFollower::SetGround(GroundSampler sampler) {
  ground_ = sampler ? std::make_shared<const GroundSampler>(std::move(sampler)) : nullptr;
}

void ShadeFollower::SetSize(const ShadeSize& size) { size_ = size; }

ShadeFollower::Request ShadeFollower::RequestFor(const Place& eye, const DistantLight& light,
                                                 double share) const {
  const LocalFrame here(ellipsoid_, eye);
  LocalFrame frame(ellipsoid_, {eye.latitude_deg, eye.longitude_deg, 0.0});
  // Heights are kept while the eye is near their centre.
  const std::optional<Request>& last = maker_.requested();
  if (last && DistanceBetween(last->frame, frame) < kPlaceStep * size_.half_width_m)
    frame = last->frame;
  const Vector<Ecef> to_light = here.EcefFromEnu(Vector<Enu>{light.direction.seen});
  return {ground_,
          size_,
          frame,
          glm::normalize(frame.EnuFromEcef(to_light).xyz),
          light.radius_rad,
          std::min(kSunStep / share, kMostStep)};
}

bool ShadeFollower::Suits(const Request& requested, const Request& wanted) {
  return requested.ground == wanted.ground && requested.size == wanted.size &&
         AreOne(requested.frame, wanted.frame) &&
         glm::length(requested.to_light - wanted.to_light) < wanted.most_step * wanted.radius_rad;
}

void ShadeFollower::PollFinished() {
  std::optional<std::shared_ptr<const Made>> made = maker_.Poll();
  if (!made) return;
  coming_ = std::move(*made);
  texture_.TakeOver({coming_, &coming_->map});
}

void ShadeFollower::Upload(int lines, int unit) {
  if (!coming_) return;
  if (texture_.Upload(lines, unit)) used_ = std::exchange(coming_, nullptr);
}

void ShadeFollower::Follow(const Place& eye, const DistantLight& light, double share, int unit) {
  // If the sun moves faster than maps are made, a finished map must still be shown.
  if (!coming_) maker_.RequestWhenIdle(RequestFor(eye, light, share));
  if (!coming_) PollFinished();
  Upload(kLinesOfAFrame, unit);
}

void ShadeFollower::WaitUntilReady(const Place& eye, const DistantLight& light, int unit) {
  maker_.WaitUntilReady(RequestFor(eye, light, 1.0));
  PollFinished();
  Upload(std::numeric_limits<int>::max(), unit);
}

bool ShadeFollower::IsOf(const Place& eye, const DistantLight& light) const {
  const double near = std::cos(3.0 * kRadiansPerDegree);
  if (!used_) return false;
  const LocalFrame here(ellipsoid_, eye);
  const Vector<Ecef> to_light = here.EcefFromEnu(Vector<Enu>{light.direction.seen});
  return glm::dot(glm::normalize(used_->frame.EnuFromEcef(to_light).xyz), used_->to_light) > near;
}

glm::dmat4 ShadeFollower::MapFromEye(const Place& eye) const {
  ALPENGLOW_ENSURE(texture_.Shades(), ==, true);
  const FrameTransform to_map(used_->frame, LocalFrame(ellipsoid_, eye));
  glm::dmat4 map_from_eye(to_map.axes());
  map_from_eye[3] = glm::dvec4(to_map.origin_m(), 1.0);
  return map_from_eye;
}

}  // namespace alpenglow::viewer
