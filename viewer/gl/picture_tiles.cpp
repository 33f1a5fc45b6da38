// SPDX-License-Identifier: MIT
#include "viewer/gl/picture_tiles.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

#include "atmosphere/base/error.h"

namespace alpenglow::viewer {
namespace {

int Parts(int whole, int part) { return (whole + part - 1) / part; }

/// Returns the first pixel of each part of a side, and the end of the last part.
std::vector<int> Cuts(int side, int largest) {
  const int step = std::min(kTileStep, largest);
  const int steps = Parts(side, step);
  const int count = Parts(steps, largest / step);
  std::vector<int> cuts;
  for (int i = 0; i <= count; ++i) {
    const auto whole_steps = static_cast<int>(static_cast<long long>(steps) * i / count);
    cuts.push_back(std::min(step * whole_steps, side));
  }
  return cuts;
}

PictureTile WithRim(const PictureTile& tile, int rim, int width, int height) {
  const int left = std::max(tile.left - rim, 0), top = std::max(tile.top - rim, 0);
  return {left, top, std::min(tile.left + tile.width + rim, width) - left,
          std::min(tile.top + tile.height + rim, height) - top};
}

/// Returns the memory that Linux reports as available without taking memory from other programs.
std::optional<double> SpareBytes() {
  std::ifstream meminfo("/proc/meminfo");
  std::string name;
  double kilobytes = 0.0;
  for (std::string unit; meminfo >> name >> kilobytes && std::getline(meminfo, unit);) {
    if (name == "MemAvailable:") return 1024.0 * kilobytes;
  }
  return std::nullopt;
}

// A driver may limit the bytes of a texture in addition to its sides.
bool HoldsTexture(int width, int height) {
  glTexImage2D(GL_PROXY_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
  GLint held = 0;
  glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &held);
  return held == width;
}

int LongestSide() {
  GLint texture = 0, renderbuffer = 0;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderbuffer);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  return std::min({texture, renderbuffer, viewport[0], viewport[1]});
}

}  // namespace

std::vector<PictureTile> TilesOf(int width, int height, int largest_side) {
  const std::vector<int> columns = Cuts(width, largest_side), rows = Cuts(height, largest_side);
  std::vector<PictureTile> tiles;
  for (std::size_t row = rows.size() - 1; row > 0; --row) {
    for (std::size_t column = 0; column + 1 < columns.size(); ++column) {
      tiles.push_back({columns[column], height - rows[row], columns[column + 1] - columns[column],
                       rows[row] - rows[row - 1]});
    }
  }
  return tiles;
}

glm::dvec4 ViewOfTile(const PictureTile& tile, int width, int height) {
  const double middle_right = (2.0 * tile.left + tile.width) / width - 1.0;
  const double middle_up = 1.0 - (2.0 * tile.top + tile.height) / height;
  return {middle_right, middle_up, static_cast<double>(width) / tile.width,
          static_cast<double>(height) / tile.height};
}

TiledPicture::TiledPicture(int width, int height, int largest_side) {
  const bool is_one = std::max(width, height) <= largest_side;
  const int rim = is_one ? 0 : std::min(kTileStep, largest_side / 4);
  const std::vector<PictureTile> kept = is_one ? std::vector{PictureTile{0, 0, width, height}}
                                               : TilesOf(width, height, largest_side - 2 * rim);
  for (const PictureTile& tile : kept) tiles_.push_back({tile, WithRim(tile, rim, width, height)});
  // Memory of the writers besides the picture: half floats, or bytes and their rows.
  constexpr int kBytesOfWriters = 8;
  RequireMemoryFor(width, height, static_cast<int>(sizeof(picture_.rgb[0])) + kBytesOfWriters);
  picture_ = Image(width, height);
}

void TiledPicture::Put(const Tile& tile, const Image& painted) {
  ALPENGLOW_ENSURE(painted.width, ==, tile.painted.width);
  ALPENGLOW_ENSURE(painted.height, ==, tile.painted.height);
  const PictureTile& kept = tile.kept;
  const int rim_left = kept.left - tile.painted.left, rim_top = kept.top - tile.painted.top;
  for (int y = 0; y < kept.height; ++y) {
    std::copy_n(&painted.at(rim_left, rim_top + y), kept.width,
                &picture_.at(kept.left, kept.top + y));
  }
}

bool IsDrawable(int width, int height) {
  const int side = LongestSide();
  return width <= side && height <= side && HoldsTexture(width, height);
}

int LargestSquareOfDriver() {
  int side = LongestSide();
  while (side > 1 && !HoldsTexture(side, side)) side /= 2;
  return side;
}

void RequireDrawable(int width, int height) {
  if (IsDrawable(width, height)) return;
  const int square = LargestSquareOfDriver();
  throw OptionError(fmt::format(
      "--size {}x{}: this OpenGL draws {} pixels a side and about {}x{} in one piece, and no more",
      width, height, LongestSide(), square, square));
}

void RequireMemoryFor(int width, int height, int bytes_per_pixel) {
  const double needed = static_cast<double>(width) * height * bytes_per_pixel;
  const std::optional<double> spare = SpareBytes();
  if (!spare || needed <= *spare) return;
  throw OptionError(
      fmt::format("--size {}x{}: the picture takes {:.1f} GB of memory; {:.1f} GB are left here",
                  width, height, 1e-9 * needed, 1e-9 * *spare));
}

}  // namespace alpenglow::viewer
