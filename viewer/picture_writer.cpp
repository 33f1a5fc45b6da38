// SPDX-License-Identifier: MIT
#include "viewer/picture_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/base/thread_priority.h"
#include "lut/cli/output_file.h"
#include "lut/cli/program.h"
#include "renderer/series/manifest.h"
#include "viewer/gl/gl_context.h"
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

}  // namespace

void RequirePictureName(const std::filesystem::path& file) {
  if (HasExtension(file, ".png") || HasExtension(file, ".exr")) return;
  throw OptionError(
      fmt::format("\"{}\" is no picture's name; it must end in .png or .exr", file.string()));
}

Image PictureWriter::Picture(const ImageSize& size, int samples, const PictureProgress& progress) {
  return PictureOf(flight_.ViewOf(size), samples, progress);
}

namespace {

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

Image PictureWriter::PictureOf(const PaintedView& view, int samples,
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
  const Image image = PictureOf(view, kPictureSamples, progress);
  const Development development = flight_.exposure().DevelopmentOf(image);
  flight_.exposure().Record(development);
  flight_.frames().ShowStill(image, development, screen);
  return HeaderOf(view, development);
}

void PictureWriter::Write(const std::filesystem::path& file, const ImageSize& size,
                          const PictureProgress& progress) {
  RequirePictureName(file);
  Image image = Picture(size, kPictureSamples, progress);
  const PaintedView view = flight_.ViewOf(size);
  const Projection projection = ProjectionOf(view);
  const Development development = flight_.exposure().DevelopmentOf(image, projection);
  const auto& [look, ev100] = development;
  const Metadata metadata = HeaderOf(view, development);
  if (HasExtension(file, ".exr")) {
    WriteExr(file, image, metadata, projection);
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
    recorder.Record(along_s, flight_.eye(), flight_.now());
  }
}

DisplayImage PictureWriter::Film(const ReplayFrame& frame, const ImageSize& size, double seconds) {
  flight_.Show(frame);
  Image image = Picture(size, kPictureSamples);
  ExposureControl& exposure = flight_.exposure();
  exposure.Follow(ReadingOf(image, exposure.look(), ProjectionOf(flight_.ViewOf(size))),
                  flight_.now(), seconds);
  const Look look = exposure.ShownLook();
  return Develop(Balanced(std::move(image), look.white), *exposure.exposure().ev100, look);
}

namespace {

namespace fs = std::filesystem;

/// Returns the first numbered name for which no file with any of the extensions exists.
fs::path NextFree(const fs::path& folder, const char* stem,
                  std::initializer_list<const char*> extensions,
                  const std::vector<fs::path>& promised = {}) {
  for (int number = 1;; ++number) {
    const fs::path free = folder / fmt::format("{}-{:04d}", stem, number);
    const auto is_taken = [&](const char* extension) {
      const fs::path file = free.string() + extension;
      const bool is_promised = std::find(promised.begin(), promised.end(), file) != promised.end();
      return is_promised || fs::exists(file) || fs::exists(GrowingFile::PartOf(file));
    };
    if (std::none_of(extensions.begin(), extensions.end(), is_taken)) return free;
  }
}

}  // namespace

fs::path NextScreenshot(const fs::path& folder, const std::vector<fs::path>& promised) {
  return NextFree(folder, "skyview", {".png", ".exr"}, promised);
}

fs::path NextFlight(const fs::path& folder) {
  fs::path file = NextFree(folder, "flight", {".csv"});
  file += ".csv";
  return file;
}

namespace {

/// Exception that ends a picture that is no longer wanted.
struct Dropped {};

// The threads that the writer starts have its priority: those of the scene, and those of a driver
// that renders on the CPU. They get a third of the weight of the window's thread.
constexpr int kStepsBelowTheWindow = 5;

// Written pictures use the complete atmosphere and exact tables from the start.
FlightSessionSettings WithoutDrafts(FlightSessionSettings settings) {
  if (IsDraft(settings.first_air)) settings.first_air = {};
  return settings;
}

}  // namespace

/// A flight that paints pictures in its own OpenGL context.
struct PictureQueue::SecondFlight {
  HeadlessContext context;
  FlightSession flight;
};

PictureQueue::PictureQueue(const Scene& scene, const FlightSessionSettings& settings)
    : scene_(scene),
      settings_(WithoutDrafts(settings)),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

PictureQueue::~PictureQueue() {
  Finish();
  thread_.request_stop();
  changed_.notify_all();
}

void PictureQueue::Request(PictureRequest request) {
  {
    const std::scoped_lock lock(mutex_);
    requests_.push_back(std::move(request));
  }
  changed_.notify_all();
}

void PictureQueue::NextFrame() {
  std::unique_lock lock(mutex_);
  ++frames_;
  DrawOverlay(lock);
  changed_.notify_all();
}

void PictureQueue::Finish() {
  std::unique_lock lock(mutex_);
  hurries_ = true;
  changed_.notify_all();
  while (!requests_.empty()) {
    DrawOverlay(lock);
    changed_.wait(lock, [&] { return requests_.empty() || overlay_.developed != nullptr; });
  }
  hurries_ = false;
}

void PictureQueue::FinishWithoutWindow() {
  {
    const std::scoped_lock lock(mutex_);
    has_window_ = false;
  }
  Finish();
}

void PictureQueue::Drop() {
  {
    const std::scoped_lock lock(mutex_);
    drops_ = !requests_.empty();
  }
  changed_.notify_all();
}

std::vector<PictureOutcome> PictureQueue::PollOutcomes() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(outcomes_, {});
}

std::optional<PictureUnderWay> PictureQueue::UnderWay() const {
  const std::scoped_lock lock(mutex_);
  if (requests_.empty()) return std::nullopt;
  return PictureUnderWay{requests_.front().file, share_, requests_.size() - 1};
}

std::vector<std::filesystem::path> PictureQueue::Files() const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::filesystem::path> files;
  for (const PictureRequest& request : requests_) files.push_back(request.file);
  return files;
}

// The lock is released while the instruments are drawn.
void PictureQueue::DrawOverlay(std::unique_lock<std::mutex>& lock) {
  if (overlay_.developed == nullptr) return;
  const Image& developed = *overlay_.developed;
  const auto draw = requests_.front().instruments;
  const bool has_window = has_window_;
  lock.unlock();
  Overlay drawn;
  try {
    if (!has_window) throw DisplayError("its instruments need the window, which has gone");
    drawn.drawn = draw(developed);
  } catch (...) {
    drawn.fault = std::current_exception();
  }
  lock.lock();
  overlay_ = std::move(drawn);
  changed_.notify_all();
}

DisplayImage PictureQueue::WithInstruments(const Image& developed) {
  std::unique_lock lock(mutex_);
  overlay_ = {&developed, std::nullopt, nullptr};
  changed_.notify_all();
  changed_.wait(lock, [this] { return overlay_.drawn || overlay_.fault; });
  Overlay overlay = std::exchange(overlay_, {});
  if (overlay.fault) std::rethrow_exception(overlay.fault);
  return std::move(*overlay.drawn);
}

void PictureQueue::Record(double share) {
  std::unique_lock lock(mutex_);
  share_ = share;
  changed_.wait(lock, [this] { return hurries_ || drops_ || frames_ != used_frames_; });
  used_frames_ = frames_;
  if (drops_) throw Dropped();
}

void PictureQueue::Write(const PictureRequest& request, SecondFlight& second) {
  PictureWriter pictures(second.flight);
  const auto progress = [this](double share) { Record(share); };
  second.flight.TakeUp(request.moment);
  if (!request.instruments) return pictures.Write(request.file, request.size, progress);
  const ImageSize& size = request.size;
  const RenderTarget screen(size.width, size.height, RenderTarget::Depth::kNone);
  const Metadata header =
      pictures.PaintStill({screen.framebuffer(), size.width, size.height}, progress);
  WritePng(request.file, WithInstruments(screen.Read()), header);
}

std::string PictureQueue::Make(const PictureRequest& request,
                               std::unique_ptr<SecondFlight>& second) {
  try {
    Record(0.0);
    if (!second)
      second.reset(new SecondFlight{{}, FlightSession(scene_, request.moment.now, settings_)});
    Write(request, *second);
    return "";
  } catch (const Dropped&) {
    return "it was left before it was painted";
  } catch (const std::exception& error) {
    second.reset();  // the flight may be in an inconsistent state
    return error.what();
  } catch (...) {  // a signal
    second.reset();
    return "the program was stopped before it was painted";
  }
}

void PictureQueue::Run(const std::stop_token& stop) {
  LowerPriorityOfThread(kStepsBelowTheWindow);
  std::unique_ptr<SecondFlight> second;
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !requests_.empty(); })) {
    const PictureRequest request = requests_.front();
    share_ = 0.0;
    lock.unlock();
    std::string fault = Make(request, second);
    lock.lock();
    outcomes_.push_back({request.file, std::move(fault)});
    requests_.pop_front();
    changed_.notify_all();
    if (!requests_.empty()) continue;
    drops_ = false;
    lock.unlock();
    second.reset();
    lock.lock();
  }
}

}  // namespace alpenglow::viewer
