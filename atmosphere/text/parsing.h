// SPDX-License-Identifier: MIT
// The extension of a file's name, which says what is in the file.
//
// Reads a short text from left to right, the same in every locale.
//
// Tables of numbers that travel inside the library as CSV text.
//
// TOML files read strictly: what is not understood is refused, with file, line and key.
//
// Numbers that are NaN or infinite, values of another type, values out of range, duplicate and
// unknown keys are InputErrors of the form "scene.toml:7: camera.fov is 400; it must lie in ...".
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// True if a name ends in an extension such as ".gpx", in whatever case: cameras and recorders
/// write ".GPX" and ".TIF" too.
[[nodiscard]] inline bool HasExtension(const std::filesystem::path& file,
                                       std::string_view extension) {
  const auto lower = [](unsigned char letter) { return std::tolower(letter); };
  const std::string own = file.extension().string();
  return std::equal(
      own.begin(), own.end(), extension.begin(), extension.end(), [&](char one, char other) {
        return lower(static_cast<unsigned char>(one)) == lower(static_cast<unsigned char>(other));
      });
}

class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool AtEnd() const { return rest_.empty(); }

  /// Steps over `expected` if it comes next.
  bool Accept(char expected) {
    if (rest_.empty() || rest_.front() != expected) return false;
    rest_.remove_prefix(1);
    return true;
  }

  /// Steps over all characters that come next and are in `set`; returns them.
  std::string_view Run(std::string_view set) {
    const std::size_t length = std::min(rest_.find_first_not_of(set), rest_.size());
    const std::string_view run = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return run;
  }

  /// Steps over a run of `fewest` to `most` decimal digits (at most 9) that is not followed by
  /// another digit; returns its value, or nothing, and then steps nowhere.
  std::optional<int> Number(std::size_t fewest, std::size_t most) {
    TextCursor ahead = *this;
    const std::string_view digits = ahead.Run("0123456789");
    if (digits.size() < fewest || digits.size() > most) return std::nullopt;
    int value = 0;
    for (const char digit : digits) value = 10 * value + (digit - '0');
    *this = ahead;
    return value;
  }

 private:
  std::string_view rest_;
};

/// Chosen columns of an embedded table: lines of '#', a line of names, then numbers. One list a
/// column, in the order asked for. Throws InternalError for a field that is not a number.
/// @param file  as EmbeddedText takes it.
[[nodiscard]] std::vector<std::vector<double>> ReadColumns(std::string_view file,
                                                           const std::vector<int>& columns);

/// One column of such a table as text.
[[nodiscard]] std::vector<std::string> ReadTextColumn(std::string_view file, int column);

/// The content of a text file. Throws InputError when it cannot be read or is over 16 MiB.
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

/// The one of `known` with the smallest edit distance to `name`, when it is small enough to be a
/// slip of the hand; else nothing.
[[nodiscard]] std::optional<std::string> NearestName(std::string_view name,
                                                     const std::vector<std::string>& known);

/// A table of a TOML document. Copies share the document.
class TomlTable {
 public:
  /// The whole document; `origin` stands in messages where the file's name would.
  TomlTable(std::string_view text, const std::string& origin);

  /// Refuses every key but these, naming the nearest of them. To be called before values are read.
  void AllowOnly(const std::vector<std::string>& keys) const;

  [[nodiscard]] bool Has(const std::string& key) const;
  /// A number, integer or not, in [low, high].
  [[nodiscard]] std::optional<double> Number(const std::string& key, double low, double high) const;
  /// A list of numbers in [low, high]; a single number is a list of one.
  [[nodiscard]] std::optional<std::vector<double>> Numbers(const std::string& key, double low,
                                                           double high) const;
  [[nodiscard]] std::optional<std::string> Text(const std::string& key) const;
  [[nodiscard]] std::optional<bool> Truth(const std::string& key) const;
  [[nodiscard]] std::optional<TomlTable> Table(const std::string& key) const;
  /// The tables of [[key]]; none when the key is absent.
  [[nodiscard]] std::vector<TomlTable> Tables(const std::string& key) const;

  /// "camera.fov" of key fov in table camera.
  [[nodiscard]] std::string FullName(const std::string& key) const;
  /// Throws InputError "origin:line: <fault>", the line that of the key, or of the table when it
  /// has none of that name.
  [[noreturn]] void Fail(const std::string& key, const std::string& fault) const;

 private:
  struct Level;
  explicit TomlTable(std::shared_ptr<const Level> level);
  std::shared_ptr<const Level> level_;
};

}  // namespace alpenglow::atmosphere
