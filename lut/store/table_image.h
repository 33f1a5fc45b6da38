// SPDX-License-Identifier: MIT
// OpenEXR images that hold tables: one part of scan lines, floats, ZIP, text attributes.
//
// Reading trusts nothing: what is damaged, truncated, foreign or larger than its file can hold is
// refused with an InputError that names the file, before memory is taken.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::lut {

using TextAttributes = std::map<std::string, std::string>;

enum class TexelType { kFloat, kHalf };
enum class TexelTypes { kFloat, kFloatOrHalf };

/// What an image is made of. Values are interleaved: (row * width + column) * channels + channel.
struct TableImage {
  std::size_t width;
  std::size_t height;
  std::vector<std::string> channels;
  std::span<const float> values;
  TextAttributes attributes;
  TexelType type = TexelType::kFloat;  // in the file; half: rounded to the nearest
};

/// Writes whole or not at all (WriteFileAtomically). Throws OutputError naming the file.
void WriteTableImage(const std::filesystem::path& file, const TableImage& image);

/// An image that was opened and whose header is sound.
class TableImageReader {
 public:
  /// Throws InputError for anything but an intact header of one part of scan lines at the origin.
  explicit TableImageReader(const std::filesystem::path& file);
  ~TableImageReader();
  TableImageReader(const TableImageReader&) = delete;
  TableImageReader& operator=(const TableImageReader&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::size_t width() const;
  [[nodiscard]] std::size_t height() const;
  /// Whether the first channel is half.
  [[nodiscard]] bool IsHalf() const;
  [[nodiscard]] bool HasChannel(const std::string& name) const;
  /// Whether there is such a text attribute.
  [[nodiscard]] bool Has(const std::string& name) const;
  /// The text attribute; throws InputError when it is missing or of another type.
  [[nodiscard]] std::string Attribute(const std::string& name) const;
  /// Reads every value of these channels, interleaved in this order. Throws InputError when one is
  /// missing, of another type or subsampled, when there are others, and when the file is cut short.
  [[nodiscard]] std::vector<float> Values(const std::vector<std::string>& channels,
                                          TexelTypes types = TexelTypes::kFloat) const;

 private:
  struct State;
  std::filesystem::path file_;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::lut
