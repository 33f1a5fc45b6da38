// SPDX-License-Identifier: MIT
// Strict parsing of short texts: letters, words, numbers and file extensions.
//
// Numbers and letters do not depend on the locale of the host program, which may write "0,5" for
// 0.5.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Reads a text from left to right.
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

}  // namespace alpenglow::atmosphere
