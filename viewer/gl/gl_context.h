// SPDX-License-Identifier: MIT
// Provides OpenGL core contexts, 3.3 or later, with the newest version that the driver supports;
// versions are tried downwards from 4.6.
//
// This file provides the headless context (EGL, no display); window.h provides the context of a
// window. All GL calls of this folder use the context that is current on the calling thread.
#pragma once

#include <array>
#include <memory>
#include <string>

namespace alpenglow::viewer {

/// A version of OpenGL that is requested from a driver.
struct GlVersion {
  int major;
  int minor;
};

/// Versions to request, newest first. The last one is the oldest that the shaders support. Mesa's
/// llvmpipe supports 4.5 and rejects 4.6, so one rejection does not mean that OpenGL is missing.
inline constexpr std::array<GlVersion, 8> kGlVersions{
    {{4, 6}, {4, 5}, {4, 4}, {4, 3}, {4, 2}, {4, 1}, {4, 0}, {3, 3}}};

/// A context without a display: on a GPU that EGL can reach, otherwise on Mesa's software renderer.
/// It is current on the thread that constructs it until it is destroyed.
class HeadlessContext {
 public:
  /// Throws DisplayError that lists the attempts if EGL is missing or does not support OpenGL 3.3.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns a description of the current context: "OpenGL 4.5 (Core Profile) Mesa 22.3.6 on llvmpipe
/// (...)".
[[nodiscard]] std::string GlDescription();

/// Throws DisplayError if the context is lost because the GPU or its driver was reset. Detection
/// requires a context that reports resets (OpenGL 4.5 or KHR_robustness).
void RequireContext();

/// Throws an error if GL has recorded one since the last call: DisplayError for insufficient memory
/// or a lost context, otherwise InternalError that names `where`.
void CheckGl(const char* where);

}  // namespace alpenglow::viewer
