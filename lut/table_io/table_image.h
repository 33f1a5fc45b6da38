// SPDX-License-Identifier: MIT
// This header provides OpenEXR images that hold tables: one part of scan lines, floats, ZIP, text
// attributes.
//
// Readers do not trust the file. A file that is damaged, truncated, of another format or that
// claims more data than it can hold is refused with an InputError that names the file, before
// memory is allocated.
#pragma once

#include <alpenglow/tables.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::lut {

using TextAttributes = std::map<std::string, std::string>;

enum class TexelTypes { kFloat, kFloatOrHalf };

/// Contents of an image. Values are interleaved: (row * width + column) * channels + channel.
struct TableImage {
  std::size_t width;
  std::size_t height;
  std::vector<std::string> channels;
  std::span<const float> values;
  TextAttributes attributes;
  TexelType type = TexelType::kFloat;  // type in the file; half: rounded to the nearest
};

/// Writes the file atomically (WriteFileAtomically). Throws OutputError naming the file.
void WriteTableImage(const std::filesystem::path& file, const TableImage& image);

/// An open image whose header is valid.
class TableImageReader {
 public:
  /// Throws InputError unless the header is intact and has one part of scan lines at the origin.
  explicit TableImageReader(const std::filesystem::path& file);
  ~TableImageReader();
  TableImageReader(const TableImageReader&) = delete;
  TableImageReader& operator=(const TableImageReader&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::size_t width() const;
  [[nodiscard]] std::size_t height() const;
  /// Returns whether the first channel is half.
  [[nodiscard]] bool IsHalf() const;
  [[nodiscard]] bool HasChannel(const std::string& name) const;
  /// Returns whether the text attribute exists.
  [[nodiscard]] bool Has(const std::string& name) const;
  /// Returns the text attribute; throws InputError if it is missing or of another type.
  [[nodiscard]] std::string Attribute(const std::string& name) const;
  /// Reads every value of these channels, interleaved in this order. Throws InputError if one is
  /// missing, of another type or subsampled, if there are others, and if the file is truncated.
  [[nodiscard]] std::vector<float> Values(const std::vector<std::string>& channels,
                                          TexelTypes types = TexelTypes::kFloat) const;

 private:
  struct State;
  std::filesystem::path file_;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::lut
