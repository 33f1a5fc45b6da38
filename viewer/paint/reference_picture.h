// SPDX-License-Identifier: MIT
// The renderer's own picture of a view, made beside drawing and refined while the view stays.
//
// How far the picture on the graphics card is from the renderer's, edges aside.
//
// Of a pixel: PixelChange (effect_choice.h), the relative difference of linear radiance above the
// floor of ChangeFloor. Left out are pixels beside an edge, where a hundredth of a pixel decides
// what is seen: whose neighbours are of another kind, a tenth farther or nearer, or lit by more or
// less of the sun's disk, or by a fifth more or less by lamps.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "lut/picture/image.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"
#include "viewer/flight/flight.h"
#include "viewer/job/latest_job.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// What the renderer renders for a viewer.
struct ReferenceScene {
  Scene scene;
  /// The terrain, made when it is first needed; nothing: as the scene says.
  std::function<std::shared_ptr<const SceneGround>()> ground;
};

[[nodiscard]] std::unique_ptr<SceneRenderer> RendererOf(const ReferenceScene& scene);

/// A renderer is prepared when a scene is first shown (seconds) and kept. Of a view there come a
/// small picture of a ray a pixel, then full ones of 1, 4, 16 and 64. A view that changes stops
/// what is being made of the old one.
class ReferencePicture {
 public:
  struct View {
    std::shared_ptr<const ReferenceScene> of;
    Eye eye;
    UtcInstant now;
    int width, height;  // of the full picture [pixels]
  };

  ReferencePicture();
  /// Stops what is being made.
  ~ReferencePicture();

  /// The picture wanted. Two instants within `kSameTime_s` are one.
  void Show(const View& view);
  /// A new picture of the view shown last, if one is ready. Throws what rendering threw.
  [[nodiscard]] std::optional<Image> Take();

  /// Rays a pixel of the best picture of this view so far; 0: none yet.
  [[nodiscard]] int samples() const { return samples_; }

  static constexpr double kSameTime_s = 20.0;  // the sun moves by a third of its radius

 private:
  struct Request {
    View view;
    int reduction, samples;
    std::stop_token stop;
  };
  struct Made {
    Image image;
    int samples;
    std::stop_token stop;
  };
  class Renderers;
  void AskFor(std::size_t stage);

  std::optional<View> view_;
  std::stop_source stop_;
  std::size_t stage_ = 0;
  int samples_ = 0;
  std::shared_ptr<Renderers> renderers_;  // used by the job alone
  LatestJob<Request, std::optional<Made>> job_;
};

struct ViewDifference {
  double mean = 0.0;
  double at_99_percent = 0.0;
  double at_999_permille = 0.0;
  double worst = 0.0;
  double edge_share = 0.0;  // of all pixels that were left out
};

/// Layers that the renderer's picture has; without that of lamps these have no edges.
[[nodiscard]] std::vector<PictureLayer> LayersOfEdges();

/// Pixels of the renderer's picture that stand beside an edge, row by row.
[[nodiscard]] std::vector<bool> EdgesOf(const Image& judge);

/// @param judge  the renderer's, with LayersOfEdges(). Throws InternalError for other sizes and for
///     pictures that are nothing but edges.
[[nodiscard]] ViewDifference DifferenceOf(const Image& judge, const Image& painted);

}  // namespace alpenglow::viewer
