// SPDX-License-Identifier: MIT
#include "viewer/passes/reference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/effects/effect_choice.h"
#include "viewer/flight/flight_recorder.h"

namespace alpenglow::viewer {
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
        camera_sample.poses = {PoseOf(view.eye)};
        try {
          const SceneRenderer& renderer = renderers->Of(view.of);
          return Made{renderer.Render(camera_sample, settings), request.samples, request.stop};
        } catch (const RenderingStopped&) {
          return std::nullopt;
        }
      }) {}

ReferencePicture::~ReferencePicture() { stop_.request_stop(); }

void ReferencePicture::AskFor(std::size_t stage) {
  stage_ = stage;
  job_.Request({*view_, kStages[stage].reduction, kStages[stage].samples, stop_.get_token()});
}

void ReferencePicture::Show(const View& view) {
  if (view_ && IsSame(*view_, view)) return;
  stop_.request_stop();
  stop_ = std::stop_source();
  view_ = view;
  samples_ = 0;
  AskFor(0);
}

std::optional<Image> ReferencePicture::Take() {
  std::optional<std::optional<Made>> taken = job_.Poll();
  if (!taken || !*taken || (*taken)->stop.stop_requested()) return std::nullopt;
  samples_ = (*taken)->samples;
  if (stage_ + 1 < kStages.size()) AskFor(stage_ + 1);
  return std::move((*taken)->image);
}

namespace {

const std::vector<float>* FindLayer(const Image& image, const std::string& name) {
  for (const Channel& channel : image.layers) {
    if (channel.name == name) return &channel.values;
  }
  return nullptr;
}

const std::vector<float>& LayerOf(const Image& image, const std::string& name) {
  if (const std::vector<float>* layer = FindLayer(image, name)) return *layer;
  throw InternalError("the renderer's picture has no layer " + name);
}

/// Minimum and maximum of a layer in the neighbourhood of a pixel.
struct LuminanceRange {
  float least, most;
};
LuminanceRange RangeAround(const Image& image, const std::vector<float>& layer, int x, int y) {
  LuminanceRange range{INFINITY, -INFINITY};
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, image.height - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, image.width - 1); ++column) {
      const float value = layer[static_cast<std::size_t>(row * image.width + column)];
      range = {std::min(range.least, value), std::max(range.most, value)};
    }
  }
  return range;
}

// Returns whether lamp light changes so much next to a pixel that an offset of a tenth of a pixel
// changes it by a hundredth.
bool IsEdgeOfLamps(const Image& image, const std::vector<float>& lamps, int x, int y,
                   float floor_cd_per_m2) {
  constexpr float kStep = 0.2F;
  const LuminanceRange light = RangeAround(image, lamps, x, y);
  return light.most - light.least > kStep * std::max(light.most, floor_cd_per_m2);
}

}  // namespace

std::vector<PictureLayer> LayersOfEdges() {
  return {PictureLayer::kDepth, PictureLayer::kSunVisibility, PictureLayer::kLamps};
}

std::vector<bool> EdgesOf(const Image& reference) {
  constexpr float kNearer = 1.1F;
  constexpr float kShade = 0.1F;
  const std::vector<float>& depth = LayerOf(reference, kDepthChannel);
  const std::vector<float>& sun = LayerOf(reference, "sun_visibility.Y");
  const std::vector<float>* lamps = FindLayer(reference, "lamps.G");
  const auto floor = static_cast<float>(ChangeFloor(reference));
  std::vector<bool> edges;
  edges.reserve(reference.rgb.size());
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      const LuminanceRange distance = RangeAround(reference, depth, x, y);
      const LuminanceRange light = RangeAround(reference, sun, x, y);
      const bool is_sky = std::isinf(distance.least);
      const bool is_even = is_sky || distance.most <= kNearer * distance.least;
      const bool is_lamp = lamps != nullptr && IsEdgeOfLamps(reference, *lamps, x, y, floor);
      edges.push_back(!is_even || light.most - light.least > kShade || is_lamp);
    }
  }
  return edges;
}

ViewDifference DifferenceOf(const Image& reference, const Image& painted) {
  ALPENGLOW_ENSURE(reference.rgb.size(), ==, painted.rgb.size());
  const std::vector<bool> edges = EdgesOf(reference);
  const double floor = ChangeFloor(reference);
  std::vector<double> changes;
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    if (!edges[i]) changes.push_back(PixelChange(reference.rgb[i], painted.rgb[i], floor));
  }
  ALPENGLOW_ENSURE(changes.size(), >, 0U);
  std::sort(changes.begin(), changes.end());
  double sum = 0.0;
  for (const double change : changes) sum += change;
  const auto count = static_cast<double>(changes.size());
  const auto quantile = [&](double share) {
    return changes[static_cast<std::size_t>(share * (count - 1.0))];
  };
  return {sum / count, quantile(0.99), quantile(0.999), changes.back(),
          1.0 - count / static_cast<double>(reference.rgb.size())};
}

}  // namespace alpenglow::viewer
