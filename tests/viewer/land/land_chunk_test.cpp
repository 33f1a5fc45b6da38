// SPDX-License-Identifier: MIT
// Chunks of land, and grids over meshes.
#include "renderer/terrain/land_chunk.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <set>
#include <utility>

#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/terrain/land_files.h"
#include "viewer/land/mesh_land.h"

#ifdef ALPENGLOW_TESTS_SANITIZED
// A function of the sanitizers' runtime; gcc does not install the header that declares it.
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace alpenglow::viewer {
namespace {

using namespace tests;

constexpr int kTop = 4;  // 240 samples in one chunk

class LandChunks : public LandFolder {
 protected:
  void SetUp() override {
    LandFolder::SetUp();
    WriteTile(folder_ / "a.tif", 0, 0);
    heights_.emplace(AllHeights({{folder_}, VoidPolicy::kFill, std::nullopt}));
  }
  [[nodiscard]] LandChunk Chunk(int level, int column, int row) const {
    return MakeChunk(*heights_, {level, column, row}, kTop, anchor_);
  }

  std::optional<LoadedHeights> heights_;
  LandAnchor anchor_{LocalFrame(kWgs84, PlaceOfSample(120.0, 120.0, 0.0)), 120, 120};
};

glm::dvec3 Position(const LandChunk& chunk, int i, int j) {
  const auto& p = chunk.vertices[static_cast<std::size_t>(j * kChunkSide + i)].position_m;
  return {p[0], p[1], p[2]};
}
glm::dvec3 CoarsePosition(const LandChunk& chunk, int i, int j) {
  const auto& p = chunk.vertices[static_cast<std::size_t>(j * kChunkSide + i)].coarse_position_m;
  return {p[0], p[1], p[2]};
}
glm::dvec3 Normal(const LandChunk& chunk, int i, int j) {
  const auto& n = chunk.vertices[static_cast<std::size_t>(j * kChunkSide + i)].normal;
  return glm::dvec3(n[0], n[1], n[2]) / 32767.0;
}

/// The bytes that all threads have taken from the heap and not given back. The sanitizer's heap is
/// its own.
std::size_t HeapBytes() {
#ifdef ALPENGLOW_TESTS_SANITIZED
  return __sanitizer_get_current_allocated_bytes();
#else
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
#endif
}

TEST_F(LandChunks, UseTheStatedMemory) {
  constexpr std::size_t kCount = 100;
  for (const int level : {0, 1}) {
    std::vector<LandChunk> chunks;
    chunks.reserve(kCount);
    const std::size_t before = HeapBytes();
    double said = 0.0;
    for (int i = 0; std::cmp_less(i, kCount); ++i) {
      chunks.push_back(Chunk(level, i % 7, i / 7 % 7));
      static_cast<void>(std::exchange(chunks.back().vertices, {}));  // they are on the card
      said += static_cast<double>(BytesOf(chunks.back()));
    }
    const auto held = static_cast<double>(HeapBytes() - before + kCount * sizeof(LandChunk));
    EXPECT_NEAR(said, held, 0.02 * held) << "but for heads of blocks";
    EXPECT_NEAR(said / kCount, 13.1e3, 0.1e3) << "as LandSize has it";
  }
}

TEST_F(LandChunks, FinestLevelEqualsTheRenderersMesh) {
  const TriangleMesh mesh =
      MeshFromElevation(ReadElevation(folder_ / "a.tif", VoidPolicy::kFill).grid, anchor_.frame);
  std::set<std::array<std::uint32_t, 3>> cut;  // each triangle from its least corner on
  const auto turned = [](std::array<std::uint32_t, 3> t) {
    while (t[0] > t[1] || t[0] > t[2]) t = {t[1], t[2], t[0]};
    return t;
  };
  for (const auto& triangle : mesh.triangles) cut.insert(turned(triangle));
  for (const auto& [column, row] : {std::pair{0, 0}, {5, 7}, {14, 14}}) {
    const LandChunk chunk = Chunk(0, column, row);
    const auto sample = [&, column = column, row = row](std::uint32_t v) {
      return static_cast<std::uint32_t>((16 * row + static_cast<int>(v) / kChunkSide) *
                                            kTileSamples +
                                        16 * column + static_cast<int>(v) % kChunkSide);
    };
    for (std::uint32_t v = 0; v < kChunkVertices; ++v) {
      ASSERT_EQ(chunk.vertices[v].position_m, mesh.positions[sample(v)]) << v;
      const auto& n = mesh.normals[sample(v)];
      const glm::dvec3 off =
          Normal(chunk, static_cast<int>(v) % kChunkSide, static_cast<int>(v) / kChunkSide) -
          glm::dvec3(n[0], n[1], n[2]);
      ASSERT_LT(glm::length(off), 6e-5) << "16 bits a coordinate";
    }
    ASSERT_EQ(chunk.triangles.size(), static_cast<std::size_t>(kChunkIndices));
    for (std::size_t i = 0; i < chunk.triangles.size(); i += 3) {
      const std::array<std::uint32_t, 3> triangle{sample(chunk.triangles[i]),
                                                  sample(chunk.triangles[i + 1]),
                                                  sample(chunk.triangles[i + 2])};
      ASSERT_TRUE(cut.contains(turned(triangle))) << "cut along the other diagonal";
    }
  }
}

TEST_F(LandChunks, NeighboursShareTheirVerticesExactly) {
  for (int level = 0; level < 3; ++level) {
    SCOPED_TRACE(level);
    const LandChunk west = Chunk(level, 1, 1), east = Chunk(level, 2, 1),
                    south = Chunk(level, 1, 2);
    for (int k = 0; k < kChunkSide; ++k) {
      ASSERT_EQ(Position(west, 16, k), Position(east, 0, k));
      ASSERT_EQ(CoarsePosition(west, 16, k), CoarsePosition(east, 0, k));
      ASSERT_EQ(Normal(west, 16, k), Normal(east, 0, k));
      ASSERT_EQ(Position(west, k, 16), Position(south, k, 0));
      ASSERT_EQ(CoarsePosition(west, k, 16), CoarsePosition(south, k, 0));
    }
  }
}

// The last chunk of each level ends at sample 240, which is no multiple of 16 2^k.
TEST_F(LandChunks, WhollyMorphedChunksLieOnTheNextLevel) {
  for (int level = 0; level + 1 < kTop; ++level) {
    for (const int at : {0, 240 / (16 << level) - (240 % (16 << level) == 0 ? 1 : 0)}) {
      SCOPED_TRACE(level);
      const LandChunk fine = Chunk(level, at, at), coarse = Chunk(level + 1, at / 2, at / 2);
      for (int j = 0; j < kChunkSide; ++j) {
        for (int i = 0; i < kChunkSide; ++i) {
          const std::size_t v = static_cast<std::size_t>(j * kChunkSide + i);
          if (std::find(fine.triangles.begin(), fine.triangles.end(), v) == fine.triangles.end())
            continue;
          const int x = i + 16 * (at % 2), y = j + 16 * (at % 2);
          // The coarse vertices around; at the rim the last one is the rim itself.
          const auto ends = [&](int k, int k_fine, int last) {
            const bool rim = k % 2 != 0 && k_fine + 16 * at == last;
            return std::pair{rim ? (k + 1) / 2 : k / 2, (k + 1) / 2};
          };
          const int last = (240 + (1 << level) - 1) >> level;
          const auto [west, east] = ends(x, i, last);
          const auto [north, south] = ends(y, j, last);
          const glm::dvec3 mean =
              0.5 * (Position(coarse, west, north) + Position(coarse, east, south));
          ASSERT_LT(glm::length(CoarsePosition(fine, i, j) - mean), 3e-3)
              << "floats at 10 km; cells are cut from north-west to south-east";
        }
      }
    }
  }
}

TEST_F(LandChunks, TheLandHasTheSameRimAtEveryLevel) {
  const auto end_of = [&](int level) {
    const int last = (240 + (1 << level) - 1) >> level;
    const int chunk = (last - 1) / kChunkCells;
    return Position(Chunk(level, chunk, 0), last - kChunkCells * chunk, 0);
  };
  const glm::dvec3 rim = end_of(0);
  for (int level = 1; level <= kTop; ++level) {
    const glm::dvec3 off = end_of(level) - rim;
    EXPECT_LT(std::hypot(off.x, off.y), 1.0) << level << ": the corner keeps its place and height";
  }
}

TEST_F(LandChunks, CoarseSidesUseOnlyVerticesOfTheNextLevel) {
  for (const int level : {0, 1}) {
    const LandChunk chunk = Chunk(level, 3, 3);
    for (unsigned sides = 0; sides < 16; ++sides) {
      SCOPED_TRACE(sides);
      const auto kept = WithCoarseSides(chunk.triangles, chunk.ends, sides);
      double doubled_area = 0.0;
      for (std::size_t t = 0; t < kept.size(); t += 3) {
        std::array<glm::dvec2, 3> at;
        for (std::size_t c = 0; c < 3; ++c) {
          const int x = kept[t + c] % kChunkSide, y = kept[t + c] / kChunkSide;
          at[c] = {x, y};
          EXPECT_FALSE((sides & kNorthSide) != 0 && y == 0 && x % 2 != 0);
          EXPECT_FALSE((sides & kEastSide) != 0 && x == 16 && y % 2 != 0);
          EXPECT_FALSE((sides & kSouthSide) != 0 && y == 16 && x % 2 != 0);
          EXPECT_FALSE((sides & kWestSide) != 0 && x == 0 && y % 2 != 0);
        }
        const glm::dvec2 a = at[1] - at[0], b = at[2] - at[0];
        EXPECT_LE(a.x * b.y - a.y * b.x, 0.0) << "seen from above, rows run southwards";
        doubled_area -= a.x * b.y - a.y * b.x;
      }
      EXPECT_DOUBLE_EQ(doubled_area, 2.0 * 256.0) << "no hole, nothing twice";
    }
  }
}

TEST_F(LandChunks, LightOfTheNextLevelIsTheMeanOfItsVertices) {
  const LandChunk chunk = Chunk(1, 2, 2);
  const auto light =
      LightOfChunk(chunk, anchor_.frame, LightOfVertices{[](const LocalFrame&, auto vertices) {
                     std::vector<VertexLight> lit;
                     for (const LandVertex& vertex : vertices)
                       lit.push_back({{1e-3F * vertex.position_m.x, 0.25F, 0.5F, 1.0F},
                                      {0.75F, 2e-3F * vertex.position_m.y, 0.5F, 1.0F},
                                      2.0F * vertex.normal.z});
                     return lit;
                   }});
  for (std::size_t v = 0; v < light.size(); ++v) {
    const float x = 1e-3F * chunk.vertices[v].coarse_position_m[0];
    EXPECT_NEAR(glm::unpackHalf1x16(light[v].coarse_sky[0]), x, 1e-3F + 1e-3F * std::abs(x))
        << "half floats: linear light stays linear";
    EXPECT_EQ(glm::unpackHalf1x16(light[v].sky[1]), 0.25F);
    const float y = 2e-3F * chunk.vertices[v].coarse_position_m[1];
    EXPECT_NEAR(glm::unpackHalf1x16(light[v].coarse_moon_sky[1]), y, 1e-3F + 1e-3F * std::abs(y));
    EXPECT_EQ(glm::unpackHalf1x16(light[v].moon_sky[0]), 0.75F);
  }
}

// An infinite share of a sky without light would be an infinite radiance.
// Hard case 23.
TEST(LightOfVertices, FractionsOfADarkSkyAreFiniteHalfFloats) {
  const std::array<std::uint16_t, 4> halves = PackedShares({3e5F, 65504.0F, 1e-9F, 0.25F});
  EXPECT_EQ(glm::unpackHalf1x16(halves[0]), 65504.0F);
  EXPECT_EQ(glm::unpackHalf1x16(halves[1]), 65504.0F);
  EXPECT_EQ(glm::unpackHalf1x16(halves[2]), 0.0F);
  EXPECT_EQ(glm::unpackHalf1x16(halves[3]), 0.25F);
}

// --- grids over meshes ---

const Place kPlace{46.5, 8.0, 0.0};
const LocalFrame kFrame(kWgs84, kPlace);

/// A square in the frame, its middle east of the origin, that rises to the east by a tenth.
Terrain SlopeAt(float east_m, float half_m) {
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}})
    mesh.positions.push_back({east_m + x * half_m, y * half_m, 100.0F + 0.1F * x * half_m});
  mesh.normals.assign(4, {0.0F, 0.0F, 1.0F});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return Terrain(std::move(mesh));
}

double ShareOnMesh(const ElevationGrid& grid) {
  double there = 0.0;
  for (const float height_m : grid.height_m) there += std::isnan(height_m) ? 0.0 : 1.0;
  return there / static_cast<double>(grid.height_m.size());
}

TEST(MeshGrid, SmallMeshesAreSampledWholeFromAnywhere) {
  for (const float half_m : {0.2F, 20.0F, 30.0F}) {
    const Terrain mesh = SlopeAt(0.0F, half_m);
    const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 64);
    ASSERT_TRUE(grid) << half_m;
    EXPECT_GT(ShareOnMesh(*grid),
              0.9 * std::pow(static_cast<double>(half_m / (half_m + 3.0F)), 2.0))
        << half_m << ": the box around it is up to 3 m wider";
    EXPECT_NEAR(*grid->HeightAt(kPlace.latitude_rad(), kPlace.longitude_rad()), 100.0, 0.01);
  }
}

TEST(MeshGrid, DistantMeshesAreSampledAtTheirPlace) {
  for (const float east_m : {33e3F, 45e3F, 72e3F, -150e3F}) {
    const Terrain mesh = SlopeAt(east_m, 1000.0F);
    const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 64);
    ASSERT_TRUE(grid) << east_m;
    EXPECT_GT(ShareOnMesh(*grid), 0.9) << east_m;
    const Place middle = kFrame.GeodeticFromEnu({{static_cast<double>(east_m), 0.0, 100.0}});
    EXPECT_NEAR(*grid->HeightAt(middle.latitude_rad(), middle.longitude_rad()), middle.height_m,
                0.5);
  }
}

TEST(MeshGrid, WideMeshesAreSampledAroundThePlace) {
  const Terrain mesh = SlopeAt(0.0F, 100e3F);
  const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 65);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->columns, 65);
  EXPECT_EQ(grid->rows, 65);
  EXPECT_EQ(ShareOnMesh(*grid), 1.0);
  const double width_m = 64 * grid->step_lat_rad * 6.37e6;
  EXPECT_NEAR(width_m, 80e3, 500.0);
  EXPECT_NEAR(grid->north_rad - kPlace.latitude_rad(), 32 * grid->step_lat_rad, 1e-9);
}

TEST(MeshGrid, SampledSquareStaysInsideAWideMesh) {
  const Terrain mesh = SlopeAt(150e3F, 100e3F);  // from 50 km to 250 km east
  const auto grid = GridOverMesh(mesh, kFrame, kPlace, 40e3, 65);
  ASSERT_TRUE(grid);
  EXPECT_GT(ShareOnMesh(*grid), 0.95);
  EXPECT_LT(grid->west_rad - kPlace.longitude_rad(),
            50e3 / 6.37e6 / std::cos(kPlace.latitude_rad()))
      << "as near to the place as the mesh comes";
}

TEST(MeshGrid, TheHighestSurfaceCounts) {
  TriangleMesh two = SlopeAt(0.0F, 50.0F).mesh();
  for (std::size_t i = 0; i < 4; ++i)
    two.positions.push_back({two.positions[i][0], two.positions[i][1], 130.0F});
  two.normals.assign(8, {0.0F, 0.0F, 1.0F});
  two.triangles.push_back({4, 5, 6});
  two.triangles.push_back({4, 6, 7});
  const auto grid = GridOverMesh(Terrain(std::move(two)), kFrame, kPlace, 40e3, 32);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(*grid->HeightAt(kPlace.latitude_rad(), kPlace.longitude_rad()), 130.0, 1e-3);
}

}  // namespace
}  // namespace alpenglow::viewer
