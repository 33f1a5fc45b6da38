// SPDX-License-Identifier: MIT
#include "viewer/gl/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "atmosphere/base/error.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

// libepoxy ends the process if libEGL is missing. This check throws an exception instead.
void RequireEglLibrary() {
  void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) {
    throw DisplayError("no OpenGL without a display here: libEGL.so.1 is not installed");
  }
  // The library stays open, because the drivers loaded by it do not support being unloaded.
}

// Returns the displays to try: first the GPUs in EGL's order, then Mesa's surfaceless platform and
// devices of software, then the default display.
std::vector<EGLDisplay> CandidateDisplays() {
  std::vector<EGLDisplay> displays, of_software;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_query") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
    for (EGLint i = 0; i < count; ++i) {
      const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
      const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
      const bool software = extensions != nullptr &&
                            epoxy_extension_in_string(extensions, "EGL_MESA_device_software");
      (software ? of_software : displays)
          .push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
    }
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    displays.push_back(
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  displays.insert(displays.end(), of_software.begin(), of_software.end());
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return displays;
}

std::optional<EGLConfig> AnyConfig(EGLDisplay display) {
  const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) return std::nullopt;
  return config;
}

EGLContext NewestContext(EGLDisplay display, EGLConfig config) {
  for (const GlVersion& version : kGlVersions) {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 version.major,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 version.minor,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

// The displays on which software OpenGL has a context, once for each context.
class SoftwareDisplays {
 public:
  void Add(EGLDisplay display) {
    const std::lock_guard lock(mutex_);
    used_.push_back(display);
  }
  void Remove(EGLDisplay display) {
    const std::lock_guard lock(mutex_);
    const auto one = std::find(used_.begin(), used_.end(), display);
    if (one != used_.end()) used_.erase(one);
  }
  bool Has(EGLDisplay display) {
    const std::lock_guard lock(mutex_);
    return std::find(used_.begin(), used_.end(), display) != used_.end();
  }

 private:
  std::mutex mutex_;
  std::vector<EGLDisplay> used_;
};

SoftwareDisplays& UsedBySoftware() {
  static SoftwareDisplays displays;
  return displays;
}

// Returns whether the bound texture has storage of this size and format.
bool HoldsTexels(GLenum target, const Texels& of) {
  const auto is = [&](GLenum property, GLint wanted) {
    GLint value = 0;
    glGetTexLevelParameteriv(target, 0, property, &value);
    return value == wanted;
  };
  return is(GL_TEXTURE_WIDTH, of.width) &&
         is(GL_TEXTURE_INTERNAL_FORMAT, static_cast<GLint>(of.internal_format)) &&
         (target == GL_TEXTURE_1D || is(GL_TEXTURE_HEIGHT, of.height)) &&
         (target == GL_TEXTURE_1D || target == GL_TEXTURE_2D || is(GL_TEXTURE_DEPTH, of.depth));
}

void AllocateTexels(GLenum target, const Texels& of) {
  const auto internal = static_cast<GLint>(of.internal_format);
  if (target == GL_TEXTURE_1D) {
    glTexImage1D(target, 0, internal, of.width, 0, of.format, of.type, of.data);
  } else if (target == GL_TEXTURE_2D) {
    glTexImage2D(target, 0, internal, of.width, of.height, 0, of.format, of.type, of.data);
  } else {
    glTexImage3D(target, 0, internal, of.width, of.height, of.depth, 0, of.format, of.type,
                 of.data);
  }
}

void OverwriteTexels(GLenum target, const Texels& of) {
  if (target == GL_TEXTURE_1D) {
    glTexSubImage1D(target, 0, 0, of.width, of.format, of.type, of.data);
  } else if (target == GL_TEXTURE_2D) {
    glTexSubImage2D(target, 0, 0, 0, of.width, of.height, of.format, of.type, of.data);
  } else {
    glTexSubImage3D(target, 0, 0, 0, 0, of.width, of.height, of.depth, of.format, of.type, of.data);
  }
}

}  // namespace

struct HeadlessContext::State {
  EGLDisplay display;
  EGLContext context;

  State(EGLDisplay on, EGLContext made) : display(on), context(made) {
    if (IsSoftwareOpenGl()) UsedBySoftware().Add(display);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  // The display stays open: the whole process shares it, and other contexts may use it.
  ~State() {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    UsedBySoftware().Remove(display);
  }

  // Returns a current context; null if the display gives none.
  static std::unique_ptr<State> On(EGLDisplay display) {
    const std::optional<EGLConfig> config =
        eglBindAPI(EGL_OPENGL_API) ? AnyConfig(display) : std::nullopt;
    const EGLContext context = config ? NewestContext(display, *config) : EGL_NO_CONTEXT;
    if (context != EGL_NO_CONTEXT &&
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      return std::make_unique<State>(display, context);
    }
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    return nullptr;
  }
};

// Before llvmpipe touches a texture, it looks through the unfinished draws of all contexts of the
// display (llvmpipe_flush_resource of Mesa 22.3), without a lock on them: where two threads draw, it
// reads what the other has freed. A context of software OpenGL therefore shares a display only if
// every display has one.
HeadlessContext::HeadlessContext() {
  RequireEglLibrary();
  bool any_initialised = false;
  for (const bool shares : {false, true}) {
    for (EGLDisplay display : CandidateDisplays()) {
      if (display == EGL_NO_DISPLAY || (!shares && UsedBySoftware().Has(display))) continue;
      if (!eglInitialize(display, nullptr, nullptr)) continue;
      any_initialised = true;
      state_ = State::On(display);
      if (state_) return;
    }
  }
  throw DisplayError(any_initialised
                         ? "the OpenGL that EGL gives without a display is older than 3.3"
                         : "EGL opens no device here, so there is no OpenGL without a display");
}

HeadlessContext::~HeadlessContext() = default;

std::string GlDescription() {
  const auto text = [](GLenum name) {
    const auto* bytes = glGetString(name);
    return bytes == nullptr ? std::string("unknown") : reinterpret_cast<const char*>(bytes);
  };
  return fmt::format("OpenGL {} on {}", text(GL_VERSION), text(GL_RENDERER));
}

bool IsSoftwareOpenGl() {
  const auto* bytes = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = bytes == nullptr ? "" : bytes;
  const auto names = {"llvmpipe", "softpipe", "SWR", "SwiftShader", "Software"};
  return std::any_of(names.begin(), names.end(), [&](const char* name) {
    return renderer.find(name) != std::string_view::npos;
  });
}

int TextureUnitsOfDriver() {
  GLint units = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  const char* const text = std::getenv("ALPENGLOW_TEXTURE_UNITS");
  const std::string_view asked = text == nullptr ? "" : text;
  if (asked.empty()) return units;  // a shell can only clear it
  GLint fewer = 0;
  const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), fewer);
  if (error != std::errc() || end != asked.data() + asked.size() || fewer < 1)
    throw InputError(
        fmt::format("ALPENGLOW_TEXTURE_UNITS is \"{}\"; it must be a whole number from 1", asked));
  return std::min(units, fewer);
}

void RequireContext() {
  // libepoxy ends the process if a missing function is called, so check for it first.
  const bool tells = epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness");
  if (tells && glGetGraphicsResetStatus() != GL_NO_ERROR) {
    throw DisplayError(
        "the graphics card or its driver was reset, and the window's OpenGL is lost");
  }
}

void CheckGl(const char* where) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  if (error == GL_OUT_OF_MEMORY) {
    throw DisplayError(fmt::format("{}: the graphics card has no memory left", where));
  }
  if (error == GL_CONTEXT_LOST) throw DisplayError(fmt::format("{}: OpenGL is lost", where));
  throw InternalError(fmt::format("{}: OpenGL error 0x{:04x}", where, error));
}

void ClampAndFilter(GLenum target, bool linear) {
  const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

// New storage costs more than its values: software drivers clear it, and its pages are new.
void UploadTexture(GLenum target, const GlTexture& texture, const Texels& of) {
  glBindTexture(target, texture.id());
  if (!HoldsTexels(target, of)) {
    AllocateTexels(target, of);
  } else if (of.data != nullptr) {
    OverwriteTexels(target, of);
  }
  ClampAndFilter(target, true);
}

}  // namespace alpenglow::viewer
