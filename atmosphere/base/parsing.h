// SPDX-License-Identifier: MIT
// Strict parsing: file extensions, numbers, short texts, embedded CSV tables, and TOML files.
//
// Numbers and letters do not depend on the locale of the host program, which may write "0,5" for
// 0.5. Short texts are read from left to right. TOML files are read strictly:
// unknown content is rejected, with file, line and key.
//
// Numbers that are NaN or infinite, values of another type, values out of range, duplicate and
// unknown keys are InputErrors of the form "scene.toml:7: camera.fov is 400; it must lie in ...".
//
// Names of the values of an enumeration: one table serves both directions, and the messages that
// list the names.
//
//   constexpr EnumNames kNames{{std::pair{ToneCurve::kAgx, "agx"}, {ToneCurve::kAces, "aces"}}};
//
// The compiler counts the entries, so that a table has no entry without a name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {

/// Converts the letters A to Z to lower case; other bytes remain.
[[nodiscard]] constexpr char LowerCase(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}
[[nodiscard]] std::string LowerCase(std::string_view text);
/// Converts the letters a to z to upper case; other bytes remain.
[[nodiscard]] constexpr char UpperCase(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}
[[nodiscard]] constexpr bool IsLetterOrDigit(char letter) {
  return (LowerCase(letter) >= 'a' && LowerCase(letter) <= 'z') || (letter >= '0' && letter <= '9');
}

/// Returns the text without blanks, tabs and line ends at its ends.
[[nodiscard]] std::string_view Trimmed(std::string_view text);

/// Returns the words between blanks, tabs and line ends.
[[nodiscard]] std::vector<std::string_view> WordsOf(std::string_view text);

/// Returns the number that the whole text is, with a decimal point and possibly a plus sign;
/// nullopt for another text and for numbers that a double cannot hold. NaN and infinity count as
/// numbers.
[[nodiscard]] std::optional<double> ParseNumber(std::string_view text);

/// Returns the whole number that the whole text is, possibly with a plus sign.
[[nodiscard]] std::optional<int> ParseWholeNumber(std::string_view text);

/// Returns whether a name ends in an extension such as ".gpx", ignoring case: cameras and recorders
/// also write ".GPX" and ".TIF".
[[nodiscard]] inline bool HasExtension(const std::filesystem::path& file,
                                       std::string_view extension) {
  const std::string own = file.extension().string();
  return std::equal(own.begin(), own.end(), extension.begin(), extension.end(),
                    [](char one, char other) { return LowerCase(one) == LowerCase(other); });
}

class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool AtEnd() const { return rest_.empty(); }

  /// Skips `expected` if it comes next, and returns whether it did.
  bool Accept(char expected) {
    if (rest_.empty() || rest_.front() != expected) return false;
    rest_.remove_prefix(1);
    return true;
  }

  /// Skips all following characters that are in `set`; returns them.
  std::string_view Run(std::string_view set) {
    const std::size_t length = std::min(rest_.find_first_not_of(set), rest_.size());
    const std::string_view run = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return run;
  }

  /// Skips a run of `fewest` to `most` decimal digits (at most 9) that is not followed by another
  /// digit, and returns its value; otherwise returns std::nullopt and skips nothing.
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

/// Returns the requested columns of an embedded table: lines that start with '#', a line of names,
/// then numbers. One list per column, in the order requested. Throws InternalError for a field that
/// is not a number.
/// @param file  as for EmbeddedText.
[[nodiscard]] std::vector<std::vector<double>> ReadColumns(std::string_view file,
                                                           const std::vector<int>& columns);

/// Returns one column of an embedded table as text.
[[nodiscard]] std::vector<std::string> ReadTextColumn(std::string_view file, int column);

/// Returns the content of a text file or of a pipe. Throws InputError if it cannot be read, is over
/// 16 MiB, or has the format of files that hold no text (FormatOf).
[[nodiscard]] std::string ReadTextFile(const std::filesystem::path& file);

/// Returns the folder to which names in a file are relative: its own; for a pipe the current one.
[[nodiscard]] std::filesystem::path FolderOf(const std::filesystem::path& file);

/// Returns the element of `known` with the smallest edit distance to `name`, if the distance is
/// small enough for a typing error: a third of the characters of the name, and one for short ones.
/// Otherwise it returns the first that begins with the name, or with which the name begins (three
/// characters at least), or std::nullopt. It never returns the name itself.
[[nodiscard]] std::optional<std::string> NearestName(std::string_view name,
                                                     const std::vector<std::string>& known);

/// A table of a TOML document. Copies share the document.
class TomlTable {
 public:
  /// Reads the whole document; messages contain `origin` in place of the file name.
  TomlTable(std::string_view text, const std::string& origin);

  /// Throws for every key except these, naming the nearest of them. Must be called before values
  /// are read.
  void AllowOnly(const std::vector<std::string>& keys) const;

  [[nodiscard]] bool Has(const std::string& key) const;
  /// Returns a number, integer or not, in [low, high].
  [[nodiscard]] std::optional<double> Number(const std::string& key, double low, double high) const;
  /// Returns a list of numbers in [low, high]; a single number is a list of one.
  [[nodiscard]] std::optional<std::vector<double>> Numbers(const std::string& key, double low,
                                                           double high) const;
  [[nodiscard]] std::optional<std::string> Text(const std::string& key) const;
  [[nodiscard]] std::optional<bool> Truth(const std::string& key) const;
  [[nodiscard]] std::optional<TomlTable> Table(const std::string& key) const;
  /// Returns the tables of [[key]]; empty if the key is absent.
  [[nodiscard]] std::vector<TomlTable> Tables(const std::string& key) const;

  /// Returns "camera.fov" for key fov in table camera.
  [[nodiscard]] std::string FullName(const std::string& key) const;
  /// Throws InputError "origin:line: <fault>" with the line of the key, or of the table if it has
  /// no such key.
  [[noreturn]] void Fail(const std::string& key, const std::string& fault) const;

 private:
  struct Level;
  explicit TomlTable(std::shared_ptr<const Level> level);
  std::shared_ptr<const Level> level_;
};

/// Throws an InputError about a name that is not in a table.
/// @param refusal  the message, where {0} is the name, {1} "a, b, c" and {2} "a, b or c".
[[noreturn]] void RefuseName(std::string_view refusal, std::string_view name,
                             std::span<const std::string> known);

template <typename Enum, std::size_t N>
class EnumNames {
 public:
  constexpr explicit EnumNames(const std::pair<Enum, const char*> (&names)[N]) {
    std::copy(std::begin(names), std::end(names), names_.begin());
  }

  /// Throws InternalError for a value without a name.
  [[nodiscard]] constexpr const char* Of(Enum value) const {
    for (const auto& [known, name] : names_) {
      if (known == value) return name;
    }
    throw InternalError("a value of an enumeration has no name");
  }
  [[nodiscard]] constexpr std::optional<Enum> Find(std::string_view name) const {
    for (const auto& [value, known] : names_) {
      if (name == known) return value;
    }
    return std::nullopt;
  }
  /// Returns the value with a name; throws InputError for another name.
  /// @param refusal  as for RefuseName.
  [[nodiscard]] Enum Named(std::string_view name, std::string_view refusal) const {
    if (const std::optional<Enum> found = Find(name)) return *found;
    RefuseName(refusal, name, All());
  }
  /// Returns the names in the order of the table.
  [[nodiscard]] std::vector<std::string> All() const {
    std::vector<std::string> names;
    for (const auto& entry : names_) names.emplace_back(entry.second);
    return names;
  }

 private:
  std::array<std::pair<Enum, const char*>, N> names_{};
};

}  // namespace alpenglow::atmosphere
