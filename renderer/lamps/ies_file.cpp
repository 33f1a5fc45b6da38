// SPDX-License-Identifier: MIT
#include "renderer/lamps/ies_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/base/text_file.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

using Columns = std::vector<std::pair<double, std::size_t>>;  // angle [degrees], measured plane

// Returns the horizontal angles to which a measured plane of type C applies by symmetry.
std::vector<double> MirroredIn(const std::vector<double>& all_deg, double angle_deg) {
  const double last = all_deg.back();
  if (all_deg.front() == 90.0) return {angle_deg, 180.0 - angle_deg};
  if (last == 90.0) return {angle_deg, 180.0 - angle_deg, 180.0 + angle_deg, 360.0 - angle_deg};
  if (last == 180.0) return {angle_deg, 360.0 - angle_deg};
  return {angle_deg};
}

// Returns planes around the whole turn, ascending from 0 to below 360 degrees, each once.
Columns WholeTurn(const std::vector<double>& horizontal_deg) {
  Columns columns;
  for (std::size_t i = 0; i < horizontal_deg.size(); ++i) {
    for (const double angle : MirroredIn(horizontal_deg, horizontal_deg[i])) {
      columns.emplace_back(angle - 360.0 * std::floor(angle / 360.0), i);
    }
  }
  std::stable_sort(columns.begin(), columns.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  columns.erase(std::unique(columns.begin(), columns.end(), same), columns.end());
  return columns;
}

// Adds a column at 0, where a table must begin. If no plane was measured there, it is interpolated
// between its neighbours, the first and the last column.
void BeginAtZero(LampTable& table) {
  const std::size_t verticals = table.gamma_rad.size();
  const std::size_t last = table.intensity.size() - verticals;
  const double before = 2.0 * kPi - table.c_rad.back();
  const double share = before / (before + table.c_rad.front());  // of the first column
  std::vector<double> column;
  for (std::size_t i = 0; i < verticals; ++i) {
    column.push_back((1.0 - share) * table.intensity[last + i] + share * table.intensity[i]);
  }
  table.c_rad.insert(table.c_rad.begin(), 0.0);
  table.intensity.insert(table.intensity.begin(), column.begin(), column.end());
}

LampTable TypeC(const MeasuredAngles& measured) {
  LampTable table;
  for (const double angle : measured.vertical_deg) {
    table.gamma_rad.push_back(angle * kRadiansPerDegree);
  }
  const auto verticals = static_cast<std::ptrdiff_t>(measured.vertical_deg.size());
  for (const auto& [angle, plane] : WholeTurn(measured.horizontal_deg)) {
    const auto from = measured.intensity.begin() + static_cast<std::ptrdiff_t>(plane) * verticals;
    table.c_rad.push_back(angle * kRadiansPerDegree);
    table.intensity.insert(table.intensity.end(), from, from + verticals);
  }
  if (table.c_rad.front() > 0.0) BeginAtZero(table);
  return table;
}

/// Interpolation position among ascending angles.
struct AnglePlace {
  std::size_t low = 0;
  double share = 0.0;  // weight of the next angle
  bool is_inside = false;
};

AnglePlace PlaceAmong(const std::vector<double>& angles, double at) {
  constexpr double kRounding_deg = 1e-9;
  if (at < angles.front() - kRounding_deg || at > angles.back() + kRounding_deg) return {};
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, at);
  const auto low = static_cast<std::size_t>(above - angles.begin()) - 1;
  const double share = (at - angles[low]) / (angles[low + 1] - angles[low]);
  return {low, std::clamp(share, 0.0, 1.0), true};
}

double IntensityAt(const MeasuredAngles& measured, double vertical_deg, double horizontal_deg) {
  const bool is_mirrored = measured.horizontal_deg.front() == 0.0;
  const AnglePlace v = PlaceAmong(measured.vertical_deg, vertical_deg);
  const AnglePlace h =
      PlaceAmong(measured.horizontal_deg, is_mirrored ? std::abs(horizontal_deg) : horizontal_deg);
  if (!v.is_inside || !h.is_inside) return 0.0;
  const auto plane = [&](std::size_t horizontal) {
    const double* values =
        measured.intensity.data() + horizontal * measured.vertical_deg.size() + v.low;
    return (1.0 - v.share) * values[0] + v.share * values[1];
  };
  return (1.0 - h.share) * plane(h.low) + h.share * plane(h.low + 1);
}

// Returns the intensity towards a direction (d, a, l); see the header. On the axis of the planes
// their angle is 0.
double IntensityTowards(const MeasuredAngles& measured, const glm::dvec3& direction) {
  const auto degrees = [](double sine, double cosine) {
    constexpr double kOnAxis = 1e-12;
    return std::hypot(sine, cosine) < kOnAxis ? 0.0 : std::atan2(sine, cosine) / kRadiansPerDegree;
  };
  const auto [d, a, l] = std::tuple(direction.x, direction.y, direction.z);
  if (measured.type == PhotometricType::kB) {
    return IntensityAt(measured, degrees(a, d), degrees(-l, std::hypot(d, a)));
  }
  return IntensityAt(measured, degrees(-d, std::hypot(a, l)), degrees(-l, a));
}

double SmallestStep(const std::vector<double>& angles) {
  double smallest = 180.0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    smallest = std::min(smallest, angles[i] - angles[i - 1]);
  }
  return smallest;
}

// Returns the number of steps per quarter turn.
int StepsFor(const MeasuredAngles& measured) {
  constexpr double kFinest_deg = 0.25, kCoarsest_deg = 2.5;
  const double step =
      0.5 * std::min(SmallestStep(measured.vertical_deg), SmallestStep(measured.horizontal_deg));
  return static_cast<int>(std::ceil(90.0 / std::clamp(step, kFinest_deg, kCoarsest_deg) - 1e-9));
}

LampTable SampledInTypeC(const MeasuredAngles& measured) {
  const int quarter = StepsFor(measured);
  const double step_rad = 0.5 * kPi / quarter;
  LampTable table;
  for (int i = 0; i <= 2 * quarter; ++i) table.gamma_rad.push_back(i * step_rad);
  for (int c = 0; c < 4 * quarter; ++c) {
    table.c_rad.push_back(c * step_rad);
    for (const double gamma : table.gamma_rad) {
      table.intensity.push_back(IntensityTowards(
          measured, {std::cos(gamma), std::sin(gamma) * std::cos(table.c_rad.back()),
                     std::sin(gamma) * std::sin(table.c_rad.back())}));
    }
  }
  return table;
}

constexpr std::size_t kMostAngles = 4096;
constexpr char kEndOfDosFile = '\x1a';  // Ctrl-Z

/// Converts line ends of any system to line feeds, and removes a byte-order mark.
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

bool IsIesBlank(char c) {
  return std::string_view(" \t\n\v\f\r").find(c) != std::string_view::npos;
}

/// Returns the line in upper case, without white space.
std::string Compact(std::string_view line) {
  std::string compact;
  for (const char c : line) {
    if (!IsIesBlank(c)) compact += UpperCase(c);
  }
  return compact;
}

/// The numbers after the TILT line, independent of line breaks.
class Numbers {
 public:
  Numbers(std::string_view text, std::size_t line, const std::string& origin)
      : rest_(text), line_(line), origin_(origin) {}

  double Next(const char* what, double low, double high) {
    SkipBlanks();
    if (rest_.empty() || rest_.front() == kEndOfDosFile) {
      Fail(fmt::format("{} is missing: the file ends", what));
    }
    const std::string_view token = Token();
    const std::optional<double> number = ParseNumber(token);
    if (!number) Fail(fmt::format("{} is \"{}\"; it must be a number", what, token));
    const double value = *number;
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

  /// Throws InputError if anything but white space and the end mark of DOS files follows the last
  /// value.
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
  static bool IsBlank(char c) { return c == ',' || IsIesBlank(c); }
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

/// Content of the lines before the numbers.
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

/// Numbers that precede the angles.
struct Sizes {
  std::size_t verticals = 0, horizontals = 0;
  PhotometricType type = PhotometricType::kC;
  double factor = 1.0;  // factor on the candela values
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

bool HasWholeTurn(PhotometricType type, const std::vector<double>& horizontal_deg) {
  const double first = horizontal_deg.front(), last = horizontal_deg.back();
  if (type == PhotometricType::kC) {
    return (first == 0.0 && (last == 0.0 || last == 90.0 || last == 180.0 || last == 360.0)) ||
           (first == 90.0 && last == 270.0);
  }
  return last > 0.0 && last <= 90.0 && (first == 0.0 || first == -last);
}

LampTable TableOf(const MeasuredAngles& measured) {
  return measured.type == PhotometricType::kC ? TypeC(measured) : SampledInTypeC(measured);
}

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
  const std::string text = ReadTextFile(file);
  const std::optional<FileFormat> format = FormatOf(text, text.size());
  if (format && format->name != "IES photometry")
    RefuseFormat(file, *format, "lamps are read as IES photometry");
  return IesFromText(text, file.string());
}

}  // namespace alpenglow::renderer
