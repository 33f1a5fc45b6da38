// SPDX-License-Identifier: MIT
// Names of files that a key asks for.
//
// Pictures that are made while the flight goes on.
//
// A thread with an OpenGL context of its own makes a second flight of the same scene, takes up the
// moment of each request in turn, and paints, develops and writes its picture as WritePicture does.
// The window's share of the machine is kept in two ways: on Linux this thread and those that it
// starts run at a lower priority, and between two frames the graphics card gets no more than one
// ray a pixel of a picture. The second flight takes as much memory as the first; it is there only
// while there are requests.
#pragma once

#include <condition_variable>
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

#include "viewer/flythrough.h"

namespace alpenglow::viewer {

/// The next free of skyview-0001, skyview-0002, ... in the folder: with neither a .png nor an .exr,
/// so that both of one frame have one number.
/// @param promised  files that are not there yet and will be.
[[nodiscard]] std::filesystem::path NextScreenshot(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& promised = {});

/// The next free of flight-0001.csv, flight-0002.csv, ...: neither there nor being recorded into.
[[nodiscard]] std::filesystem::path NextFlight(const std::filesystem::path& folder);

/// A picture that is asked for.
struct PictureRequest {
  FlightMoment moment;
  std::filesystem::path file;  // .png or .exr
  ImageSize size;
  /// Draws instruments over a developed picture; empty: none. Called from NextFrame and Finish.
  std::function<DisplayImage(const Image& developed)> instruments = {};
};

/// How a request ended.
struct PictureOutcome {
  std::filesystem::path file;
  std::string fault;  // why there is no file; empty: it is written
};

/// The picture that is being made.
struct PictureUnderWay {
  std::filesystem::path file;
  double share = 0.0;       // done, [0, 1]
  std::size_t waiting = 0;  // behind it
};

/// All calls come from one thread, which draws the window.
class PictureQueue {
 public:
  /// Of a flight's first scene and its settings.
  PictureQueue(const Scene& scene, const FlythroughSettings& settings);
  /// Finishes what has been asked for, if it was not dropped.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  /// Returns at once. Pictures are made in the order in which they are asked for.
  void Ask(PictureRequest request);
  /// A frame of the window was drawn: the picture under way may go on to its next part.
  void NextFrame();
  /// Waits until all is written, without frames between.
  void Finish();
  /// The same when the window's OpenGL is lost: pictures with instruments are not written.
  void FinishWithoutWindow();
  /// Gives up what is not painted yet.
  void Drop();

  /// What has ended since the last call.
  [[nodiscard]] std::vector<PictureOutcome> TakeOutcomes();
  /// Nothing: all that was asked for has ended.
  [[nodiscard]] std::optional<PictureUnderWay> UnderWay() const;
  /// Files that are asked for and have not ended.
  [[nodiscard]] std::vector<std::filesystem::path> Files() const;

 private:
  struct SecondFlight;
  /// What waits for the thread that draws.
  struct Overlay {
    const Image* developed = nullptr;
    std::optional<DisplayImage> drawn;
    std::exception_ptr fault;
  };

  void Run(const std::stop_token& stop);
  /// @return why there is no file; empty: it is written.
  [[nodiscard]] std::string Make(const PictureRequest& request,
                                 std::unique_ptr<SecondFlight>& second);
  void Write(const PictureRequest& request, SecondFlight& second);
  void Note(double share);
  [[nodiscard]] DisplayImage WithInstruments(const Image& developed);
  void DrawOverlay(std::unique_lock<std::mutex>& lock);

  Scene scene_;
  FlythroughSettings settings_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<PictureRequest> requests_;  // the first is under way
  std::vector<PictureOutcome> outcomes_;
  double share_ = 0.0;
  std::size_t frames_ = 0;       // drawn by the window so far
  std::size_t used_frames_ = 0;  // so many of them had a part of a picture after them
  bool hurries_ = false, drops_ = false, has_window_ = true;
  Overlay overlay_;
  std::jthread thread_;  // last: it uses all above
};

}  // namespace alpenglow::viewer
