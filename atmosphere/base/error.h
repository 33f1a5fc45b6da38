// SPDX-License-Identifier: MIT
// Exceptions for failures caused by the user (InputError), the machine (OutputError, DisplayError)
// or the program (InternalError). No fault is repaired silently, and every check stays in release
// builds. Those that the library can throw are defined in its public header errors.h.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include <alpenglow/errors.h>

namespace alpenglow::atmosphere {

/// Returns the text for a terminal or a log. Control characters, and bytes that are not UTF-8, are
/// written as "\\x1b", so that no text of a file can move the cursor or end a message. The
/// characters of `kept` remain.
[[nodiscard]] std::string Printable(std::string_view text, std::string_view kept = "");

/// An option needs a capability that this machine lacks; the message names the option. Exit status
/// 2.
class OptionError : public InputError {
 public:
  using InputError::InputError;
};

/// There is no display, or its OpenGL version is too old. Exit status 5.
class DisplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws the InputError "FILE: fault".
[[noreturn]] void RefuseFile(const std::filesystem::path& file, std::string_view fault);

/// Returns the operating system's message for the call that has just failed (errno).
[[nodiscard]] std::string LastSystemError();

/// Returns `value`, or throws InputError naming `name` if it is not in [low, high]; NaN is never in
/// the range.
double RequireInRange(double value, double low, double high, std::string_view name);

/// Formats a number for ALPENGLOW_ENSURE: in the fewest digits that give the same value back.
[[nodiscard]] std::string EnsuredText(double value);
[[nodiscard]] std::string EnsuredText(long long value);
[[nodiscard]] std::string EnsuredText(unsigned long long value);
template <typename Value>
[[nodiscard]] std::string EnsuredText(Value value) {
  static_assert(std::is_arithmetic_v<Value>);
  if constexpr (std::is_floating_point_v<Value>)
    return EnsuredText(static_cast<double>(value));
  else if constexpr (std::is_signed_v<Value>)
    return EnsuredText(static_cast<long long>(value));
  else
    return EnsuredText(static_cast<unsigned long long>(value));
}

/// Throws the InternalError of ALPENGLOW_ENSURE. `claim` is "left op right".
[[noreturn]] void FailEnsured(const char* file, int line, const char* claim,
                              const std::string& left, const std::string& right);

}  // namespace alpenglow::atmosphere

/// ALPENGLOW_ENSURE(row.size(), ==, width): throws InternalError with both values if the claim does
/// not hold.
#define ALPENGLOW_ENSURE(left, op, right)                                                       \
  do {                                                                                          \
    const auto& ensure_left = (left);                                                           \
    const auto& ensure_right = (right);                                                         \
    if (!(ensure_left op ensure_right)) {                                                       \
      ::alpenglow::atmosphere::FailEnsured(__FILE__, __LINE__, #left " " #op " " #right,        \
                                           ::alpenglow::atmosphere::EnsuredText(ensure_left),   \
                                           ::alpenglow::atmosphere::EnsuredText(ensure_right)); \
    }                                                                                           \
  } while (false)
