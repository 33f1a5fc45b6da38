// SPDX-License-Identifier: MIT
#include "viewer/land/landscape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/obj_file.h"
#include "renderer/terrain/terrain.h"
#include "tests/fixtures/quantile.h"
#include "tests/fixtures/sanitized.h"
#include "tests/viewer/land/headless_land.h"
#include "viewer/land/land_pass.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

using namespace tests;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kWidth = 256, kHeight = 144;

/// An eye over the land, and where it looks.
struct LookOut {
  Place place;
  double heading_rad = 0.0, pitch_rad = 0.0, fov_rad = 1.2;
  glm::dvec2 shift{0.0};  // of a pixel's ray, in half widths and heights

  [[nodiscard]] LandView View() const {
    const ViewAxes unit = AxesFromAngles(heading_rad, pitch_rad, 0.0);
    const double wide = std::tan(0.5 * fov_rad);
    return {{wide * unit.right, wide * kHeight / kWidth * unit.up, unit.forward}};
  }
  /// Returns the ray of a pixel, with any length; row 0 is at the top.
  [[nodiscard]] glm::dvec3 Ray(int x, int y) const {
    const ViewAxes axes = View().axes;
    return axes.forward + (2.0 * (x + 0.5) / kWidth - 1.0 + shift.x) * axes.right +
           (1.0 - 2.0 * (y + 0.5) / kHeight + shift.y) * axes.up;
  }
};

// Row 0 at the top.
const glm::vec4& PixelAt(const std::vector<glm::vec4>& picture, int x, int y) {
  return picture[static_cast<std::size_t>(y * kWidth + x)];
}

// Written apart from gbuffer/octahedral.glsl.
glm::dvec3 UnitOf(const glm::vec4& surface) {
  const double x = surface.x, y = surface.y, z = 1.0 - std::abs(x) - std::abs(y);
  if (z >= 0.0) return glm::normalize(glm::dvec3(x, y, z));
  return glm::normalize(
      glm::dvec3(std::copysign(1.0 - std::abs(y), x), std::copysign(1.0 - std::abs(x), y), z));
}

class LandscapePictures : public HeadlessLand {
 protected:
  void SetUp() override {
    HeadlessLand::SetUp();
    if (!IsSkipped()) map_.emplace(kWidth, kHeight);
  }

  [[nodiscard]] LandSource Folder() const { return {{folder_}, VoidPolicy::kFill, std::nullopt}; }

  // Draws what the last Update or WaitUntilReady chose.
  [[nodiscard]] std::vector<glm::vec4> Draw(Landscape& land, const LookOut& eye) const {
    constexpr GLuint kView = 1;
    const ViewAxes axes = eye.View().axes;
    const auto padded = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0.0F); };
    ViewBlock block{};
    block.view_right = padded(axes.right);
    block.view_up = padded(axes.up);
    block.view_forward = padded(axes.forward);
    block.eye = {1e-3 * eye.place.height_m, eye.shift.x, eye.shift.y,
                 1e-3 * OsculatingRadius(kWgs84, eye.place.latitude_rad())};
    block.bend.x = block.eye.w;  // straight rays
    const GlBuffer buffer;
    glBindBufferBase(GL_UNIFORM_BUFFER, kView, buffer.id());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_STATIC_DRAW);
    map_->Bind();
    land.Draw(LandDrawn::kSurface, kView);
    CheckGl("draw");
    return map_->ReadValues(GBuffer::kSurface);
  }
  [[nodiscard]] std::vector<glm::vec4> Settled(Landscape& land, const LookOut& eye) const {
    land.WaitUntilReady(eye.place, eye.View());
    return Draw(land, eye);
  }

  /// Returns the relative error of distances to triangles that the renderer has, too. A GPU (NVIDIA
  /// H100) interpolates 1 / w to 3e-5.
  [[nodiscard]] static double ErrorOfDistances() { return IsSoftwareOpenGl() ? 1e-5 : 4e-5; }

  std::optional<GBuffer> map_;
};

struct Misses {
  std::vector<double> distance, normal;  // relative; [rad]
  int only_one = 0, both = 0;            // pixels with terrain on one side alone, on both
};

// The renderer's rays through every fourth pixel.
Misses MissesOf(const std::vector<glm::vec4>& picture, const LookOut& eye, const Terrain& terrain,
                const LocalFrame& frame) {
  Misses misses;
  const LocalFrame there(kWgs84, eye.place);
  const glm::dvec3 origin = frame.EnuFromGeodetic(eye.place).xyz;
  const auto turned = [&](const glm::dvec3& v) {
    return frame.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{v})).xyz;
  };
  for (int y = 0; y < kHeight; y += 4) {
    for (int x = 0; x < kWidth; x += 4) {
      const glm::vec4& pixel = PixelAt(picture, x, y);
      const auto hit = terrain.Intersect(origin, glm::normalize(turned(eye.Ray(x, y))));
      if (!hit && pixel.w == 0.0F) continue;
      if (!hit || pixel.w == 0.0F) {
        ++misses.only_one;
        continue;
      }
      ++misses.both;
      misses.distance.push_back(std::abs(static_cast<double>(pixel.w) / hit->distance_m - 1.0));
      misses.normal.push_back(
          std::acos(std::min(glm::dot(turned(UnitOf(pixel)), hit->normal), 1.0)));
    }
  }
  std::sort(misses.distance.begin(), misses.distance.end());
  std::sort(misses.normal.begin(), misses.normal.end());
  return misses;
}

TEST_F(LandscapePictures, DistanceAndNormalEqualTheRenderersUpToOrbit) {
  WriteTile(folder_ / "a.tif", 0, 0);
  const Place middle = PlaceOfSample(120.0, 120.0, 0.0);
  const LocalFrame frame(kWgs84, middle);
  const Terrain terrain(
      MeshFromElevation(ReadElevation(folder_ / "a.tif", VoidPolicy::kFill).grid, frame));
  Landscape land(Folder(), {96.0}, kWgs84);
  // Near the eye stand the renderer's own triangles, farther ones of a 96th of the distance.
  struct View {
    double above_m, column, row, pitch_rad, fov_rad;
    double middling, most;  // of the relative error of distances: median, 95 %
  };
  for (const View& view : {View{2.0, 120.0, 60.0, 0.0, 1.2, ErrorOfDistances(), 2e-3},
                           View{2e3, 120.0, 20.0, -0.4, 1.2, 2e-3, 1e-2},
                           View{100e3, 120.0, 120.0, -1.57, 0.1, 1e-3, 3e-3},
                           View{400e3, 120.0, 120.0, -1.57, 0.03, 5e-4, 1e-3}}) {
    SCOPED_TRACE(view.above_m);
    LookOut eye{PlaceOfSample(view.column + 0.3, view.row + 0.4, 0.0), 2.8, view.pitch_rad,
                view.fov_rad};
    land.WaitUntilReady(eye.place, eye.View());
    eye.place.height_m = *land.ground().HeightUnder(eye.place) + view.above_m;
    const Misses misses = MissesOf(Settled(land, eye), eye, terrain, frame);
    ASSERT_GT(misses.both, 500);
    EXPECT_LE(misses.only_one, 4 + misses.both / 30) << "rims of mountains and of the land";
    EXPECT_LT(tests::Quantile(misses.distance, 0.5), view.middling);
    EXPECT_LT(tests::Quantile(misses.distance, 0.95), view.most);
    EXPECT_TRUE(view.above_m > 10.0 || tests::Quantile(misses.normal, 0.5) < 5e-5)
        << "16 bits a coordinate";
    EXPECT_TRUE(view.above_m > 3e3 || tests::Quantile(misses.normal, 0.5) < 0.03)
        << "slopes of the next finer level; the level's own triangles have 0.04";
  }
}

// Half a pixel off its middle a ray is as much as 0.1 % longer or shorter. From 400 km that is half
// a kilometre of height, and another one's snow.
TEST_F(LandscapePictures, DistanceIsMeasuredAlongTheRayOfAPixel) {
  WriteTile(folder_ / "a.tif", 0, 0);
  const LocalFrame frame(kWgs84, PlaceOfSample(120.0, 120.0, 0.0));
  const Terrain terrain(
      MeshFromElevation(ReadElevation(folder_ / "a.tif", VoidPolicy::kFill).grid, frame));
  Landscape land(Folder(), {96.0}, kWgs84);
  LookOut eye{PlaceOfSample(120.3, 60.4, 0.0), 2.8};
  land.WaitUntilReady(eye.place, eye.View());
  eye.place.height_m = *land.ground().HeightUnder(eye.place) + 2.0;
  eye.shift = {1.0 / kWidth, 1.0 / kHeight};
  const Misses misses = MissesOf(Settled(land, eye), eye, terrain, frame);
  ASSERT_GT(misses.both, 500);
  EXPECT_LT(tests::Quantile(misses.distance, 0.5), ErrorOfDistances()) << "1e-3 along the middle";
}

// With every sample drawn, the picture is the renderer's wherever nothing is left out that is seen.
TEST_F(LandscapePictures, OnlyChunksHiddenByNearLandAreOmitted) {
  WriteTile(folder_ / "a.tif", 0, 0);
  const LocalFrame frame(kWgs84, PlaceOfSample(120.0, 120.0, 0.0));
  const Terrain terrain(
      MeshFromElevation(ReadElevation(folder_ / "a.tif", VoidPolicy::kFill).grid, frame));
  Landscape land(Folder(), {600.0}, kWgs84);
  int fewest = std::numeric_limits<int>::max(), most = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    LookOut eye{PlaceOfSample(20.0 + 200.0 * std::fmod(0.7549 * i, 1.0),
                              20.0 + 200.0 * std::fmod(0.5698 * i, 1.0), 0.0),
                1.1 * i, -0.1};
    land.WaitUntilReady(eye.place, eye.View());
    eye.place.height_m = *land.ground().HeightUnder(eye.place) + 2.0 + std::exp2(i % 10);
    const Misses misses = MissesOf(Settled(land, eye), eye, terrain, frame);
    fewest = std::min(fewest, land.Figures().chunks);
    most = std::max(most, land.Figures().chunks);
    EXPECT_LE(misses.only_one, 4) << "pixels on a rim";
    EXPECT_LT(tests::Quantile(misses.distance, 0.99), 1e-3) << "the rest lies on crests";
  }
  EXPECT_LT(4 * fewest, most) << "in a valley little is seen";
}

// The choice is made on another thread.
TEST_F(LandscapePictures, ChunksOfAFrameAreChosenForItsOwnView) {
  WriteTile(folder_ / "a.tif", 0, 0);
  Landscape land(Folder(), {64.0}, kWgs84);
  LookOut inwards{PlaceOfSample(60.0, 120.0, 0.0), 0.5 * kPi}, outwards = inwards;
  land.WaitUntilReady(inwards.place, inwards.View());
  inwards.place.height_m = *land.ground().HeightUnder(inwards.place) + 1000.0;
  outwards.place = inwards.place;
  outwards.heading_rad = -inwards.heading_rad;
  const auto chunks = [&](const LookOut& eye) {
    land.Update(eye.place, eye.View(), 0.0);
    return land.Figures().chunks;
  };
  land.WaitUntilReady(inwards.place, inwards.View());
  const int many = chunks(inwards), few = chunks(outwards);
  ASSERT_GT(many, few);
  for (int turn = 0; turn < 20; ++turn) {
    ASSERT_EQ(chunks(inwards), many);
    ASSERT_EQ(chunks(outwards), few);
  }
}

TEST_F(LandscapePictures, EveryPixelBelowTheSkylineHasTerrain) {
  WriteTiles(3);
  Landscape land(Folder(), {64.0}, kWgs84);
  for (int i = 0; i < 24; i += ScaledDown(1, 3)) {
    SCOPED_TRACE(i);
    LookOut eye{PlaceOfSample(40.0 + 640.0 * std::fmod(0.7549 * i, 1.0),
                              40.0 + 640.0 * std::fmod(0.5698 * i, 1.0), 0.0),
                0.7 * i, 0.0};  // level, so that a column of pixels has one azimuth
    land.WaitUntilReady(eye.place, eye.View());
    eye.place.height_m = *land.ground().HeightUnder(eye.place) + std::exp2(i % 12);
    const auto picture = Settled(land, eye);
    for (int x = 0; x < kWidth; ++x) {
      int y = 0;  // from below
      const auto is_land = [&] { return PixelAt(picture, x, kHeight - 1 - y).w > 0.0F; };
      // Beyond the rim there is no land under a low view from above.
      while (y < kHeight && !is_land()) ++y;
      ASSERT_TRUE(i % 12 >= 8 || y == 0) << "column " << x;
      while (y < kHeight && is_land()) ++y;
      while (y < kHeight && !is_land()) ++y;
      ASSERT_EQ(y, kHeight) << "column " << x << ": a hole below land";
    }
  }
}

TEST_F(LandscapePictures, FlightOverAFolderKeepsItsMemoryLimits) {
  WriteTiles(6);
  LandSize size;
  size.detail = 64.0;
  size.most_bytes = 1500000;  // five of the 36 tiles
  Landscape land(Folder(), size, kWgs84);
  std::size_t most_chunks = 0;
  constexpr int kSteps = ScaledDown(60, 24);
  for (int step = 0; step < kSteps; ++step) {
    const LookOut eye{PlaceOfSample(20.0 * step + 100.0, 24.0 * step, 3000.0), 0.7, -0.3};
    for (int frame = 0; frame < 12; ++frame) {
      land.Update(eye.place, eye.View(), 0.05);
      const LandFigures figures = land.Figures();
      ASSERT_LE(figures.tile_bytes, size.most_bytes + 310000) << "and one that has just come";
      most_chunks = std::max(most_chunks, static_cast<std::size_t>(figures.kept_chunks));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (step % 4 != 3) continue;  // most places are left before all of their land is there
    land.WaitUntilReady(eye.place, eye.View());
    ASSERT_GT(land.Figures().chunks, 0) << "step " << step;
    ASSERT_LE(land.Figures().tile_bytes, size.most_bytes) << "step " << step;
  }
  EXPECT_LT(most_chunks, 1500U) << "about a thousand lie in reach at once";
  const LookOut eye{PlaceOfSample(700.0, 700.0, 2500.0), 0.7, -0.3};
  land.WaitUntilReady(eye.place, eye.View());
  EXPECT_TRUE(land.Progress().text.empty());
  EXPECT_NEAR(*land.ground().HeightUnder(PlaceOfSample(700.0, 700.0, 0.0)),
              static_cast<double>(HeightOfSample(700, 700)), 0.01)
      << "near the eye stand the samples themselves";
}

TEST_F(LandscapePictures, DistantLandIsFinerInATelephotoView) {
  WriteTiles(3);
  const LookOut wide{PlaceOfSample(360.0, 700.0, 4000.0), 0.0, -0.2, 1.2};
  LookOut narrow = wide;
  narrow.fov_rad = 0.2;
  Landscape land(Folder(), {64.0}, kWgs84);
  land.WaitUntilReady(wide.place, wide.View());
  const int usual = land.Figures().kept_chunks;
  land.WaitUntilReady(narrow.place, narrow.View());
  EXPECT_GT(land.Figures().kept_chunks, 2 * usual) << "twice as fine, and the land ends somewhere";
}

TEST_F(LandscapePictures, NoViewKeepsMoreChunksThanTheLimit) {
  WriteTiles(3);  // 2,800 chunks in all
  struct Case {
    const char* name;
    double detail, fov_rad;
    int rays;
  };
  const std::vector<Case> all{
      {"several rays", 256.0, 1.2, 16}, {"a long lens", 256.0, 0.1, 1}, {"detail", 1024.0, 1.2, 1}};
  for (const Case& wants : ScaledDown(all, {all[1]})) {
    const LookOut eye{PlaceOfSample(360.0, 360.0, 4000.0), 0.0, -0.2, wants.fov_rad};
    LandView view = eye.View();
    view.rays = wants.rays;
    LandSize size;
    size.detail = wants.detail;
    const auto kept = [&](int most_chunks) {
      size.most_chunks = most_chunks;
      Landscape land(Folder(), size, kWgs84);
      land.WaitUntilReady(eye.place, view);
      EXPECT_GT(land.Figures().chunks, 0);
      return land.Figures().kept_chunks;
    };
    constexpr int kMost = ScaledDown(1500, 500);
    EXPECT_LE(kept(kMost), kMost) << wants.name;
    EXPECT_GT(kept(ScaledDown(LandSize().most_chunks, 1500)), kMost)
        << wants.name << " would take more";
  }
}

// The sum is over all buffers that exist; their names are small numbers.
std::size_t BytesOnTheCard() {
  std::size_t sum = 0;
  for (GLuint id = 1; id < 1000; ++id) {
    if (glIsBuffer(id) == GL_FALSE) continue;
    GLint64 bytes = 0;
    glBindBuffer(GL_COPY_READ_BUFFER, id);
    glGetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &bytes);
    sum += static_cast<std::size_t>(bytes);
  }
  return sum;
}

TEST_F(LandscapePictures, BuffersUseTheStatedMemory) {
  WriteTile(folder_ / "a.tif", 0, 0);
  const std::size_t before = BytesOnTheCard();
  Landscape land(Folder(), {96.0}, kWgs84);
  const LookOut eye{PlaceOfSample(120.0, 120.0, 3000.0), 0.0, -0.3};
  land.WaitUntilReady(eye.place, eye.View());
  const auto held = static_cast<double>(BytesOnTheCard() - before);
  EXPECT_NEAR(static_cast<double>(land.Figures().card_bytes), held, 2e3)
      << "but for the block of uniforms";
  const auto bytes = [](int slots) { return static_cast<double>(ChunkBuffers(slots).bytes()); };
  EXPECT_NEAR((bytes(200) - bytes(100)) / 100.0, 37.8e3, 0.1e3) << "a slot, as LandSize has it";
}

TEST_F(LandscapePictures, ADamagedTileIsReportedAndTheRestIsDrawn) {
  WriteTiles(2);
  std::filesystem::resize_file(folder_ / "tile01.tif", 60000);
  Landscape land(Folder(), {64.0}, kWgs84);
  const LookOut eye{PlaceOfSample(100.0, 300.0, 2500.0), 0.7, -0.3};
  land.WaitUntilReady(eye.place, eye.View());
  EXPECT_THAT(land.PollNotes(), ElementsAre(HasSubstr("tile01.tif")));
  EXPECT_GT(land.Figures().chunks, 3);
  EXPECT_FALSE(land.ground().HeightUnder(PlaceOfSample(300.0, 100.0, 0.0)));
}

TEST_F(LandscapePictures, ADamagedFileIsRefused) {
  WriteTile(folder_ / "a.tif", 0, 0);
  std::filesystem::resize_file(folder_ / "a.tif", 60000);
  Landscape land({{folder_ / "a.tif"}, VoidPolicy::kFill, std::nullopt}, {64.0}, kWgs84);
  const LookOut eye{PlaceOfSample(100.0, 100.0, 2500.0), 0.7, -0.3};
  EXPECT_THROW(land.WaitUntilReady(eye.place, eye.View()), InputError);
}

// Without a horizon of the terrain, three properties of a program can change: fading light,
// moonlight and refraction.
TEST_F(LandscapePictures, ProgramsNeededLaterAreMadeOneByOne) {
  WriteTile(folder_ / "a.tif", 0, 0);
  Landscape land(Folder(), {64.0}, kWgs84);
  EXPECT_FALSE(land.pass().MakeOneReady()) << "nothing has been drawn that could change";
  const LookOut eye{PlaceOfSample(120.0, 60.0, 3000.0), 3.1, -0.3};
  const std::vector<glm::vec4> drawn = Settled(land, eye);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(land.pass().MakeOneReady()) << i;
  EXPECT_FALSE(land.pass().MakeOneReady());
  CheckGl("MakeOneReady");
  EXPECT_EQ(map_->ReadValues(GBuffer::kSurface), drawn) << "nothing is drawn over the land";
  EXPECT_EQ(Draw(land, eye), drawn);
}

TEST_F(LandscapePictures, NewLightReplacesTheOldWhenItIsComplete) {
  WriteTile(folder_ / "a.tif", 0, 0);
  Landscape land(Folder(), {64.0}, kWgs84);
  const LookOut eye{PlaceOfSample(120.0, 60.0, 3000.0), 3.1, -0.3};
  const auto light = [](float sun_x) {
    return LightOfVertices{[sun_x](const LocalFrame&, std::span<const LandVertex> vertices) {
      return std::vector<VertexLight>(vertices.size(), {{0.1F, 0.2F, 0.3F, 0.4F}, {}, sun_x});
    }};
  };
  const auto middle = [&] { return PixelAt(Draw(land, eye), kWidth / 2, kHeight - 11); };
  land.WaitUntilReady(eye.place, eye.View());
  EXPECT_NEAR(middle().z, 4.0F, 1e-6F) << "without a function the whole sun shines";
  land.Relight(light(-2.0F));
  land.Update(eye.place, eye.View(), 0.0);
  EXPECT_TRUE(land.IsRelighting());
  EXPECT_NEAR(middle().z, 4.0F, 1e-6F) << "the old light stays until the new is there";
  land.WaitUntilReady(eye.place, eye.View());
  EXPECT_FALSE(land.IsRelighting());
  EXPECT_NEAR(middle().z, -2.0F, 1e-3F);
  const glm::vec4 sky = PixelAt(map_->ReadValues(GBuffer::kSky), kWidth / 2, kHeight - 11);
  EXPECT_NEAR(sky.x, 0.1F, 2e-4F);
  EXPECT_NEAR(sky.w, 0.4F, 4e-4F);
}

TEST_F(LandscapePictures, ShadowEdgesMoveWithTheSun) {
  WriteTile(folder_ / "a.tif", 0, 0);
  Landscape land(Folder(), {64.0}, kWgs84);
  const LookOut eye{PlaceOfSample(120.0, 60.0, 3000.0), 3.1, -0.3};
  constexpr double kRadius_rad = 0.0047;
  const auto towards = [&](double elevation_rad) {
    return LocalFrame(kWgs84, eye.place).EcefFromEnu(EnuFromAngles(elevation_rad, 2.0));
  };
  const auto shaded = [](const LocalFrame&, std::span<const LandVertex> vertices) {
    return std::vector<VertexLight>(vertices.size(), {{0.1F, 0.2F, 0.3F, 0.4F}, {}, -2.0F});
  };
  land.Relight({shaded, towards(0.1)});
  land.WaitUntilReady(eye.place, eye.View());
  for (const double radii : {0.0, 3.0, -1.0}) {
    land.Use(MomentaryEdges{0.0, towards(0.1 + radii * kRadius_rad), kRadius_rad});
    EXPECT_NEAR(PixelAt(Draw(land, eye), kWidth / 2, kHeight - 11).z, radii - 2.0, 0.02)
        << "the anchor of the land is some kilometres off";
  }
}

// 190 km apart: farther than one anchor reaches.
TEST_F(LandscapePictures, LandIsExactFarFromTheStart) {
  constexpr int kFar = 6000;
  WriteTile(folder_ / "a.tif", 0, 0);
  WriteTile(folder_ / "b.tif", kFar, 0);
  Landscape land(Folder(), {96.0}, kWgs84);
  const LookOut first{PlaceOfSample(120.0, 120.0, 3000.0), 0.0, -0.3};
  land.WaitUntilReady(first.place, first.View());
  LookOut eye{PlaceOfSample(kFar + 120.3, 60.4, 0.0), 3.0, -0.05};
  land.WaitUntilReady(eye.place, eye.View());
  eye.place.height_m = *land.ground().HeightUnder(eye.place) + 2.0;
  const LocalFrame frame(kWgs84, PlaceOfSample(kFar + 120.0, 120.0, 0.0));
  const Terrain terrain(
      MeshFromElevation(ReadElevation(folder_ / "b.tif", VoidPolicy::kFill).grid, frame));
  const Misses misses = MissesOf(Settled(land, eye), eye, terrain, frame);
  EXPECT_GT(misses.both, 500);
  EXPECT_LT(tests::Quantile(misses.distance, 0.5), 1e-4)
      << "2 m over ground that floats place to 1 mm";
}

// Beside these tiles coarse land reaches 130 m higher than the fine land in its place: over a range
// of heights each has the other drawn.
TEST_F(LandscapePictures, SettledLandDoesNotDependOnTheEarlierEye) {
  WriteTiles(2);
  for (int i = 0; i < 12; i += ScaledDown(1, 4)) {
    const double height_m = 5400.0 + 15.0 * i;
    SCOPED_TRACE(height_m);
    const LookOut eye{PlaceOfSample(200.3, 91.7, height_m), 2.8, -0.3};
    Landscape fresh(Folder(), {96.0}, kWgs84), flown(Folder(), {96.0}, kWgs84);
    const auto reference = Settled(fresh, eye);
    LookOut higher = eye;
    higher.place.height_m += 100.0 * (i % 3);
    flown.WaitUntilReady(higher.place, higher.View());
    EXPECT_EQ(Settled(flown, eye), reference);
    EXPECT_EQ(Settled(flown, eye), reference) << "nor on how often that is asked";
  }
}

// A cone of 25 km around a sample.
auto Mountain(int column, int row, double top_m) {
  return [=](int at_column, int at_row) {
    const double away_m = std::hypot(32.0 * (at_column - column), 46.0 * (at_row - row));
    return static_cast<float>(top_m * std::max(1.0 - away_m / 25e3, 0.0));
  };
}

// From 3 km the horizon lies 196 km away. At 250 km it hides what is lower than 230 m, at 600 km
// what is lower than 12.8 km.
TEST_F(LandscapePictures, ThePlanetHidesOnlyLandBelowItsHorizon) {
  constexpr int kEast = 7869, kNorth = -12960;  // 250 km, 600 km
  constexpr int kSamples = 101, kStride = 16;
  constexpr int kHalf = kStride * (kSamples - 1) / 2;
  WriteTile(folder_ / "near.tif", kEast - kHalf, -kHalf, kSamples, kStride,
            Mountain(kEast, 0, 4000.0));
  WriteTile(folder_ / "far.tif", -kHalf, kNorth - kHalf, kSamples, kStride,
            Mountain(0, kNorth, 8000.0));
  Landscape land(Folder(), {96.0}, kWgs84);
  const Place eye = PlaceOfSample(0.0, 0.0, 3000.0);
  const auto pixels = [&](double heading_rad) {
    const auto picture = Settled(land, {eye, heading_rad, -0.03, 0.2});
    EXPECT_GT(land.Figures().triangles, 0) << "it stands in the view";
    return std::count_if(picture.begin(), picture.end(),
                         [](const glm::vec4& pixel) { return pixel.w > 0.0F; });
  };
  EXPECT_GT(pixels(0.5 * kPi), 1000) << "15 mrad high and 190 wide, of 0.8 mrad a pixel";
  EXPECT_EQ(pixels(0.0), 0);
}

TEST_F(LandscapePictures, NothingIsDrawnWithoutASource) {
  Landscape land({}, {96.0}, kWgs84);
  land.Relight({[](const LocalFrame&, std::span<const LandVertex> vertices) {
    return std::vector<VertexLight>(vertices.size());
  }});
  const LookOut eye{{0.8, 0.1, 1000.0}, 0.0, 0.0};
  const auto picture = Settled(land, eye);
  EXPECT_TRUE(std::all_of(picture.begin(), picture.end(),
                          [](const glm::vec4& pixel) { return pixel.w == 0.0F; }));
  EXPECT_FALSE(land.ground().HeightUnder(eye.place));
}

TEST_F(LandscapePictures, ProceduralRangeIsNotedAsMadeUp) {
  Landscape land({{}, VoidPolicy::kFill, Place{0.81, 0.14, 0.0}}, {64.0}, kWgs84);
  EXPECT_THAT(land.PollNotes(), ElementsAre(HasSubstr("made up")));
}

TEST_F(LandscapePictures, AMeshIsDrawnCompletely) {
  WriteText(folder_ / "hill.obj",
            "v -5000 -5000 100\nv 5000 -5000 100\nv 5000 5000 300\nv -5000 5000 300\n"
            "f 1 2 3\nf 1 3 4\n");
  LandSource source;
  source.mesh = {folder_ / "hill.obj", {0.81, 0.14, 0.0}};
  Landscape land(source, {64.0}, kWgs84);
  LookOut eye{{0.81, 0.14, 500.0}, 0.0, -0.5};
  EXPECT_THAT(land.Progress().text, HasSubstr("hill.obj"));
  const auto picture = Settled(land, eye);
  EXPECT_NEAR(*land.ground().HeightUnder(eye.place), 200.0, 0.01);
  const LocalFrame frame(kWgs84, {0.81, 0.14, 0.0});
  const Misses misses = MissesOf(picture, eye, Terrain(ReadObj(folder_ / "hill.obj").mesh), frame);
  EXPECT_GT(misses.both, 500);
  EXPECT_LT(tests::Quantile(misses.distance, 1.0), ErrorOfDistances());
  EXPECT_LT(tests::Quantile(misses.normal, 1.0), 1e-4);
  const auto grid = land.ground().Sampler()(eye.place, 1000.0, 9);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(*grid->HeightAt(eye.place.latitude_rad(), eye.place.longitude_rad()), 200.0, 0.1);
  land.Relight({[](const LocalFrame&, std::span<const LandVertex> vertices) {
    return std::vector<VertexLight>(vertices.size(), {{0.1F, 0.2F, 0.3F, 0.4F}, {}, -1.0F});
  }});
  EXPECT_NEAR(PixelAt(Settled(land, eye), kWidth / 2, kHeight - 1).z, -1.0F, 1e-5F);
}

}  // namespace
}  // namespace alpenglow::viewer
