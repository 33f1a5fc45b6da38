// SPDX-License-Identifier: MIT
#include "atmosphere/base/text_file.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <optional>
#include <system_error>

#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"

namespace alpenglow::atmosphere {

namespace fs = std::filesystem;

std::string ReadTextFile(const fs::path& file) {
  constexpr std::size_t kMostBytes = 16U << 20U;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (error) RefuseFile(file, fmt::format("cannot be read: {}", error.message()));
  if (status.type() == fs::file_type::directory) RefuseFile(file, "is a folder");
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  for (std::array<char, 1U << 16U> part; stream && text.size() <= kMostBytes;) {
    stream.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream && !stream.eof()) RefuseFile(file, "cannot be read");
  if (text.size() > kMostBytes)
    RefuseFile(file, fmt::format("has more than {} bytes, the most of a text file", kMostBytes));
  const std::optional<FileFormat> format = FormatOf(text, text.size());
  if (format && !format->is_text) RefuseFormat(file, *format, "text is read");
  return text;
}

fs::path FolderOf(const fs::path& file) {
  std::error_code ignored;
  const fs::file_type type = fs::status(file, ignored).type();
  const bool is_pipe = type == fs::file_type::fifo || type == fs::file_type::character;
  return is_pipe ? fs::path() : file.parent_path();
}

}  // namespace alpenglow::atmosphere
