// SPDX-License-Identifier: MIT
#include "renderer/lamp/ies_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "atmosphere/text/toml_table.h"
#include "renderer/lamp/ies_angles.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kMostAngles = 4096;
constexpr char kEndOfDosFile = '\x1a';  // Ctrl-Z

/// Lines end with a line feed, whatever system wrote them, and a byte-order mark is left out.
std::string WithLineFeeds(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') {
      plain += text[i];
    } else if (i + 1 == text.size() || text[i + 1] != '\n') {
      plain += '\n';
    }
  }
  return plain;
}

/// The line in upper case, without white space.
std::string Compact(std::string_view line) {
  std::string compact;
  for (const char c : line) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isspace(letter) == 0) compact += static_cast<char>(std::toupper(letter));
  }
  return compact;
}

/// The numbers after the TILT line, wherever lines break.
class Numbers {
 public:
  Numbers(std::string_view text, std::size_t line, const std::string& origin)
      : rest_(text), line_(line), origin_(origin) {}

  double Next(const char* what, double low, double high) {
    SkipBlanks();
    if (rest_.empty() || rest_.front() == kEndOfDosFile) {
      Fail(fmt::format("{} is missing: the file ends", what));
    }
    std::string_view token = Token();
    if (token.starts_with('+')) token.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc() || end != token.data() + token.size()) {
      Fail(fmt::format("{} is \"{}\"; it must be a number", what, token));
    }
    if (!(value >= low && value <= high)) {
      Fail(fmt::format("{} is {}; it must lie in [{}, {}]", what, value, low, high));
    }
    rest_.remove_prefix(Token().size());
    return value;
  }

  std::size_t Whole(const char* what, double low, double high) {
    const double value = Next(what, low, high);
    if (value != std::floor(value)) Fail(fmt::format("{} is {}; it must be whole", what, value));
    return static_cast<std::size_t>(value);
  }
  std::size_t Count(const char* what) { return Whole(what, 1.0, static_cast<double>(kMostAngles)); }

  std::vector<double> Angles(const char* what, std::size_t count, double low, double high) {
    std::vector<double> angles;
    for (std::size_t i = 0; i < count; ++i) {
      angles.push_back(Next(what, low, high));
      if (i > 0 && !(angles[i - 1] < angles[i])) {
        Fail(fmt::format("{} {} comes after {}; angles must ascend", what, angles[i],
                         angles[i - 1]));
      }
    }
    return angles;
  }

  /// Only white space and the mark that ends files of DOS may follow the last value.
  void End(std::size_t candela_values) {
    while (!rest_.empty() && (IsBlank(rest_.front()) || rest_.front() == kEndOfDosFile)) Skip();
    if (rest_.empty()) return;
    Fail(
        fmt::format("\"{}\" follows the last of {} candela values; the file must end there (a "
                    "comma separates numbers, decimals take a point)",
                    Token(), candela_values));
  }

  [[noreturn]] void Fail(const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", origin_, line_, fault));
  }

 private:
  static bool IsBlank(char c) {
    return c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0;
  }
  [[nodiscard]] std::string_view Token() const {
    return rest_.substr(0, static_cast<std::size_t>(
                               std::find_if(rest_.begin(), rest_.end(), IsBlank) - rest_.begin()));
  }
  void SkipBlanks() {
    while (!rest_.empty() && IsBlank(rest_.front())) Skip();
  }
  void Skip() {
    if (rest_.front() == '\n') ++line_;
    rest_.remove_prefix(1);
  }

  std::string_view rest_;
  std::size_t line_;
  const std::string& origin_;
};

/// The content of the lines before the numbers.
struct Head {
  bool has_photometric_factor = false;
  bool has_tilt = false;
  std::size_t length = 0;  // bytes
  std::size_t lines = 0;
};

// Files of 1986 begin with a label, all later ones with the name of their edition.
bool IsOf1986Or1991(std::string_view first_line) {
  const std::string name = Compact(first_line);
  return name.starts_with("IESNA91") || name.starts_with("IESNA:LM-63-1991") ||
         name.starts_with("IESNA86") || name.starts_with("IESNA:LM-63-1986") ||
         !(name.starts_with("IESNA") || name.starts_with("IES:LM-63"));
}

Head HeadOf(std::string_view text, const std::string& origin) {
  Head head;
  while (head.length < text.size()) {
    const std::size_t end = std::min(text.find('\n', head.length), text.size());
    const std::string_view line = text.substr(head.length, end - head.length);
    head.length = std::min(end + 1, text.size());
    if (++head.lines == 1) head.has_photometric_factor = IsOf1986Or1991(line);
    const std::string compact = Compact(line);
    if (!compact.starts_with("TILT=")) continue;
    head.has_tilt = compact == "TILT=INCLUDE";
    if (head.has_tilt || compact == "TILT=NONE") return head;
    throw InputError(
        fmt::format("{}:{}: {}; TILT=NONE and TILT=INCLUDE are read", origin, head.lines, line));
  }
  throw InputError(fmt::format("{}: has no TILT line; it is no IES file", origin));
}

LampTilt TiltFrom(Numbers& numbers) {
  LampTilt tilt;
  tilt.stays_level = numbers.Whole("lamp-to-luminaire geometry", 1.0, 3.0) == 2;
  const std::size_t count = numbers.Count("number of tilt angles");
  tilt.angle_deg = numbers.Angles("tilt angle", count, 0.0, 180.0);
  for (std::size_t i = 0; i < count; ++i) {
    tilt.factor.push_back(numbers.Next("tilt factor", 0.0, 1e6));
  }
  return tilt;
}

/// The numbers that come before the angles.
struct Sizes {
  std::size_t verticals = 0, horizontals = 0;
  PhotometricType type = PhotometricType::kC;
  double factor = 1.0;  // of the candela values
};

Sizes SizesFrom(Numbers& numbers, bool has_photometric_factor) {
  Sizes sizes;
  (void)numbers.Next("number of lamps", 0.0, 1e6);
  (void)numbers.Next("lumens per lamp", -1.0, 1e9);
  sizes.factor = numbers.Next("candela multiplier", 0.0, 1e6);
  sizes.verticals = numbers.Count("number of vertical angles");
  sizes.horizontals = numbers.Count("number of horizontal angles");
  sizes.type = static_cast<PhotometricType>(numbers.Whole("photometric type", 1.0, 3.0));
  (void)numbers.Whole("units type", 1.0, 2.0);
  for (const char* size : {"width", "length", "height"}) (void)numbers.Next(size, -1e4, 1e4);
  sizes.factor *= numbers.Next("ballast factor", 0.0, 1e6);
  if (has_photometric_factor) {
    sizes.factor *= numbers.Next("ballast-lamp photometric factor", 0.0, 1e6);
  } else {
    (void)numbers.Next("future use", -1e9, 1e9);
  }
  (void)numbers.Next("input watts", 0.0, 1e9);
  return sizes;
}

void RequireWholeTurn(const Numbers& numbers, const MeasuredAngles& measured) {
  if (measured.vertical_deg.size() < 2) {
    numbers.Fail("has one vertical angle; there must be at least two");
  }
  if (HasWholeTurn(measured.type, measured.horizontal_deg)) return;
  numbers.Fail(fmt::format("horizontal angles go from {} to {}; they must go from {}",
                           measured.horizontal_deg.front(), measured.horizontal_deg.back(),
                           measured.type == PhotometricType::kC
                               ? "0 to 0, 90, 180 or 360, or from 90 to 270"
                               : "0 or -x to x, x at most 90, in types A and B"));
}

MeasuredAngles MeasuredFrom(Numbers& numbers, const Sizes& sizes) {
  const bool is_c = sizes.type == PhotometricType::kC;
  MeasuredAngles measured;
  measured.type = sizes.type;
  measured.vertical_deg =
      numbers.Angles("vertical angle", sizes.verticals, is_c ? 0.0 : -90.0, is_c ? 180.0 : 90.0);
  measured.horizontal_deg = numbers.Angles("horizontal angle", sizes.horizontals,
                                           is_c ? 0.0 : -90.0, is_c ? 360.0 : 90.0);
  RequireWholeTurn(numbers, measured);
  for (std::size_t i = 0; i < sizes.verticals * sizes.horizontals; ++i) {
    measured.intensity.push_back(sizes.factor * numbers.Next("candela value", 0.0, 1e12));
  }
  numbers.End(measured.intensity.size());
  return measured;
}

}  // namespace

double LampTilt::FactorAt(double tilt_deg) const {
  if (angle_deg.empty()) return 1.0;
  const double tilt = stays_level ? 0.0 : tilt_deg;
  if (!(tilt >= angle_deg.front() && tilt <= angle_deg.back())) {
    throw InputError(fmt::format("is tilted by {} degrees; its factors are for {} to {} degrees",
                                 tilt, angle_deg.front(), angle_deg.back()));
  }
  const auto above = std::upper_bound(angle_deg.begin(), angle_deg.end(), tilt);
  if (above == angle_deg.end()) return factor.back();
  const auto high = static_cast<std::size_t>(above - angle_deg.begin());
  const double share = (tilt - angle_deg[high - 1]) / (angle_deg[high] - angle_deg[high - 1]);
  return (1.0 - share) * factor[high - 1] + share * factor[high];
}

IesLamp IesFromText(std::string_view text, const std::string& origin) {
  const std::string plain = WithLineFeeds(text);
  const Head head = HeadOf(plain, origin);
  Numbers numbers(std::string_view(plain).substr(head.length), head.lines + 1, origin);
  IesLamp lamp;
  if (head.has_tilt) lamp.tilt = TiltFrom(numbers);
  MeasuredAngles measured = MeasuredFrom(numbers, SizesFrom(numbers, head.has_photometric_factor));
  lamp.intensity_cd = *std::max_element(measured.intensity.begin(), measured.intensity.end());
  if (!(lamp.intensity_cd > 0.0)) numbers.Fail("has no light: every candela value is 0");
  for (double& value : measured.intensity) value /= lamp.intensity_cd;
  lamp.table = TableOf(measured);
  return lamp;
}

IesLamp ReadIes(const std::filesystem::path& file) {
  return IesFromText(ReadTextFile(file), file.string());
}

}  // namespace alpenglow::renderer
