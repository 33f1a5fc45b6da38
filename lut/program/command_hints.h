// SPDX-License-Identifier: MIT
// Hints for words on a command line that the program does not know.
#pragma once

#include <string>
#include <vector>

namespace alpenglow::lut {

/// Describes the fault of a word that stands where a command or the name of a file may: it is
/// neither, but nearly a command, or one that other programs have as a command ("help"). Empty for
/// other words.
[[nodiscard]] std::string FaultOfCommand(const std::string& word,
                                         const std::vector<std::string>& commands);

/// Describes an option that the program does not have, "-o" or "--lattitude=3", and which
/// of the known ones (long names without dashes) are like it.
[[nodiscard]] std::string FaultOfUnknownOption(const std::string& option,
                                               const std::vector<std::string>& known);

}  // namespace alpenglow::lut
