// SPDX-License-Identifier: MIT
#include "renderer/series/frame_name.h"

#include <fmt/format.h>

#include "atmosphere/text/error.h"
#include "atmosphere/text/file_extension.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

[[noreturn]] void Refuse(const std::string& pattern, const std::string& fault) {
  throw InputError(fmt::format("--out is \"{}\"; {}", pattern, fault));
}

struct Conversion {
  int width = 0;
  std::size_t length = 0;  // characters after the per cent sign
};

Conversion ConversionAt(const std::string& pattern, std::size_t at) {
  constexpr int kWidest = 19;
  Conversion conversion;
  std::size_t i = at;
  for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9'; ++i) {
    conversion.width = 10 * conversion.width + (pattern[i] - '0');
    if (conversion.width > kWidest) Refuse(pattern, "the frame number is too wide");
  }
  if (i >= pattern.size() || pattern[i] != 'd') {
    Refuse(pattern, "the frame number is written %d or %04d, a per cent sign %%");
  }
  conversion.length = i + 1 - at;
  return conversion;
}

}  // namespace

FrameName::FrameName(const std::string& pattern) {
  if (!HasExtension(pattern, ".exr")) Refuse(pattern, "it must end in .exr");
  std::string* part = &before_;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') {
      *part += pattern[i];
    } else if (i + 1 < pattern.size() && pattern[i + 1] == '%') {
      *part += pattern[++i];
    } else {
      if (has_number_) Refuse(pattern, "it must have one frame number, not more");
      const Conversion conversion = ConversionAt(pattern, i + 1);
      has_number_ = true;
      width_ = conversion.width;
      part = &after_;
      i += conversion.length;
    }
  }
  if (has_number_ && after_.find('/') != std::string::npos) {
    Refuse(pattern, "the frame number must be in the name of the file, not of a folder");
  }
}

std::filesystem::path FrameName::Exr(int number) const {
  if (!has_number_) return before_;
  return before_ + fmt::format("{:0{}}", number, width_) + after_;
}

std::filesystem::path FrameName::Png(int number) const {
  return Exr(number).replace_extension(".png");
}

std::filesystem::path FrameName::Manifest() const {
  const std::filesystem::path first(has_number_ ? before_ : before_ + after_);
  std::string stem = has_number_ ? first.filename().string() : first.stem().string();
  while (!stem.empty() && (stem.back() == '.' || stem.back() == '_' || stem.back() == '-')) {
    stem.pop_back();
  }
  return first.parent_path() / (stem.empty() ? "manifest.csv" : stem + ".manifest.csv");
}

std::filesystem::path FrameName::JsonManifest() const {
  return Manifest().replace_extension(".json");
}

std::filesystem::path FrameName::Folder() const {
  return std::filesystem::path(before_).parent_path();
}

}  // namespace alpenglow::renderer
