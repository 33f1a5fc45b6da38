// SPDX-License-Identifier: MIT
#include "lut/table_io/table_image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>
#include <half.h>

#include <cstdint>
#include <optional>
#include <system_error>
#include <type_traits>

#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"
#include "lut/cli/output_file.h"
#include "lut/image/exr.h"
#include "lut/image/image.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

constexpr int kLongestSide = 1 << 20;

// Deflate expands one byte to at most 1032 bytes: a file cannot hold more than this many times its
// size.
constexpr std::uint64_t kLargestExpansion = 1032;

/// Returns the number of rows that the library decompresses together. It allocates memory for all
/// of them, even if the image has fewer.
std::uint64_t RowsOfAChunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    default:
      return 256;
  }
}

/// Runs `read` and converts every exception of the library, including out of memory, into an
/// InputError.
template <typename Read>
auto NamingDamage(const fs::path& file, const Read& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: is damaged: {}", file.string(), error.what()));
  }
}

/// Returns a frame buffer for the channels of interleaved values of the file's type.
template <typename Value>
Imf::FrameBuffer TableBufferOf(const Value* values, const std::vector<std::string>& channels,
                               std::size_t width) {
  constexpr Imf::PixelType kType = std::is_same_v<Value, half> ? Imf::HALF : Imf::FLOAT;
  const std::size_t stride = sizeof(Value) * channels.size();
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    // The library uses one pointer type for both reading and writing.
    char* base = reinterpret_cast<char*>(const_cast<Value*>(values + i));
    buffer.insert(channels[i], Imf::Slice(kType, base, stride, stride * width));
  }
  return buffer;
}

template <typename Value>
void WriteRows(const fs::path& name, const Imf::Header& header, const TableImage& image,
               const Value* values) {
  Imf::OutputFile output(name.c_str(), header);
  output.setFrameBuffer(TableBufferOf(values, image.channels, image.width));
  output.writePixels(static_cast<int>(image.height));
}

void RequireReadable(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(
        fmt::format("{}: {}", file.string(), error ? error.message() : "is not a regular file"));
  }
  if (!Imf::isOpenExrFile(file.c_str())) {
    throw InputError(fmt::format("{}: is not an OpenEXR file", file.string()));
  }
  RequireBoundedExrHeader(file, kLongestSide);
}

}  // namespace

void WriteTableImage(const fs::path& file, const TableImage& image) {
  ALPENGLOW_ENSURE(image.values.size(), ==, image.width * image.height * image.channels.size());
  RequireFinite(image.values, file.string());
  WriteFileAtomically(file, [&](const fs::path& name) {
    try {
      Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
      header.compression() = Imf::ZIP_COMPRESSION;
      for (const std::string& channel : image.channels) {
        header.channels().insert(
            channel, Imf::Channel(image.type == TexelType::kHalf ? Imf::HALF : Imf::FLOAT));
      }
      for (const auto& [key, text] : image.attributes) {
        header.insert(key, Imf::StringAttribute(text));
      }
      if (image.type == TexelType::kHalf) {
        const std::vector<half> halves(image.values.begin(), image.values.end());
        WriteRows(name, header, image, halves.data());
      } else {
        WriteRows(name, header, image, image.values.data());
      }
    } catch (const std::exception& error) {
      throw OutputError(fmt::format("{}: cannot be written: {}", name.string(), error.what()));
    }
  });
}

struct TableImageReader::State {
  explicit State(const fs::path& file) : parts(file.c_str()) {}

  [[nodiscard]] const Imf::Header& header() const { return parts.header(0); }

  Imf::MultiPartInputFile parts;
};

TableImageReader::TableImageReader(const fs::path& file) : file_(file) {
  RequireReadable(file);
  state_ = NamingDamage(file, [&] { return std::make_unique<State>(file); });
  const auto fail = [&](const std::string& fault) {
    throw InputError(fmt::format("{}: {}", file.string(), fault));
  };
  const int version = state_->parts.version();
  if (state_->parts.parts() != 1) {
    fail(fmt::format("has {} parts; a table has one", state_->parts.parts()));
  }
  if (Imf::isNonImage(version)) fail("holds deep data; a table has plain scan lines");
  if (Imf::isTiled(version) || state_->header().hasTileDescription() ||
      (state_->header().hasType() && state_->header().type() != Imf::SCANLINEIMAGE)) {
    fail("is tiled; a table has plain scan lines");
  }
  const Imath::Box2i& window = state_->header().dataWindow();
  if (window.min != Imath::V2i(0, 0) || window.max.x < 0 || window.max.y < 0) {
    fail(fmt::format("has a data window from ({}, {}) to ({}, {}); a table starts at (0, 0)",
                     window.min.x, window.min.y, window.max.x, window.max.y));
  }
}

TableImageReader::~TableImageReader() = default;

std::size_t TableImageReader::width() const {
  return static_cast<std::size_t>(state_->header().dataWindow().max.x) + 1;
}

std::size_t TableImageReader::height() const {
  return static_cast<std::size_t>(state_->header().dataWindow().max.y) + 1;
}

std::string TableImageReader::Attribute(const std::string& name) const {
  const auto* text = state_->header().findTypedAttribute<Imf::StringAttribute>(name);
  if (text == nullptr) {
    throw InputError(fmt::format("{}: has no text attribute {}: it is not a table of this program",
                                 file_.string(), name));
  }
  return text->value();
}

bool TableImageReader::IsHalf() const {
  const Imf::ChannelList& list = state_->header().channels();
  return list.begin() != list.end() && list.begin().channel().type == Imf::HALF;
}

bool TableImageReader::HasChannel(const std::string& name) const {
  return state_->header().channels().findChannel(name) != nullptr;
}

bool TableImageReader::Has(const std::string& name) const {
  return state_->header().findTypedAttribute<Imf::StringAttribute>(name) != nullptr;
}

std::vector<float> TableImageReader::Values(const std::vector<std::string>& channels,
                                            TexelTypes types) const {
  const auto fail = [&](const std::string& fault) {
    throw InputError(fmt::format("{}: {}", file_.string(), fault));
  };
  std::size_t present = 0;
  const Imf::ChannelList& list = state_->header().channels();
  for (auto channel = list.begin(); channel != list.end(); ++channel) ++present;
  for (const std::string& name : channels) {
    const Imf::Channel* channel = list.findChannel(name);
    if (channel == nullptr) fail(fmt::format("channel {} is missing", name));
    const bool half_too = types == TexelTypes::kFloatOrHalf;
    if (channel->type != Imf::FLOAT && !(half_too && channel->type == Imf::HALF)) {
      fail(fmt::format("channel {} is not {}32-bit float", name, half_too ? "half or " : ""));
    }
    if (channel->xSampling != 1 || channel->ySampling != 1) {
      fail(fmt::format("channel {} is subsampled", name));
    }
  }
  if (present != channels.size()) {
    fail(fmt::format("has {} channels; this table has {}", present, channels.size()));
  }
  const std::uint64_t row = std::uint64_t{width()} * channels.size();
  const std::uint64_t values = row * height();
  const std::uint64_t chunk = RowsOfAChunk(state_->header().compression());
  const std::uint64_t bytes = row * ((height() + chunk - 1) / chunk * chunk) * sizeof(float);
  if (bytes > kLargestTable_bytes || bytes / kLargestExpansion > fs::file_size(file_)) {
    fail(fmt::format("claims {} bytes of texels, more than it can hold", values * sizeof(float)));
  }
  return NamingDamage(file_, [&] {
    std::vector<float> result(values);
    Imf::InputPart part(state_->parts, 0);
    part.setFrameBuffer(TableBufferOf(result.data(), channels, width()));
    part.readPixels(0, static_cast<int>(height()) - 1);
    return result;
  });
}

}  // namespace alpenglow::lut
