// SPDX-License-Identifier: MIT
// Provides SceneLamps, the lamps of a scene and the landing light of the eye's own aircraft for a
// moving eye. It selects the lamps, or the nodes that represent many lamps
// (renderer/lamps/lamp_tree.h), for the loop of a shader. It also provides
// LampShadowFieldFollower, which computes the LitPlans of all lamps once, one by one, beside
// drawing.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/lamps/lamp_shadow_field.h"
#include "renderer/lamps/lamp_tree.h"
#include "renderer/lamps/lamps_block.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// A spotlight that moves with the eye.
struct LandingLight {
  double intensity_cd = 400e3;
  double temperature_k = 3200.0;
  double radius_m = 0.1;    // radius of the luminous sphere
  double inner_rad = 0.07;  // half angles: full intensity inside inner_rad, none outside outer_rad
  double outer_rad = 0.14;
  glm::dvec3 offset_m{0.0, 0.0, -1.5};  // from the eye, east, north, up
  glm::dvec3 axis{0.0, 1.0, 0.0};       // unit, east, north, up
};

/// The disk of a directly visible lamp.
struct LampDisk {
  glm::vec4 towards;  // unit, in the frame of the eye; angular radius without that of a pixel [rad]
  glm::vec4 light;    // irradiance at the eye [W m^-2 nm^-1]
  glm::vec4 place;    // distance [m]; the rest unused
};

/// Size of the GPU table of a measured lamp: equidistant angles gamma over [0, pi] and C over a
/// whole turn, whose first and last columns are equal.
inline constexpr int kLampGammas = 361;
inline constexpr int kLampTurns = 73;
/// Terrain around a lamp: the slope above which the lamp is visible, over compass directions and
/// over distances from the nearest to the farthest in equal ratios.
inline constexpr int kShadeTurns = 96;
inline constexpr int kShadeRings = 192;
inline constexpr double kNearestShade_m = 1.0;
inline constexpr double kFarthestShade_m = 2e4;
/// Texture layers that every OpenGL supports; terrain does not shade lamps beyond this number.
inline constexpr std::size_t kMostShades = 256;
/// Number of the brightest lamps that have a LampShadowField, of up to 1.3 MB each.
inline constexpr std::size_t kMostPlans = 32;

class LampShadowFieldFollower {
 public:
  /// Returns the plan of a lamp with this number, from 0.
  using Make = std::function<LampShadowField(std::size_t)>;
  /// @param make  called on a thread of this object; everything it refers to must outlive this
  ///     object.
  LampShadowFieldFollower(std::size_t lamps, Make make) : lamps_(lamps), plan_(std::move(make)) {}

  /// Takes a finished plan and requests the next one.
  void Follow();
  /// Waits for all plans.
  void WaitUntilReady();
  /// Returns the finished plans, which are those of the first lamps.
  [[nodiscard]] const std::vector<LampShadowField>& plans() const { return plans_; }

 private:
  std::size_t lamps_;
  std::vector<LampShadowField> plans_;
  AsyncValue<std::size_t, LampShadowField> plan_;
};

class SceneLamps {
 public:
  /// Takes lights and layers of the scene and reads the IES files of lamps. `ground` must outlive this
  /// object. Throws InputError that names the lamp if it is below the ground, and errors of
  /// ReadIes.
  SceneLamps(const Scene& scene, const SceneGround& ground, const Medium& medium);

  void SetLandingLight(const std::optional<LandingLight>& light) { landing_ = light; }

  [[nodiscard]] bool IsDark() const { return tree_.lamps() == 0 && !landing_; }
  [[nodiscard]] bool HasLayer() const { return stage_.layers().size() > 2; }
  [[nodiscard]] const std::vector<LampLayer>& layers() const { return stage_.layers(); }
  [[nodiscard]] const Medium& medium() const { return medium_; }
  /// Returns the profiles of the measured lamps, in the order of ChosenLamp::table.
  [[nodiscard]] const std::vector<LampProfile>& tables() const { return tables_; }
  /// Returns the glows in the order of ChosenLamp::glow.
  [[nodiscard]] const std::vector<const LampAirlightIrradiance*>& glows() const { return glows_; }

  /// Returns the terrain around each lamp, [ring * kShadeTurns + turn]; empty without terrain.
  [[nodiscard]] const std::vector<std::vector<float>>& shades() const { return shades_; }

  /// Returns the finished plans of lit ground, in their own order. shades() are used until a plan
  /// is finished, and for lamps without a plan.
  [[nodiscard]] const std::vector<LampShadowField>& plans() const { return plans_->plans(); }
  /// Returns the number of layers of all plans, finished or not.
  [[nodiscard]] int PlanLayerCount() const;
  /// Takes finished plans and requests the next one, beside drawing.
  void FollowPlans() { plans_->Follow(); }
  /// Waits until all plans are finished.
  void WaitForPlans() { plans_->WaitUntilReady(); }

  /// Everything that depends on the eye.
  struct InView {
    LampsBlock block;
    std::vector<LampDisk> disks;
  };
  /// @param dimmest_cd_per_m2  lamps are omitted if their glow and their light on the ground below
  ///     them are darker than this luminance.
  /// @param most  maximum number of lamps or nodes in the block, at most kMostGpuLamps.
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
  std::optional<glm::dvec3> stands_at_m_;  // the eye for which the tree is prepared
  std::optional<LandingLight> landing_;
  std::vector<LampProfile> tables_;
  std::vector<int> table_of_lamp_;
  std::vector<const LampAirlightIrradiance*> glows_;
  std::map<const LampAirlightIrradiance*, int> number_of_glow_;
  std::vector<std::vector<float>> shades_;
  /// A lamp with a plan, and the first layer of the plan.
  struct PlannedLamp {
    std::uint32_t node;
    Lamp lamp;
    int first_layer, levels;
  };
  std::vector<PlannedLamp> planned_;
  std::optional<LampShadowFieldFollower>
      plans_;  // last member, because its thread reads the ones above
};

/// Returns the visibility of a place over terrain up to a distance: [ring * kShadeTurns + turn],
/// the rise over distance that a point must exceed to be visible. Turns are counted from east to
/// north.
[[nodiscard]] std::vector<float> ShadeAround(const LampStage& stage, const glm::dvec3& place);
/// Returns a measured profile at the angles of kLampGammas and kLampTurns, [turn * kLampGammas +
/// gamma].
[[nodiscard]] std::vector<float> SampledProfile(const LampProfile& profile);

}  // namespace alpenglow::renderer
