// SPDX-License-Identifier: MIT
// How much one picture differs from another of the same scene, as a number that a budget can hold.
//
//   d = |b - a| / max((|a| + |b|) / 2, floor)          of a pixel; |.| over linear R, G and B
//
// with floor a sixteenth of the luminance that the exposure meter makes middle grey: what is darker
// shows less than half a code value of an 8-bit picture for 1 % of it. d is 0 for equal pixels, the
// relative error where it is small, and 2 where light is in one picture and not in the other.
//
// What it does not see: where in the picture a change is, and that it may be what one looks at;
// that the two may be exposed differently; that a slow gradient shows an edge which rough ground
// hides; that the eye forgives errors of hue less than errors of lightness.
//
// Only what a scene needs: which effects a picture can do without, within a budget of change.
//
// A pilot decides: a few of the picture's own pixels, rendered with every effect on, and again with
// each one off. Effects whose change (effect_choice.h) is small are left out, smallest first, as
// long as the pilot without all of them together stays within the budget:
//
//   rms of d at most the budget,    99th percentile of d at most four times the budget,
//
// both three standard errors up, of the picture as a whole and again of the lamps in it and of the
// surroundings of the sun, each counted alone however small.
//
// The pilot's pixels are one in each cell of a grid over the picture, at a place in the cell that
// looks random and is not. So nothing larger than a cell is missed; of smaller things that are
// neither lamps nor near the sun, only as many as the pilot's pixels happen to meet.
//
// The decision depends on pixels alone. What the effects cost is measured beside,
// and told. Parts of the air cost nothing to keep, and are kept
// (EffectText::is_free). Frames of a series decide each for itself: between
// neighbours that decide differently the picture moves by the budget at most.
#pragma once

#include <array>
#include <ctime>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "lut/picture/image.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effect/effects.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct PictureChange {
  double rms = 0.0;            // root mean square of d
  double at_99_percent = 0.0;  // 99th percentile of d
};

/// In [0, 2].
[[nodiscard]] double PixelChange(const std::array<float, 3>& a, const std::array<float, 3>& b,
                                 double floor_cd_per_m2);

/// The floor of a picture [cd/m^2]; the sun's disk is not metered.
[[nodiscard]] double ChangeFloor(const Image& reference);

/// Of all pixels. Throws InternalError for pictures of different sizes.
[[nodiscard]] PictureChange ChangeOf(const Image& reference, const Image& other);

/// What a sample of pixels says of the whole picture.
struct ChangeEstimate {
  PictureChange seen;     // of the sample
  PictureChange at_most;  // three standard errors more

  [[nodiscard]] static ChangeEstimate Of(std::vector<double> changes);
};

struct PixelPlace {
  int x, y;
};

/// Pixels that a picture is judged by: the first group stands for the whole, each other one for
/// something small.
using PilotGroups = std::vector<std::vector<PixelPlace>>;

/// One pixel in each cell of a grid of about `count` square cells.
[[nodiscard]] std::vector<PixelPlace> PilotGrid(int width, int height, int count);

/// Pixels within `radius` around a place in the picture or beside it, about `count`, on a spiral.
[[nodiscard]] std::vector<PixelPlace> PilotSpiral(int width, int height,
                                                  const std::array<double, 2>& centre,
                                                  double radius, int count);

/// The groups of a picture: a grid, what surrounds the sun, lamps.
/// @param lamps  unit directions from the eye.
[[nodiscard]] PilotGroups PilotPixels(const CameraRays& camera, int width, int height,
                                      const glm::dvec3& to_sun,
                                      const std::vector<glm::dvec3>& lamps);

/// Time that the program's threads have worked since it was made, together: other programs on the
/// machine do not count.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC;
  }

 private:
  std::clock_t begin_ = std::clock();
};

/// The pilot's pixels, group after group, as a picture of one row; and the time that took.
struct PilotPicture {
  Image image;
  double seconds = 0.0;
};

/// What a picture does not have, and could.
struct Refinement {
  std::string name;
  std::function<PilotPicture()> render;
};

struct EffectPilot {
  PilotGroups groups;
  std::function<PilotPicture(EffectSet)> render;
  double pixels_of_picture = 0.0;
  EffectSet present = EffectSet::All();  // others have nothing to do in this scene
  std::vector<Refinement> refinements;   // estimated where the choice is explained
  /// Of the picture, before any pixel: shadows of terrain, the plan of lamps [s].
  std::function<double(Effect)> preparation_s = [](Effect) { return 0.0; };
};

/// An effect of a picture, as the pilot saw it.
struct EffectEstimate {
  Effect effect;
  ChangeEstimate change;  // the worst of the groups
  ChangeEstimate whole;   // of the picture as a whole
  double cost_s = 0.0;    // of the picture's time, preparation included, all threads together
  bool kept = true;
  bool present = true;  // false: nothing to do in this scene
};

/// What more would change.
struct RefinementEstimate {
  std::string name;
  ChangeEstimate change;
  double cost_s;
};

struct EffectBudget {
  double max_error = 0.01;  // rms of d, in (0, 1]
  /// Estimates parts of the air too, which cost nothing and are always kept, and times each
  /// picture of the pilot three times.
  bool explain = false;
  bool leave_out = true;  // false: everything is kept, and only estimated
};

struct EffectChoice {
  EffectSet effects;  // what to render
  double max_error = 0.0;
  std::vector<EffectEstimate> estimates;  // of what was asked for, in the order of Effect
  ChangeEstimate together;                // of all that is left out
  std::vector<RefinementEstimate> refinements;
  // Time of all threads together: of the picture with
  // everything, of the picture as chosen, and of choosing.
  double all_s = 0.0, chosen_s = 0.0, pilot_s = 0.0;
  std::size_t pilot_pixels = 0;

  [[nodiscard]] EffectSet LeftOut() const;
};

/// @param wanted  what "everything" is.
[[nodiscard]] EffectChoice ChooseEffects(const EffectPilot& pilot, EffectSet wanted,
                                         const EffectBudget& budget);

/// A table of a choice, with a line for every effect.
[[nodiscard]] std::string ExplainText(const EffectChoice& choice);

/// What a file says of the choice: what is left out, and by how much that changes the picture.
[[nodiscard]] Metadata NotesOn(const EffectChoice& choice);

}  // namespace alpenglow::renderer
