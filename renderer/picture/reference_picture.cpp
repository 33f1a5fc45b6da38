// SPDX-License-Identifier: MIT
#include "renderer/picture/reference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "renderer/picture/picture_layers.h"

namespace alpenglow::renderer {
namespace {

struct ReferenceStage {
  int reduction;  // divisor of width and height
  int samples;
};
constexpr std::array<ReferenceStage, 5> kStages{{{4, 1}, {1, 1}, {1, 4}, {1, 16}, {1, 64}}};

bool IsSame(const ReferencePicture::View& a, const ReferencePicture::View& b) {
  return a.of == b.of && a.eye == b.eye && a.width == b.width && a.height == b.height &&
         std::abs(SecondsBetween(a.now, b.now)) < ReferencePicture::kSameTime_s;
}

}  // namespace

std::unique_ptr<SceneRenderer> RendererOf(const ReferenceScene& of) {
  return of.ground ? std::make_unique<SceneRenderer>(of.scene, of.ground())
                   : std::make_unique<SceneRenderer>(of.scene);
}

RenderSettings ComparisonSettings(int width, int height, int samples) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.samples_per_pixel = samples;
  settings.filter = PixelFilter::Kind::kBox;
  settings.layers = LayersOfEdges();
  return settings;
}

/// Holds the renderer of the most recent scene.
class ReferencePicture::Renderers {
 public:
  const SceneRenderer& Of(const std::shared_ptr<const ReferenceScene>& of) {
    if (of_ != of) {
      renderer_.reset();  // frees its memory first
      renderer_ = RendererOf(*of);
      of_ = of;
    }
    return *renderer_;
  }

 private:
  std::shared_ptr<const ReferenceScene> of_;
  std::unique_ptr<SceneRenderer> renderer_;
};

ReferencePicture::ReferencePicture()
    : renderers_(std::make_shared<Renderers>()),
      job_([renderers = renderers_](const Request& request) -> std::optional<Made> {
        const View& view = request.view;
        RenderSettings settings;
        settings.width = std::max(view.width / request.reduction, 1);
        settings.height = std::max(view.height / request.reduction, 1);
        settings.samples_per_pixel = request.samples;
        settings.stop = request.stop;
        CameraSample camera_sample(view.now);
        camera_sample.poses = {view.eye};
        try {
          const SceneRenderer& renderer = renderers->Of(view.of);
          return Made{renderer.Render(camera_sample, settings), request.samples, request.stop};
        } catch (const RenderingStopped&) {
          return std::nullopt;
        }
      }) {}

ReferencePicture::~ReferencePicture() { stop_.request_stop(); }

void ReferencePicture::RequestStage(std::size_t stage) {
  stage_ = stage;
  job_.Request({*view_, kStages[stage].reduction, kStages[stage].samples, stop_.get_token()});
}

void ReferencePicture::Show(const View& view) {
  if (view_ && IsSame(*view_, view)) return;
  stop_.request_stop();
  stop_ = std::stop_source();
  view_ = view;
  samples_ = 0;
  RequestStage(0);
}

std::optional<HdrImage> ReferencePicture::Poll() {
  std::optional<std::optional<Made>> taken = job_.Poll();
  if (!taken || !*taken || (*taken)->stop.stop_requested()) return std::nullopt;
  samples_ = (*taken)->samples;
  if (stage_ + 1 < kStages.size()) RequestStage(stage_ + 1);
  return std::move((*taken)->image);
}

}  // namespace alpenglow::renderer
