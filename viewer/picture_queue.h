// SPDX-License-Identifier: MIT
// Provides PictureQueue, which makes pictures while the flight continues.
//
// A thread with its own OpenGL context creates a second flight of the same scene. For each request
// it restores the moment of the request and paints, develops and writes the picture as
// PictureWriter does. Two measures keep the window responsive: on Linux this thread and the threads
// that it starts run at a lower priority, and between two frames the GPU gets at most one ray per
// pixel of a picture. The second flight needs as much memory as the first; it exists only while
// there are requests.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "lut/image/image.h"
#include "renderer/scene/scene.h"
#include "viewer/flight_session.h"

namespace alpenglow::viewer {

/// Request for a picture.
struct PictureRequest {
  FlightMoment moment;
  std::filesystem::path file;  // of one of PictureFormats
  ImageSize size;
  /// Draws instruments over a developed picture; an empty function draws none. It is called from
  /// NextFrame and Finish.
  std::function<DisplayImage(const HdrImage& developed)> instruments = {};
};

/// Outcome of a request.
struct PictureOutcome {
  std::filesystem::path file;
  std::string fault;  // reason why there is no file; empty if the file is written
};

/// Progress of the picture that is being made.
struct PictureUnderWay {
  std::filesystem::path file;
  double share = 0.0;       // completed fraction, [0, 1]
  std::size_t waiting = 0;  // requests that follow
};

/// Makes pictures in a second thread. All member functions are called from one thread, which draws
/// the window.
class PictureQueue {
 public:
  /// Takes the first scene and the settings of a flight.
  PictureQueue(const Scene& scene, const FlightSessionSettings& settings);
  /// Finishes all requests that were not dropped.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  /// Adds a request and returns at once. Pictures are made in the order of the requests.
  void Request(PictureRequest request);
  /// Reports that the window has drawn a frame. The current picture may then continue with its next
  /// part.
  void NextFrame();
  /// Waits until all pictures are written. They continue without waiting for frames.
  void Finish();
  /// Finishes after the OpenGL context of the window is lost: pictures with instruments are not
  /// written.
  void FinishWithoutWindow();
  /// Cancels the pictures that are not painted yet.
  void Drop();

  /// Returns the outcomes since the last call.
  [[nodiscard]] std::vector<PictureOutcome> PollOutcomes();
  /// Returns the progress of the current picture; nullopt if no request is left.
  [[nodiscard]] std::optional<PictureUnderWay> UnderWay() const;
  /// Returns the files of all requests that have not ended.
  [[nodiscard]] std::vector<std::filesystem::path> Files() const;

 private:
  struct SecondFlight;
  /// A picture that waits for the drawing thread to add instruments.
  struct Overlay {
    const HdrImage* developed = nullptr;
    std::optional<DisplayImage> drawn;
    std::exception_ptr fault;
  };

  void Run(const std::stop_token& stop);
  /// @return the reason why there is no file; empty if the file is written.
  [[nodiscard]] std::string Make(const PictureRequest& request,
                                 std::unique_ptr<SecondFlight>& second);
  void Write(const PictureRequest& request, SecondFlight& second);
  void Record(double share);
  [[nodiscard]] DisplayImage WithInstruments(const HdrImage& developed);
  void DrawOverlay(std::unique_lock<std::mutex>& lock);

  Scene scene_;
  FlightSessionSettings settings_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<PictureRequest> requests_;  // the first one is being made
  std::vector<PictureOutcome> outcomes_;
  double share_ = 0.0;
  std::size_t frames_ = 0;       // drawn by the window so far
  std::size_t used_frames_ = 0;  // value of frames_ when the last part of a picture was started
  bool hurries_ = false, drops_ = false, has_window_ = true;
  Overlay overlay_;
  std::jthread thread_;  // last member, because it uses all others
};

}  // namespace alpenglow::viewer
