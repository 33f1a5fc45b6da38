// SPDX-License-Identifier: MIT
#include "renderer/picture/reference_picture.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "atmosphere/base/error.h"
#include "tests/fixtures/bare_scene.h"
#include "viewer/flight/flight_recorder.h"

namespace alpenglow::viewer {
namespace {

ReferencePicture::View ViewOf(const std::shared_ptr<const ReferenceScene>& of) {
  CameraPose eye{of->scene.place, 1.0, 0.2, 0.0, 1.0};
  eye.place.height_m = 500.0;
  return {of, eye, ParseInstant("2026-06-21T05:00:00Z"), 16, 8};
}

// Takes pictures until there is one of so many rays a pixel.
Image PictureOf(ReferencePicture& reference, int samples) {
  for (;;) {
    std::optional<Image> image = reference.Take();
    if (image && reference.samples() >= samples) return std::move(*image);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

TEST(ReferencePicture, EndsAsTheRenderersPictureOf64Rays) {
  const auto of = std::make_shared<const ReferenceScene>(
      ReferenceScene{BareScene(500.0, 80.0, 20.0, 110.0), nullptr});
  ReferencePicture reference;
  const ReferencePicture::View view = ViewOf(of);
  reference.Show(view);
  EXPECT_EQ(reference.samples(), 0);
  const Image made = PictureOf(reference, 64);
  RenderSettings settings;
  settings.width = 16;
  settings.height = 8;
  settings.samples_per_pixel = 64;
  CameraSample camera_sample(view.now);
  camera_sample.poses = {view.eye};
  EXPECT_EQ(made.rgb, SceneRenderer(of->scene).Render(camera_sample, settings).rgb);
}

TEST(ReferencePicture, OfAViewThatHasChangedNothingIsShown) {
  const auto of = std::make_shared<const ReferenceScene>(
      ReferenceScene{BareScene(500.0, 80.0, 20.0, 110.0), nullptr});
  ReferencePicture reference;
  ReferencePicture::View view = ViewOf(of);
  reference.Show(view);
  static_cast<void>(PictureOf(reference, 1));
  view.width = 32;
  reference.Show(view);
  EXPECT_EQ(reference.samples(), 0) << "what was made before is of another view";
  EXPECT_EQ(PictureOf(reference, 4).width, 32);
  view.now = AddSeconds(view.now, 0.5 * ReferencePicture::kSameTime_s);
  reference.Show(view);
  EXPECT_GE(reference.samples(), 1) << "a clock that runs does not begin it anew at every frame";
}

TEST(ReferencePicture, SaysWhatTheRendererRefuses) {
  Scene scene = BareScene(500.0, 80.0, 20.0, 110.0);
  scene.terrain.kind = TerrainSource::Kind::kElevationModel;
  scene.terrain.file = "nowhere.tif";
  ReferencePicture reference;
  reference.Show(ViewOf(std::make_shared<const ReferenceScene>(ReferenceScene{scene, nullptr})));
  EXPECT_THROW(static_cast<void>(PictureOf(reference, 64)), InputError);
}

}  // namespace
}  // namespace alpenglow::viewer
