// SPDX-License-Identifier: MIT
// This file reads and writes EXR through OpenEXR 3
// (https://openexr.com/en/latest/OpenEXRFileLayout.html).
#include "lut/image/exr.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <functional>
#include <mutex>
#include <string>
#include <system_error>

#include "atmosphere/base/error.h"
#include "lut/cli/output_file.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kSeveralParts = 0x1000;  // flag in the version

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, std::int64_t longest_side)
      : file_(file),
        longest_side_(longest_side),
        stream_(file, std::ios::binary),
        left_(std::filesystem::file_size(file)) {}

  /// Checks the headers. Files that are not OpenEXR files pass.
  void Check() {
    if (left_ < 8 || Number() != kMagic) return;
    const bool several = (Number() & kSeveralParts) != 0;
    for (std::string name = Text(); !name.empty(); name = Text()) {
      while (!name.empty()) {
        SkipAttribute(name);
        name = Text();
      }
      if (!several) return;
    }
  }

 private:
  [[noreturn]] void Fail(const std::string& fault) const {
    throw InputError(fmt::format("{}: is damaged: {}", file_.string(), fault));
  }

  void Take(std::uint64_t bytes, const std::string& what) {
    if (bytes > left_) {
      Fail(fmt::format("{} claims {} bytes, {} are left in the file", what, bytes, left_));
    }
    left_ -= bytes;
  }

  std::uint32_t Number() {
    Take(4, "a number");
    std::array<unsigned char, 4> bytes{};
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(stream_.get());
    return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8U |
           std::uint32_t{bytes[2]} << 16U | std::uint32_t{bytes[3]} << 24U;
  }

  /// Returns the text up to the next 0 byte and consumes that byte.
  std::string Text() {
    constexpr std::size_t kLongest = 255;
    std::string text;
    for (;;) {
      Take(1, "a name");
      const int next = stream_.get();
      if (next == 0) return text;
      if (next < 0 || text.size() == kLongest) Fail("a name in its header does not end");
      text += static_cast<char>(next);
    }
  }

  void SkipAttribute(const std::string& name) {
    static_cast<void>(Text());  // type of the attribute
    const std::uint32_t size = Number();
    if (name == "dataWindow" && size == 4 * sizeof(std::int32_t)) return CheckDataWindow();
    Take(size, "attribute " + name);
    stream_.seekg(size, std::ios::cur);
  }

  void CheckDataWindow() {
    std::array<std::int64_t, 4> window{};  // least x and y, largest x and y
    for (std::int64_t& side : window) side = static_cast<std::int32_t>(Number());
    const std::int64_t width = window[2] - window[0] + 1, height = window[3] - window[1] + 1;
    if (width > longest_side_ || height > longest_side_) {
      Fail(fmt::format("its data window has {} x {} pixels; a side may have up to {}", width,
                       height, longest_side_));
    }
  }

  const std::filesystem::path& file_;
  std::int64_t longest_side_;
  std::ifstream stream_;
  std::uint64_t left_;
};

/// A file stream that checks every write including the last one. OpenEXR's own stream closes in a
/// destructor, which cannot report that the disk is full.
class CheckedStream : public Imf::OStream {
 public:
  explicit CheckedStream(const fs::path& name)
      : Imf::OStream(name.c_str()), file_(name, std::ios::binary) {
    Check();
  }
  void write(const char* bytes, int count) override {
    file_.write(bytes, count);
    Check();
  }
  uint64_t tellp() override { return static_cast<uint64_t>(std::streamoff(file_.tellp())); }
  void seekp(uint64_t position) override {
    file_.seekp(static_cast<std::streamoff>(position));
    Check();
  }
  void Close() {
    file_.close();
    Check();
  }

 private:
  void Check() const {
    if (file_) return;
    throw OutputError("cannot be written: " + std::generic_category().message(errno));
  }

  std::ofstream file_;
};

Imf::Header HeaderOf(const HdrImage& image, const Metadata& metadata, Projection projection) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  constexpr int kLevel = 2;  // for floats, higher ones save 3 % of the bytes in half as long again
  header.zipCompressionLevel() = kLevel;
  Imf::addWhiteLuminance(header, 1.0F);
  if (projection == Projection::kLatitudeLongitude) Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  for (const auto& [name, value] : metadata) {
    if (header.find(name) != header.end())
      throw InputError(fmt::format("metadata {}: OpenEXR uses this name itself", name));
    header.insert(name, Imf::StringAttribute(value));
  }
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  for (const ImageLayer& layer : image.layers) {
    ALPENGLOW_ENSURE(layer.values.size(), ==, image.rgb.size());
    header.channels().insert(layer.name, Imf::Channel(Imf::FLOAT));
  }
  return header;
}

Imf::Slice SliceOf(const float* first, std::size_t stride, int width) {
  // FrameBuffer serves both reading and writing, so it needs a pointer to non-const data.
  auto* bytes = reinterpret_cast<char*>(const_cast<float*>(first));
  return {Imf::FLOAT, bytes, stride * sizeof(float),
          stride * sizeof(float) * static_cast<std::size_t>(width)};
}

Imf::FrameBuffer FrameBufferOf(const HdrImage& image) {
  Imf::FrameBuffer buffer;
  const float* rgb = image.rgb.front().data();
  buffer.insert("R", SliceOf(rgb, 3, image.width));
  buffer.insert("G", SliceOf(rgb + 1, 3, image.width));
  buffer.insert("B", SliceOf(rgb + 2, 3, image.width));
  for (const ImageLayer& layer : image.layers) {
    buffer.insert(layer.name, SliceOf(layer.values.data(), 1, image.width));
  }
  return buffer;
}

/// Lets OpenEXR compress blocks of lines in as many threads as the rest of the program may use,
/// unless the process has already chosen a number. OpenEXR has one number for the whole process:
/// the last of the objects that exist at a time restores it. The bytes of a file do not depend on
/// it.
class CompressionThreads {
 public:
  CompressionThreads() {
    using oneapi::tbb::global_control;
    const std::lock_guard lock(mutex_);
    if (users_++ > 0 || Imf::globalThreadCount() > 0) return;
    const auto threads =
        static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
    if (threads < 2) return;
    Imf::setGlobalThreadCount(threads);
    is_ours_ = true;
  }
  ~CompressionThreads() {
    const std::lock_guard lock(mutex_);
    if (--users_ > 0 || !is_ours_) return;
    Imf::setGlobalThreadCount(0);
    is_ours_ = false;
  }
  CompressionThreads(const CompressionThreads&) = delete;
  CompressionThreads& operator=(const CompressionThreads&) = delete;

 private:
  inline static std::mutex mutex_;
  inline static int users_ = 0;
  inline static bool is_ours_ = false;  // the number of threads is that of the first object
};

void WritePixels(const fs::path& name, const HdrImage& image, const Metadata& metadata,
                 Projection projection) {
  CheckedStream stream(name);
  {
    const CompressionThreads threads;
    Imf::OutputFile file(stream, HeaderOf(image, metadata, projection), Imf::globalThreadCount());
    file.setFrameBuffer(FrameBufferOf(image));
    file.writePixels(image.height);
  }
  stream.Close();
}

/// Calls `read` and converts every error of OpenEXR into an InputError that names the file.
template <typename Result>
Result Reading(const fs::path& file, const std::function<Result()>& read) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(fmt::format("{}: no such file", file.string()));
  }
  try {
    RequireBoundedExrHeader(file);
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: the picture does not fit in memory", file.string()));
  } catch (const std::exception& fault) {
    throw InputError(
        fmt::format("{}: not a readable EXR picture: {}", file.string(), fault.what()));
  }
}

/// Returns an empty image of the size in the header. Throws unless every channel covers every pixel
/// and the origin is (0, 0).
HdrImage EmptyImageFor(const fs::path& file, const Imf::Header& header) {
  const Imath::Box2i window = header.dataWindow();
  const auto width = static_cast<std::int64_t>(window.max.x) - window.min.x + 1;
  const auto height = static_cast<std::int64_t>(window.max.y) - window.min.y + 1;
  if (window.min.x != 0 || window.min.y != 0 || width > kLargestImageSide ||
      height > kLargestImageSide) {
    throw InputError(fmt::format(
        "{}: the data window is ({}, {}) to ({}, {}); it must begin at (0, 0) and have sides up to "
        "{}",
        file.string(), window.min.x, window.min.y, window.max.x, window.max.y, kLargestImageSide));
  }
  for (const char* name : {"R", "G", "B"}) {
    if (header.channels().findChannel(name) == nullptr) {
      throw InputError(fmt::format("{}: channel {} is missing", file.string(), name));
    }
  }
  return HdrImage(static_cast<int>(width), static_cast<int>(height));
}

void AddLayers(const fs::path& file, const Imf::ChannelList& channels, HdrImage& image) {
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::string name = channel.name();
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      throw InputError(fmt::format("{}: channel {} is subsampled", file.string(), name));
    }
    if (name == "R" || name == "G" || name == "B") continue;
    image.layers.push_back({name, std::vector<float>(image.rgb.size())});
  }
}

Metadata TextsOf(const Imf::Header& header) {
  Metadata metadata;
  for (auto at = header.begin(); at != header.end(); ++at) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute());
    if (text != nullptr) metadata[at.name()] = text->value();
  }
  return metadata;
}

}  // namespace

void RequireBoundedExrHeader(const std::filesystem::path& file, std::int64_t longest_side) {
  HeaderReader(file, longest_side).Check();
}

void WriteExr(const fs::path& file, const HdrImage& image, const Metadata& metadata,
              Projection projection) {
  if (const auto fault = FaultyValue(image)) {
    throw InternalError(fmt::format("{} is not written: {}", file.string(), *fault));
  }
  WriteFileAtomically(file, [&](const fs::path& name) {
    try {
      WritePixels(name, image, metadata, projection);
    } catch (const Iex::BaseExc& fault) {
      throw OutputError(fault.what());
    }
  });
}

HdrImage ReadExrPicture(const fs::path& file) {
  return Reading<HdrImage>(file, [&] {
    Imf::InputFile input(file.c_str());
    HdrImage image = EmptyImageFor(file, input.header());
    AddLayers(file, input.header().channels(), image);
    image.metadata = TextsOf(input.header());
    image.is_panorama =
        Imf::hasEnvmap(input.header()) && Imf::envmap(input.header()) == Imf::ENVMAP_LATLONG;
    input.setFrameBuffer(FrameBufferOf(image));
    input.readPixels(0, image.height - 1);
    return image;
  });
}

Metadata ReadExrMetadata(const fs::path& file) {
  return Reading<Metadata>(file, [&] { return TextsOf(Imf::InputFile(file.c_str()).header()); });
}

}  // namespace alpenglow::lut
