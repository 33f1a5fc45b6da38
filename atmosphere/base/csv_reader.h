// SPDX-License-Identifier: MIT
// Reader of CSV with a header and lines of numbers and names (atmosphere/base/csv.h): columns in
// any order, separated by commas, semicolons or tabs. Lines end with CR, LF or both and are read one
// at a time: a file of a million lines needs the memory of one line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/csv.h"

namespace alpenglow::atmosphere {

/// Returns whether a file names a column in its header; the rest of the file is not checked. Throws
/// InputError for a file that cannot be read or is empty.
[[nodiscard]] bool HeaderNames(const std::filesystem::path& file, std::string_view column);

class CsvReader {
 public:
  /// Opens the file and reads its header. Throws InputError, here and in every other member, with
  /// file, line and fault: a missing, unknown or repeated column, too few or too many fields, text
  /// that is not a number, a value out of range, a file without lines, a file of another format.
  /// @param columns  names of the columns; a column's index in the list is its number below.
  CsvReader(const std::filesystem::path& file, std::span<const std::string_view> columns)
      : CsvReader(file, columns, {columns.size(), false}) {}

  struct Rules {
    std::size_t needed;      // the first `needed` columns are required, the others are optional
    bool comments;           // blank lines, and text after a `#`, are skipped
    bool cut_short = false;  // a last line without a line end is skipped: its writer was killed
  };
  CsvReader(const std::filesystem::path& file, std::span<const std::string_view> columns,
            const Rules& rules);
  /// Reads text that is in memory; messages contain `origin` in place of the file.
  CsvReader(const std::string& text, const std::filesystem::path& origin,
            std::span<const std::string_view> columns, const Rules& rules);

  /// Returns whether the file has the column. Field and Number require that it has.
  [[nodiscard]] bool Has(std::size_t column) const { return position_[column] != columns_.size(); }

  /// Goes to the next line; returns false at the end.
  [[nodiscard]] bool Next();

  /// Returns a field of the current line, without surrounding blanks.
  [[nodiscard]] std::string_view Field(std::size_t column) const;
  [[nodiscard]] double Number(std::size_t column, double low, double high) const;

  /// Throws an InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const;
  /// Returns the current line's number in the file, from 1.
  [[nodiscard]] std::size_t line() const { return line_number_; }

  /// Number of bytes read and to read, for progress.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  CsvReader(std::unique_ptr<std::streambuf> bytes, const std::filesystem::path& origin,
            std::span<const std::string_view> columns, const Rules& rules);
  [[nodiscard]] bool ReadLine();
  [[nodiscard]] bool ReadRecord();
  void ReadHeader();

  std::filesystem::path file_;
  std::vector<std::string_view> columns_;
  std::unique_ptr<std::streambuf> stream_;
  std::uint64_t bytes_ = 0;
  std::uint64_t bytes_read_ = 0;
  std::size_t line_number_ = 0;
  bool any_ = false;
  Rules rules_;
  CsvSyntax syntax_;
  std::size_t fields_in_header_ = 0;
  std::string line_;
  CsvRecord record_;                   // fields of line_
  std::vector<std::size_t> position_;  // of each column in the file; columns_.size(): missing
};

}  // namespace alpenglow::atmosphere
