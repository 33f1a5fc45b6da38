// SPDX-License-Identifier: MIT
#include "renderer/terrain/land_chunk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "renderer/elevation/mesh.h"

namespace alpenglow::renderer {
namespace {

// Vertices of a level with their normals. At level 0 the normals are the area-weighted means of the
// surrounding triangles, as in SmoothNormals. At other levels they are the slopes of the next finer
// level: means over triangles of the level itself would lose half of the detail that its vertices
// can show.
class SurfacePatch {
 public:
  // Covers vertices [first_i, first_i + side) x [first_j, first_j + side).
  SurfacePatch(const LoadedHeights& heights, int level, int first_i, int first_j, int side,
               const LocalFrame& frame)
      : lattice_(heights.tiles().lattice()),
        level_(level),
        first_i_(first_i - 1),
        first_j_(first_j - 1),
        side_(side + 2),
        block_(heights.Block(level, first_i - 2, first_j - 2, side + 4, side + 4)),
        finer_(level > 0 ? heights.Block(level - 1, 2 * first_i_ - 1, 2 * first_j_ - 1,
                                         2 * side_ + 1, 2 * side_ + 1)
                         : HeightBlock{}) {
    PlaceVertices(frame);
    SumNormals();
    if (level_ > 0) TakeFinerSlopes(frame);
  }

  [[nodiscard]] bool Has(int i, int j) const { return has_[At(i, j)] == Vertex::kOnThisSide; }
  [[nodiscard]] const glm::dvec3& Position(int i, int j) const { return position_m_[At(i, j)]; }
  [[nodiscard]] glm::dvec3 Normal(int i, int j) const {
    const glm::dvec3& sum = normal_sum_[At(i, j)];
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : glm::dvec3(0.0, 0.0, 1.0);
  }
  [[nodiscard]] float Height(int i, int j) const { return block_.at(i, j); }

  // Returns whether the cell south-east of a vertex is cut from north-west to south-east.
  [[nodiscard]] bool IsFalling(int i, int j) const {
    const bool void_off_falling = !IsKnown(i + 1, j) || !IsKnown(i, j + 1);
    const bool void_off_rising = !IsKnown(i, j) || !IsKnown(i + 1, j + 1);
    if (void_off_falling || void_off_rising) return void_off_falling;
    if (level_ > 0) return true;
    CellHeights around{};
    for (int k = 0; k < 16; ++k)
      around[static_cast<std::size_t>(k)] =
          static_cast<double>(block_.at(i - 1 + k % 4, j - 1 + k / 4));
    return FallingDiagonalFits(around);
  }

 private:
  // Vertices beyond the first or last column of a lattice that closes around the earth are those of
  // its other side. They only give the vertices of the rim their normals.
  enum class Vertex : char { kNone, kAcrossSeam, kOnThisSide };

  [[nodiscard]] std::size_t At(int i, int j) const {
    return static_cast<std::size_t>((j - first_j_) * side_ + (i - first_i_));
  }
  [[nodiscard]] bool IsKnown(int i, int j) const { return has_[At(i, j)] != Vertex::kNone; }

  void PlaceVertices(const LocalFrame& frame) {
    const auto count = static_cast<std::size_t>(side_ * side_);
    position_m_.resize(count);
    normal_sum_.resize(count, glm::dvec3(0.0));
    has_.resize(count, Vertex::kNone);
    const bool closes = lattice_.ClosesAroundTheEarth();
    for (int j = first_j_; j < first_j_ + side_; ++j) {
      if (j < 0 || j > lattice_.LastJ(level_)) continue;
      for (int i = first_i_; i < first_i_ + side_; ++i) {
        const bool is_on_lattice = i >= 0 && i <= lattice_.LastI(level_);
        if (!(is_on_lattice || closes) || std::isnan(block_.at(i, j))) continue;
        has_[At(i, j)] = is_on_lattice ? Vertex::kOnThisSide : Vertex::kAcrossSeam;
        position_m_[At(i, j)] = frame
                                    .EnuFromGeodetic(lattice_.PlaceOf(
                                        lattice_.ColumnOf(i, level_), lattice_.RowOf(j, level_),
                                        static_cast<double>(block_.at(i, j))))
                                    .xyz;
      }
    }
  }

  // Returns the rise of the finer level around a vertex along one axis [m] per sample.
  [[nodiscard]] double FinerRise(float before, float after, int samples) const {
    return samples > 0 ? static_cast<double>(after - before) / samples
                       : std::numeric_limits<double>::quiet_NaN();
  }

  // Replaces normals by those of the finer level. If a neighbour is missing, the normal of the
  // triangles stays.
  void TakeFinerSlopes(const LocalFrame& frame) {
    for (int j = first_j_; j < first_j_ + side_; ++j) {
      const double latitude = lattice_.PlaceOf(0, lattice_.RowOf(j, level_), 0.0).latitude_rad();
      const SampleSize size = SampleSizeAt(lattice_, latitude);
      for (int i = first_i_; i < first_i_ + side_; ++i) {
        if (!Has(i, j)) continue;
        const int x = 2 * i, y = 2 * j, finer = level_ - 1;
        const double east =
            FinerRise(finer_.at(x - 1, y), finer_.at(x + 1, y),
                      lattice_.ColumnOf(x + 1, finer) - lattice_.ColumnOf(x - 1, finer)) /
            size.column_m;
        const double south =
            FinerRise(finer_.at(x, y - 1), finer_.at(x, y + 1),
                      lattice_.RowOf(y + 1, finer) - lattice_.RowOf(y - 1, finer)) /
            size.row_m;
        if (std::isnan(east + south)) continue;
        const LocalFrame there(frame.ellipsoid(), lattice_.PlaceOf(lattice_.ColumnOf(i, level_),
                                                                   lattice_.RowOf(j, level_), 0.0));
        normal_sum_[At(i, j)] =
            frame.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{{-east, south, 1.0}})).xyz;
      }
    }
  }

  void SumNormals() {
    for (int j = first_j_; j + 1 < first_j_ + side_; ++j) {
      for (int i = first_i_; i + 1 < first_i_ + side_; ++i) {
        const std::size_t nw = At(i, j), ne = At(i + 1, j), sw = At(i, j + 1),
                          se = At(i + 1, j + 1);
        if (IsFalling(i, j)) {
          AddTriangle(nw, sw, se);
          AddTriangle(nw, se, ne);
        } else {
          AddTriangle(nw, sw, ne);
          AddTriangle(ne, sw, se);
        }
      }
    }
  }

  void AddTriangle(std::size_t a, std::size_t b, std::size_t c) {
    for (const std::size_t corner : {a, b, c})
      if (has_[corner] == Vertex::kNone) return;
    const glm::dvec3 twice_area =
        glm::cross(position_m_[b] - position_m_[a], position_m_[c] - position_m_[a]);
    for (const std::size_t corner : {a, b, c}) normal_sum_[corner] += twice_area;
  }

  const LandLattice& lattice_;
  int level_, first_i_, first_j_, side_;
  HeightBlock block_, finer_;
  std::vector<glm::dvec3> position_m_, normal_sum_;
  std::vector<Vertex> has_;
};

// The vertices of the next coarser level at the ends of the edge on which a vertex lies.
struct Ends {
  std::array<int, 2> first, second;  // i, j
};

class ChunkMaker {
 public:
  ChunkMaker(const LoadedHeights& heights, const ChunkKey& key, int top, const LandAnchor& anchor)
      : lattice_(heights.tiles().lattice()),
        key_(key),
        top_(top),
        anchor_(anchor),
        i0_(kChunkCells * key.column),
        j0_(kChunkCells * key.row),
        fine_(heights, key.level, i0_, j0_, kChunkSide, anchor.frame),
        coarse_(heights, std::min(key.level + 1, top), key.level < top ? i0_ / 2 : i0_,
                key.level < top ? j0_ / 2 : j0_, CoarseSide(), anchor.frame) {}

  LandChunk Make() {
    chunk_.key = key_;
    chunk_.highest_m = -std::numeric_limits<double>::infinity();
    chunk_.low = glm::dvec3(std::numeric_limits<double>::infinity());
    chunk_.high = -chunk_.low;
    AddCoarseVertices();
    chunk_.vertices.reserve(kChunkVertices);
    chunk_.own.reserve(kChunkVertices);
    chunk_.ends.reserve(kChunkVertices);
    for (int j = 0; j < kChunkSide; ++j)
      for (int i = 0; i < kChunkSide; ++i) AddVertex(i0_ + i, j0_ + j);
    AddTriangles();
    return std::move(chunk_);
  }

 private:
  [[nodiscard]] int CoarseSide() const {
    return key_.level < top_ ? kChunkCells / 2 + 1 : kChunkSide;
  }
  [[nodiscard]] int CoarseI0() const { return key_.level < top_ ? i0_ / 2 : i0_; }
  [[nodiscard]] int CoarseJ0() const { return key_.level < top_ ? j0_ / 2 : j0_; }
  [[nodiscard]] std::uint8_t CoarseIndex(int i, int j) const {
    return static_cast<std::uint8_t>((j - CoarseJ0()) * CoarseSide() + (i - CoarseI0()));
  }

  void AddCoarseVertices() {
    if (key_.level == top_) return;
    chunk_.coarse.reserve(static_cast<std::size_t>(CoarseSide() * CoarseSide()));
    for (int j = CoarseJ0(); j < CoarseJ0() + CoarseSide(); ++j)
      for (int i = CoarseI0(); i < CoarseI0() + CoarseSide(); ++i)
        chunk_.coarse.push_back(LitVertex(coarse_, i, j));
  }

  // Returns a vertex for lighting. A missing vertex gets the default position: it is lit but not
  // drawn.
  static LandVertex LitVertex(const SurfacePatch& patch, int i, int j) {
    if (!patch.Has(i, j)) return {};
    return {glm::vec3(patch.Position(i, j)), glm::vec3(patch.Normal(i, j))};
  }

  [[nodiscard]] bool CoarseHas(const std::array<int, 2>& at) const {
    return coarse_.Has(at[0], at[1]);
  }

  // Returns the ends of a vertex. If one of them is missing, both are the existing one, or else the
  // nearest existing corner of the coarser cell.
  [[nodiscard]] Ends EndsOf(int i, int j) const {
    const auto halves = [&](int at, int last) {
      const bool at_rim = at % 2 != 0 && at == last;
      return std::array<int, 2>{at_rim ? (at + 1) / 2 : at / 2, (at + 1) / 2};
    };
    const auto [west, east] = halves(i, lattice_.LastI(key_.level));
    const auto [north, south] = halves(j, lattice_.LastJ(key_.level));
    const Ends falling{{west, north}, {east, south}};
    const Ends rising{{east, north}, {west, south}};
    for (const Ends& ends : {falling, rising})
      if (CoarseHas(ends.first) && CoarseHas(ends.second)) return ends;
    for (const auto& end : {falling.first, falling.second, rising.first, rising.second})
      if (CoarseHas(end)) return {end, end};
    return falling;
  }

  static std::array<std::int16_t, 4> Packed(const glm::dvec3& normal, int level) {
    const auto pack = [](double value) {
      return static_cast<std::int16_t>(std::lround(32767.0 * value));
    };
    return {pack(normal.x), pack(normal.y), pack(normal.z), static_cast<std::int16_t>(level)};
  }
  static std::array<float, 3> Floats(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  }

  void AddVertex(int i, int j) {
    chunk_.own.push_back(LitVertex(fine_, i, j));
    chunk_.ends.push_back({0, 0});
    if (!fine_.Has(i, j)) {
      chunk_.vertices.push_back({});
      return;
    }
    glm::dvec3 coarse = fine_.Position(i, j), coarse_normal = fine_.Normal(i, j);
    if (key_.level < top_) {
      const auto [first, second] = EndsOf(i, j);
      chunk_.ends.back() = {CoarseIndex(first[0], first[1]), CoarseIndex(second[0], second[1])};
      if (CoarseHas(first)) {
        coarse =
            0.5 * (coarse_.Position(first[0], first[1]) + coarse_.Position(second[0], second[1]));
        coarse_normal =
            0.5 * (coarse_.Normal(first[0], first[1]) + coarse_.Normal(second[0], second[1]));
      }
    }
    const glm::dvec3& position = fine_.Position(i, j);
    const auto sample = [](int at, int of) { return static_cast<float>(at - of); };
    chunk_.vertices.push_back({Floats(position),
                               Floats(coarse),
                               {sample(lattice_.ColumnOf(i, key_.level), anchor_.column),
                                sample(lattice_.RowOf(j, key_.level), anchor_.row)},
                               Packed(fine_.Normal(i, j), key_.level),
                               Packed(coarse_normal, key_.level)});
    chunk_.low = glm::min(chunk_.low, glm::min(position, coarse));
    chunk_.high = glm::max(chunk_.high, glm::max(position, coarse));
    chunk_.highest_m = std::max(chunk_.highest_m, static_cast<double>(fine_.Height(i, j)));
    WidenParts(i - i0_, j - j0_, glm::min(position, coarse), glm::max(position, coarse));
  }

  // Extends the boxes of the parts. A vertex on a border belongs to the parts on both sides.
  void WidenParts(int i, int j, const glm::dvec3& low, const glm::dvec3& high) {
    constexpr int kAcross = kChunkCells / kChunkPart;
    for (int y = 0; y < kAcross; ++y) {
      for (int x = 0; x < kAcross; ++x) {
        const int east = i - kChunkPart * x, south = j - kChunkPart * y;
        if (east < 0 || south < 0 || east > kChunkPart || south > kChunkPart) continue;
        ChunkBox& box = chunk_.parts[static_cast<std::size_t>(kAcross * y + x)];
        box.low = glm::min(box.low, glm::vec3(low));
        box.high = glm::max(box.high, glm::vec3(high));
      }
    }
  }

  void AddTriangles() {
    for (int j = 0; j < kChunkCells; ++j)
      for (int i = 0; i < kChunkCells; ++i) AddCell(i, j);
    chunk_.is_whole = key_.level > 0 && chunk_.triangles.size() == kChunkIndices;
  }

  void AddCell(int i, int j) {
    if (i0_ + i >= lattice_.LastI(key_.level) || j0_ + j >= lattice_.LastJ(key_.level)) return;
    const auto index = [](int x, int y) { return static_cast<std::uint16_t>(y * kChunkSide + x); };
    const std::uint16_t nw = index(i, j), ne = index(i + 1, j);
    const std::uint16_t sw = index(i, j + 1), se = index(i + 1, j + 1);
    if (fine_.IsFalling(i0_ + i, j0_ + j)) {
      AddTriangle(nw, sw, se);
      AddTriangle(nw, se, ne);
    } else {
      AddTriangle(nw, sw, ne);
      AddTriangle(ne, sw, se);
    }
  }

  void AddTriangle(std::uint16_t a, std::uint16_t b, std::uint16_t c) {
    for (const std::uint16_t corner : {a, b, c})
      if (!fine_.Has(i0_ + corner % kChunkSide, j0_ + corner / kChunkSide)) return;
    chunk_.triangles.insert(chunk_.triangles.end(), {a, b, c});
  }

  const LandLattice& lattice_;
  ChunkKey key_;
  int top_;
  const LandAnchor& anchor_;
  int i0_, j0_;
  SurfacePatch fine_, coarse_;
  LandChunk chunk_;
};

VertexLight MeanLight(const VertexLight& a, const VertexLight& b) {
  VertexLight mean;
  for (std::size_t band = 0; band < mean.sky.size(); ++band) {
    mean.sky[band] = 0.5F * (a.sky[band] + b.sky[band]);
    mean.moon_sky[band] = 0.5F * (a.moon_sky[band] + b.moon_sky[band]);
  }
  mean.disk_x = 0.5F * (a.disk_x + b.disk_x);
  return mean;
}

std::vector<VertexLight> LightFor(const std::vector<LandVertex>& vertices, const LocalFrame& frame,
                                  const std::optional<LightOfVertices>& light) {
  if (!light) return std::vector<VertexLight>(vertices.size());
  std::vector<VertexLight> lit = light->at(frame, vertices);
  ALPENGLOW_ENSURE(lit.size(), ==, vertices.size());
  return lit;
}

}  // namespace

LandChunk MakeChunk(const LoadedHeights& heights, const ChunkKey& key, int top,
                    const LandAnchor& anchor) {
  return ChunkMaker(heights, key, top, anchor).Make();
}

std::array<std::uint16_t, 4> PackedShares(const std::array<float, 4>& values) {
  std::array<std::uint16_t, 4> halves{};
  for (std::size_t i = 0; i < values.size(); ++i)
    halves[i] = glm::packHalf1x16(WithinHalf(values[i]));
  return halves;
}

std::size_t BytesOf(const LandChunk& chunk) {
  return sizeof(LandChunk) + chunk.vertices.capacity() * sizeof(ChunkVertex) +
         (chunk.own.capacity() + chunk.coarse.capacity()) * sizeof(LandVertex) +
         chunk.ends.capacity() * sizeof(CoarseEnds) +
         chunk.triangles.capacity() * sizeof(std::uint16_t);
}

std::vector<ChunkLight> LightOfChunk(const LandChunk& chunk, const LocalFrame& frame,
                                     const std::optional<LightOfVertices>& light) {
  std::vector<LandVertex> all = chunk.own;
  all.insert(all.end(), chunk.coarse.begin(), chunk.coarse.end());
  const std::vector<VertexLight> lit = LightFor(all, frame, light);
  std::vector<ChunkLight> packed;
  packed.reserve(chunk.own.size());
  for (std::size_t i = 0; i < chunk.own.size(); ++i) {
    const VertexLight coarse = chunk.coarse.empty()
                                   ? lit[i]
                                   : MeanLight(lit[chunk.own.size() + chunk.ends[i].first],
                                               lit[chunk.own.size() + chunk.ends[i].second]);
    packed.push_back({PackedShares(lit[i].sky),
                      PackedShares(coarse.sky),
                      PackedShares(lit[i].moon_sky),
                      PackedShares(coarse.moon_sky),
                      {glm::packHalf1x16(lit[i].disk_x), glm::packHalf1x16(coarse.disk_x)}});
  }
  return packed;
}

const std::vector<std::uint16_t>& WholeTriangles() {
  static const std::vector<std::uint16_t> kTriangles = [] {
    std::vector<std::uint16_t> triangles;
    for (int cell = 0; cell < kChunkCells * kChunkCells; ++cell) {
      const int nw = cell / kChunkCells * kChunkSide + cell % kChunkCells;
      for (const int corner :
           {nw, nw + kChunkSide, nw + kChunkSide + 1, nw, nw + kChunkSide + 1, nw + 1})
        triangles.push_back(static_cast<std::uint16_t>(corner));
    }
    return triangles;
  }();
  return kTriangles;
}

std::vector<std::uint16_t> WithCoarseSides(std::span<const std::uint16_t> triangles,
                                           std::span<const CoarseEnds> ends, unsigned sides) {
  // An odd vertex on the rim of the lattice also belongs to the coarser level.
  const auto is_coarse = [&](std::uint16_t vertex) {
    return !ends.empty() && ends[vertex].first == ends[vertex].second;
  };
  const auto even = [&](std::uint16_t vertex) {
    if (is_coarse(vertex)) return vertex;
    const int x = vertex % kChunkSide, y = vertex / kChunkSide;
    const bool along_row =
        (y == 0 && (sides & kNorthSide) != 0) || (y == kChunkCells && (sides & kSouthSide) != 0);
    const bool along_column =
        (x == 0 && (sides & kWestSide) != 0) || (x == kChunkCells && (sides & kEastSide) != 0);
    const int to_x = along_row ? x & ~1 : x, to_y = along_column ? y & ~1 : y;
    return static_cast<std::uint16_t>(to_y * kChunkSide + to_x);
  };
  std::vector<std::uint16_t> kept;
  kept.reserve(triangles.size());
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const std::uint16_t a = even(triangles[i]), b = even(triangles[i + 1]),
                        c = even(triangles[i + 2]);
    if (a != b && b != c && c != a) kept.insert(kept.end(), {a, b, c});
  }
  return kept;
}

}  // namespace alpenglow::renderer
