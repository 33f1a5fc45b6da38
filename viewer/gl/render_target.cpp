// SPDX-License-Identifier: MIT
#include "viewer/gl/render_target.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "viewer/gl/gl_context.h"

namespace alpenglow::viewer {
namespace {

struct FormatRow {
  GLint internal;
  GLenum format, type;
};

const FormatRow& RowOf(PixelFormat format) {
  static constexpr FormatRow kRows[] = {
      {GL_RGBA32F, GL_RGBA, GL_FLOAT},
      {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT},
      {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
  };
  return kRows[static_cast<std::size_t>(format)];
}

// The allocation fails with a GL error, which CheckGl reports.
void Allocate(const GlTexture& texture, int width, int height, const FormatRow& row) {
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, row.internal, width, height, 0, row.format, row.type, nullptr);
  CheckGl(fmt::format("a picture of {}x{}", width, height).c_str());
  ClampAndFilter(GL_TEXTURE_2D, false);
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
}

// Reverses the order of rows: row 0 of OpenGL is the lowest.
template <typename Pixel>
void TurnUpsideDown(std::vector<Pixel>& pixels, std::size_t row) {
  const std::size_t rows = pixels.size() / row;
  for (std::size_t y = 0; y < rows / 2; ++y) {
    std::swap_ranges(&pixels[y * row], &pixels[y * row] + row, &pixels[(rows - 1 - y) * row]);
  }
}

GLsizeiptr BytesOf(std::size_t pixels) {
  return static_cast<GLsizeiptr>(pixels * sizeof(std::array<float, 3>));
}

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
  for (std::string line; std::getline(meminfo, line);) {
    const std::vector<std::string_view> words = WordsOf(line);
    if (words.size() < 2 || words[0] != "MemAvailable:") continue;
    if (const std::optional<double> kilobytes = ParseNumber(words[1])) return 1024.0 * *kilobytes;
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

RenderTarget::RenderTarget(int width, int height, const std::vector<PixelFormat>& formats,
                           Depth depth)
    : width_(width), height_(height), colours_(formats.size()) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  std::vector<GLenum> outputs;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    Allocate(colours_[i], width, height, RowOf(formats[i]));
    outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    glFramebufferTexture2D(GL_FRAMEBUFFER, outputs.back(), GL_TEXTURE_2D, colours_[i].id(), 0);
  }
  glDrawBuffers(static_cast<GLsizei>(outputs.size()), outputs.data());
  if (depth == Depth::k32Bit) {
    Allocate(depth_, width, height, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT});
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  }
  if (formats.empty()) glReadBuffer(GL_NONE);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  ALPENGLOW_ENSURE(status, ==, static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
}

void RenderTarget::Bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
}

void RenderTarget::BindTexture(int unit, std::size_t output) const {
  viewer::BindTexture(unit, GL_TEXTURE_2D, colours_[output]);
}

void RenderTarget::BindDepth(int unit) const { viewer::BindTexture(unit, GL_TEXTURE_2D, depth_); }

void RenderTarget::Write(const HdrImage& image) const {
  ALPENGLOW_ENSURE(image.width, ==, width_);
  ALPENGLOW_ENSURE(image.height, ==, height_);
  std::vector<std::array<float, 3>> rows = image.rgb;
  TurnUpsideDown(rows, static_cast<std::size_t>(width_));
  glBindTexture(GL_TEXTURE_2D, colours_.front().id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_FLOAT, rows.data());
}

template <typename Pixel>
void RenderTarget::ReadInto(std::vector<Pixel>& pixels, std::size_t output, GLenum format) const {
  pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(output));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, format, GL_FLOAT, pixels.data());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  TurnUpsideDown(pixels, static_cast<std::size_t>(width_));
}

void RenderTarget::UseDepthOf(const RenderTarget& other) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, other.depth_.id(), 0);
}

HdrImage RenderTarget::Read() const {
  HdrImage image(width_, height_);
  ReadInto(image.rgb, 0, GL_RGB);
  return image;
}

std::vector<glm::vec4> RenderTarget::ReadValues(std::size_t output) const {
  std::vector<glm::vec4> values;
  ReadInto(values, output, GL_RGBA);
  return values;
}

DisplayImage RenderTarget::ReadBytes() const {
  const std::size_t row = 3 * static_cast<std::size_t>(width_);
  DisplayImage image{width_, height_, {}};
  image.rgb.resize(row * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
  TurnUpsideDown(image.rgb, row);
  return image;
}

PixelReader::~PixelReader() { Forget(); }

void PixelReader::Forget() {
  if (arrives_ != nullptr) glDeleteSync(std::exchange(arrives_, nullptr));
}

void PixelReader::Begin(const RenderTarget& picture, const PixelBox& part) {
  if (Busy()) return;
  pixels_ = static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.id());
  glBufferData(GL_PIXEL_PACK_BUFFER, BytesOf(pixels_), nullptr, GL_STREAM_READ);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(part.x, part.y, part.width, part.height, GL_RGB, GL_FLOAT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  arrives_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  CheckGl("PixelReader::Begin");
}

std::optional<std::vector<std::array<float, 3>>> PixelReader::Poll() {
  if (!Busy()) return std::nullopt;
  const GLenum state = glClientWaitSync(arrives_, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) return std::nullopt;
  glDeleteSync(std::exchange(arrives_, nullptr));
  std::vector<std::array<float, 3>> rgb(pixels_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.id());
  glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, BytesOf(pixels_), rgb.data());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  return rgb;
}

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
  picture_ = HdrImage(width, height);
}

void TiledPicture::Put(const Tile& tile, const HdrImage& painted) {
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
