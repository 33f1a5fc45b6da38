// SPDX-License-Identifier: MIT
// The renderer's own picture of a view, made on a worker thread and refined while the view does not
// change, and the difference between it and the picture of the GPU away from edges.
//
// The difference of a pixel is PixelChange (effect_choice.h), the relative difference of linear
// radiance above the floor of ChangeFloor. Pixels at an edge are excluded, because there a
// hundredth of a pixel decides what is visible: pixels with neighbours of another kind, a tenth
// farther or nearer, lit by more or less of the sun's disk, or lit a fifth more or less by lamps.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "lut/image/image.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"
#include "viewer/async/async_value.h"
#include "viewer/flight/flight.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// The scene that the renderer draws for a viewer.
struct ReferenceScene {
  Scene scene;
  /// Returns the terrain and is called on first use. Empty: the terrain is that of the scene.
  std::function<std::shared_ptr<const SceneGround>()> ground;
};

[[nodiscard]] std::unique_ptr<SceneRenderer> RendererOf(const ReferenceScene& scene);

/// Renders reference pictures in the background. A renderer is prepared when a scene is first shown
/// (seconds) and then kept. For each view it produces a small picture with one ray per pixel, then
/// full ones with 1, 4, 16 and 64. When the view changes, rendering of the old view stops.
class ReferencePicture {
 public:
  struct View {
    std::shared_ptr<const ReferenceScene> of;
    Eye eye;
    UtcInstant now;
    int width, height;  // of the full picture [pixels]
  };

  ReferencePicture();
  /// Stops rendering.
  ~ReferencePicture();

  /// Requests a picture of a view. Instants that differ by less than `kSameTime_s` count as equal.
  void Show(const View& view);
  /// Returns a new picture of the view shown last, if one is ready. Rethrows exceptions of the
  /// rendering.
  [[nodiscard]] std::optional<Image> Take();

  /// Number of rays per pixel of the best picture of this view so far; 0: none yet.
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
  std::shared_ptr<Renderers> renderers_;  // used only by the job
  AsyncValue<Request, std::optional<Made>> job_;
};

struct ViewDifference {
  double mean = 0.0;
  double at_99_percent = 0.0;
  double at_999_permille = 0.0;
  double worst = 0.0;
  double edge_share = 0.0;  // fraction of excluded pixels
};

/// Returns the layers that the renderer's picture must have. The layer of lamps is optional;
/// without it lamps cause no edges.
[[nodiscard]] std::vector<PictureLayer> LayersOfEdges();

/// Returns which pixels of the renderer's picture are at an edge, row by row.
[[nodiscard]] std::vector<bool> EdgesOf(const Image& reference);

/// Returns the differences of a drawn picture from the reference.
/// @param reference solution  the renderer's, with LayersOfEdges(). Throws InternalError if the sizes differ or
///   all pixels are at edges.
[[nodiscard]] ViewDifference DifferenceOf(const Image& reference, const Image& painted);

}  // namespace alpenglow::viewer
