// SPDX-License-Identifier: MIT
// This header measures the difference between two pictures of a scene, and chooses the effects that
// a picture needs within a budget of change.
//
//   d = |b - a| / max((|a| + |b|) / 2, floor)          of a pixel; |.| over linear R, G and B
//
// The floor is a sixteenth of the luminance that the exposure meter maps to middle grey: in darker
// pixels, a change of 1 % is less than half a code value of an 8-bit picture. d is 0 for equal
// pixels, equals the relative error where that is small, and is 2 where only one picture has light.
//
// The measure ignores the position of a change in the picture, and hence its importance to a
// viewer. It ignores that the two pictures may be exposed differently, that a slow gradient reveals
// an edge which rough ground masks, and that viewers tolerate errors of hue more than errors of
// lightness.
//
// The choice is made with a preview: a few of the picture's own pixels are rendered with all
// effects, and again without each one. Effects whose change is small are left out, smallest first,
// as long as the preview without all of them together stays within the budget:
//
//   rms of d at most the budget,    99th percentile of d at most four times the budget,
//
// Three standard errors are added to both numbers. They must hold for the picture as a whole and
// also, separately and however small these are, for its lamps and for the surroundings of the sun.
//
// The preview has one pixel in each cell of a grid over the picture, at a pseudo-random but
// deterministic position in the cell. It therefore misses nothing larger than a cell. Smaller
// features that are neither lamps nor near the sun are seen only if a preview pixel happens to hit
// them.
//
// The choice depends on pixels alone; the cost of effects is measured and reported, but not used.
// Parts of the air that cost nothing are always kept (EffectText::is_free). Each frame of a series
// chooses independently, so between neighbouring frames with different choices the picture changes
// by the budget at most.
#pragma once

#include <array>
#include <ctime>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/math/error_statistics.h"
#include "lut/image/image.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effects/effects.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns the change d of a pixel, in [0, 2].
[[nodiscard]] double PixelChange(const std::array<float, 3>& a, const std::array<float, 3>& b,
                                 double floor_cd_per_m2);

/// Returns the floor of a picture [cd/m^2]; the sun's disk is excluded from metering.
[[nodiscard]] double ChangeFloor(const HdrImage& reference);

/// Returns the changes d of all pixels. Throws InternalError for pictures of different sizes.
[[nodiscard]] ErrorStatistics ChangeOf(const HdrImage& reference, const HdrImage& other);

struct PixelPlace {
  int x, y;
};

/// Pixels of the preview: the first group represents the whole picture, each other group a small
/// feature.
using PreviewGroups = std::vector<std::vector<PixelPlace>>;

/// Changes of the preview's pixels by group, and the largest value of any group.
struct PreviewChange {
  std::vector<ErrorStatistics> groups;

  [[nodiscard]] double Rms() const;
  [[nodiscard]] double RmsAtMost() const;
  [[nodiscard]] double Quantile(double share) const;
  [[nodiscard]] double QuantileAtMost(double share) const;
};

/// Returns one pixel in each cell of a grid of about `count` square cells.
[[nodiscard]] std::vector<PixelPlace> PreviewGrid(int width, int height, int count);

/// Returns about `count` pixels on a spiral within `radius` of a centre, which may lie outside the
/// picture.
[[nodiscard]] std::vector<PixelPlace> PilotSpiral(int width, int height,
                                                  const std::array<double, 2>& centre,
                                                  double radius, int count);

/// Returns the groups of a picture: the grid, the surroundings of the sun, and the lamps.
/// @param lamps  unit directions from the eye.
[[nodiscard]] PreviewGroups PreviewPixels(const CameraRays& camera, int width, int height,
                                          const glm::dvec3& to_sun,
                                          const std::vector<glm::dvec3>& lamps);

/// CPU time of all threads of the program together since construction; other programs on the
/// machine do not count.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC;
  }

 private:
  std::clock_t begin_ = std::clock();
};

/// The preview's pixels, group after group, as a picture of one row, and the rendering time.
struct PreviewPicture {
  HdrImage image;
  double seconds = 0.0;
};

/// A refinement that the picture does not use, but could.
struct Refinement {
  std::string name;
  std::function<PreviewPicture()> render;
};

struct EffectPreview {
  PreviewGroups groups;
  std::function<PreviewPicture(EffectSet)> render;
  double pixels_of_picture = 0.0;
  EffectSet present = EffectSet::All();  // other effects are inactive in this scene
  std::vector<Refinement> refinements;   // estimated only if the choice is explained
  /// Preparation time before any pixel [s]: shadows of terrain, the plan of lamps.
  std::function<double(Effect)> preparation_s = [](Effect) { return 0.0; };
};

/// Estimate of an effect of a picture from the preview.
struct EffectEstimate {
  Effect effect;
  PreviewChange change;
  double cost_s = 0.0;  // of the picture, including preparation, summed over threads
  bool kept = true;
  bool present = true;  // false: inactive in this scene
};

/// Estimate of a refinement's change and cost.
struct RefinementEstimate {
  std::string name;
  PreviewChange change;
  double cost_s;
};

struct EffectBudget {
  double max_error = 0.01;  // rms of d, in (0, 1]
  /// Also estimates the parts of the air, which cost nothing and are always kept, and times each
  /// preview picture three times.
  bool explain = false;
  bool leave_out = true;  // false: all effects are kept and only estimated
};

struct EffectChoice {
  EffectSet effects;  // effects to render
  double max_error = 0.0;
  std::vector<EffectEstimate> estimates;  // of the requested effects, in the order of Effect
  PreviewChange together;                 // change from leaving out all of `LeftOut()`
  std::vector<RefinementEstimate> refinements;
  // Times, summed over threads: the picture with all effects, the picture as chosen, and the
  // preview.
  double all_s = 0.0, chosen_s = 0.0, preview_s = 0.0;
  std::size_t preview_pixels = 0;

  [[nodiscard]] EffectSet LeftOut() const;
};

/// @param wanted  the effects of the reference picture.
[[nodiscard]] EffectChoice ChooseEffects(const EffectPreview& preview, EffectSet wanted,
                                         const EffectBudget& budget);

/// Returns a table of a choice, with one line per effect.
[[nodiscard]] std::string ExplainText(const EffectChoice& choice);

/// Returns the metadata of a choice: the effects left out, and the resulting change of the picture.
[[nodiscard]] Metadata NotesOn(const EffectChoice& choice);

}  // namespace alpenglow::renderer
