// SPDX-License-Identifier: MIT
// What programs say. Words that nobody takes (a terminal that is gone, a full disk, a closed pipe)
// are lost; the work that they speak of never is, so nothing here throws while it is done.
#pragma once

#include <string_view>

namespace alpenglow::lut {

/// Writes to standard error, as it stands; a line ends with its own line end.
void Say(std::string_view text) noexcept;

/// Writes a result to standard output. What is not taken is remembered until FlushStandardOutput.
void Print(std::string_view text) noexcept;

/// Brings to the system what Print and std::cout still hold. Throws OutputError when standard
/// output has not taken everything.
void FlushStandardOutput();

/// Puts something unwritable in place of each of the descriptors 0, 1 and 2 that is closed: the
/// next file that is opened would get its number, and messages would go into that file.
void OccupyStandardDescriptors() noexcept;

}  // namespace alpenglow::lut
