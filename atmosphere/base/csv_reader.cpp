// SPDX-License-Identifier: MIT
#include "atmosphere/base/csv_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/parsing.h"

namespace alpenglow::atmosphere {
namespace {

// Longer lines are rejected: in a binary file, for example, the first line could be the whole file.
constexpr std::size_t kLongestLine = 4096;

std::unique_ptr<std::streambuf> OpenedFile(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(
        fmt::format("{}: {}", file.string(), error ? error.message() : "is not a regular file"));
  }
  RefuseKnownFormats(file, "CSV is read");
  auto bytes = std::make_unique<std::filebuf>();
  if (bytes->open(file, std::ios::in | std::ios::binary) == nullptr)
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  return bytes;
}

}  // namespace

bool HeaderNames(const std::filesystem::path& file, std::string_view column) {
  std::ifstream stream(file, std::ios::binary);
  std::string line(kLongestLine, '\0');
  stream.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  line.resize(std::min(line.size(), line.find_first_of("\r\n")));
  const std::string_view header = WithoutByteOrderMark(line);
  const CsvRecord names = SplitCsv(header, {.separator = SeparatorOf(header)});
  return std::find(names.fields.begin(), names.fields.end(), column) != names.fields.end();
}

CsvReader::CsvReader(const std::filesystem::path& file, std::span<const std::string_view> columns,
                     const Rules& rules)
    : CsvReader(OpenedFile(file), file, columns, rules) {
  bytes_ = std::filesystem::file_size(file);
}

CsvReader::CsvReader(const std::string& text, const std::filesystem::path& origin,
                     std::span<const std::string_view> columns, const Rules& rules)
    : CsvReader(std::make_unique<std::stringbuf>(text), origin, columns, rules) {
  bytes_ = text.size();
}

CsvReader::CsvReader(std::unique_ptr<std::streambuf> stream, const std::filesystem::path& origin,
                     std::span<const std::string_view> columns, const Rules& rules)
    : file_(origin),
      columns_(columns.begin(), columns.end()),
      stream_(std::move(stream)),
      rules_(rules),
      syntax_{.has_comments = rules.comments} {
  ReadHeader();
}

void CsvReader::Fail(std::size_t line, const std::string& fault) const {
  throw InputError(fmt::format("{}:{}: {}", file_.string(), line, fault));
}

bool CsvReader::ReadLine() {
  line_.clear();
  using Traits = std::streambuf::traits_type;
  bool any = false, ended = false;
  auto c = stream_->sbumpc();
  for (; !Traits::eq_int_type(c, Traits::eof()); c = stream_->sbumpc()) {
    any = true;
    ++bytes_read_;
    ended = c == '\n' || c == '\r';
    if (ended) break;
    line_ += Traits::to_char_type(c);
    if (line_.size() > kLongestLine) {
      Fail(line_number_ + 1, fmt::format("is longer than {} characters", kLongestLine));
    }
  }
  if (!any || (rules_.cut_short && !ended)) return false;
  if (c == '\r' && stream_->sgetc() == '\n') {
    stream_->sbumpc();
    ++bytes_read_;
  }
  ++line_number_;
  return true;
}

void CsvReader::ReadHeader() {
  if (!ReadRecord()) throw InputError(fmt::format("{}: is empty", file_.string()));
  const std::size_t missing = columns_.size();
  position_.assign(columns_.size(), missing);
  const std::vector<std::string_view>& names = record_.fields;
  for (std::size_t field = 0; field < names.size(); ++field) {
    const auto found = std::find(columns_.begin(), columns_.end(), names[field]);
    if (found == columns_.end()) {
      Fail(line_number_, fmt::format("column \"{}\" is unknown; the columns are {}", names[field],
                                     fmt::join(columns_, ", ")));
    }
    std::size_t& position = position_[static_cast<std::size_t>(found - columns_.begin())];
    if (position != missing) Fail(line_number_, fmt::format("column {} twice", names[field]));
    position = field;
  }
  fields_in_header_ = names.size();
  for (std::size_t column = 0; column < rules_.needed; ++column) {
    if (position_[column] == missing) {
      Fail(line_number_, fmt::format("column {} is missing", columns_[column]));
    }
  }
}

bool CsvReader::ReadRecord() {
  const bool is_header = line_number_ == 0 || position_.empty();
  while (ReadLine()) {
    if (line_number_ == 1) line_ = WithoutByteOrderMark(line_);
    if (is_header) syntax_.separator = SeparatorOf(line_);
    record_ = SplitCsv(line_, syntax_);
    if (!record_.fault.empty()) Fail(line_number_, record_.fault);
    const bool is_blank = record_.fields.size() == 1 && record_.fields.front().empty();
    if (!rules_.comments || !is_blank) return true;
  }
  return false;
}

bool CsvReader::Next() {
  if (!ReadRecord()) {
    if (!any_) throw InputError(fmt::format("{}: has no lines below its header", file_.string()));
    return false;
  }
  any_ = true;
  if (record_.fields.size() != fields_in_header_) {
    Fail(line_number_,
         fmt::format("has {} fields; it must have {}", record_.fields.size(), fields_in_header_));
  }
  return true;
}

std::string_view CsvReader::Field(std::size_t column) const {
  return record_.fields[position_[column]];
}

double CsvReader::Number(std::size_t column, double low, double high) const {
  const std::string_view text = Field(column);
  const std::optional<double> number = ParseNumber(text);
  if (!number) {
    const bool has_comma = text.find(',') != std::string_view::npos;
    Fail(line_number_, fmt::format("{} is \"{}\"; it must be a number{}", columns_[column], text,
                                   has_comma ? " with a decimal point" : ""));
  }
  const double value = *number;
  if (!(value >= low && value <= high)) {
    Fail(line_number_,
         fmt::format("{} is {}; it must lie in [{}, {}]", columns_[column], text, low, high));
  }
  return value;
}

}  // namespace alpenglow::atmosphere
