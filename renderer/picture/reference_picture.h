// SPDX-License-Identifier: MIT
// The renderer's own picture of a view, made on a worker thread and refined while the view does not
// change.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "lut/image/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/layer.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// The scene that the renderer draws for a viewer.
struct ReferenceScene {
  Scene scene;
  /// Returns the terrain and is called on first use. Empty: the terrain is that of the scene.
  std::function<std::shared_ptr<const SceneGround>()> ground;
};

[[nodiscard]] std::unique_ptr<SceneRenderer> RendererOf(const ReferenceScene& scene);

/// Returns the settings of a picture that drawn ones are compared with by DifferenceOf: no pixel has
/// light of its neighbours.
[[nodiscard]] RenderSettings ComparisonSettings(int width, int height, int samples);

/// Renders reference pictures in the background. A renderer is prepared when a scene is first shown
/// (seconds) and then kept. For each view it produces a small picture with one ray per pixel, then
/// full ones with 1, 4, 16 and 64. When the view changes, rendering of the old view stops.
class ReferencePicture {
 public:
  struct View {
    std::shared_ptr<const ReferenceScene> of;
    CameraPose eye;
    UtcTime now;
    int width, height;  // of the full picture [pixels]
  };

  ReferencePicture();
  /// Stops rendering.
  ~ReferencePicture();

  /// Requests a picture of a view. Instants that differ by less than `kSameTime_s` count as equal.
  void Show(const View& view);
  /// Returns a new picture of the view shown last, if one is ready. Rethrows exceptions of the
  /// rendering.
  [[nodiscard]] std::optional<HdrImage> Poll();

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
    HdrImage image;
    int samples;
    std::stop_token stop;
  };
  class Renderers;
  void RequestStage(std::size_t stage);

  std::optional<View> view_;
  std::stop_source stop_;
  std::size_t stage_ = 0;
  int samples_ = 0;
  std::shared_ptr<Renderers> renderers_;  // used only by the job
  AsyncValue<Request, std::optional<Made>> job_;
};

}  // namespace alpenglow::renderer
