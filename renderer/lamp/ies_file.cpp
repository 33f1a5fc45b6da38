// SPDX-License-Identifier: MIT
#include "renderer/lamp/ies_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "atmosphere/text/toml_table.h"

namespace alpenglow {
namespace {

constexpr std::size_t kMostAngles = 4096;

/// The numbers after the TILT line, wherever lines break.
class Numbers {
 public:
  Numbers(std::string_view text, std::size_t line, const std::string& origin)
      : rest_(text), line_(line), origin_(origin) {}

  double Next(const char* what, double low, double high) {
    while (!rest_.empty() && IsBlank(rest_.front())) Skip();
    if (rest_.empty()) Fail(fmt::format("{} is missing: the file ends", what));
    const std::size_t length =
        static_cast<std::size_t>(std::find_if(rest_.begin(), rest_.end(), IsBlank) - rest_.begin());
    std::string_view token = rest_.substr(0, length);
    if (token.starts_with('+')) token.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc() || end != token.data() + token.size()) {
      Fail(fmt::format("{} is \"{}\"; it must be a number", what, token));
    }
    if (!(value >= low && value <= high)) {
      Fail(fmt::format("{} is {}; it must lie in [{}, {}]", what, value, low, high));
    }
    rest_.remove_prefix(length);
    return value;
  }

  std::size_t Count(const char* what) {
    const double value = Next(what, 1.0, static_cast<double>(kMostAngles));
    if (value != std::floor(value)) Fail(fmt::format("{} is {}; it must be whole", what, value));
    return static_cast<std::size_t>(value);
  }

  std::vector<double> Angles(const char* what, std::size_t count, double high) {
    std::vector<double> angles;
    for (std::size_t i = 0; i < count; ++i) {
      angles.push_back(Next(what, 0.0, high));
      if (i > 0 && !(angles[i - 1] < angles[i])) {
        Fail(fmt::format("{} {} comes after {}; angles must ascend", what, angles[i],
                         angles[i - 1]));
      }
    }
    return angles;
  }

  [[noreturn]] void Fail(const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", origin_, line_, fault));
  }

 private:
  static bool IsBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
  }
  void Skip() {
    if (rest_.front() == '\n') ++line_;
    rest_.remove_prefix(1);
  }

  std::string_view rest_;
  std::size_t line_;
  const std::string& origin_;
};

/// The text behind the TILT line.
Numbers AfterTilt(std::string_view text, const std::string& origin) {
  std::size_t line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view now = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (!now.empty() && (now.back() == '\r' || now.back() == ' ')) now.remove_suffix(1);
    if (!now.starts_with("TILT=")) continue;
    if (now != "TILT=NONE") {
      throw InputError(
          fmt::format("{}:{}: {}; only TILT=NONE is read", origin, line, std::string(now)));
    }
    return {text, line + 1, origin};
  }
  throw InputError(fmt::format("{}: has no TILT line; it is no IES file", origin));
}

/// Columns around the whole turn, from those of the quadrants that were measured.
void Unfold(const std::vector<double>& horizontal_deg, const std::vector<double>& candela,
            std::size_t verticals, LampTable& table) {
  const auto add = [&](double c_deg, std::size_t column) {
    table.c_rad.push_back(c_deg * kRadiansPerDegree);
    const auto from = candela.begin() + static_cast<std::ptrdiff_t>(column * verticals);
    table.intensity.insert(table.intensity.end(), from,
                           from + static_cast<std::ptrdiff_t>(verticals));
  };
  const std::size_t last = horizontal_deg.size() - 1;
  const double span = horizontal_deg[last];
  for (std::size_t i = 0; i <= last; ++i) {
    if (horizontal_deg[i] < 360.0) add(horizontal_deg[i], i);
  }
  if (span == 90.0) {
    for (std::size_t i = last; i-- > 0;) add(180.0 - horizontal_deg[i], i);
    for (std::size_t i = 1; i <= last; ++i) add(180.0 + horizontal_deg[i], i);
    for (std::size_t i = last; i-- > 1;) add(360.0 - horizontal_deg[i], i);
  }
  if (span == 180.0) {
    for (std::size_t i = last; i-- > 1;) add(360.0 - horizontal_deg[i], i);
  }
}

}  // namespace

IesLamp IesFromText(std::string_view text, const std::string& origin) {
  Numbers numbers = AfterTilt(text, origin);
  (void)numbers.Next("number of lamps", 0.0, 1e6);
  (void)numbers.Next("lumens per lamp", -1.0, 1e9);
  const double multiplier = numbers.Next("candela multiplier", 0.0, 1e6);
  const std::size_t verticals = numbers.Count("number of vertical angles");
  const std::size_t horizontals = numbers.Count("number of horizontal angles");
  const double type = numbers.Next("photometric type", 1.0, 3.0);
  if (type != 1.0) numbers.Fail(fmt::format("photometric type is {}; only 1 (C) is read", type));
  (void)numbers.Next("units type", 1.0, 2.0);
  for (const char* size : {"width", "length", "height"}) (void)numbers.Next(size, -1e4, 1e4);
  const double ballast = numbers.Next("ballast factor", 0.0, 1e6);
  (void)numbers.Next("future use", -1e9, 1e9);
  (void)numbers.Next("input watts", 0.0, 1e9);
  const std::vector<double> gamma = numbers.Angles("vertical angle", verticals, 180.0);
  if (verticals < 2) numbers.Fail("has one vertical angle; there must be at least two");
  const std::vector<double> horizontal = numbers.Angles("horizontal angle", horizontals, 360.0);
  const double span = horizontal.back();
  if (horizontal.front() != 0.0 || (span != 0.0 && span != 90.0 && span != 180.0 && span < 270.0)) {
    numbers.Fail(
        fmt::format("horizontal angles go from {} to {}; they must go from 0 to 0, 90, "
                    "180 or 360",
                    horizontal.front(), span));
  }
  std::vector<double> candela;
  for (std::size_t i = 0; i < verticals * horizontals; ++i) {
    candela.push_back(multiplier * ballast * numbers.Next("candela value", 0.0, 1e12));
  }
  IesLamp lamp;
  lamp.intensity_cd = *std::max_element(candela.begin(), candela.end());
  if (!(lamp.intensity_cd > 0.0)) numbers.Fail("has no light: every candela value is 0");
  for (double& value : candela) value /= lamp.intensity_cd;
  for (const double angle : gamma) lamp.table.gamma_rad.push_back(angle * kRadiansPerDegree);
  Unfold(horizontal, candela, verticals, lamp.table);
  return lamp;
}

IesLamp ReadIes(const std::filesystem::path& file) {
  return IesFromText(ReadTextFile(file), file.string());
}

}  // namespace alpenglow
