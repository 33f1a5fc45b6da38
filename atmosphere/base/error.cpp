// SPDX-License-Identifier: MIT
#include "atmosphere/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace alpenglow::atmosphere {
namespace {

/// Returns the bytes of the character of UTF-8 with which the text begins; 0 if it begins with
/// another byte, a longer form of a shorter character, a surrogate or a code beyond U+10FFFF.
std::size_t BytesOfCharacter(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[i])) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t bytes = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const bool is_longer_form =
      (first == 0xE0U && byte(1) < 0xA0U) || (first == 0xF0U && byte(1) < 0x90U);
  const bool is_no_character =
      (first == 0xEDU && byte(1) > 0x9FU) || (first == 0xF4U && byte(1) > 0x8FU);
  return is_longer_form || is_no_character ? 0 : bytes;
}

/// Returns whether a character is a control character: C0, DEL or C1.
bool IsControl(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < 0x20U || first == 0x7FU;
  return first == 0xC2U && static_cast<unsigned char>(character[1]) < 0xA0U;
}

}  // namespace

std::string Printable(std::string_view text, std::string_view kept) {
  std::string printable;
  while (!text.empty()) {
    const std::size_t bytes = BytesOfCharacter(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
    text.remove_prefix(character.size());
    if (kept.find(character) != std::string_view::npos || (bytes > 0 && !IsControl(character))) {
      printable += character;
      continue;
    }
    for (const char byte : character)
      printable +=
          fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(byte)));
  }
  return printable;
}

InputError::InputError(const std::string& message) : std::runtime_error(Printable(message)) {}
OutputError::OutputError(const std::string& message) : std::runtime_error(Printable(message)) {}

void RefuseFile(const std::filesystem::path& file, std::string_view fault) {
  throw InputError(fmt::format("{}: {}", file.string(), fault));
}

std::string LastSystemError() { return std::generic_category().message(errno); }

double RequireInRange(double value, double low, double high, std::string_view name) {
  if (!(value >= low && value <= high)) {  // written so that NaN fails
    throw InputError(fmt::format("{} is {}; it must lie in [{}, {}]", name, value, low, high));
  }
  return value;
}

std::string EnsuredText(double value) { return fmt::format("{}", value); }
std::string EnsuredText(long long value) { return fmt::format("{}", value); }
std::string EnsuredText(unsigned long long value) { return fmt::format("{}", value); }

void FailEnsured(const char* file, int line, const char* claim, const std::string& left,
                 const std::string& right) {
  throw InternalError(
      fmt::format("{}:{}: expected {}, got {} and {}", file, line, claim, left, right));
}

}  // namespace alpenglow::atmosphere
