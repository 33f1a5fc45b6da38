// SPDX-License-Identifier: MIT
#include "lut/image/development.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "atmosphere/base/error.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

constexpr int kSize = kDitherTileSize;
constexpr int kCells = kSize * kSize;

// Points farther away than this along x or y add less than half a unit of the kernel, which is 0.
constexpr int kReach = 10;
constexpr int kKernelSide = 2 * kReach + 1;

/// Returns a Gaussian of the distance, sigma 1.9 pixels (Ulichney's 1.5 leaves more low frequencies
/// in tiles this small), in integers so that sums are exact. Element 0 is at (-kReach, -kReach).
std::vector<int> DitherKernel() {
  std::vector<int> kernel;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const double gauss = std::exp(-static_cast<double>(dx * dx + dy * dy) / (2.0 * 1.9 * 1.9));
      kernel.push_back(static_cast<int>(std::lround(1e6 * gauss)));
    }
  }
  return kernel;
}

/// The extreme cells of a row of a pattern, each if the row has one. They are found when they are
/// needed.
struct PatternRow {
  bool is_known = false;
  std::optional<int> cluster, gap;
};

/// A pattern of points on the torus, with the crowding of every cell.
class Pattern {
 public:
  Pattern() : kernel_(DitherKernel()), crowding_(kCells, 0), set_(kCells, 0) {}

  void Add(int cell) { Change(cell, true, 1); }
  void Remove(int cell) { Change(cell, false, -1); }

  /// Returns the point with the largest crowding; of equal ones the first.
  [[nodiscard]] int TightestCluster() {
    return Extreme(&PatternRow::cluster, [](int a, int b) { return a > b; });
  }
  /// Returns the cell without a point that has the smallest crowding; of equal ones the first.
  [[nodiscard]] int LargestVoid() {
    return Extreme(&PatternRow::gap, [](int a, int b) { return a < b; });
  }

 private:
  void Change(int cell, bool set, int sign) {
    set_[static_cast<std::size_t>(cell)] = set ? 1 : 0;
    const int x0 = cell % kSize + kSize - kReach;
    const int y0 = cell / kSize + kSize - kReach;
    for (int dy = 0; dy < kKernelSide; ++dy) {
      const int y = (y0 + dy) % kSize;
      rows_[static_cast<std::size_t>(y)].is_known = false;
      int* const row = crowding_.data() + y * kSize;
      const int* const kernel = kernel_.data() + dy * kKernelSide;
      for (int dx = 0; dx < kKernelSide; ++dx) row[(x0 + dx) % kSize] += sign * kernel[dx];
    }
  }
  [[nodiscard]] PatternRow ExtremesOfRow(int y) const {
    PatternRow row;
    row.is_known = true;
    const int* const crowding = crowding_.data();
    for (int cell = y * kSize; cell < (y + 1) * kSize; ++cell) {
      if (set_[static_cast<std::size_t>(cell)] != 0) {
        if (!row.cluster || crowding[cell] > crowding[*row.cluster]) row.cluster = cell;
      } else if (!row.gap || crowding[cell] < crowding[*row.gap]) {
        row.gap = cell;
      }
    }
    return row;
  }
  template <typename Exceeds>
  [[nodiscard]] int Extreme(std::optional<int> PatternRow::*of_row, const Exceeds& exceeds) {
    std::optional<int> best;
    for (int y = 0; y < kSize; ++y) {
      PatternRow& row = rows_[static_cast<std::size_t>(y)];
      if (!row.is_known) row = ExtremesOfRow(y);
      const std::optional<int> cell = row.*of_row;
      if (!cell) continue;
      if (!best || exceeds(crowding_[static_cast<std::size_t>(*cell)],
                           crowding_[static_cast<std::size_t>(*best)])) {
        best = cell;
      }
    }
    return best.value();
  }

  std::vector<int> kernel_, crowding_;
  std::vector<std::uint8_t> set_;
  std::array<PatternRow, kSize> rows_;
};

/// Returns a tenth of the cells, chosen at random. Regular starts, lattices among them, survive the
/// relaxation and correlate the tile with its shifted copies.
std::vector<int> FirstPoints() {
  std::mt19937 random(20260621);  // one sequence on every machine (ISO C++ [rand.predef])
  std::vector<int> cells;
  while (cells.size() < kCells / 10) {
    const auto cell = static_cast<int>(random() % kCells);
    if (std::find(cells.begin(), cells.end(), cell) == cells.end()) cells.push_back(cell);
  }
  return cells;
}

/// Moves points from clusters into voids until no move is an improvement.
void Relax(Pattern& pattern) {
  for (int moves = 0; moves < kCells; ++moves) {
    const int cluster = pattern.TightestCluster();
    pattern.Remove(cluster);
    const int gap = pattern.LargestVoid();
    pattern.Add(gap);
    if (gap == cluster) return;
  }
}

std::vector<std::uint16_t> VoidAndCluster() {
  Pattern pattern;
  const std::vector<int> first = FirstPoints();
  for (const int cell : first) pattern.Add(cell);
  Relax(pattern);
  std::vector<std::uint16_t> rank(kCells);
  Pattern thinned = pattern;
  for (std::size_t left = first.size(); left > 0; --left) {
    const int cell = thinned.TightestCluster();
    thinned.Remove(cell);
    rank[static_cast<std::size_t>(cell)] = static_cast<std::uint16_t>(left - 1);
  }
  // The sum of crowding by points and crowding by gaps is equal in all cells, so the largest void
  // of the points is also the tightest cluster of the gaps. One loop therefore does both of
  // Ulichney's last phases.
  for (std::size_t points = first.size(); points < kCells; ++points) {
    const int cell = pattern.LargestVoid();
    pattern.Add(cell);
    rank[static_cast<std::size_t>(cell)] = static_cast<std::uint16_t>(points);
  }
  return rank;
}

/// Returns the inverse cumulative distribution of the triangular distribution on (-1, 1). @param u
/// in (0, 1).
float Triangular(float u) {
  return u < 0.5F ? std::sqrt(2.0F * u) - 1.0F : 1.0F - std::sqrt(2.0F - 2.0F * u);
}

}  // namespace

const std::vector<std::uint16_t>& DitherTile() {
  static const std::vector<std::uint16_t> tile = VoidAndCluster();
  return tile;
}

DitherShift DitherShiftOf(int tile_x, int tile_y) {
  const std::uint32_t hash =
      shared::DitherHash(static_cast<std::uint32_t>(tile_x), static_cast<std::uint32_t>(tile_y));
  constexpr std::uint32_t kMask = kSize - 1;
  return {static_cast<int>(hash & kMask), static_cast<int>((hash >> 8) & kMask)};
}

float DitherNoise(int x, int y, int channel) {
  static const std::vector<float> noise = [] {
    std::vector<float> values;
    for (const std::uint16_t rank : DitherTile()) {
      values.push_back(Triangular((static_cast<float>(rank) + 0.5F) / kCells));
    }
    return values;
  }();
  constexpr std::array<int, 3> kShiftX = {0, 23, 47};
  constexpr std::array<int, 3> kShiftY = {0, 41, 19};
  const auto c = static_cast<std::size_t>(channel);
  const DitherShift shift = DitherShiftOf(x / kSize, y / kSize);
  const int column = (x + shift.x + kShiftX[c]) % kSize;
  const int row = (y + shift.y + kShiftY[c]) % kSize;
  return noise[static_cast<std::size_t>(row * kSize + column)];
}

std::uint8_t DitheredCode(float code, float noise) {
  return static_cast<std::uint8_t>(std::lround(shared::DitheredValue(code, noise)));
}

namespace {

constexpr float kLeastLight = 16.0F, kFullLight = 256.0F;  // times white
constexpr float kEven = 0.4F;         // of the light, in its square; the limb is half as bright
constexpr float kDarkestLimb = 0.4F;  // fraction of the light four pixels farther in
// Search distances [pixels]: filters spread an edge over three or four pixels.
constexpr int kToLight = 4, kToBeside = 4;
// Squared radii near 2 and 4 pixels. They are squared lengths of knight's moves, so that in every
// direction some pixel lies at about that distance.
constexpr int kToLimb2 = 5, kToLight2 = 20;
// An aureole brightens towards its sun. From the farther background pixels (more than the root of
// kToFar2 away) to the nearer ones it brightens by a factor, and from those to the pixel by about
// the square of this factor. A factor above kSteepest indicates the edge of another object.
constexpr int kToFar2 = 10;
constexpr float kSteepest = 1.6F;
// The outer taps of a filter add a little of the light to some unclipped pixels too. Such a pixel
// is brighter than its background by at least this factor.
constexpr float kTouched = 1.25F;

float LuminanceAt(const Image& image, int x, int y) {
  const auto& rgb = image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
  return shared::Luminance(rgb[0], rgb[1], rgb[2]);
}

/// Returns whether a pixel belongs to a 2x2 square of pixels that are about as bright.
bool IsEven(const Image& image, int x, int y, float light) {
  const auto bright = [&](int i, int j) { return LuminanceAt(image, i, j) >= kEven * light; };
  for (const int i : {x - 1, x + 1}) {
    for (const int j : {y - 1, y + 1}) {
      if (bright(i, y) && bright(x, j) && bright(i, j)) return true;
    }
  }
  return false;
}

struct Pixel {
  int x, y;
};

/// Calls visit(pixel) for all pixels at most `reach` rows and columns away from `at`.
template <typename Visit>
void Around(const Image& image, const Pixel& at, int reach, const Visit& visit) {
  for (int y = std::max(at.y - reach, 0); y <= std::min(at.y + reach, image.height - 1); ++y) {
    for (int x = std::max(at.x - reach, 0); x <= std::min(at.x + reach, image.width - 1); ++x) {
      visit(Pixel{x, y});
    }
  }
}

struct EdgeLight {
  Pixel at;
  float luminance;
};

/// Returns the brightest pixel within the square root of `reach2`.
EdgeLight BrightestAround(const Image& image, const Pixel& at, int reach2) {
  EdgeLight light{at, LuminanceAt(image, at.x, at.y)};
  Around(image, at, kToLight, [&](const Pixel& pixel) {
    const int dx = pixel.x - at.x, dy = pixel.y - at.y;
    const float luminance = LuminanceAt(image, pixel.x, pixel.y);
    if (dx * dx + dy * dy <= reach2 && luminance > light.luminance) light = {pixel, luminance};
  });
  return light;
}

struct EdgeDirection {
  float x, y;
};

/// Returns the unit vector away from the light around a pixel; zero if the light is equal on all
/// sides.
EdgeDirection AwayFromLight(const Image& image, const Pixel& at) {
  EdgeDirection away{0.0F, 0.0F};
  Around(image, at, kToBeside, [&](const Pixel& pixel) {
    const float luminance = LuminanceAt(image, pixel.x, pixel.y);
    away.x -= luminance * static_cast<float>(pixel.x - at.x);
    away.y -= luminance * static_cast<float>(pixel.y - at.y);
  });
  const float length = std::hypot(away.x, away.y);
  return length > 0.0F ? EdgeDirection{away.x / length, away.y / length}
                       : EdgeDirection{0.0F, 0.0F};
}

/// A weighted mean of colours.
class MeanColour {
 public:
  void Add(const std::array<float, 3>& rgb, float weight) {
    for (std::size_t c = 0; c < 3; ++c) sum_[c] += weight * rgb[c];
    weights_ += weight;
  }
  [[nodiscard]] bool empty() const { return weights_ == 0.0F; }
  [[nodiscard]] std::array<float, 3> Value() const {
    return {sum_[0] / weights_, sum_[1] / weights_, sum_[2] / weights_};
  }
  [[nodiscard]] float Luminance() const {
    const auto rgb = Value();
    return shared::Luminance(rgb[0], rgb[1], rgb[2]);
  }

 private:
  std::array<float, 3> sum_{};
  float weights_ = 0.0F;
};

/// Returns the factor by which an aureole brightens from the background pixels, near and far, to
/// the pixel itself.
float RiseTowardsLight(const MeanColour& near, const MeanColour& far) {
  if (near.empty() || far.empty()) return 1.0F;
  const float rise = near.Luminance() / std::max(far.Luminance(), 1e-30F);
  return rise > 1.0F && rise < kSteepest ? rise * rise : 1.0F;
}

/// Returns the colour of the unclipped background, extrapolated to the pixel. It is a mean over
/// unclipped pixels, weighted by proximity and by the fourth power of the cosine between their
/// direction and the direction away from the light, times the rise of the aureole. If no pixel lies
/// in that direction, the mean is weighted by proximity alone. Returns nullopt if all pixels are
/// clipped.
std::optional<std::array<float, 3>> Beside(const Image& image, const Pixel& at, float white) {
  const EdgeDirection away = AwayFromLight(image, at);
  MeanColour behind, around, near, far;
  Around(image, at, kToBeside, [&](const Pixel& pixel) {
    if (LuminanceAt(image, pixel.x, pixel.y) > white) return;
    const auto dx = static_cast<float>(pixel.x - at.x), dy = static_cast<float>(pixel.y - at.y);
    const float distance2 = dx * dx + dy * dy;
    if (distance2 == 0.0F) return;
    // Pixels in which a filter mixes the light count only if there are none farther away.
    const bool mixed = distance2 < static_cast<float>(kToLimb2);
    const float weight = (mixed ? 1e-6F : 1.0F) / distance2;
    const float cosine = std::max(away.x * dx + away.y * dy, 0.0F) / std::sqrt(distance2);
    const float along = cosine * cosine * cosine * cosine;
    const auto& rgb = image.at(pixel.x, pixel.y);
    around.Add(rgb, weight);
    behind.Add(rgb, weight * along);
    if (!mixed) (distance2 > static_cast<float>(kToFar2) ? far : near).Add(rgb, along);
  });
  if (around.empty()) return std::nullopt;
  std::array<float, 3> colour = (behind.empty() ? around : behind).Value();
  for (float& channel : colour) channel *= RiseTowardsLight(near, far);
  return colour;
}

}  // namespace

std::optional<ClippedEdge> ClippedEdgeAt(const Image& image, int x, int y, float white) {
  const float here = LuminanceAt(image, x, y);
  const auto clips = [&](int dx, int dy) { return LuminanceAt(image, x + dx, y + dy) > white; };
  if (!clips(0, 0) && !clips(-2, 0) && !clips(2, 0) && !clips(0, -2) && !clips(0, 2)) {
    return std::nullopt;
  }
  const EdgeLight light = BrightestAround(image, {x, y}, kToLight2);
  if (light.luminance <= kLeastLight * white ||
      !IsEven(image, light.at.x, light.at.y, light.luminance)) {
    return std::nullopt;
  }
  const std::optional<std::array<float, 3>> beside = Beside(image, {x, y}, white);
  if (!beside) return std::nullopt;
  const float dark = shared::Luminance((*beside)[0], (*beside)[1], (*beside)[2]);
  if (dark >= white || (here <= white && here < kTouched * dark)) return std::nullopt;
  const float within = BrightestAround(image, {x, y}, kToLimb2).luminance;
  const float full =
      std::max(3.0F * within - 2.0F * light.luminance, kDarkestLimb * light.luminance);
  const float stops = std::log2(light.luminance / (kLeastLight * white));
  const float seen = std::clamp(2.0F * (1.0F - dark / white), 0.0F, 1.0F);
  return ClippedEdge{image.at(light.at.x, light.at.y), *beside,
                     std::clamp((here - dark) / (full - dark), 0.0F, 1.0F),
                     seen * std::min(stops / std::log2(kFullLight / kLeastLight), 1.0F)};
}

namespace {

void RequireFinite(const std::array<float, 3>& pixel, int x, int y) {
  if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) return;
  throw InternalError(fmt::format("pixel ({}, {}) is ({}, {}, {}), which is no colour", x, y,
                                  pixel[0], pixel[1], pixel[2]));
}

/// Returns the display light of a pixel. At the edge of a disk that is far brighter than white it
/// is mixed from the display light of the disk and of its background.
Rgb<float> DisplayLightAt(const Image& image, int x, int y, float scale, const Look& look) {
  const auto shown = [&](const std::array<float, 3>& rgb) {
    return DisplayLight(look.curve, rgb, scale, look.agx);
  };
  const std::optional<ClippedEdge> edge = ClippedEdgeAt(image, x, y, 1.0F / scale);
  const Rgb<float> whole = shown(image.at(x, y));
  if (!edge) return whole;
  const Rgb<float> light = shown(edge->light), beside = shown(edge->beside);
  Rgb<float> mixed;
  for (std::size_t c = 0; c < 3; ++c) {
    const float parts = edge->share * light[c] + (1.0F - edge->share) * beside[c];
    mixed[c] = edge->weight * parts + (1.0F - edge->weight) * whole[c];
  }
  return mixed;
}

void DevelopRow(const Image& image, int y, float scale, const Look& look, DisplayImage& display) {
  for (int x = 0; x < image.width; ++x) {
    const std::array<float, 3>& pixel = image.at(x, y);
    RequireFinite(pixel, x, y);
    const Rgb<float> light = DisplayLightAt(image, x, y, scale, look);
    const auto index = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x));
    for (std::size_t c = 0; c < 3; ++c) {
      const float code = 255.0F * shared::SrgbCode(light[c]);
      display.rgb[index + c] = DitheredCode(code, DitherNoise(x, y, static_cast<int>(c)));
    }
  }
}

}  // namespace

DisplayImage Develop(const Image& image, double ev100, ToneCurve curve) {
  return Develop(image, ev100, Look{.curve = curve});
}

DisplayImage Develop(const Image& seen, double ev100, const Look& look) {
  if (look.local_exposure) {
    Look rest = look;
    rest.local_exposure = false;
    return Develop(LocallyExposed(seen, ev100), ev100, rest);
  }
  if (look.rolls_off) {
    Look rest = look;
    rest.rolls_off = false;
    return Develop(WithHighlightsRolledOff(seen, ev100), ev100, rest);
  }
  const auto scale = static_cast<float>(ExposureScale(ev100));
  DisplayImage display{seen.width, seen.height, std::vector<std::uint8_t>(3 * seen.rgb.size())};
  tbb::parallel_for(0, seen.height, [&](int y) { DevelopRow(seen, y, scale, look, display); });
  return display;
}

}  // namespace alpenglow::lut
