// SPDX-License-Identifier: MIT
#include "viewer/picture_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/program.h"
#include "renderer/series/manifest.h"
#include "viewer/gl/picture_tiles.h"

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

}  // namespace

void RequirePictureName(const std::filesystem::path& file) {
  if (HasExtension(file, ".png") || HasExtension(file, ".exr")) return;
  throw InputError(
      fmt::format("\"{}\" is no picture's name; it must end in .png or .exr", file.string()));
}

Image PictureWriter::Picture(const ImageSize& size, int samples, const PictureProgress& progress) {
  const FrameRenderer::StillSizes still_sizes(flight_.frames());
  if (progress) progress(kBegunShare);
  flight_.WaitUntilReady(size, samples);
  if (progress) progress(kReadyShare);
  PictureProgress painted;
  if (progress) {
    painted = [&](double share) { progress(kReadyShare + (kPaintedShare - kReadyShare) * share); };
  }
  const std::optional<int> largest_part = flight_.start().settings.largest_part;
  return flight_.frames().PaintInParts(flight_.ViewOf(size), samples,
                                       largest_part.value_or(LargestPartOf(size)), painted);
}

Metadata PictureWriter::HeaderOf(const ImageSize& size, const Development& development) const {
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  settings.samples_per_pixel = kPictureSamples;
  settings.filter = PixelFilter::Kind::kBox;
  Metadata metadata =
      PictureMetadata(flight_.edits().SeenBy(flight_.eye(), flight_.now()), settings);
  metadata["alpenglow.time"] = FormatUtc(flight_.now(), 3);
  metadata["alpenglow.painter"] = "skyview";
  metadata["alpenglow.quality"] = NameOf(flight_.frames().still_quality());
  metadata.merge(flight_.exposure().Header(development));
  return metadata;
}

Metadata PictureWriter::PaintStill(const ToneMapPass::Screen& screen,
                                   const PictureProgress& progress) {
  const ImageSize size{screen.width, screen.height};
  const Image image = Picture(size, kPictureSamples, progress);
  const Development development = flight_.exposure().DevelopmentOf(image);
  flight_.exposure().Record(development);
  flight_.frames().ShowStill(image, development, screen);
  return HeaderOf(size, development);
}

void PictureWriter::Write(const std::filesystem::path& file, const ImageSize& size,
                          const PictureProgress& progress) {
  RequirePictureName(file);
  Image image = Picture(size, kPictureSamples, progress);
  const Development development = flight_.exposure().DevelopmentOf(image);
  const auto& [look, ev100] = development;
  const Metadata metadata = HeaderOf(size, development);
  if (HasExtension(file, ".exr")) {
    WriteExr(file, image, metadata);
  } else {
    WritePng(file, Develop(Balanced(std::move(image), look.white), ev100, look), metadata);
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
    recorder.Note(along_s, flight_.eye(), flight_.now());
  }
}

DisplayImage PictureWriter::Film(const ReplayFrame& frame, const ImageSize& size, double seconds) {
  flight_.Show(frame);
  Image image = Picture(size, kPictureSamples);
  ExposureControl& exposure = flight_.exposure();
  exposure.Follow(ReadingOf(image, exposure.look()), flight_.now(), seconds);
  const Look look = exposure.ShownLook();
  return Develop(Balanced(std::move(image), look.white), *exposure.exposure().ev100, look);
}

}  // namespace alpenglow::viewer
