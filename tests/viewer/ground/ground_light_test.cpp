// SPDX-License-Identifier: MIT
// What the ground sends to the eye on the graphics card, against the renderer's.
#include "renderer/picture/ground_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/halton.h"
#include "tests/viewer/ground/rough_site.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/embedded_text.h"
#include "viewer/ground/ground_block.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow {
namespace {

using GroundOnGpu = tests::Headless;

constexpr double kEye_m = 4000.0;
constexpr double kPixel_rad = 8e-4;

std::vector<ShaderPiece> Texts() {
  std::vector<ShaderPiece> pieces = SharedTexts();
  for (const char* name : {"viewer/shaders/air_block.glsl", "viewer/shaders/view_block.glsl",
                           "viewer/shaders/sun_light.glsl", "viewer/shaders/sun_transmittance.glsl",
                           "viewer/shaders/ground.glsl", "viewer/shaders/ground_light.glsl"})
    pieces.push_back({name, std::string(viewer::EmbeddedText(name))});
  return pieces;
}

template <typename Block>
void Bind(const ShaderProgram& program, const char* name, GLuint binding, const GlBuffer& buffer,
          const Block& block) {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_STATIC_DRAW);
  program.BindBlock(name, binding);
}

/// What the shaders read for an eye over the origin of the site.
class Blocks {
 public:
  explicit Blocks(const LitGround& lit) : lit_(lit) {}

  void Upload(const ShaderProgram& program) const {
    const GroundSite& site = lit_.site();
    const Lighting& light = lit_.lighting();
    Bind(program, "Air", 0, air_, AirBlockOf(site.medium()));
    ViewBlock view{};
    view.sun = {glm::vec3(light.to_sun), light.sun_radius_rad};
    view.eye = {kEye_m / 1e3, 0.0, 0.0, 0.0};
    Bind(program, "View", 1, view_, view);
    const GroundPoint origin = site.geometry().GroundAt({0.0, 0.0, 0.0}, 0.0);
    GroundBlock ground = GroundBlockOf(light.surface, origin.east_m, origin.north_m, true);
    ground.mesh_east = {1.0F, 0.0F, 0.0F, 0.0F};
    ground.mesh_north = {0.0F, 1.0F, 0.0F, 0.0F};
    ground.mesh_up = {0.0F, 0.0F, 1.0F, 0.0F};
    Bind(program, "Ground", 2, ground_, ground);
    Bind(program, "GroundLight", 3, light_, GroundLightBlockOf(lit_, kPixel_rad));
  }

 private:
  const LitGround& lit_;
  GlBuffer air_, view_, ground_, light_;
};

struct Case {
  Hit hit;
  VertexLight light;
  glm::dvec3 to_eye;
};

std::vector<Case> CasesOn(const LitGround& lit) {
  const Terrain& terrain = *lit.site().ground().terrain;
  const glm::dvec3 eye(0.0, 0.0, kEye_m);
  std::vector<Case> cases;
  for (int i = 1; i <= 400; ++i) {
    const glm::dvec3 above(6000.0 * (Halton(i, 2) - 0.5), 6000.0 * (Halton(i, 3) - 0.5), 9000.0);
    const auto found = terrain.Intersect(above, {0.0, 0.0, -1.0});
    Case c;
    c.hit.kind = HitKind::kTerrain;
    c.hit.point = found->smooth_point;
    c.hit.mesh_normal = found->normal;
    c.hit.geometric_normal = found->geometric_normal;
    c.hit.distance_m = glm::length(c.hit.point - eye);
    c.hit.footprint_m = kPixel_rad * c.hit.distance_m;
    c.hit.normal = MountainSurface::DetailedNormal(
        lit.site().geometry().GroundAt(c.hit.point, c.hit.footprint_m), c.hit.mesh_normal);
    c.to_eye = glm::normalize(eye - c.hit.point);
    GroundVertex vertex{};
    for (const glm::length_t axis : {0, 1, 2}) {
      const auto k = static_cast<std::size_t>(axis);
      vertex.position_m[k] = static_cast<float>(c.hit.point[axis]);
      vertex.normal[k] = static_cast<float>(c.hit.mesh_normal[axis]);
    }
    c.light = lit.At(vertex);
    const double over_plane =
        glm::dot(c.hit.mesh_normal, lit.lighting().to_sun) / lit.lighting().sun_radius_rad;
    const bool cut = std::abs(over_plane) < 1.0 || std::abs(c.light.sun_x) < 1.0F;
    if (!cut) cases.push_back(c);  // of the disk the renderer takes one point
  }
  return cases;
}

/// Ascending relative differences of the mean over bands.
std::vector<double> Differences(const LitGround& lit) {
  const std::vector<Case> cases = CasesOn(lit);
  const Blocks blocks(lit);
  std::vector<double> gpu(cases.size(), 0.0), differences;
  for (std::size_t band = 0; band < 4; ++band) {
    std::vector<tests::Arguments<float>> points;
    for (const Case& c : cases) {
      points.push_back({static_cast<float>(c.hit.point.x), static_cast<float>(c.hit.point.y),
                        static_cast<float>(c.hit.point.z - kEye_m),
                        static_cast<float>(c.hit.mesh_normal.x),
                        static_cast<float>(c.hit.mesh_normal.y), c.light.sun_x, c.light.sky[band]});
    }
    const std::string expression =
        "GroundRadiance(vec3(a[0], a[1], a[2]), vec3(a[3], a[4], sqrt(1.0 - a[3] * a[3] - a[4] * "
        "a[4])), a[5], vec4(a[6]), normalize(-vec3(a[0], a[1], a[2])))[" +
        std::to_string(band) + "]";
    const std::vector<float> values = tests::EvaluateOnGpu(
        Texts(), expression, points, [&](const ShaderProgram& program) { blocks.Upload(program); });
    for (std::size_t i = 0; i < cases.size(); ++i) gpu[i] += static_cast<double>(values[i]);
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const GroundRadiance judge = lit.site().light().Towards(
        c.hit, c.to_eye, {lit.lighting(), nullptr}, LampNodes{}, {0.0, 0.0});
    double sum = 0.0;
    for (std::size_t band = 0; band < 4; ++band) {
      sum += static_cast<double>(judge.natural[band]) /
             static_cast<double>(lit.lighting().irradiance[band]);
    }
    differences.push_back(std::abs(gpu[i] / sum - 1.0));
  }
  std::sort(differences.begin(), differences.end());
  return differences;
}

TEST_F(GroundOnGpu, MountainsAreTheRenderers) {
  const auto site = tests::RoughSite();
  for (const double elevation_deg : {50.0, 12.0, -3.0}) {
    const std::vector<double> differences =
        Differences(LitGround(site, tests::RoughSun(*site, elevation_deg)));
    EXPECT_LT(differences[differences.size() / 2], elevation_deg > 0.0 ? 4e-3 : 1e-2)
        << elevation_deg;
    EXPECT_LT(differences[differences.size() * 9 / 10], 0.03)
        << "the sky's light on relief is corrected by that of an open place";
  }
}

}  // namespace
}  // namespace alpenglow
