// SPDX-License-Identifier: MIT
// A context for tests of shaders, without any display.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "atmosphere/base/error.h"
#include "viewer/gl/gl_context.h"
#include "viewer/layer.h"

namespace alpenglow::tests {

using namespace viewer;

/// A context that is current; null where EGL gives none.
inline std::unique_ptr<HeadlessContext> ContextOrNone() {
  try {
    return std::make_unique<HeadlessContext>();
  } catch (const DisplayError&) {
    return nullptr;
  }
}

inline bool HasOpenGl() {
  static const bool has = ContextOrNone() != nullptr;
  return has;
}

/// Tests of this fixture have a current OpenGL context. They are skipped only where EGL gives none.
/// @tparam Base  a fixture that they need too.
template <typename Base>
class HeadlessWith : public Base {
 protected:
  void SetUp() override {
    Base::SetUp();
    context_ = ContextOrNone();
    if (!context_) GTEST_SKIP() << "EGL gives no OpenGL here";
  }

 private:
  std::unique_ptr<HeadlessContext> context_;
};

using Headless = HeadlessWith<::testing::Test>;

/// Tests of this fixture share an OpenGL context and a value that the first of them makes in it.
/// They are skipped only where EGL gives none.
template <typename Shared>
class HeadlessSharing : public ::testing::Test {
 public:
  static void TearDownTestSuite() {
    shared_.reset();
    context_.reset();
  }

 protected:
  void SetUp() override {
    if (!context_) context_ = ContextOrNone();
    if (!context_) GTEST_SKIP() << "EGL gives no OpenGL here";
    if (!shared_) shared_ = std::make_unique<Shared>();
  }
  [[nodiscard]] static Shared& shared() { return *shared_; }

 private:
  static inline std::unique_ptr<HeadlessContext> context_;
  static inline std::unique_ptr<Shared> shared_;
};

}  // namespace alpenglow::tests
