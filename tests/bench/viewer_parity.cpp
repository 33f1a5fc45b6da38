// SPDX-License-Identifier: MIT
// Compares pictures of the viewer with pictures of the renderer in fifteen views, without edges.
// Run by hand; results are in README.md.
//   studies viewer_parity FOLDER [WIDTH HEIGHT [SAMPLES [VIEWS]]]
// VIEWS are the numbers of the views to draw, separated by commas: 1,2,15. Both pictures and their
// difference (white is a tenth) are written to the folder. Existing pictures of the renderer are
// read instead of rendered.
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "atmosphere/base/error.h"
#include "lut/image/development.h"
#include "lut/image/exr.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/png.h"
#include "lut/image/tone_mapping.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/picture/reference_picture.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "tests/bench/studies.h"
#include "tests/fixtures/parity_views.h"
#include "viewer/gl/gl_context.h"
#include "viewer/passes/sky_painter.h"

namespace alpenglow::viewer {
namespace {

/// Returns the PixelChange of each pixel in grey; pixels that are left out are blue.
HdrImage DifferencePicture(const HdrImage& reference, const HdrImage& painted) {
  const std::vector<bool> edges = EdgesOf(reference);
  const double floor = ChangeFloor(reference);
  HdrImage picture(reference.width, reference.height);
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    const auto change = static_cast<float>(PixelChange(reference.rgb[i], painted.rgb[i], floor));
    picture.rgb[i] = edges[i] ? std::array{0.0F, 0.0F, 1.0F} : std::array{change, change, change};
  }
  return picture;
}

HdrImage ReferenceOf(const ParityView& view, const RenderSettings& settings,
                     const std::filesystem::path& file) {
  if (std::filesystem::exists(file)) return ReadExr(file);
  HdrImage reference = SceneRenderer(view.scene).Render(view.instant, settings);
  WriteExr(file, reference, {});
  return reference;
}

HdrImage PaintedOf(const ParityView& view, const RenderSettings& settings) {
  const SceneGround ground = LoadGround(view.scene);
  CameraPose eye{view.scene.place, view.scene.camera.heading_rad, view.scene.camera.pitch_rad,
                 view.scene.camera.roll_rad, view.scene.camera.fov_rad};
  eye.place.height_m = ground.eye_height_m;
  const PaintedView painted{eye, view.instant, settings.width, settings.height};
  SkyPainter painter(view.scene, LandSourceOf(view.scene), painted, SizesOf(Quality::kHigh));
  painter.WaitUntilReady(painted, settings.samples_per_pixel);
  painter.Paint(painted, settings.samples_per_pixel);
  return painter.picture().Read();
}

DisplayImage TenfoldGrey(const HdrImage& difference) {
  DisplayImage grey{difference.width, difference.height, {}};
  for (const auto& rgb : difference.rgb) {
    for (const float value : rgb)
      grey.rgb.push_back(static_cast<std::uint8_t>(255.0F * std::min(10.0F * value, 1.0F)));
  }
  return grey;
}

void Run(const std::filesystem::path& folder, const RenderSettings& settings,
         const std::string& views) {
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const ParityView& view : ParityViews()) {
    ++number;
    if (!views.empty() &&
        fmt::format(",{},", views).find(fmt::format(",{},", number)) == std::string::npos)
      continue;
    const std::filesystem::path file = folder / fmt::format("reference-{}.exr", number);
    const HdrImage reference = ReferenceOf(view, settings, file);
    WritePng(folder / fmt::format("reference-{}.png", number),
             Develop(reference, MeterEv100(reference, kSunDiskLuminance_cd_per_m2),
                     {.curve = ToneCurve::kAgx}),
             {});
    const HdrImage painted = PaintedOf(view, settings);
    WriteExr(folder / fmt::format("painted-{}.exr", number), painted, {});
    WritePng(folder / fmt::format("painted-{}.png", number),
             Develop(painted, MeterEv100(reference, kSunDiskLuminance_cd_per_m2),
                     {.curve = ToneCurve::kAgx}),
             {});
    WritePng(folder / fmt::format("difference-{}.png", number),
             TenfoldGrey(DifferencePicture(reference, painted)), {});
    const ErrorStatistics is = DifferenceOf(reference, painted);
    fmt::print(
        "{:<24} mean {:6.3f} %  p99 {:6.3f} %  p99.9 {:6.3f} %  worst {:7.2f} %  edges {:4.1f} %\n",
        view.name, 100.0 * is.mean(), 100.0 * is.Quantile(0.99), 100.0 * is.Quantile(0.999),
        100.0 * is.Largest(),
        100.0 -
            100.0 * static_cast<double>(is.count()) / static_cast<double>(reference.rgb.size()));
  }
}

}  // namespace
}  // namespace alpenglow::viewer

void alpenglow::tests::ViewerParity(int count, char** arguments) {
  if (count < 2) {
    throw atmosphere::InputError("usage: viewer_parity FOLDER [WIDTH HEIGHT [SAMPLES [VIEWS]]]");
  }
  const viewer::RenderSettings settings = viewer::ComparisonSettings(
      count > 3 ? std::atoi(arguments[2]) : 640, count > 3 ? std::atoi(arguments[3]) : 360,
      count > 4 ? std::atoi(arguments[4]) : 64);
  const viewer::HeadlessContext context;
  viewer::Run(arguments[1], settings, count > 5 ? arguments[5] : "");
}
