// SPDX-License-Identifier: MIT
// Whole pictures are as they were when they were last looked at: tests/golden/README.md.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lut/image/exr.h"
#include "renderer/picture/render.h"
#include "renderer/series/frame_times.h"
#include "tests/fixtures/picture_tolerance.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(tests::kSourceFolder) / "tests" / "golden";

struct Golden {
  std::string name, scene, time;
};

std::vector<Golden> Goldens() {
  std::ifstream text(kFolder / "pictures.csv");
  std::vector<Golden> goldens;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    const std::vector<std::string> cells = CellsOf(line);
    goldens.push_back({cells.at(0), cells.at(1), cells.at(2)});
  }
  return goldens;
}

/// Scenes are loaded once.
const SceneRenderer& RendererOf(const std::string& file, const Scene& scene) {
  static std::map<std::string, std::unique_ptr<SceneRenderer>> loaded;
  std::unique_ptr<SceneRenderer>& renderer = loaded[file];
  if (!renderer) renderer = std::make_unique<SceneRenderer>(scene);
  return *renderer;
}

TEST(Golden, PicturesAreTheStoredOnes) {
  const std::vector<Golden> goldens = Goldens();
  EXPECT_EQ(goldens.size(), 7U);
  for (const Golden& golden : goldens) {
    // The other pictures of the range, LitClouds with a small field and SphereLight with few photons run
    // the same code.
    const bool is_repeated = golden.name == "noon" || golden.name == "sunset" ||
                             golden.name == "clouds" || golden.name == "caustic";
    if (tests::kSanitized && is_repeated) continue;
    const fs::path stored = kFolder / (golden.name + ".exr");
    ASSERT_TRUE(fs::exists(stored)) << stored << ": see tests/golden/README.md";
    EXPECT_LE(fs::file_size(stored), 60000U) << "goldens are small";
    const HdrImage image = ReadExr(stored);
    const Scene scene = ReadScene(kFolder / golden.scene);
    const UtcTime instant = InstantFromText(golden.time, {scene.place, scene.zone, scene.time});
    RenderSettings settings;
    settings.width = image.width;
    settings.height = image.height;
    settings.samples_per_pixel = 4;
    const HdrImage now = RendererOf(golden.scene, scene).Render(instant, settings);
    EXPECT_EQ(FaultOfPicture(image, now), "") << golden.name;
  }
}

/// Returns a smooth picture without details.
HdrImage Gradient() {
  HdrImage image(160, 90);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto level = static_cast<float>(100 + 10 * y + x);
      image.at(x, y) = {level, 1.2F * level, 1.5F * level};
    }
  }
  return image;
}

void Scale(std::array<float, 3>& pixel, float by) {
  for (float& value : pixel) value *= by;
}

TEST(GoldenTolerance, RoundingOfAnotherCompilerPasses) {
  HdrImage other = Gradient();
  for (std::size_t i = 0; i < other.rgb.size(); ++i)
    Scale(other.rgb[i], i % 2 == 0 ? 1.00005F : 0.99995F);
  EXPECT_EQ(FaultOfPicture(Gradient(), other), "");
}

TEST(GoldenTolerance, ARayOverAnEdgeInOneOfTwoHundredPixelsPasses) {
  HdrImage other = Gradient();
  for (std::size_t i = 7; i < other.rgb.size(); i += 200) Scale(other.rgb[i], 1.01F);
  EXPECT_EQ(FaultOfPicture(Gradient(), other), "");
}

TEST(GoldenTolerance, HalfAPercentBrighterIsAnotherPicture) {
  HdrImage other = Gradient();
  for (auto& pixel : other.rgb) Scale(pixel, 1.005F);
  EXPECT_NE(FaultOfPicture(Gradient(), other), "");
}

TEST(GoldenTolerance, AShiftOfColourIsAnotherPicture) {
  HdrImage other = Gradient();
  for (auto& pixel : other.rgb) pixel[2] *= 1.01F;
  EXPECT_NE(FaultOfPicture(Gradient(), other), "");
}

TEST(GoldenTolerance, ASmallWrongPlaceIsAnotherPicture) {
  HdrImage other = Gradient();
  for (std::size_t i = 0; i < 200; ++i) Scale(other.rgb[i], 1.012F);
  EXPECT_LT(ChangeOf(Gradient(), other).Rms(), PictureTolerance{}.rms);
  EXPECT_NE(FaultOfPicture(Gradient(), other), "") << "200 of 14400 pixels, by 1.2 %";
}

TEST(GoldenTolerance, OtherSizesAndBrokenPixelsAreNamed) {
  EXPECT_EQ(FaultOfPicture(Gradient(), HdrImage(90, 160)),
            "is 90 x 160; the golden picture is 160 x 90");
  HdrImage broken = Gradient();
  broken.at(3, 3)[1] = std::nanf("");
  EXPECT_EQ(FaultOfPicture(Gradient(), broken), "has a pixel that is not finite");
}

}  // namespace
}  // namespace alpenglow::renderer
