// SPDX-License-Identifier: MIT
// Content of text files and pipes.
#pragma once

#include <filesystem>
#include <string>

namespace alpenglow::atmosphere {

/// Returns the content of a text file or of a pipe. Throws InputError if it cannot be read, is over
/// 16 MiB, or has the format of files that hold no text (FormatOf).
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

/// Returns the folder to which names in a file are relative: its own; for a pipe the current one.
[[nodiscard]] std::filesystem::path FolderOf(const std::filesystem::path& file);

}  // namespace alpenglow::atmosphere
