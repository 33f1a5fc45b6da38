// SPDX-License-Identifier: MIT
// Text for the people and programs that read standard output: lines as soon as they are known, help
// in the width of the terminal, and directions in degrees.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <alpenglow/errors.h>

namespace alpenglow::lut {

/// The reader of standard output has left, as "head" does. It wants no message.
class ReaderLeft : public OutputError {
 public:
  using OutputError::OutputError;
};

/// Writes a part of a result to standard output at once, as soon as it is known. Throws like
/// FlushStandardOutput: the rest of the result need not be computed.
void PrintNow(std::string_view text);

/// Returns a direction, an azimuth or a heading in degrees, in [0, 360) after rounding: 359.9998 is
/// "0.000" with three decimals.
[[nodiscard]] std::string DirectionText(double degrees, int decimals);

/// Returns the number of columns of the terminal of a descriptor (STDOUT_FILENO, STDERR_FILENO);
/// elsewhere the environment's COLUMNS, or `otherwise`.
[[nodiscard]] int ColumnsOf(int descriptor, int otherwise);

/// Returns the text with lines of at most `columns` bytes, broken at spaces; longer words stay
/// whole. A broken line goes on below the second column of its text (two or more spaces before it),
/// or else two spaces farther in. Commands, which begin with `program`, are broken by backslashes.
[[nodiscard]] std::string Wrapped(std::string_view text, std::size_t columns,
                                  std::string_view program);

}  // namespace alpenglow::lut
