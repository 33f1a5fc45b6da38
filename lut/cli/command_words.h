// SPDX-License-Identifier: MIT
// Faults of single words of a command line.
#pragma once

#include <string>
#include <vector>

namespace alpenglow::lut {

/// Returns the name in "--latitude=3" or "--latitude", without dashes and value.
[[nodiscard]] std::string LongNameOf(const std::string& option);

/// Describes an option that a command does not have but other commands have.
/// @param commands  at least one, as "skyseries times".
[[nodiscard]] std::string FaultOfOptionOfOthers(const std::string& option,
                                                const std::vector<std::string>& commands);

}  // namespace alpenglow::lut
