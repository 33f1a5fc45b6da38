// SPDX-License-Identifier: MIT
// A context for tests of shaders, without any display.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "atmosphere/text/error.h"
#include "viewer/gl/gl_context.h"

namespace alpenglow::tests {

/// Tests of this fixture have a current OpenGL context. They are skipped only where EGL gives none.
class Headless : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      context_ = std::make_unique<HeadlessContext>();
    } catch (const DisplayError& error) {
      GTEST_SKIP() << error.what();
    }
  }

 private:
  std::unique_ptr<HeadlessContext> context_;
};

}  // namespace alpenglow::tests
