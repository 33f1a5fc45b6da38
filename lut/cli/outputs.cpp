// SPDX-License-Identifier: MIT
#include "lut/cli/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <unordered_map>

#include "atmosphere/base/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

/// Finds the one name that all names of a file have in common. The file need not exist. A series
/// asks for a hundred thousand files of one folder, whose name is found once.
class RealNames {
 public:
  [[nodiscard]] std::string Of(const fs::path& file) {
    constexpr int kMostLinks = 40;  // limit of the kernel
    std::error_code error;
    fs::path real = file;
    for (int links = 0; links < kMostLinks && fs::is_symlink(real, error); ++links) {
      real = real.parent_path() / fs::read_symlink(real, error);
    }
    return (FolderOf(real.parent_path()) / real.filename()).string();
  }

 private:
  [[nodiscard]] const fs::path& FolderOf(const fs::path& folder) {
    const auto [known, is_new] = folders_.try_emplace(folder.string());
    if (is_new) {
      std::error_code error;
      const fs::path absolute = fs::absolute(folder.empty() ? fs::path(".") : folder, error);
      const fs::path canonical = fs::weakly_canonical(absolute / "", error);
      known->second = (error ? absolute : canonical).lexically_normal() / "";
    }
    return known->second;
  }

  std::unordered_map<std::string, fs::path> folders_;
};

}  // namespace

void RequireDifferent(const std::vector<NamedFile>& outputs) {
  RealNames real_names;
  std::unordered_map<std::string, const NamedFile*> known;
  for (const NamedFile& output : outputs) {
    const auto [other, is_new] = known.emplace(real_names.Of(output.file), &output);
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
