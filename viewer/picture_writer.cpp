// SPDX-License-Identifier: MIT
#include "viewer/picture_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"
#include "lut/cli/program.h"
#include "lut/image/development.h"
#include "lut/image/picture_format.h"
#include "lut/image/white_balance.h"
#include "renderer/series/manifest.h"
#include "renderer/series/scene_metadata.h"
#include "viewer/gl/render_target.h"
#include "viewer/passes/panorama.h"

namespace alpenglow::viewer {
namespace {

constexpr int kPictureSamples = 4;
// Largest side of a tile, used if the driver cannot hold the whole picture: 0.7 GB.
constexpr int kLargestPart = 4096;

// Completed fractions when the flight exists, when its scene is ready, and when all light is
// painted. Over the built-in range at 1280x720 these steps take 2, 3 and 3 s, and writing takes
// 0.3 s.
constexpr double kBegunShare = 0.2;
constexpr double kReadyShare = 0.5;
constexpr double kPaintedShare = 0.95;

int LargestPartOf(const ImageSize& size) {
  return IsDrawable(size.width, size.height) ? std::max(size.width, size.height)
                                             : std::min(LargestSquareOfDriver(), kLargestPart);
}

Projection ProjectionOf(const PaintedView& view) {
  return IsPanorama(view) ? Projection::kLatitudeLongitude : Projection::kCamera;
}

// A panorama is held together with one side of the cube that it is made of: 3 GB at this width.
void RequirePanoramaSize(const PaintedView& view) {
  constexpr int kWidest = 16384;
  if (view.width <= kWidest) return;
  throw OptionError(fmt::format("a panorama of {} x {} pixels is too large; it may be {} wide",
                                view.width, view.height, kWidest));
}

// Returns the progress of the part of a picture that begins at a share; empty if nobody asks.
PictureProgress PartOf(const PictureProgress& progress, double begin, double range) {
  if (!progress) return {};
  return [=](double share) { progress(begin + range * share); };
}

}  // namespace

HdrImage PictureWriter::Picture(const ImageSize& size, int samples,
                                const PictureProgress& progress) {
  return PictureOf(flight_.ViewOf(size), samples, progress);
}

HdrImage PictureWriter::PictureOf(const PaintedView& view, int samples,
                                  const PictureProgress& progress) {
  if (IsPanorama(view)) RequirePanoramaSize(view);
  const FrameRenderer::StillSizes still_sizes(flight_.frames());
  if (progress) progress(kBegunShare);
  flight_.WaitUntilReady({view.width, view.height});
  const std::optional<int> largest_part = flight_.start().settings.largest_part;
  const auto paint = [&](PaintedView part, const PictureProgress& painted) {
    part.eye.place = flight_.eye().place;  // the eye may have been put on the ground
    return flight_.frames().PaintInParts(
        part, samples, largest_part.value_or(LargestPartOf({part.width, part.height})), painted);
  };
  if (progress) progress(kReadyShare);
  constexpr double kRange = kPaintedShare - kReadyShare;
  if (!IsPanorama(view)) return paint(view, PartOf(progress, kReadyShare, kRange));
  int sides = 0;
  return PaintPanorama(view, [&](const PaintedView& side) {
    const double begin = kReadyShare + kRange * sides++ / kPanoramaSides;
    return paint(side, PartOf(progress, begin, kRange / kPanoramaSides));
  });
}

Metadata PictureWriter::HeaderOf(const PaintedView& view, const Development& development) const {
  RenderSettings settings;
  settings.width = view.width;
  settings.height = view.height;
  settings.samples_per_pixel = kPictureSamples;
  settings.filter = PixelFilter::Kind::kBox;
  CameraPose eye = flight_.eye();
  eye.fov_rad = view.eye.fov_rad;
  Metadata metadata = PictureMetadata(flight_.edits().SeenBy(eye, flight_.now()),
                                      flight_.edits().file_hashes(), settings);
  metadata["alpenglow.time"] = FormatUtc(flight_.now(), 3);
  metadata["alpenglow.painter"] = "skyview";
  metadata["alpenglow.quality"] = NameOf(flight_.frames().still_quality());
  metadata.merge(flight_.exposure().Header(development));
  return metadata;
}

Metadata PictureWriter::PaintStill(const ToneMapPass::Screen& screen,
                                   const PictureProgress& progress) {
  const PaintedView view = InWindow(flight_.ViewOf({screen.width, screen.height}));
  const HdrImage image = PictureOf(view, kPictureSamples, progress);
  const Development development = flight_.exposure().DevelopmentOf(image);
  flight_.exposure().Record(development);
  flight_.frames().ShowStill(image, development, screen);
  return HeaderOf(view, development);
}

void PictureWriter::Write(const std::filesystem::path& file, const ImageSize& size,
                          const PictureProgress& progress) {
  const PictureFormat& format = FormatOfPicture(file);
  HdrImage image = Picture(size, kPictureSamples, progress);
  const PaintedView view = flight_.ViewOf(size);
  const Projection projection = ProjectionOf(view);
  const Development development = flight_.exposure().DevelopmentOf(image, projection);
  const Metadata metadata = HeaderOf(view, development);
  if (format.StoresLight()) {
    format.write_light(file, image, metadata, projection);
  } else {
    const Look& look = development.look;
    format.write_colours(
        file, Develop(Balanced(std::move(image), look.white), development.ev100, look), metadata);
  }
}

void PictureWriter::WriteReplay(const CameraPath& path,
                                const std::vector<std::filesystem::path>& files,
                                const ImageSize& size, FlightRecorder& recorder) {
  const double steps = std::max(static_cast<double>(files.size()) - 1.0, 1.0);
  for (std::size_t i = 0; i < files.size(); ++i) {
    ThrowIfInterrupted();
    const double along_s = (path.end_s() - path.begin_s()) * static_cast<double>(i) / steps;
    flight_.Show(ReplayAt(path, path.begin_s() + along_s));
    Write(files[i], size);
    // The ground at this place is loaded by now.
    recorder.Record(along_s, flight_.eye(), flight_.now());
  }
}

DisplayImage PictureWriter::Film(const ReplayFrame& frame, const ImageSize& size, double seconds) {
  flight_.Show(frame);
  HdrImage image = Picture(size, kPictureSamples);
  ExposureControl& exposure = flight_.exposure();
  exposure.Follow(ReadingOf(image, exposure.look(), ProjectionOf(flight_.ViewOf(size))),
                  flight_.now(), seconds);
  const Look look = exposure.ShownLook();
  return Develop(Balanced(std::move(image), look.white), *exposure.exposure().ev100, look);
}

}  // namespace alpenglow::viewer
