// SPDX-License-Identifier: MIT
// Names of outputs that are refused before the work.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::lut {

/// A file and what the user calls it: "--cases", "terrain.colour".
struct NamedFile {
  std::string name;
  std::filesystem::path file;
};

/// Throws InputError when the output is one of the inputs, under whatever name: writing it would
/// destroy what it is made from.
void RequireNoInput(const NamedFile& output, const std::vector<NamedFile>& inputs);

/// What is wrong with the name of a file that is written with this extension (".exr"; empty: any),
/// for the command line; empty when nothing is. "-" is no file's name.
[[nodiscard]] std::string FaultOfFileName(std::string_view name, std::string_view extension);

/// The same for a folder of files: the name of a picture
/// or a table file is no folder's, "-" is no folder's.
[[nodiscard]] std::string FaultOfFolderName(std::string_view name);

}  // namespace alpenglow::lut
