// SPDX-License-Identifier: MIT
// Measures shafts on the GPU over the built-in range: the time of the map, of the pass and of
// interpolation between rays, and the error relative to ShadowHeights away from edges.
//
// The air is replaced by light that accumulates exponentially, over 12 to 80 km. The fraction of
// this light that arrives is compared.
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/terrain/terrain.h"
#include "renderer/visibility/heights_around.h"
#include "renderer/visibility/shadow_heights.h"
#include "renderer/visibility/sun_shadow_map.h"
#include "tests/bench/studies.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_context.h"
#include "viewer/shade/shafts.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr double kSunRadius_rad = 0.00465;
constexpr double kReach_km = 25.0;  // of the band that is compared
constexpr int kSurfaceUnit = 0, kShadeUnit = 1, kShaftUnit = 2;
constexpr GLuint kViewBinding = 1;

double Milliseconds() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

struct View {
  ElevationGrid grid;
  LocalFrame frame;
  Terrain terrain;
  glm::dvec3 right, up, forward;  // as in ViewBlock
  Place place;
  glm::dmat4 mesh_from_eye{1.0};
  std::vector<float> distance_m;  // starts with the lowest row
};

glm::dvec3 DirectionAt(const View& view, int x, int y) {
  return glm::normalize(view.forward + ((2.0 * x + 1.0) / kWidth - 1.0) * view.right +
                        ((2.0 * y + 1.0) / kHeight - 1.0) * view.up);
}

glm::dvec3 InMesh(const View& view, const glm::dvec3& direction) {
  return glm::dvec3(view.mesh_from_eye * glm::dvec4(direction, 0.0));
}

View TheView() {
  const Place centre{46.5, 8.0, 0.0};
  ElevationGrid grid = ProceduralMountains(centre);
  CameraPose eye = ProceduralMountainsView(centre, grid);
  eye.pitch_rad = 0.0;
  const LocalFrame frame(kWgs84, centre), here(kWgs84, eye.place);
  Terrain terrain(MeshFromElevation(grid, frame));
  const ViewAxes axes = AxesOf(eye);
  const double half = std::tan(0.5 * eye.fov_rad);
  View view{std::move(grid),
            frame,
            std::move(terrain),
            half * axes.right,
            half * kHeight / kWidth * axes.up,
            axes.forward,
            eye.place,
            glm::dmat4(1.0),
            {}};
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    view.mesh_from_eye[axis] =
        glm::dvec4(frame.EnuFromEcef(here.EcefFromEnu(Vector<Enu>{unit})).xyz, 0.0);
  }
  view.mesh_from_eye[3] = glm::dvec4(frame.EnuFromGeodetic(eye.place).xyz, 1.0);
  view.distance_m.resize(static_cast<std::size_t>(kWidth) * kHeight);
  tbb::parallel_for(0, kHeight, [&](int y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto hit = view.terrain.Intersect(glm::dvec3(view.mesh_from_eye[3]),
                                              InMesh(view, DirectionAt(view, x, y)));
      view.distance_m[static_cast<std::size_t>(y * kWidth + x)] =
          hit ? static_cast<float>(hit->distance_m) : 0.0F;
    }
  });
  return view;
}

float DistanceAt(const View& view, int x, int y) {
  return view.distance_m[static_cast<std::size_t>(y * kWidth + x)];
}

bool IsAtAnEdge(const View& view, int x, int y) {
  const float here_m = DistanceAt(view, x, y);
  for (int j = std::max(y - 2, 0); j <= std::min(y + 2, kHeight - 1); ++j) {
    for (int i = std::max(x - 2, 0); i <= std::min(x + 2, kWidth - 1); ++i) {
      const float there_m = DistanceAt(view, i, j);
      if (std::abs(there_m - here_m) > 0.2F * std::max(there_m, here_m)) return true;
    }
  }
  return false;
}

// Returns the fraction of the light of a ray that comes from its sunlit segments.
double LitShare(const SunlitPath& lit, double length_m) {
  const auto upto = [](double distance_m) {
    return 1.0 - std::exp(-1e-3 * distance_m / kReach_km);
  };
  double sum = 0.0;
  for (const SunlitPiece& piece : lit) {
    constexpr int kParts = 8;
    for (int i = 0; i < kParts; ++i) {
      const double begin = i / double{kParts}, end = (i + 1) / double{kParts};
      const double x = piece.begin_x + 0.5 * (begin + end) * (piece.end_x - piece.begin_x);
      sum += SunlightOverEdge(x) * (upto(piece.begin_m + end * piece.length_m()) -
                                    upto(piece.begin_m + begin * piece.length_m()));
    }
  }
  return sum / upto(length_m);
}

/// Returns the sunlit fractions, starting with the lowest row; -1 at edges.
std::vector<double> Reference(const View& view, const glm::dvec3& to_sun) {
  const ShadowHeights heights(view.terrain.mesh(), to_sun, kSunRadius_rad);
  std::vector<double> shares(view.distance_m.size(), -1.0);
  tbb::parallel_for(0, kHeight, [&](int y) {
    for (int x = 0; x < kWidth; ++x) {
      if (IsAtAnEdge(view, x, y)) continue;
      const double distance_m = static_cast<double>(DistanceAt(view, x, y));
      const double length_m = distance_m > 0.0 ? distance_m : 500e3;
      shares[static_cast<std::size_t>(y * kWidth + x)] =
          LitShare(heights.Along(glm::dvec3(view.mesh_from_eye[3]),
                                 InMesh(view, DirectionAt(view, x, y)), length_m),
                   length_m);
    }
  });
  return shares;
}

std::vector<ShaderPiece> AirTexts() {
  return {ViewerPiece("viewer/shaders/view/block.glsl"),
          {"air",
           "vec4 SingleTo(vec3 direction, float distance_km) {\n"
           "  return 1.0 - exp(-distance_km / vec4(25.0, 12.0, 45.0, 80.0));\n}\n"
           "vec4 SkyRadiance(vec3 direction) { return SingleTo(direction, 1e9); }\n"}};
}

class Picture {
 public:
  explicit Picture(const View& view)
      : pass_(AirTexts()), program_(FullScreenProgram(Texts())), target_(kWidth, kHeight) {
    UploadView(view);
    pass_.program().BindBlock("View", kViewBinding);
    std::vector<glm::vec4> texels;
    for (const float distance_m : view.distance_m)
      texels.emplace_back(0.0F, 0.0F, 0.0F, distance_m);
    glActiveTexture(GL_TEXTURE0 + kSurfaceUnit);
    glBindTexture(GL_TEXTURE_2D, surface_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kWidth, kHeight, 0, GL_RGBA, GL_FLOAT,
                 texels.data());
    ClampAndFilter(GL_TEXTURE_2D, false);
  }

  struct Times {
    double pass_ms = 1e9, between_ms = 1e9;
  };
  Times Paint(const ShadeTexture& shade, const glm::dmat4& map_from_eye,
              const ShaftDetail& detail) {
    Times best;
    for (int run = 0; run < 5; ++run) {
      const double begin = Milliseconds();
      pass_.Paint(shade, map_from_eye, kWidth, kHeight, kSurfaceUnit, kShadeUnit, detail);
      glFinish();
      const double middle = Milliseconds();
      target_.Bind();
      pass_.Bind(program_, kShaftUnit);
      program_.BindSampler("surface_map", kSurfaceUnit);
      DrawFullScreen(program_, no_vertices_);
      glFinish();
      best.pass_ms = std::min(best.pass_ms, middle - begin);
      best.between_ms = std::min(best.between_ms, Milliseconds() - middle);
    }
    return best;
  }
  [[nodiscard]] HdrImage Read() const { return target_.Read(); }

 private:
  void UploadView(const View& view) const {
    ViewBlock block{};
    block.view_right = {glm::vec3(view.right), 0.0F};
    block.view_up = {glm::vec3(view.up), 0.0F};
    block.view_forward = {glm::vec3(view.forward), 0.0F};
    glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, view_.id());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_STATIC_DRAW);
  }

  static std::vector<ShaderPiece> Texts() {
    std::vector<ShaderPiece> texts = ShaftTexts();
    texts.push_back({"picture",
                     "uniform sampler2D surface_map;\nout vec4 picture;\nvoid main() {\n"
                     "  float way = texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0).w;\n"
                     "  way = way > 0.0 ? 1e-3 * way : 1e9;\n"
                     "  picture = 1.0 - TakenByShade(way, vec4(1.0));\n}\n"});
    return texts;
  }

  GlBuffer view_;
  ShaftPass pass_;
  ShaderProgram program_;
  RenderTarget target_;
  GlTexture surface_;
  GlVertexArray no_vertices_;
};

void PrintErrors(const HdrImage& image, const std::vector<double>& reference) {
  std::vector<double> errors;
  double sum = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double share = reference[static_cast<std::size_t>(y * kWidth + x)];
      if (share < 0.0) continue;
      errors.push_back(std::abs(static_cast<double>(image.at(x, kHeight - 1 - y)[0]) - share));
      sum += errors.back();
    }
  }
  std::sort(errors.begin(), errors.end());
  const auto quantile = [&](double at) {
    return 100.0 * errors[static_cast<std::size_t>(at * static_cast<double>(errors.size() - 1))];
  };
  fmt::print("mean {:.2f} % p90 {:.2f} % p99 {:.2f} % p99.9 {:.2f} %\n",
             100.0 * sum / static_cast<double>(errors.size()), quantile(0.9), quantile(0.99),
             quantile(0.999));
}

void Compare() {
  const HeadlessContext context;
  const View view = TheView();
  Picture picture(view);
  for (const double degrees : {15.0, 8.0, 3.0, 1.0}) {
    for (const double beside : {10.0, 160.0}) {
      const double elevation = degrees * kRadiansPerDegree;
      const double azimuth =
          std::atan2(view.forward.x, view.forward.y) + beside * kRadiansPerDegree;
      const glm::dvec3 to_sun = glm::normalize(InMesh(view, EnuFromAngles(elevation, azimuth).xyz));
      const std::vector<double> reference = Reference(view, to_sun);
      for (const auto& [name, quality] :
           {std::pair{"low", kLowShade}, std::pair{"medium", kMediumShade},
            std::pair{"high", kHighShade}}) {
        const double begin = Milliseconds();
        const HeightRaster heights = HeightsAround(
            view.grid, view.frame, 36e3, quality.size.nodes_a_sample * quality.size.samples);
        const double middle = Milliseconds();
        const auto map = std::make_shared<SunShadowMap>(
            SunShadowMapOf(heights, to_sun, kSunRadius_rad, quality.size.cells));
        const double end = Milliseconds();
        ShadeTexture shade;
        shade.TakeOver(map);
        shade.Upload(map->lines, kShadeUnit);
        const auto times = picture.Paint(shade, view.mesh_from_eye, quality.detail);
        fmt::print(
            "{:2g} deg {:3g} beside {:6}: heights {:5.1f} ms map {:5.1f} ms pass {:6.1f} ms "
            "between {:4.1f} ms; ",
            degrees, beside, name, middle - begin, end - middle, times.pass_ms, times.between_ms);
        PrintErrors(picture.Read(), reference);
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer

void alpenglow::tests::ShadeError(int /*count*/, char** /*arguments*/) { viewer::Compare(); }
