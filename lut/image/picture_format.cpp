// SPDX-License-Identifier: MIT
#include "lut/image/picture_format.h"

#include <fmt/format.h>

#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/image/exr.h"
#include "lut/image/png.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr PictureFormat kFormats[] = {
    {.extension = ".png",
     .name = "PNG",
     .write_light = nullptr,
     .write_colours = WritePng,
     .read_metadata = ReadPngMetadata},
    {.extension = ".exr",
     .name = "EXR",
     .write_light = WriteExr,
     .write_colours = nullptr,
     .read_metadata = ReadExrMetadata},
};

/// Returns the texts as "a, b or c".
std::string ListOf(const std::vector<std::string>& texts) {
  std::string list = texts.front();
  for (std::size_t i = 1; i < texts.size(); ++i)
    list += (i + 1 == texts.size() ? " or " : ", ") + texts[i];
  return list;
}

}  // namespace

std::span<const PictureFormat> PictureFormats() { return kFormats; }

const PictureFormat& FormatOfPicture(const std::filesystem::path& file) {
  for (const PictureFormat& format : kFormats) {
    if (HasExtension(file, format.extension)) return format;
  }
  std::vector<std::string> extensions;
  for (const PictureFormat& format : kFormats) extensions.emplace_back(format.extension);
  throw OptionError(fmt::format("\"{}\" is no picture's name; it must end in {}", file.string(),
                                ListOf(extensions)));
}

std::string NamesOfPictureFormats() {
  std::vector<std::string> names;
  for (const PictureFormat& format : kFormats) names.emplace_back(format.name);
  return ListOf(names);
}

std::string NamesOfDevelopedFormats() {
  std::vector<std::string> names;
  for (const PictureFormat& format : kFormats) {
    if (!format.StoresLight()) names.emplace_back(format.name);
  }
  return ListOf(names);
}

}  // namespace alpenglow::lut
