// SPDX-License-Identifier: MIT
#include "lut/cli/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <system_error>

#include "atmosphere/base/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

/// Returns the one name that all names of a file have in common. The file need not exist.
fs::path RealName(const fs::path& file) {
  constexpr int kMostLinks = 40;  // limit of the kernel
  std::error_code error;
  fs::path real = file;
  for (int links = 0; links < kMostLinks && fs::is_symlink(real, error); ++links) {
    real = real.parent_path() / fs::read_symlink(real, error);
  }
  const fs::path folder = fs::absolute(real, error).parent_path();
  const fs::path canonical = fs::weakly_canonical(folder, error);
  return (error ? folder.lexically_normal() : canonical) / real.filename();
}

}  // namespace

void RequireDifferent(const std::vector<NamedFile>& outputs) {
  std::map<fs::path, const NamedFile*> known;
  for (const NamedFile& output : outputs) {
    const auto [other, is_new] = known.emplace(RealName(output.file), &output);
    if (is_new) continue;
    throw OptionError(fmt::format("{} {} and {} {} are the same file; every output needs its own",
                                  other->second->name, other->second->file.string(), output.name,
                                  output.file.string()));
  }
}

void PrepareOutputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  for (const NamedFile& output : outputs) RequireNoInput(output, inputs);
  RequireDifferent(outputs);
  for (const NamedFile& output : outputs) {
    MakeFolder(output.file.parent_path());
    RequireWritable(output.file);
  }
}

}  // namespace alpenglow::lut
