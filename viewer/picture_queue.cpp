// SPDX-License-Identifier: MIT
#include "viewer/picture_queue.h"

#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/thread_priority.h"
#include "lut/image/picture_format.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/picture_writer.h"

namespace alpenglow::viewer {
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
  const HdrImage& developed = *overlay_.developed;
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

DisplayImage PictureQueue::WithInstruments(const HdrImage& developed) {
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
  FormatOfPicture(request.file).write_colours(request.file, WithInstruments(screen.Read()), header);
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
