// SPDX-License-Identifier: MIT
// Phase functions as shaders that are made for one kind call them.
//
// Lamps as lamp_light.glsl reads them: a uniform block of vec4 alone.
//
// Altitudes count from that of the lowest of eye and lamps, so that float holds fog of metres' scale
// height under an eye kilometres above it. Densities are relative to those at each layer's base.
//
// The lamps of a scene and the landing light of the eye's own aircraft, as an eye that flies has
// them: which of them, or of the nodes that stand for many (renderer/lamp/lamp_tree.h), are worth a
// loop in a shader.
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/air/phase.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/sun/geodesy.h"
#include "renderer/lamp/lamp_tree.h"
#include "renderer/lamp/placed_lamp.h"
#include "viewer/lamps/ground_under_lamps.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// An expression over a cosine `c` and a vector `p` of parameters, ParametersOf(). Tables have
/// none: what reads them has a texture.
[[nodiscard]] std::string PhaseExpression(PhaseKind kind);
[[nodiscard]] glm::vec4 ParametersOf(const PhaseFunction& phase);

/// As many as the smallest uniform block that every OpenGL has room for can hold, and a loop in a
/// shader should.
inline constexpr std::size_t kMostGpuLamps = 64;

/// `struct Lamp` of lamp_light.glsl.
struct GpuLamp {
  glm::vec4 position, intensity, axis, side, profile, up, at_eye, at_lamp, glow, shade;
};

/// `block Lamps` of lamp_light.glsl.
struct LampsBlock {
  glm::vec4 count, planet, falls, bases, molecules, aerosol, dimming, fog, mie_phase, fog_phase;
  glm::vec4 red, green, blue;
  std::array<glm::vec4, 3> ground;
  std::array<GpuLamp, kMostGpuLamps> lamps;
};
static_assert(sizeof(LampsBlock) == (16 + 10 * kMostGpuLamps) * sizeof(glm::vec4));
static_assert(sizeof(LampsBlock) <= 16384);  // GL_MAX_UNIFORM_BLOCK_SIZE is at least that

/// From where lamps are seen, and how finely.
struct LampView {
  glm::dvec3 eye_m{0.0};  // in the frame of SceneGround
  glm::dmat3 eye_from_ground{
      1.0};                 // turns directions of that frame into east, north, up at the eye
  double altitude_m = 0.0;  // of the eye over the sphere
  double pixel_angle_rad = 1e-3;
};

/// Of an eye anywhere; `ground` is the frame of SceneGround.
[[nodiscard]] LampView LampViewFrom(const LocalFrame& ground, const GeodeticPosition& eye,
                                    double pixel_angle_rad);

/// Layers of the texture of plans that are of a lamp; levels 0: none.
struct PlanLayers {
  int first = 0, levels = 0;
};

/// A lamp of the block, and what its picture needs beside it.
struct ChosenLamp {
  const PlacedLamp* placed;  // before the eye of the view
  int table = 0;             // layer of its measured profile
  int glow = 0;              // of what its air brings to surfaces
  int shade = -1;            // of the terrain around it; -1: none
  PlanLayers plan{};         // of where it lights the ground
};

/// @param layers  of LampStage: molecules, aerosol and perhaps fog.
/// @param core_rad  angles from a lamp at which what is drawn of it by itself fades and ends; 0, 0:
///     nothing is. Lamps that shine evenly come first in the block.
[[nodiscard]] LampsBlock LampsBlockOf(std::vector<ChosenLamp> lamps,
                                      const std::vector<LampLayer>& layers, const Medium& medium,
                                      const LampView& view, std::array<double, 2> core_rad);

/// A spot that moves with the eye.
struct LandingLight {
  double intensity_cd = 400e3;
  double temperature_k = 3200.0;
  double radius_m = 0.1;    // of the luminous sphere that it is
  double inner_rad = 0.07;  // half angles: full inside, none outside
  double outer_rad = 0.14;
  glm::dvec3 offset_m{0.0, 0.0, -1.5};  // from the eye, east, north, up
  glm::dvec3 axis{0.0, 1.0, 0.0};       // unit, east, north, up
};

/// A lamp itself, as the picture shows it.
struct LampDisk {
  glm::vec4 towards;  // unit, in the frame of the eye; angular radius, without that of pixels [rad]
  glm::vec4 light;    // irradiance at the eye [W m^-2 nm^-1]
  glm::vec4 place;    // distance [m]; the rest unused
};

/// What a measured lamp's table has on the graphics card: uniform angles gamma over [0, pi] and C
/// over a whole turn, its ends the same.
inline constexpr int kLampGammas = 361;
inline constexpr int kLampTurns = 73;
/// Terrain around a lamp: the slope over which it is seen, over directions of the compass and
/// distances from the first to the last in equal ratios.
inline constexpr int kShadeTurns = 96;
inline constexpr int kShadeRings = 192;
inline constexpr double kNearestShade_m = 1.0;
inline constexpr double kFarthestShade_m = 2e4;
/// As many layers as every OpenGL has; lamps beyond are not shaded.
inline constexpr std::size_t kMostShades = 256;
/// The brightest so many lamps have a LitPlan, of up to 1.3 MB each.
inline constexpr std::size_t kMostPlans = 32;

class SceneLamps {
 public:
  /// Lights and fog of the scene. Reads the IES files of lamps. `ground` must outlive this. Throws
  /// InputError naming the lamp for a lamp below the ground, and what ReadIes refuses.
  SceneLamps(const Scene& scene, const SceneGround& ground, const Medium& medium);

  void SetLandingLight(const std::optional<LandingLight>& light) { landing_ = light; }

  [[nodiscard]] bool IsDark() const { return tree_.lamps() == 0 && !landing_; }
  [[nodiscard]] bool HasFog() const { return stage_.layers().size() > 2; }
  [[nodiscard]] const std::vector<LampLayer>& layers() const { return stage_.layers(); }
  [[nodiscard]] const Medium& medium() const { return medium_; }
  /// Of the measured lamps, in the order of ChosenLamp::table.
  [[nodiscard]] const std::vector<LampProfile>& tables() const { return tables_; }
  /// In the order of ChosenLamp::glow.
  [[nodiscard]] const std::vector<const LampGlow*>& glows() const { return glows_; }

  /// Of each lamp, [ring * kShadeTurns + turn]; empty without terrain.
  [[nodiscard]] const std::vector<std::vector<float>>& shades() const { return shades_; }

  /// Ground that lamps light, in an order of its own, as many as are finished. Until then, and of
  /// lamps that have none, shades() decide.
  [[nodiscard]] const std::vector<LitPlan>& plans() const { return plans_->plans(); }
  /// Layers of all of them, finished or not.
  [[nodiscard]] int PlanLayerCount() const;
  /// Takes in what is finished and has more made, beside drawing.
  void FollowPlans() { plans_->Follow(); }
  /// Waits until all are there.
  void SettlePlans() { plans_->Settle(); }

  /// Everything that depends on the eye.
  struct InView {
    LampsBlock block;
    std::vector<LampDisk> disks;
  };
  /// @param dimmest_cd_per_m2  lamps whose glow and light on the ground under them stay below this
  ///     are left out.
  /// @param most  lamps or nodes of the block, at most kMostGpuLamps.
  [[nodiscard]] InView Before(const LampView& view, std::array<double, 2> core_rad,
                              double dimmest_cd_per_m2, std::size_t most = kMostGpuLamps);

 private:
  [[nodiscard]] LampNodes Cut(std::size_t most) const;
  [[nodiscard]] PlacedLamp Landing(const LampView& view) const;
  [[nodiscard]] ChosenLamp Choose(std::uint32_t node) const;
  void PlanBrightest();

  Medium medium_;
  BandColour colour_;
  LampStage stage_;
  LampTree tree_;
  std::optional<LandingLight> landing_;
  std::vector<LampProfile> tables_;
  std::vector<int> table_of_lamp_;
  std::vector<const LampGlow*> glows_;
  std::map<const LampGlow*, int> number_of_glow_;
  std::vector<std::vector<float>> shades_;
  /// A lamp that has a plan, and the first of its layers.
  struct PlannedLamp {
    std::uint32_t node;
    Lamp lamp;
    int first_layer, levels;
  };
  std::vector<PlannedLamp> planned_;
  std::optional<LitPlanFollower> plans_;  // last: its thread reads what is above
};

/// What terrain up to a distance leaves of sight from a place: [ring * kShadeTurns + turn], the
/// rise over the distance that a point there must have; turns count from east to north.
[[nodiscard]] std::vector<float> ShadeAround(const LampStage& stage, const glm::dvec3& place);
/// A measured profile at the angles of kLampGammas and kLampTurns, [turn * kLampGammas + gamma].
[[nodiscard]] std::vector<float> SampledProfile(const LampProfile& profile);

}  // namespace alpenglow::viewer
