// SPDX-License-Identifier: MIT
#include "lut/picture/exr_header.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <string>

#include "atmosphere/text/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kSeveralParts = 0x1000;  // of the version

class HeaderReader {
 public:
  explicit HeaderReader(const std::filesystem::path& file)
      : file_(file), stream_(file, std::ios::binary), left_(std::filesystem::file_size(file)) {}

  /// Nothing is said of files that are no OpenEXR files.
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
    return bytes[0] | bytes[1] << 8U | bytes[2] << 16U | std::uint32_t{bytes[3]} << 24U;
  }

  /// Up to the next 0, which it takes too.
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
    static_cast<void>(Text());  // its type
    const std::uint32_t size = Number();
    Take(size, "attribute " + name);
    stream_.seekg(size, std::ios::cur);
  }

  const std::filesystem::path& file_;
  std::ifstream stream_;
  std::uint64_t left_;
};

}  // namespace

void RequireBoundedExrHeader(const std::filesystem::path& file) { HeaderReader(file).Check(); }

}  // namespace alpenglow::lut
