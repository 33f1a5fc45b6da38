// SPDX-License-Identifier: MIT
#include "renderer/elevation/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "atmosphere/base/error.h"
#include "renderer/elevation/polygon_triangles.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

using Words = std::vector<std::string_view>;

constexpr double kFarthest_m = 1e7;
constexpr std::string_view kBlanks = " \t\v\f\x1a";  // the last one ends DOS files

/// Keywords that do not describe surfaces. Statements of the first list end with free text, which
/// may end in a backslash.
constexpr std::string_view kWithText[] = {"o", "g", "usemtl", "mtllib", "usemap", "maplib"};
constexpr std::string_view kWithoutSurface[] = {
    "vt", "vp", "l", "p", "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj"};

template <std::size_t count>
bool IsOneOf(const std::string_view (&keywords)[count], std::string_view word) {
  return std::find(std::begin(keywords), std::end(keywords), word) != std::end(keywords);
}

std::string_view WithoutSign(std::string_view word) {
  const bool has_plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
  return has_plus ? word.substr(1) : word;
}

/// Returns the value of a number; 0 if it underflows.
std::optional<double> NumberOf(std::string_view word) {
  const std::string_view digits = WithoutSign(word);
  const char* end = digits.data() + digits.size();
  double value = 0.0;
  const auto [stop, fault] = std::from_chars(digits.data(), end, value);
  if (stop != end || fault == std::errc::invalid_argument) return std::nullopt;
  if (fault == std::errc()) return value;
  const bool is_small = digits.find("e-") != digits.npos || digits.find("E-") != digits.npos;
  return is_small ? std::optional(0.0) : std::nullopt;
}

std::optional<long long> IntegerOf(std::string_view word) {
  const std::string_view digits = WithoutSign(word);
  const char* end = digits.data() + digits.size();
  long long value = 0;
  const auto [stop, fault] = std::from_chars(digits.data(), end, value);
  if (stop != end || fault != std::errc()) return std::nullopt;
  return value;
}

Words WordsOf(std::string_view line) {
  Words words;
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != line.npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name) : rest_(text), name_(name) {
    if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);
    const std::string_view mark = rest_.substr(0, 2);
    if (mark == "\xff\xfe" || mark == "\xfe\xff")
      throw InputError(name + ": is UTF-16 text; it must be ASCII or UTF-8");
  }

  ObjText Parse() {
    while (!rest_.empty()) {
      line_ = lines_taken_ + 1;
      ReadStatement(NextStatement());
    }
    CheckIndices();
    return std::move(read_);
  }

 private:
  std::string_view TakeLine() {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    const bool is_pair = rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(std::min(end + (is_pair ? 2 : 1), rest_.size()));
    ++lines_taken_;
    return line.substr(0, line.find('#'));
  }

  /// Returns the words of a line and of its continuation lines.
  Words NextStatement() {
    Words words = WordsOf(TakeLine());
    if (!words.empty() && IsOneOf(kWithText, words[0])) return words;
    while (!words.empty() && words.back().back() == '\\') {
      words.back().remove_suffix(1);
      if (words.back().empty()) words.pop_back();
      if (rest_.empty()) break;
      const Words more = WordsOf(TakeLine());
      words.insert(words.end(), more.begin(), more.end());
      if (more.empty()) break;
    }
    return words;
  }

  void ReadStatement(const Words& words) {
    if (words.empty()) return;
    const std::string_view keyword = words[0];
    if (keyword == "v") return ReadPosition(words);
    if (keyword == "vn") return ReadNormal(words);
    if (keyword == "f" || keyword == "fo") return ReadFace(words);
    if (keyword == "s") return ReadSmoothing(words);
    if (IsOneOf(kWithText, keyword) || IsOneOf(kWithoutSurface, keyword)) return;
    if (read_.other_statements++ > 0) return;
    read_.first_other_line = line_;
    read_.first_other = keyword;
  }

  /// Reads a position. A weight or a colour may follow the coordinates.
  void ReadPosition(const Words& words) {
    if (words.size() < 4) Refuse("a vertex of fewer than 3 coordinates");
    std::array<float, 3> position{};
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::optional<double> value = NumberOf(words[i]);
      if (!value || (i <= 3 && !(std::abs(*value) <= kFarthest_m))) {
        Refuse(fmt::format("coordinate '{}'; it must be a number in [{}, {}]", words[i],
                           -kFarthest_m, kFarthest_m));
      }
      if (i <= 3) position[i - 1] = static_cast<float>(*value);
    }
    read_.positions.push_back(position);
  }

  void ReadNormal(const Words& words) {
    if (words.size() < 4) Refuse("a normal of fewer than 3 coordinates");
    std::array<double, 3> normal{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<double> value = NumberOf(words[i + 1]);
      if (!value) Refuse(fmt::format("coordinate '{}'; it must be a number", words[i + 1]));
      normal[i] = *value;
    }
    read_.normals.push_back(normal);
  }

  void ReadSmoothing(const Words& words) {
    const std::string_view group = words.size() == 2 ? words[1] : std::string_view();
    const std::optional<long long> number = group == "off"  ? 0
                                            : group == "on" ? 1
                                                            : IntegerOf(group);
    if (!number || *number < 0 || *number >= ObjText::kNone)
      Refuse(fmt::format("smoothing group '{}'; it must be off, on or a number from 0", group));
    smoothing_ = static_cast<std::uint32_t>(*number);
  }

  void ReadFace(const Words& words) {
    if (words.size() < 4) Refuse("a face of fewer than 3 corners");
    const std::size_t count = words.size() - 1;
    if (count > kMostPolygonCorners)
      Refuse(fmt::format("a face of {} corners; at most {} are read", count, kMostPolygonCorners));
    const std::size_t first = read_.corners.size();
    for (std::size_t i = 1; i < words.size(); ++i) read_.corners.push_back(CornerOf(words[i]));
    read_.faces.push_back({first, static_cast<std::uint32_t>(count), smoothing_, line_});
  }

  /// Parses v, v/vt, v//vn or v/vt/vn; trailing empty numbers may be omitted.
  ObjText::Corner CornerOf(std::string_view word) {
    std::array<std::string_view, 3> parts;
    std::size_t begin = 0;
    for (std::size_t k = 0; begin <= word.size(); ++k) {
      if (k == parts.size()) RefuseCorner(word);
      const std::size_t end = std::min(word.find('/', begin), word.size());
      parts[k] = word.substr(begin, end - begin);
      begin = end + 1;
    }
    if (!parts[1].empty() && !IntegerOf(parts[1])) RefuseCorner(word);
    const std::uint32_t position = IndexOf(word, parts[0], "vertex", read_.positions.size());
    if (parts[2].empty()) return {position, ObjText::kNone};
    return {position, IndexOf(word, parts[2], "normal", read_.normals.size())};
  }

  /// Returns the index counted from 0. Negative indices count back from the statements read so far.
  std::uint32_t IndexOf(std::string_view corner, std::string_view word, const char* what,
                        std::size_t so_far) {
    const std::optional<long long> index = IntegerOf(word);
    if (!index) RefuseCorner(corner);
    const auto count = static_cast<long long>(so_far);
    if (*index == 0 || *index < -count) {
      Refuse(
          fmt::format("{} {}; indices count from 1, or from -1 back to {}", what, *index, -count));
    }
    const long long from_zero = *index > 0 ? *index - 1 : count + *index;
    if (from_zero >= ObjText::kNone) Refuse(fmt::format("{} {} is too large", what, *index));
    return static_cast<std::uint32_t>(from_zero);
  }

  /// Checks the indices after reading, because a face may precede its vertices.
  void CheckIndices() {
    for (const ObjText::Face& face : read_.faces) {
      line_ = face.line;
      for (std::size_t i = face.first; i < face.first + face.corners; ++i) {
        const auto [position, normal] = read_.corners[i];
        if (position >= read_.positions.size())
          Refuse(fmt::format("vertex {}; there are {}", position + 1, read_.positions.size()));
        if (normal != ObjText::kNone && normal >= read_.normals.size())
          Refuse(fmt::format("normal {}; there are {}", normal + 1, read_.normals.size()));
      }
    }
  }

  [[noreturn]] void RefuseCorner(std::string_view corner) const {
    Refuse(fmt::format("corner '{}'; it must be an index, as 1, 1/2, 1//3 or 1/2/3", corner));
  }
  [[noreturn]] void Refuse(const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, fault));
  }

  std::string_view rest_;
  const std::string& name_;
  std::size_t lines_taken_ = 0;
  std::size_t line_ = 0;  // first line of the statement
  std::uint32_t smoothing_ = ObjText::kNone;
  ObjText read_;
};

}  // namespace

ObjText ParseObj(std::string_view text, const std::string& name) {
  return ObjParser(text, name).Parse();
}

}  // namespace alpenglow::renderer
