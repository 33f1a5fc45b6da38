// SPDX-License-Identifier: MIT
/// @file
/// Exceptions of the library. No fault is repaired silently.
#pragma once

#include <stdexcept>
#include <string>

#include <alpenglow/export.h>

namespace alpenglow::atmosphere {

/// The input is wrong: a value, a name or a file. The message is one line with file, line or key,
/// value and allowed range. It is UTF-8 text without control characters: such bytes of the input
/// are written as "\x1b". Programs exit with status 3.
class ALPENGLOW_EXPORT InputError : public std::runtime_error {
 public:
  /// Makes the exception from one line of text; control characters of the text are escaped.
  explicit InputError(const std::string& message);
};

/// An output could not be written; the message, which is text like that of InputError, names the
/// file. Programs exit with status 4.
class ALPENGLOW_EXPORT OutputError : public std::runtime_error {
 public:
  /// Makes the exception from one line of text; control characters of the text are escaped.
  explicit OutputError(const std::string& message);
};

/// A fault of the library itself; please report it. Programs exit with status 70.
class ALPENGLOW_EXPORT InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace alpenglow::atmosphere

/// Light in the atmospheres of planets: sky, aerial perspective, tables and pictures.
///
/// Any function may throw InternalError and std::bad_alloc. The other exceptions are part of the
/// description of each function.
namespace ALPENGLOW_EXPORT alpenglow {

using atmosphere::InputError;
using atmosphere::InternalError;
using atmosphere::OutputError;

}  // namespace alpenglow
