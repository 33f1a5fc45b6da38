// SPDX-License-Identifier: MIT
// What a report's CSV says, read back.
#pragma once

#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace alpenglow {

inline std::vector<std::string> LinesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Cells of a line of CSV, without quotation marks.
inline std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

/// The values of a line by the names of the header.
inline std::map<std::string, std::string> ValuesByName(const std::vector<std::string>& header,
                                                       const std::vector<std::string>& cells) {
  std::map<std::string, std::string> value;
  for (std::size_t k = 0; k < header.size() && k < cells.size(); ++k) value[header[k]] = cells[k];
  return value;
}

}  // namespace alpenglow
