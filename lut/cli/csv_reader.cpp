// SPDX-License-Identifier: MIT
#include "lut/cli/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "atmosphere/base/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

// Longer lines are rejected: in a binary file, for example, the first line could be the whole file.
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

std::vector<std::string_view> FieldsOfHeader(std::string_view header) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (header.starts_with(kByteOrderMark)) header.remove_prefix(kByteOrderMark.size());
  return FieldsOf(header);
}

}  // namespace

bool HeaderNames(const std::filesystem::path& file, std::string_view column) {
  std::ifstream stream(file, std::ios::binary);
  std::string line(kLongestLine, '\0');
  stream.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  line.resize(std::min(line.size(), line.find_first_of("\r\n")));
  const std::vector<std::string_view> fields = FieldsOfHeader(line);
  return std::find(fields.begin(), fields.end(), column) != fields.end();
}

CsvReader::CsvReader(const std::filesystem::path& file, std::span<const std::string_view> columns,
                     const Rules& rules)
    : file_(file), columns_(columns.begin(), columns.end()), rules_(rules) {
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

void CsvReader::Fail(std::size_t line, const std::string& fault) const {
  throw InputError(fmt::format("{}:{}: {}", file_.string(), line, fault));
}

bool CsvReader::ReadLine() {
  line_.clear();
  using Traits = std::ifstream::traits_type;
  bool any = false, ended = false;
  std::streambuf* buffer = stream_.rdbuf();
  for (auto c = buffer->sbumpc(); !Traits::eq_int_type(c, Traits::eof()); c = buffer->sbumpc()) {
    any = true;
    ++bytes_read_;
    ended = Traits::to_char_type(c) == '\n';
    if (ended) break;
    line_ += Traits::to_char_type(c);
    if (line_.size() > kLongestLine) {
      Fail(line_number_ + 1, fmt::format("is longer than {} characters", kLongestLine));
    }
  }
  if (!any || (rules_.cut_short && !ended)) return false;
  ++line_number_;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  return true;
}

void CsvReader::ReadHeader() {
  if (!ReadLineOfData()) throw InputError(fmt::format("{}: is empty", file_.string()));
  const std::size_t missing = columns_.size();
  position_.assign(columns_.size(), missing);
  const std::vector<std::string_view> fields = FieldsOfHeader(line_);
  for (std::size_t field = 0; field < fields.size(); ++field) {
    const auto found = std::find(columns_.begin(), columns_.end(), fields[field]);
    if (found == columns_.end()) {
      Fail(line_number_, fmt::format("column \"{}\" is unknown; the columns are {}", fields[field],
                                     fmt::join(columns_, ", ")));
    }
    std::size_t& position = position_[static_cast<std::size_t>(found - columns_.begin())];
    if (position != missing) Fail(line_number_, fmt::format("column {} twice", fields[field]));
    position = field;
  }
  fields_in_header_ = fields.size();
  for (std::size_t column = 0; column < rules_.needed; ++column) {
    if (position_[column] == missing) {
      Fail(line_number_, fmt::format("column {} is missing", columns_[column]));
    }
  }
}

bool CsvReader::ReadLineOfData() {
  while (ReadLine()) {
    if (!rules_.comments) return true;
    line_.resize(std::min(line_.size(), line_.find('#')));
    if (line_.find_first_not_of(" \t") != std::string::npos) return true;
  }
  return false;
}

bool CsvReader::Next() {
  if (!ReadLineOfData()) {
    if (!any_) throw InputError(fmt::format("{}: has no lines below its header", file_.string()));
    return false;
  }
  any_ = true;
  fields_ = FieldsOf(line_);
  if (fields_.size() != fields_in_header_) {
    Fail(line_number_,
         fmt::format("has {} fields; it must have {}", fields_.size(), fields_in_header_));
  }
  return true;
}

std::string_view CsvReader::Field(std::size_t column) const { return fields_[position_[column]]; }

double CsvReader::Number(std::size_t column, double low, double high) const {
  const std::string_view text = Field(column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) {
    Fail(line_number_, fmt::format("{} is \"{}\"; it must be a number", columns_[column], text));
  }
  if (!(value >= low && value <= high)) {
    Fail(line_number_,
         fmt::format("{} is {}; it must lie in [{}, {}]", columns_[column], text, low, high));
  }
  return value;
}

}  // namespace alpenglow::lut
