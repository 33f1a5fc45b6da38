// SPDX-License-Identifier: MIT
#include "atmosphere/base/parsing.h"

#include <charconv>
#include <system_error>

namespace alpenglow::atmosphere {
namespace {

/// Returns the text without a plus sign, which std::from_chars does not accept.
std::string_view WithoutPlus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return has_plus ? text.substr(1) : text;
}

template <typename Number>
std::optional<Number> ParseAs(std::string_view text) {
  const std::string_view digits = WithoutPlus(text);
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) letter = LowerCase(letter);
  return lower;
}

std::string_view Trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::vector<std::string_view> WordsOf(std::string_view text) {
  std::vector<std::string_view> words;
  while (!(text = Trimmed(text)).empty()) {
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

std::optional<double> ParseNumber(std::string_view text) { return ParseAs<double>(text); }

std::optional<int> ParseWholeNumber(std::string_view text) { return ParseAs<int>(text); }

}  // namespace alpenglow::atmosphere
