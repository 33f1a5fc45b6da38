// SPDX-License-Identifier: MIT
#include "renderer/scene/blosc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "atmosphere/base/error.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kBloscHeader = 16;
constexpr unsigned kShuffled = 0x1, kStored = 0x2, kBitShuffled = 0x4, kNotSplit = 0x10;

[[noreturn]] void FailBlosc() { throw InputError("a Blosc buffer is damaged"); }

std::size_t ByteAt(std::string_view text, std::size_t at) {
  if (at >= text.size()) FailBlosc();
  return static_cast<unsigned char>(text[at]);
}

std::size_t WordAt(std::string_view text, std::size_t at) {
  std::size_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8U | ByteAt(text, at + i);
  return word;
}

std::string_view BloscPart(std::string_view text, std::size_t begin, std::size_t length) {
  if (begin > text.size() || length > text.size() - begin) FailBlosc();
  return text.substr(begin, length);
}

/// Reads the sequences of an LZ4 block.
class Lz4Reader {
 public:
  explicit Lz4Reader(std::string_view packed) : packed_(packed) {}

  [[nodiscard]] std::string Unpacked(std::size_t bytes) {
    while (at_ < packed_.size()) {
      const std::size_t token = Next();
      const std::size_t literals = Length(token >> 4U);
      out_ += BloscPart(packed_, at_, literals);
      at_ += literals;
      if (at_ >= packed_.size()) break;  // the last sequence has no match
      const std::size_t low = Next(), offset = low | Next() << 8U;
      Repeat(offset, Length(token & 15U) + 4, bytes);
    }
    if (out_.size() != bytes) FailBlosc();
    return std::move(out_);
  }

 private:
  std::size_t Next() { return ByteAt(packed_, at_++); }
  /// Returns a length of which the token has up to 15, and further bytes the rest.
  std::size_t Length(std::size_t length) {
    if (length < 15) return length;
    for (;;) {
      const std::size_t more = Next();
      length += more;
      if (more < 255) return length;
    }
  }
  void Repeat(std::size_t offset, std::size_t length, std::size_t most) {
    if (offset == 0 || offset > out_.size() || length > most - std::min(most, out_.size())) {
      FailBlosc();
    }
    // A match may overlap what it makes.
    for (std::size_t i = 0; i < length; ++i) out_.push_back(out_[out_.size() - offset]);
  }

  std::string_view packed_;
  std::size_t at_ = 0;
  std::string out_;
};

/// Returns the bytes in the order of values.
std::string Unshuffled(const std::string& bytes, std::size_t value_bytes) {
  const std::size_t values = bytes.size() / value_bytes;
  std::string ordered = bytes;  // bytes beyond the last whole value stay in place
  for (std::size_t i = 0; i < values; ++i) {
    for (std::size_t byte = 0; byte < value_bytes; ++byte) {
      ordered[i * value_bytes + byte] = bytes[byte * values + i];
    }
  }
  return ordered;
}

/// A buffer with its header.
struct BloscBuffer {
  explicit BloscBuffer(std::string_view packed)
      : text(packed),
        flags(static_cast<unsigned>(ByteAt(packed, 2))),
        value_bytes(ByteAt(packed, 3)),
        bytes(WordAt(packed, 4)),
        block_bytes(WordAt(packed, 8)) {}

  /// Returns the bytes of one block, `begin` bytes behind the first.
  [[nodiscard]] std::string Block(std::size_t begin) const {
    constexpr std::size_t kMostStreams = 16, kLeastStream = 128;
    const std::size_t length = std::min(block_bytes, bytes - begin);
    const bool is_split = (flags & kNotSplit) == 0 && length == block_bytes &&
                          value_bytes <= kMostStreams && block_bytes / value_bytes >= kLeastStream;
    const std::size_t streams = is_split ? value_bytes : 1;
    std::size_t at = WordAt(text, kBloscHeader + 4 * (begin / block_bytes));
    std::string block;
    for (std::size_t stream = 0; stream < streams; ++stream) {
      const std::size_t packed = WordAt(text, at);
      const std::string_view data = BloscPart(text, at + 4, packed);
      block += packed == length / streams ? std::string(data)
                                          : Lz4Reader(data).Unpacked(length / streams);
      at += 4 + packed;
    }
    return (flags & kShuffled) != 0 && value_bytes > 1 ? Unshuffled(block, value_bytes) : block;
  }

  std::string_view text;
  unsigned flags;
  std::size_t value_bytes, bytes, block_bytes;
};

}  // namespace

std::string UnpackedBlosc(std::string_view packed, std::size_t bytes) {
  const BloscBuffer buffer(packed);
  if (buffer.bytes != bytes) {
    throw InputError(
        fmt::format("a Blosc buffer of {} bytes; {} are expected", buffer.bytes, bytes));
  }
  if ((buffer.flags & kStored) != 0) return std::string(BloscPart(packed, kBloscHeader, bytes));
  if (buffer.flags >> 5U != 1U) throw InputError("a Blosc buffer of another codec than LZ4");
  if ((buffer.flags & kBitShuffled) != 0) throw InputError("a Blosc buffer with shuffled bits");
  if (buffer.block_bytes == 0 || buffer.value_bytes == 0) FailBlosc();
  std::string all;
  while (all.size() < bytes) all += buffer.Block(all.size());
  return all;
}

}  // namespace alpenglow::renderer
