// SPDX-License-Identifier: MIT
// Pictures of the graphics card against those of the renderer, pixel by pixel.
#include "viewer/passes/sky_painter.h"
#include "lut/image/tone_mapping.h"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "atmosphere/astronomy/sky_bodies.h"
#include "renderer/picture/reference_picture.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "renderer/surface/scene_ground.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/parity_views.h"
#include "tests/fixtures/sanitized.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/passes/frame_light.h"

namespace alpenglow::viewer {
namespace {

struct PictureSize {
  int width, height;
};
constexpr int kViewWidth = 160, kViewHeight = 90;
constexpr PictureSize kFull{kViewWidth, kViewHeight}, kScaled = tests::ScaledDown(kFull, {64, 36});
// Differences at rims of the ground grow with the pixels.
constexpr double kPixelWidth = static_cast<double>(kViewWidth) / kScaled.width;
// Rays of both fall on different places of rough ground: the fewer, the farther they are apart.
constexpr int kSamples = 32;

RenderSettings ReferenceSettings(const PictureSize& size) {
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  settings.samples_per_pixel = kSamples;
  settings.filter = PixelFilter::Kind::kBox;
  settings.layers = LayersOfEdges();
  return settings;
}

PaintedView ViewOf(const Scene& scene, double eye_height_m, const UtcInstant& now,
                   const PictureSize& size = kFull) {
  CameraPose eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad,
                 scene.camera.roll_rad, scene.camera.fov_rad};
  eye.place.height_m = eye_height_m;
  return {eye, now, size.width, size.height};
}

/// The renderer and the painter of a scene, for as many views as one likes.
class BothPrograms {
 public:
  explicit BothPrograms(const Scene& scene, const UtcInstant& first, PictureSize size = kScaled)
      : size_(size),
        ground_(std::make_shared<const SceneGround>(LoadGround(scene))),
        reference_(scene, ground_),
        painter_(scene, LandSourceOf(scene), ViewOf(scene, ground_->eye_height_m, first, size),
                 SizesOf(Quality::kHigh)) {}

  ViewDifference Difference(PaintedView view) {
    view.width = size_.width;
    view.height = size_.height;
    CameraSample camera_sample(view.now);
    camera_sample.poses = {view.eye};
    painter_.WaitUntilReady(view, kSamples);
    painter_.Paint(view, kSamples);
    return DifferenceOf(reference_.Render(camera_sample, ReferenceSettings(size_)),
                        painter_.picture().Read());
  }
  ViewDifference Difference(const ParityView& view) {
    return Difference(ViewOf(view.scene, ground_->eye_height_m, view.instant));
  }

 private:
  PictureSize size_;
  std::shared_ptr<const SceneGround> ground_;
  SceneRenderer reference_;
  SkyPainter painter_;
};

struct Bounds {
  double mean, at_99_percent;
};
/// @param bounds  half as much again as was measured, in pictures of kFull.
void ExpectWithin(const ViewDifference& is, const Bounds& bounds, const char* why,
                  double pixel_width = kPixelWidth) {
  EXPECT_LT(is.mean, pixel_width * bounds.mean) << why;
  EXPECT_LT(is.at_99_percent, pixel_width * bounds.at_99_percent) << why;
  EXPECT_LT(is.edge_share, 0.6) << "there is enough left to compare";
}

ParityView ViewNamed(const std::string& name) {
  for (const ParityView& view : ParityViews()) {
    if (view.name == name) return view;
  }
  throw InternalError("no view is named " + name);
}

using SkyPainterTest = tests::Headless;

TEST_F(SkyPainterTest, TheRangeAtSunsetAndInTwilightIsTheRenderers) {
  const ParityView sunset = ViewNamed("ground, sunset, shafts"), twilight = ViewNamed("twilight");
  BothPrograms both(sunset.scene, sunset.instant);
  ExpectWithin(both.Difference(sunset), {0.0027, 0.011},
               "noise of thirty-two rays a pixel over rough ground, and tables between nodes");
  ExpectWithin(both.Difference(twilight), {0.0046, 0.032},
               "the same; what is dark is nearer to that noise");
}

TEST_F(SkyPainterTest, TheRangeByDayIsTheRenderersFromTheGroundAndFromAnAeroplane) {
  const ParityView noon = ViewNamed("ground, noon"), high = ViewNamed("10 km");
  BothPrograms both(noon.scene, noon.instant);
  ExpectWithin(both.Difference(noon), {0.0044, 0.036},
               "noise of thirty-two rays a pixel where materials meet on rough ground");
  ExpectWithin(both.Difference(ViewOf(high.scene, high.scene.camera.height.value_m, high.instant)),
               {0.0076, 0.057}, "the same, of more ground a pixel");
}

TEST_F(SkyPainterTest, TheRangeInFogIsTheRenderers) {
  const ParityView fog = ViewNamed("fog");
  ExpectWithin(
      BothPrograms(fog.scene, fog.instant).Difference(fog), {0.0045, 0.013},
      "light of the fog is a map, and light of the air before it is weighed in a few stretches");
}

// Over Burgos with nine tenths covered.
TEST_F(SkyPainterTest, ASunWithTheMoonBeforeItIsTheRenderers) {
  const UtcInstant now = ParseInstant("2026-08-12T18:23:00Z");
  Scene scene = BareScene(2.0, 284.0, 9.0, 8.0);
  scene.place = PlaceFromDegrees(42.3439, -3.6969, 0.0);
  ExpectWithin(BothPrograms(scene, now).Difference(ViewOf(scene, 2.0, now)), {0.0031, 0.0041},
               "tables between nodes, within four degrees of the sun");
  const SunPosition sun = ApparentSunAt(scene.place, now);
  const std::shared_ptr<const SolvedAir> air = SolveAir(scene.medium, AirSolution::kDraft);
  const double left = double{LightsOfSkyAt(scene.place, now, sun, *air).front().irradiance[1]} /
                      double{SunAsLight(sun, scene.medium).irradiance[1]};
  const double covered = SkyBodiesAt(scene.place, now).CoveredLight();
  EXPECT_NEAR(covered, 0.9, 0.02);
  EXPECT_NEAR(left / (1.0 - covered), 1.0, 0.02) << "of 550 nm and of the second band";
}

TEST_F(SkyPainterTest, WhereSunAndMoonBothCountTheRangeIsLitByBoth) {
  const ParityView first = ViewNamed("dusk, moon, -6.8");
  BothPrograms both(first.scene, first.instant);
  const char* why =
      "noise of thirty-two rays a pixel, fewer in small pictures, on moonlit rough ground";
  std::vector<std::pair<const char*, Bounds>> views{{"dusk, moon, -10", {0.0019, 0.029}},
                                                    {"dusk, moon, -8.4", {0.0017, 0.015}},
                                                    {"dusk, moon, -6.8", {0.0015, 0.014}}};
  views.resize(tests::ScaledDown(views.size(), std::size_t{1}));
  for (const auto& [name, bounds] : views)
    ExpectWithin(both.Difference(ViewNamed(name)), bounds, why);
}

struct MeanLuminance {
  double land, sky, all;
};

MeanLuminance MeanLuminanceOf(const Image& picture) {
  std::array<double, 2> sum{}, count{};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::array<float, 3>& rgb = picture.at(x, y);
      const std::size_t part = y < picture.height / 3 ? 1 : 0;
      sum[part] += static_cast<double>(shared::Luminance(rgb[0], rgb[1], rgb[2]));
      count[part] += 1.0;
    }
  }
  return {sum[0] / count[0], sum[1] / count[1], (sum[0] + sum[1]) / (count[0] + count[1])};
}

/// The built-in range, painted while time jumps or runs, and settled.
class RangeInTime : public SkyPainterTest {
 protected:
  void SetUp() override {
    SkyPainterTest::SetUp();
    painter_.emplace(scene_, LandSourceOf(scene_), At("2026-12-23T11:00:00Z"),
                     SizesOf(Quality::kLow));
    painter_->WaitUntilReady(At("2026-12-23T11:00:00Z"));
  }

  [[nodiscard]] PaintedView At(const UtcInstant& now) const {
    return ViewOf(scene_, ground_->eye_height_m, now, {64, 36});
  }
  [[nodiscard]] PaintedView At(const char* utc) const { return At(ParseInstant(utc)); }

  MeanLuminance Frame(const PaintedView& view) {
    painter_->Update(view, 0.04);
    return Paint(view);
  }
  MeanLuminance Settled(const PaintedView& view) {
    painter_->WaitUntilReady(view);
    return Paint(view);
  }
  MeanLuminance Paint(const PaintedView& view) {
    painter_->Paint(view, 1, SkyPainter::Bodies::kNone);
    return MeanLuminanceOf(painter_->picture().Read());
  }

  /// Half of the picture is land that is darker than the sky.
  static void ExpectNear(const MeanLuminance& shown, const MeanLuminance& settled,
                         const std::string& when) {
    EXPECT_NEAR(shown.all / settled.all, 1.0, 0.1) << when;
    EXPECT_NEAR(shown.sky / settled.sky, 1.0, 0.1) << when << ", sky";
    EXPECT_NEAR(shown.land / settled.land, 1.0, 0.1)
        << when << ", land: what slopes see of each other and of the sky is the old sun's";
  }

  Scene scene_ = RangeScene({200.0, true}, 250.0, -8.0);
  std::shared_ptr<const SceneGround> ground_ = std::make_shared<SceneGround>(LoadGround(scene_));
  std::optional<SkyPainter> painter_;
};

// From noon to dusk with a moon and on, as the keys F5 to F9 jump.
TEST_F(RangeInTime, AfterAJumpEachFrameIsLitByTheNewSun) {
  std::vector<const char*> jumps{"2026-12-23T16:30:00Z", "2026-12-24T11:00:00Z",
                                 "2026-12-23T15:50:00Z", "2026-12-23T22:00:00Z",
                                 "2026-12-24T07:20:00Z"};
  jumps.resize(tests::ScaledDown(jumps.size(), std::size_t{2}));
  for (const char* utc : jumps) {
    std::vector<MeanLuminance> shown;
    for (int frame = 0; frame < 8; ++frame) shown.push_back(Frame(At(utc)));
    const MeanLuminance settled = Settled(At(utc));
    for (std::size_t frame = 0; frame < shown.size(); ++frame)
      ExpectNear(shown[frame], settled, fmt::format("{}, frame {}", utc, frame));
  }
}

// From the last sun into the night, at 25 frames a second of time that runs 600 times as fast.
TEST_F(RangeInTime, SixHundredTimesAsFastDuskIsLitByItsSun) {
  UtcInstant now = ParseInstant("2026-12-23T15:20:00Z");
  const int frames = tests::ScaledDown(240, 24);
  for (int frame = 0; frame < frames; ++frame) {
    now = AddSeconds(now, 24.0);
    const MeanLuminance shown = Frame(At(now));
    if (frame % 24 != 23) continue;
    const MeanLuminance settled = Settled(At(now));
    ExpectNear(shown, settled, fmt::format("frame {}", frame));
  }
}

TEST_F(SkyPainterTest, FogAmongMountainsIsShadedAsTheRenderersIs) {
  const ParityView fog = ViewNamed("fog among mountains");
  ExpectWithin(BothPrograms(fog.scene, fog.instant).Difference(fog), {0.0075, 0.03},
               "light of the fog and its shade are maps");
}

// Hard case 5.
TEST_F(SkyPainterTest, FromAnAeroplaneAndFromOrbitTheSkyIsTheRenderers) {
  const UtcInstant now = ParseInstant("2026-06-21T06:00:00Z");
  BothPrograms both(BareScene(10e3, 160.0, -5.0, 50.0), now);
  ExpectWithin(both.Difference(ViewOf(BareScene(10e3, 160.0, -5.0, 50.0), 10e3, now)),
               {0.0018, 0.0041}, "tables between nodes");
  ExpectWithin(both.Difference(ViewOf(BareScene(400e3, 160.0, -20.0, 50.0), 400e3, now)),
               {0.0081, 0.26},
               "at the limb light falls by e within half a pixel: one in a hundred is on it");
}

class DrapedLand : public tests::HeadlessTile {
 protected:
  void SetUp() override {
    HeadlessTile::SetUp();
    WriteColours(folder_ / "colours.tif");
  }

  /// Squares of red and green, a kilometre wide.
  static void WriteColours(const std::filesystem::path& file) {
    constexpr int kSide = 64, kSquare = 8;
    constexpr std::array<std::array<int, 2>, 3> kRedAndGreen{{{200, 40}, {60, 160}, {50, 60}}};
    GDALRegister_GTiff();
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDataset* const dataset = driver->Create(file.c_str(), kSide, kSide, 3, GDT_Byte, nullptr);
    for (std::size_t band = 0; band < 3; ++band) {
      std::vector<std::uint8_t> values;
      for (int i = 0; i < kSide * kSide; ++i) {
        const int square = (i % kSide / kSquare + i / kSide / kSquare) % 2;
        values.push_back(
            static_cast<std::uint8_t>(kRedAndGreen[band][static_cast<std::size_t>(square)]));
      }
      EXPECT_EQ(dataset->GetRasterBand(static_cast<int>(band) + 1)
                    ->RasterIO(GF_Write, 0, 0, kSide, kSide, values.data(), kSide, kSide, GDT_Byte,
                               0, 0, nullptr),
                CE_None);
    }
    GDALClose(dataset);
  }

  [[nodiscard]] Scene DrapedScene() const {
    Scene scene = SceneOverTile(tests::PlaceOfSample(100.0, 200.0, 0.0),
                                CameraFromDegrees({4500.0, false}, 340.0, -25.0, 0.0, 60.0));
    scene.terrain.colour = folder_ / "colours.tif";
    return scene;
  }
};

TEST_F(DrapedLand, ColoursLieWhereTheRenderersDoFromWhereverTheyAreSeen) {
  const Scene scene = DrapedScene();
  const UtcInstant now = ParseInstant("2026-06-21T10:00:00Z");
  BothPrograms both(scene, now, kFull);
  PaintedView view = ViewOf(scene, 4500.0, now);
  ExpectWithin(
      both.Difference(view), {0.010, 0.115},
      "half of it is of bare land; sixteen rays a pixel on rims of squares. A quarter of a "
      "pixel of colours aside, it would be five times as much",
      1.0);
  const GeodeticPosition elsewhere = tests::PlaceOfSample(220.0, 30.0, 4500.0);
  view.eye.place = elsewhere;
  view.eye.heading_rad = 220.0 * kRadiansPerDegree;
  ExpectWithin(both.Difference(view), {0.016, 0.15}, "in the frame of the scene's place still",
               1.0);
}

/// Three bands, quick to solve.
Scene QuickScene(double heading, double pitch, double fov) {
  Scene scene = BareScene(2.0, heading, pitch, fov);
  scene.medium = MediumPreset("bruneton2017");
  return scene;
}

using BarePlanet = tests::Headless;

void ExpectTheRenderers(const Scene& scene, const char* utc) {
  const UtcInstant now = ParseInstant(utc);
  const double eye_m = scene.camera.height.value_m;
  const ViewDifference is = BothPrograms(scene, now).Difference(ViewOf(scene, eye_m, now));
  EXPECT_LT(is.mean, 0.005);
  EXPECT_LT(is.at_999_permille, 0.02);
  EXPECT_LT(is.edge_share, 0.6) << "there is enough left to compare";
}

/// An eye at night, 3 m over ground of one albedo, who looks down at it.
Scene NightOnThePlanet(double albedo) {
  Scene scene = QuickScene(0.0, -20.0, 60.0);
  scene.camera.height = {3.0, false};
  scene.ground.kind = GroundCover::Kind::kLambert;
  scene.ground.albedo = {albedo, albedo, albedo};
  return scene;
}

constexpr const char* kMoonless = "2026-01-15T23:30:00Z";
/// Sun and moon both count.
constexpr const char* kDuskAndMoon = "2026-12-23T16:25:00Z";

TEST_F(BarePlanet, IsLitByLampsAsTheRenderersIs) {
  Scene scene = NightOnThePlanet(0.2);
  Light light;
  light.latitude_rad = scene.place.latitude_rad + 0.0002 * kRadiansPerDegree;
  light.longitude_rad = scene.place.longitude_rad;
  light.height = {8.0, false};
  light.intensity_cd = 3000.0;
  light.radius_m = 0.1;
  scene.lights = {light};
  ExpectTheRenderers(scene, kMoonless);
}

TEST_F(BarePlanet, HasTheCoverOfTheSceneAtNight) {
  for (const double albedo : {0.05, 0.8}) {
    SCOPED_TRACE(albedo);
    Scene scene = NightOnThePlanet(albedo);
    scene.medium = MediumPreset("earth");  // the night sky is over the earth alone
    ExpectTheRenderers(scene, kMoonless);
    ExpectTheRenderers(scene, kDuskAndMoon);
  }
}

TEST_F(BarePlanet, IsSeenThroughFogAsTheRenderersIs) {
  for (const double scale_height_m : {500.0, 50.0, std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(scale_height_m);
    Scene scene = QuickScene(100.0, -2.0, 60.0);
    scene.camera.height = {5.0, false};
    Fog fog;
    fog.extinction_per_m = 3.912 / 300.0;
    fog.scale_height_m = scale_height_m;
    fog.phase = FogPhase(12.0);
    scene.fog = fog;
    ExpectTheRenderers(scene, "2026-06-21T06:30:00Z");
  }
}

class BareSky : public tests::Headless {
 protected:
  /// A settled picture of a bare sky.
  static Image Painted(SkyPainter& painter, const PaintedView& view, int samples = 1) {
    painter.WaitUntilReady(view);
    painter.Paint(view, samples);
    return painter.picture().Read();
  }
  static SkyPainter PainterOf(const Scene& scene, const PaintedView& view) {
    return SkyPainter(scene, LandSourceOf(scene), view, SizesOf(Quality::kMedium));
  }
};

TEST_F(BareSky, NoPixelIsBlackOrNegativeInDaylight) {
  const Scene scene = QuickScene(30.0, 0.0, 100.0);
  PaintedView view = ViewOf(scene, 2.0, ParseInstant("2026-06-21T11:00:00Z"));
  SkyPainter painter = PainterOf(scene, view);
  for (const double height_m : {-100.0, 0.0, 0.01, 2.0, 3000.0, 59999.0, 60001.0}) {
    view.eye.place.height_m = height_m;
    for (const auto& pixel : Painted(painter, view).rgb) {
      ASSERT_TRUE(std::isfinite(pixel[0] + pixel[1] + pixel[2])) << height_m << " m";
      ASSERT_GT(pixel[1], height_m > 50e3 ? -1e-6F : 0.0F) << height_m << " m";
    }
  }
}

TEST_F(BareSky, SeveralRaysAPixelAverageToThePicture) {
  const Scene scene = QuickScene(280.0, 40.0, 60.0);
  const PaintedView view = ViewOf(scene, 2.0, ParseInstant("2026-06-21T09:00:00Z"));
  SkyPainter painter = PainterOf(scene, view);
  const Image one = Painted(painter, view), four = Painted(painter, view, 4);
  int far_off = 0;
  for (std::size_t i = 0; i < one.rgb.size(); ++i) {
    if (std::abs(four.rgb[i][1] / one.rgb[i][1] - 1.0F) > 2e-3F) ++far_off;
  }
  EXPECT_LT(far_off, static_cast<int>(one.rgb.size()) / 10) << "a smooth sky is its own average";
}

TEST_F(BareSky, AnotherPictureIsShownInstead) {
  const Scene scene = QuickScene(100.0, 30.0, 60.0);
  const PaintedView view = ViewOf(scene, 2.0, ParseInstant("2026-06-21T09:00:00Z"));
  SkyPainter painter = PainterOf(scene, view);
  static_cast<void>(Painted(painter, view));
  Image other(5, 3);
  for (std::size_t i = 0; i < other.rgb.size(); ++i)
    other.rgb[i] = {1.0F + static_cast<float>(i), 2.0F, -3.0F};
  painter.Show(other);
  EXPECT_EQ(painter.picture().width(), 5);
  EXPECT_EQ(painter.picture().Read().rgb, other.rgb);
  EXPECT_EQ(Painted(painter, view).width, kViewWidth) << "and the next picture is painted again";
}

}  // namespace
}  // namespace alpenglow::viewer
