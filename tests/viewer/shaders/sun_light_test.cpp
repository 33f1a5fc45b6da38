// SPDX-License-Identifier: MIT
// The sun's disk on the graphics card, against sun_disk.h.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/sun/sun_disk.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/embedded_text.h"

namespace alpenglow {
namespace {

using SunLight = tests::Headless;

constexpr float kRadius_rad = 0.00465F;

/// (mu_s, cosine of the horizon, radius) of disks that rise through three horizons.
std::vector<tests::Arguments<float>> RisingDisks() {
  std::vector<tests::Arguments<float>> points;
  for (const double horizon_rad : {0.0, -0.025, -0.35}) {
    for (int i = -60; i <= 60; ++i) {
      points.push_back({static_cast<float>(std::sin(horizon_rad + 0.02 * i * double{kRadius_rad})),
                        static_cast<float>(std::sin(horizon_rad)), kRadius_rad});
    }
  }
  return points;
}

std::vector<float> OfDisks(const char* component) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  for (const char* name : {"viewer/shaders/view_block.glsl", "viewer/shaders/sun_light.glsl"}) {
    pieces.push_back({name, std::string(viewer::EmbeddedText(name))});
  }
  return tests::EvaluateOnGpu(pieces, std::string("DiskOverHorizon(a[0], a[1], a[2])") + component,
                              RisingDisks());
}

TEST_F(SunLight, OfADiskThatRisesIsThatOfTheRenderer) {
  const std::vector<float> share = OfDisks(".x"), centre = OfDisks(".y");
  const auto points = RisingDisks();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto a = tests::Widen(points[i]);
    const VisibleDisk disk = DiskOverHorizon(a[0], a[1], a[2]);
    EXPECT_NEAR(double{share[i]}, disk.fraction, 1e-5) << "cosines in float place it to 1e-5 radii";
    if (disk.fraction < 1e-5) continue;  // no light comes from there
    EXPECT_NEAR(double{centre[i]}, disk.mu_s_effective, 2e-3 * double{kRadius_rad})
        << "in radii; a sliver's centre is a ratio of what is left of it";
  }
}

}  // namespace
}  // namespace alpenglow
