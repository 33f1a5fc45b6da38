// SPDX-License-Identifier: MIT
#include "atmosphere/base/parsing.h"

#include <gtest/gtest.h>

namespace alpenglow::atmosphere {
namespace {

TEST(FileExtension, IsTheSameInWhateverCase) {
  for (const char* name : {"track.gpx", "folder.d/TRACK.GPX", "a.b.GpX"}) {
    EXPECT_TRUE(HasExtension(name, ".gpx")) << name;
  }
  for (const char* name : {"gpx", ".gpx", "track.gp", "track.gpxx", "track.gpx/file", ""}) {
    EXPECT_FALSE(HasExtension(name, ".gpx")) << name;
  }
  EXPECT_TRUE(HasExtension("none", ""));
}

}  // namespace
}  // namespace alpenglow::atmosphere
