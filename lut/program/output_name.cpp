// SPDX-License-Identifier: MIT
#include "lut/program/output_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "atmosphere/text/error.h"
#include "atmosphere/text/file_extension.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

// Formats that somebody may hope for; a folder may well be called "tables.v2".
constexpr std::array<std::string_view, 14> kExtensionsOfFiles{
    ".bin", ".csv",  ".dat", ".dds", ".exr", ".hdr",  ".jpg",
    ".ktx", ".ktx2", ".npy", ".png", ".tif", ".tiff", ".toml"};

}  // namespace

void RequireNoInput(const NamedFile& output, const std::vector<NamedFile>& inputs) {
  for (const NamedFile& input : inputs) {
    std::error_code none;  // a file that is not there is not the same
    if (!fs::equivalent(output.file, input.file, none)) continue;
    throw InputError(fmt::format("{} {} is the same file as {} {}; an input is not overwritten",
                                 output.name, output.file.string(), input.name,
                                 input.file.string()));
  }
}

std::string FaultOfFileName(std::string_view name, std::string_view extension) {
  if (name == "-") return "\"-\" is no name of a file; nothing is written to standard output";
  if (extension.empty() || HasExtension(name, extension)) return "";
  return fmt::format("\"{}\" must end in {}, which is what is written", name, extension);
}

std::string FaultOfFolderName(std::string_view name) {
  const bool file =
      std::any_of(kExtensionsOfFiles.begin(), kExtensionsOfFiles.end(),
                  [&](std::string_view extension) { return HasExtension(name, extension); });
  if (!file && name != "-") return "";
  return fmt::format("\"{}\" is no name of a folder, which files are written into", name);
}

}  // namespace alpenglow::lut
