// SPDX-License-Identifier: MIT
#include "renderer/camera/pixel_samples.h"

#include <bit>

#include "atmosphere/text/error.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

/// The finaliser of MurmurHash3 (Appleby): every bit of the result depends on every bit.
std::uint32_t Mixed(std::uint32_t h) {
  h = (h ^ (h >> 16U)) * 0x85EBCA6BU;
  h = (h ^ (h >> 13U)) * 0xC2B2AE35U;
  return h ^ (h >> 16U);
}

std::uint32_t Mirrored(std::uint32_t bits) {
  bits = ((bits & 0x55555555U) << 1U) | ((bits >> 1U) & 0x55555555U);
  bits = ((bits & 0x33333333U) << 2U) | ((bits >> 2U) & 0x33333333U);
  bits = ((bits & 0x0F0F0F0FU) << 4U) | ((bits >> 4U) & 0x0F0F0F0FU);
  bits = ((bits & 0x00FF00FFU) << 8U) | ((bits >> 8U) & 0x00FF00FFU);
  return (bits << 16U) | (bits >> 16U);
}

/// Each bit is changed as the bits below it say. The factors, all even so that nothing goes from
/// high bits to low ones, are those of Laine and Karras (2011), section 3.1.
std::uint32_t ScrambledUpwards(std::uint32_t bits, std::uint32_t seed) {
  bits += seed;
  for (const std::uint32_t factor : {0x6C50B47CU, 0xB82F1E52U, 0xC7AFE638U, 0x8D22F6E6U}) {
    bits ^= bits * factor;
  }
  return bits;
}

/// Nested uniform scrambling: each bit is changed as the bits above it say.
std::uint32_t Scrambled(std::uint32_t bits, std::uint32_t seed) {
  return Mirrored(ScrambledUpwards(Mirrored(bits), seed));
}

/// Dimension 1 of Sobol's sequence, mirrored (dimension 0, mirrored, is the index itself). Its
/// direction numbers are the rows of Pascal's triangle modulo 2, in which C(j, i) is odd where the
/// bits of i are among those of j (Lucas): bit i is the sum of the bits j of the index that contain
/// i, one bit of the five of i and j at a time.
std::uint32_t MirroredSobolSecond(std::uint32_t index) {
  index ^= (index >> 1U) & 0x55555555U;
  index ^= (index >> 2U) & 0x33333333U;
  index ^= (index >> 4U) & 0x0F0F0F0FU;
  index ^= (index >> 8U) & 0x00FF00FFU;
  return index ^ (index >> 16U);
}

/// Bits of x on even places: half of Morton's code.
std::uint32_t SpreadBits(std::uint32_t x) {
  x = (x | (x << 4U)) & 0x0F0FU;
  x = (x | (x << 2U)) & 0x3333U;
  return (x | (x << 1U)) & 0x5555U;
}

double InUnit(std::uint32_t bits) { return static_cast<double>(bits) / 4294967296.0; }

}  // namespace

PixelSamples::PixelSamples(int x, int y, int samples_per_pixel) {
  ALPENGLOW_ENSURE(samples_per_pixel, <=, kMostSamples);
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  constexpr auto kSide = static_cast<std::uint32_t>(kTile);
  tile_ = Mixed(Mixed(column / kSide) + 0x9E3779B9U * (row / kSide) + 1U);
  const std::uint32_t place = SpreadBits(column % kSide) | (SpreadBits(row % kSide) << 1U);
  first_ = place * std::bit_ceil(static_cast<std::uint32_t>(samples_per_pixel));
}

std::array<double, 2> PixelSamples::Point(int sample, SampleOf decision) const {
  const std::uint32_t seed = Mixed(tile_ + 0x85EBCA77U * static_cast<std::uint32_t>(decision));
  const std::uint32_t index = Scrambled(first_ + static_cast<std::uint32_t>(sample), seed);
  return {InUnit(Mirrored(ScrambledUpwards(index, Mixed(seed + 1U)))),
          InUnit(Mirrored(ScrambledUpwards(MirroredSobolSecond(index), Mixed(seed + 2U))))};
}

}  // namespace alpenglow::renderer
