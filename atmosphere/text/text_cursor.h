// SPDX-License-Identifier: MIT
// Reads a short text from left to right, the same in every locale.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

namespace alpenglow::atmosphere {

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

}  // namespace alpenglow::atmosphere
