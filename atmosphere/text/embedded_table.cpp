// SPDX-License-Identifier: MIT
#include "atmosphere/text/embedded_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "atmosphere/embedded_text.h"
#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

std::string_view TakeUntil(std::string_view& text, char end) {
  const std::size_t length = std::min(text.find(end), text.size());
  const std::string_view piece = text.substr(0, length);
  text.remove_prefix(std::min(length + 1, text.size()));
  return piece;
}

double ToNumber(std::string_view field, std::string_view file) {
  double value = 0.0;
  const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
  if (result.ec != std::errc() || result.ptr != field.data() + field.size()) {
    throw InternalError(fmt::format("{}: \"{}\" is not a number", file, field));
  }
  return value;
}

std::string_view Field(std::string_view line, int column) {
  std::string_view field = TakeUntil(line, ',');
  for (int i = 0; i < column; ++i) field = TakeUntil(line, ',');
  return field;
}

template <typename Visit>
void VisitRows(std::string_view file, const Visit& visit) {
  std::string_view text = EmbeddedText(file);
  bool names_seen = false;
  while (!text.empty()) {
    const std::string_view line = TakeUntil(text, '\n');
    if (line.empty() || line.front() == '#') continue;
    if (std::exchange(names_seen, true)) visit(line);
  }
}

}  // namespace

std::vector<std::vector<double>> ReadColumns(std::string_view file,
                                             const std::vector<int>& columns) {
  std::vector<std::vector<double>> values(columns.size());
  VisitRows(file, [&](std::string_view line) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      values[i].push_back(ToNumber(Field(line, columns[i]), file));
    }
  });
  return values;
}

std::vector<std::string> ReadTextColumn(std::string_view file, int column) {
  std::vector<std::string> values;
  VisitRows(file, [&](std::string_view line) { values.emplace_back(Field(line, column)); });
  return values;
}

}  // namespace alpenglow::atmosphere
