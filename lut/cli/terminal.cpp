// SPDX-License-Identifier: MIT
#include "lut/cli/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "atmosphere/base/parsing.h"
#include "lut/cli/messages.h"

namespace alpenglow::lut {

void PrintNow(std::string_view text) {
  Print(text);
  FlushStandardOutput();
}

std::string DirectionText(double degrees, int decimals) {
  constexpr double kCircle = 360.0;
  const double turned = degrees - kCircle * std::floor(degrees / kCircle);
  const double unit = std::pow(10.0, -decimals);
  return fmt::format("{:.{}f}", turned < kCircle - 0.5 * unit ? turned : 0.0, decimals);
}

int ColumnsOf(int descriptor, int otherwise) {
  winsize size = {};
  if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* const given = std::getenv("COLUMNS");
  const std::optional<double> columns = atmosphere::ParseNumber(given == nullptr ? "" : given);
  return columns && *columns >= 1.0 && *columns < 10000.0 ? static_cast<int>(*columns) : otherwise;
}

namespace {

/// Returns where the further lines of a broken line begin.
std::size_t HangingIndent(std::string_view line, std::size_t columns) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", begin);
  const std::size_t second =
      gap == std::string_view::npos ? std::string_view::npos : line.find_first_not_of(' ', gap);
  return second != std::string_view::npos && second <= columns / 2
             ? second
             : std::min(begin + 2, columns / 2);
}

/// Returns where a line is broken: before a space within the room, else after a comma there, else
/// before the first space after it.
std::size_t EndOfPart(std::string_view line, std::size_t kept, std::size_t room) {
  const std::size_t space = line.rfind(' ', room);
  if (space != std::string_view::npos && space >= kept) return space;
  const std::size_t comma = room > 0 ? line.rfind(',', room - 1) : std::string_view::npos;
  if (comma != std::string_view::npos && comma > kept) return comma + 1;
  return std::min(line.find(' ', std::max(room, kept)), line.size());
}

void AppendWrapped(std::string_view line, std::size_t columns, std::string_view program,
                   std::string& text) {
  const std::size_t indent = HangingIndent(line, columns);
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const bool is_command = !program.empty() && line.substr(begin).starts_with(program);
  const std::size_t most = columns - (is_command ? 2 : 0);
  std::string current;
  std::size_t kept = begin;  // spaces up to here belong to the line
  while (current.size() + line.size() > columns) {
    const std::size_t room = most > current.size() ? most - current.size() : 0;
    const std::size_t cut = EndOfPart(line, kept, room);
    if (cut >= line.size()) break;
    text += current + std::string(line.substr(0, line.find_last_not_of(' ', cut - 1) + 1)) +
            (is_command ? " \\\n" : "\n");
    line.remove_prefix(std::min(line.find_first_not_of(' ', cut), line.size()));
    current.assign(indent, ' ');
    kept = 1;
  }
  text += current + std::string(line) + "\n";
}

}  // namespace

std::string Wrapped(std::string_view text, std::size_t columns, std::string_view program) {
  std::string wrapped;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.size() <= columns) {
      wrapped += std::string(line) + "\n";
    } else {
      AppendWrapped(line, columns, program, wrapped);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return wrapped;
}

}  // namespace alpenglow::lut
