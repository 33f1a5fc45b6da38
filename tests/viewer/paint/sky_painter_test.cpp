// SPDX-License-Identifier: MIT
// Pictures of the graphics card against those of the renderer, pixel by pixel.
#include "viewer/paint/sky_painter.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "atmosphere/number/constants.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 54;

/// Relative differences of the pixels of some rows,
/// ascending; dark ones against a millionth of the brightest.
std::vector<double> Differences(const Image& judge, const Image& other, int first_row = 0,
                                int last_row = kHeight - 1) {
  float brightest = 0.0F;
  for (const auto& pixel : judge.rgb) brightest = std::max(brightest, pixel[1]);
  std::vector<double> differences;
  for (std::size_t i = static_cast<std::size_t>(first_row) * kWidth;
       i < (static_cast<std::size_t>(last_row) + 1) * kWidth; ++i) {
    const auto& a = judge.rgb[i];
    const auto& b = other.rgb[i];
    const float scale =
        std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2]), 1e-6F * brightest, 1e-20F});
    float worst = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]) / scale);
    differences.push_back(std::isfinite(b[0] + b[1] + b[2]) ? static_cast<double>(worst) : 1e30);
  }
  std::sort(differences.begin(), differences.end());
  return differences;
}

double Quantile(const std::vector<double>& ascending, double share) {
  return ascending[static_cast<std::size_t>(share * static_cast<double>(ascending.size() - 1))];
}

/// Light of higher orders over the place of all scenes: solved once, it takes most of the time.
const DiffuseLight& Diffuse(const Medium& medium) {
  static const DiffuseLight diffuse(medium);
  return diffuse;
}

class SkyPainterTest : public tests::Headless {
 protected:
  struct Pictures {
    Image judge, painted;
  };
  // The same pictures twice.
  static std::vector<Pictures> PaintBoth(const Scene& scene,
                                         const std::vector<const char*>& instants) {
    const SceneRenderer judge(scene);
    RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.samples_per_pixel = 1;
    settings.effects = settings.effects.Without(
        Effect::kShafts);  // the painter's air is lit wherever the planet does not shade it
    const SceneGround ground = LoadGround(scene);
    SkyPainter painter(judge.medium(), Diffuse(judge.medium()),
                       ground.terrain ? ground.terrain->mesh() : TriangleMesh{}, ground.frame,
                       scene.terrain.kind != TerrainSource::Kind::kMesh);
    Eye eye = EyeOf(scene);
    eye.place.height_m = judge.eye_height_m();
    std::vector<Pictures> pictures;
    for (const char* utc : instants) {
      painter.Paint(eye, ParseInstant(utc), kWidth, kHeight);
      pictures.push_back({judge.Render(ParseInstant(utc), settings), painter.Read()});
    }
    return pictures;
  }
  static Eye EyeOf(const Scene& scene) {
    Eye eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, scene.camera.roll_rad,
            scene.camera.fov_rad};
    eye.place.height_m = scene.camera.height.value_m;
    return eye;
  }
  // A painter of bare sky over the scene's place.
  static SkyPainter SkyOver(const Scene& scene) {
    Medium medium = scene.medium;
    medium.planet_radius_m = OsculatingRadius(kWgs84, scene.place.latitude_rad);
    return SkyPainter(medium, Diffuse(medium), TriangleMesh{}, LocalFrame(kWgs84, scene.place),
                      true);
  }
};

TEST_F(SkyPainterTest, TheSkyIsTheRenderersFromNoonToTwilight) {
  const std::vector<const char*> instants = {
      "2026-06-21T11:00:00Z",   // the sun behind and above
      "2026-06-21T05:00:00Z",   // before the camera, 12 degrees high
      "2026-06-21T03:42:00Z",   // on the horizon
      "2026-06-21T03:00:00Z",   // 5 degrees below it
      "2026-06-21T18:55:00Z"};  // opposite: the belt of Venus
  const Scene scene = BareScene(2.0, 80.0, 20.0, 110.0);
  const CameraRays camera(scene.camera, kWidth, kHeight);
  int horizon = 0;  // the first row that shows ground in the middle
  while (camera.Direction(kWidth / 2 + 0.5, horizon + 0.5).z > 0.0) ++horizon;
  const auto all = PaintBoth(scene, instants);
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(instants[i]);
    const auto& [judge, painted] = all[i];
    const std::vector<double> sky = Differences(judge, painted, 0, horizon - 2);
    EXPECT_LT(Quantile(sky, 0.5), 5e-4) << "float, and a bilinear map of diffuse light";
    EXPECT_LT(Quantile(sky, 0.995), 3e-3) << "all but the edge of the sun";
    const std::vector<double> ground = Differences(judge, painted, horizon + 1);
    EXPECT_LT(Quantile(ground, 0.99), 4e-2)
        << "light on the ground is that of one random point of the sun's disk in the renderer";
  }
}

// Hard case 5.
TEST_F(SkyPainterTest, FromAnAeroplaneAndFromOrbitTheSkyIsTheRenderers) {
  for (const double height_m : {10e3, 400e3}) {
    const Scene scene = BareScene(height_m, 160.0, height_m > 100e3 ? -20.0 : -5.0, 50.0);
    const Pictures both = PaintBoth(scene, {"2026-06-21T06:00:00Z"}).front();
    const std::vector<double> differences = Differences(both.judge, both.painted);
    EXPECT_LT(Quantile(differences, 0.5), 1e-3) << height_m;
    EXPECT_LT(Quantile(differences, 0.98), 2e-2)
        << "at the limb light falls by e within a quarter of a pixel";
  }
}

TEST_F(SkyPainterTest, NoPixelIsBlackOrNegativeInDaylight) {
  const Scene scene = BareScene(2.0, 30.0, 0.0, 100.0);
  SkyPainter painter = SkyOver(scene);
  for (const double height_m : {-100.0, 0.0, 0.01, 2.0, 3000.0, 60e3, 119999.0, 120001.0}) {
    Eye eye = EyeOf(scene);
    eye.place.height_m = height_m;
    painter.Paint(eye, ParseInstant("2026-06-21T11:00:00Z"), kWidth, kHeight);
    const Image image = painter.Read();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto& pixel = image.at(x, y);
        ASSERT_TRUE(std::isfinite(pixel[0] + pixel[1] + pixel[2])) << height_m << " m";
        ASSERT_GT(pixel[2], height_m > 100e3 ? -1e-6F : 0.0F) << x << " " << y << ", " << height_m;
      }
    }
  }
}

TEST_F(SkyPainterTest, DevelopsAsTheRendererDoes) {
  const Scene scene = BareScene(2.0, 100.0, 15.0, 60.0);
  SkyPainter painter = SkyOver(scene);
  painter.Paint(EyeOf(scene), ParseInstant("2026-06-21T03:42:00Z"), kWidth, kHeight);
  const Image image = painter.Read();
  const double ev100 = painter.MeteredEv100();
  EXPECT_NEAR(ev100, MeterEv100(image, kSunDiskLuminance_cd_per_m2), 0.05)
      << "the copy that is metered has every pixel of this picture";
  const DisplayImage judge = Develop(image, ev100, ToneCurve::kAgx);
  const RenderTarget target(kWidth, kHeight, RenderTarget::Depth::kNone);
  painter.Develop(ev100, target.framebuffer());
  const Image codes = target.Read();
  int off_by_one = 0;
  for (std::size_t i = 0; i < codes.rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int code = static_cast<int>(std::lround(codes.rgb[i][c] * 255.0F));
      ASSERT_LE(std::abs(code - judge.rgb[3 * i + c]), 1) << "pixel " << i << " channel " << c;
      if (code != judge.rgb[3 * i + c]) ++off_by_one;
    }
  }
  EXPECT_LT(off_by_one, kWidth * kHeight * 3 / 10)
      << "a code falls to the other side as often as the tone table is off, by 0.06 of a code";
}

TEST_F(SkyPainterTest, SeveralRaysAPixelAverageToThePicture) {
  const Scene scene = BareScene(2.0, 100.0, 30.0, 60.0);
  SkyPainter painter = SkyOver(scene);
  const UtcInstant instant = ParseInstant("2026-06-21T09:00:00Z");
  painter.Paint(EyeOf(scene), instant, kWidth, kHeight, 1);
  const Image one = painter.Read();
  painter.Paint(EyeOf(scene), instant, kWidth, kHeight, 4);
  const std::vector<double> differences = Differences(one, painter.Read());
  EXPECT_LT(Quantile(differences, 0.9), 1e-3) << "a smooth sky is its own average";
}

/// A hill of 400 m on a plain of 12 km, as OBJ.
void WriteHill(const std::filesystem::path& file) {
  std::ofstream obj(file);
  constexpr int kSide = 81;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double x = (column - kSide / 2) * 150.0, y = (row - kSide / 2) * 150.0;
      const double hill =
          400.0 * std::exp(-((x - 800.0) * (x - 800.0) + (y - 3000.0) * (y - 3000.0)) / 1e6);
      obj << "v " << x << " " << y << " " << 20.0 + hill << "\n";
    }
  }
  for (int row = 1; row < kSide; ++row) {
    for (int column = 1; column < kSide; ++column) {
      const int a = (row - 1) * kSide + column, b = a + 1, c = a + kSide, d = c + 1;
      obj << "f " << a << " " << b << " " << d << "\nf " << a << " " << d << " " << c << "\n";
    }
  }
}

TEST_F(SkyPainterTest, AHillInLowSunIsTheRenderers) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("alpenglow-hill-{}.obj", getpid());
  WriteHill(file);
  Scene scene = BareScene(150.0, 10.0, -3.0, 70.0);
  scene.terrain.kind = TerrainSource::Kind::kMesh;
  scene.terrain.file = file;
  const Pictures both = PaintBoth(scene, {"2026-06-21T05:30:00Z"}).front();
  std::filesystem::remove(file);
  const std::vector<double> differences = Differences(both.judge, both.painted);
  EXPECT_LT(Quantile(differences, 0.5), 2e-3)
      << "light on the ground is that of one random point of the sun's disk in the renderer, up to "
         "2 % from that of its middle";
  EXPECT_LT(Quantile(differences, 0.9), 1e-2);
  EXPECT_LT(Quantile(differences, 0.97), 0.1)
      << "a pixel on the edge of the hill or of its shadow may fall to the other side";
}

}  // namespace
}  // namespace alpenglow
