// SPDX-License-Identifier: MIT
#include "lut/case_file.h"

#include <charconv>
#include <cmath>
#include <map>
#include <vector>

#include "atmosphere/error.h"

namespace alpenglow {
namespace {

constexpr std::array<std::string_view, 7> kColumnNames{"id",
                                                       "quantity",
                                                       "altitude_m",
                                                       "view_zenith_deg",
                                                       "relative_azimuth_deg",
                                                       "sun_zenith_deg",
                                                       "distance_m"};

const std::map<std::string_view, Quantity> kQuantities{
    {"transmittance", Quantity::kTransmittance},
    {"optical_depth", Quantity::kOpticalDepth},
    {"single", Quantity::kSingle},
    {"inscatter_single", Quantity::kInscatterSingle},
    {"total", Quantity::kTotal},
    {"irradiance_sun", Quantity::kIrradianceSun},
    {"irradiance_sky", Quantity::kIrradianceSky}};

// Longer lines are not cases: a binary file, say, whose first line could be all of it.
constexpr std::size_t kLongestLine = 4096;

std::vector<std::string_view> FieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view field = line.substr(0, comma);
    while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
    while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
    fields.push_back(field);
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

CaseReader::CaseReader(const std::filesystem::path& file) : file_(file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(
        fmt::format("{}: {}", file.string(), error ? error.message() : "is not a regular file"));
  }
  bytes_ = std::filesystem::file_size(file);
  stream_.open(file, std::ios::binary);
  if (!stream_) throw InputError(fmt::format("{}: cannot be read", file.string()));
  ReadHeader();
}

void CaseReader::Fail(std::size_t line, const std::string& fault) const {
  throw InputError(fmt::format("{}:{}: {}", file_.string(), line, fault));
}

bool CaseReader::ReadLine() {
  line_.clear();
  using Traits = std::ifstream::traits_type;
  bool any = false;
  std::streambuf* buffer = stream_.rdbuf();
  for (auto c = buffer->sbumpc(); !Traits::eq_int_type(c, Traits::eof()); c = buffer->sbumpc()) {
    any = true;
    ++bytes_read_;
    if (Traits::to_char_type(c) == '\n') break;
    line_ += Traits::to_char_type(c);
    if (line_.size() > kLongestLine) {
      Fail(line_number_ + 1, fmt::format("is longer than {} characters", kLongestLine));
    }
  }
  if (!any) return false;
  ++line_number_;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  return true;
}

void CaseReader::ReadHeader() {
  if (!ReadLine()) throw InputError(fmt::format("{}: is empty", file_.string()));
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view header = line_;
  if (header.starts_with(kByteOrderMark)) header.remove_prefix(kByteOrderMark.size());
  position_.fill(kColumns);
  const std::vector<std::string_view> fields = FieldsOf(header);
  for (std::size_t field = 0; field < fields.size(); ++field) {
    std::size_t column = 0;
    while (column < kColumns && kColumnNames[column] != fields[field]) ++column;
    if (column == kColumns) {
      Fail(1, fmt::format("column \"{}\" is unknown; the columns are {}", fields[field],
                          fmt::join(kColumnNames, ", ")));
    }
    if (position_[column] != kColumns) Fail(1, fmt::format("column {} twice", fields[field]));
    position_[column] = field;
  }
  for (std::size_t column = 0; column < kColumns; ++column) {
    if (position_[column] == kColumns) {
      Fail(1, fmt::format("column {} is missing", kColumnNames[column]));
    }
  }
}

std::optional<Case> CaseReader::Next() {
  if (!ReadLine()) {
    if (cases_ == 0) throw InputError(fmt::format("{}: has no cases", file_.string()));
    return std::nullopt;
  }
  ++cases_;
  return CaseOfLine();
}

double CaseReader::Number(std::string_view text, Column column, double low, double high) const {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) {
    Fail(line_number_,
         fmt::format("{} is \"{}\"; it must be a number", kColumnNames[column], text));
  }
  if (!(value >= low && value <= high)) {
    Fail(line_number_,
         fmt::format("{} is {}; it must lie in [{}, {}]", kColumnNames[column], text, low, high));
  }
  return value;
}

Case CaseReader::CaseOfLine() const {
  const std::vector<std::string_view> fields = FieldsOf(line_);
  if (fields.size() != kColumns) {
    Fail(line_number_, fmt::format("has {} fields; it must have {}", fields.size(),
                                   static_cast<std::size_t>(kColumns)));
  }
  const auto field = [&](Column column) { return fields[position_[column]]; };
  Case result;
  result.line = line_number_;
  result.id = field(kId);
  if (result.id.empty()) Fail(line_number_, "id is empty");
  if (field(kQuantity) == "airlight") {
    Fail(line_number_, "quantity airlight is not available in this version");
  }
  const auto quantity = kQuantities.find(field(kQuantity));
  if (quantity == kQuantities.end()) {
    std::vector<std::string_view> names;
    for (const auto& [name, unused] : kQuantities) names.push_back(name);
    Fail(line_number_, fmt::format("quantity is \"{}\"; it must be one of {}", field(kQuantity),
                                   fmt::join(names, ", ")));
  }
  result.quantity = quantity->second;
  result.ray = RayFromAngles(
      Number(field(kAltitude), kAltitude, -12000.0, 1e9), Number(field(kView), kView, 0.0, 180.0),
      Number(field(kAzimuth), kAzimuth, -360.0, 360.0), Number(field(kSun), kSun, 0.0, 180.0));
  if (!field(kDistance).empty()) {
    result.ray.length_m = Number(field(kDistance), kDistance, 0.0, 1e12);
  }
  return result;
}

}  // namespace alpenglow
