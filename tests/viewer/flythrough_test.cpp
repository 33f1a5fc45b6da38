// SPDX-License-Identifier: MIT
// Pictures of a flight, without hands.
#include "viewer/flythrough.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/land/headless_land.h"
#include "viewer/gl/picture_tiles.h"

namespace alpenglow {
namespace {

class PicturesInParts : public tests::HeadlessTile {
 protected:
  /// Mountains under a low sun, with shafts.
  [[nodiscard]] Flythrough FlightOf(std::optional<int> largest_part) const {
    const Scene scene = SceneOverTile(tests::PlaceOfSample(120.0, 200.0, 0.0),
                                      CameraFromDegrees({3500.0, false}, 330.0, -8.0, 7.0, 75.0));
    FlythroughSettings settings;
    settings.land = LandSourceOf(scene);
    settings.quality = {Quality::kMedium};
    settings.size = kSize;
    settings.largest_part = largest_part;
    return {scene, ParseInstant("2026-06-21T18:20:00Z"), settings};
  }

  static constexpr ImageSize kSize{560, 300};
  static constexpr int kPart = 480;
};

/// Of the larger of both, in the channel that differs most.
double Difference(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  double most = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto x = static_cast<double>(a[c]), y = static_cast<double>(b[c]);
    most = std::max(most, std::abs(x - y) / std::max(std::max(std::abs(x), std::abs(y)), 1e-6));
  }
  return most;
}

TEST_F(PicturesInParts, ArePicturesInOnePiece) {
  const Image whole = FlightOf(std::nullopt).Picture(kSize, 4);
  const Image parts = FlightOf(kPart).Picture(kSize, 4);
  ASSERT_GE(TiledPicture(kSize.width, kSize.height, kPart).tiles().size(), 6U);
  double worst = 0.0;
  for (int y = 0; y < whole.height; ++y) {
    for (int x = 0; x < whole.width; ++x)
      worst = std::max(worst, Difference(whole.at(x, y), parts.at(x, y)));
  }
  EXPECT_LT(worst, 1e-3) << "rounding of floats in a narrower view; a tile without its rim is off "
                            "by several per cent where shafts end";
}

TEST_F(PicturesInParts, AreExposedAsAWhole) {
  for (const std::optional<int> part : {std::optional<int>(), std::optional(kPart)}) {
    Flythrough flight = FlightOf(part);
    flight.WritePicture(folder_ / (part ? "parts.png" : "whole.png"), kSize);
  }
  EXPECT_NEAR(std::stod(ReadPngMetadata(folder_ / "parts.png").at("alpenglow.ev100")),
              std::stod(ReadPngMetadata(folder_ / "whole.png").at("alpenglow.ev100")), 1e-3);
}

}  // namespace
}  // namespace alpenglow
