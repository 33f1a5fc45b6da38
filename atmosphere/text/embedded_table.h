// SPDX-License-Identifier: MIT
// Tables of numbers that travel inside the library as CSV text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// Chosen columns of an embedded table: lines of '#', a line of names, then numbers. One list a
/// column, in the order asked for. Throws InternalError for a field that is not a number.
/// @param file  as EmbeddedText takes it.
[[nodiscard]] std::vector<std::vector<double>> ReadColumns(std::string_view file,
                                                           const std::vector<int>& columns);

/// One column of such a table as text.
[[nodiscard]] std::vector<std::string> ReadTextColumn(std::string_view file, int column);

}  // namespace alpenglow::atmosphere
