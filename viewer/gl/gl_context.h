// SPDX-License-Identifier: MIT
// OpenGL core contexts, 3.3 or later: the newest the driver gives, probed downwards from 4.6.
//
// Headless here (EGL, no display); with a window in window.h. All GL calls of this folder go to the
// context that is current on the calling thread.
#pragma once

#include <array>
#include <memory>
#include <string>

namespace alpenglow::viewer {

/// A version of OpenGL, as asked of a driver.
struct GlVersion {
  int major;
  int minor;
};

/// Newest first; the last one is the oldest that the shaders are written for. Mesa's llvmpipe gives
/// 4.5 and refuses 4.6, so that one refusal says little.
inline constexpr std::array<GlVersion, 8> kGlVersions{
    {{4, 6}, {4, 5}, {4, 4}, {4, 3}, {4, 2}, {4, 1}, {4, 0}, {3, 3}}};

/// A context without any display: on a graphics card that EGL can reach, else Mesa's software one.
/// Current on the thread that made it until it is destroyed.
class HeadlessContext {
 public:
  /// Throws DisplayError, with what was tried, when EGL is missing or gives no OpenGL 3.3.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "OpenGL 4.5 (Core Profile) Mesa 22.3.6 on llvmpipe (...)" of the current context.
[[nodiscard]] std::string GlDescription();

/// Throws DisplayError when the context is lost: its graphics card or driver was reset. Only where
/// the context was made to tell (OpenGL 4.5 or KHR_robustness).
void RequireContext();

/// Throws InternalError naming `where` when GL has recorded an error since the last call;
/// DisplayError when that is a lack of memory or a lost context.
void CheckGl(const char* where);

}  // namespace alpenglow::viewer
