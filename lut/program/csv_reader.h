// SPDX-License-Identifier: MIT
// Lines of numbers and names with a header (CSV): columns in any order, no quotes. Read a line at a
// time: a file of a million lines needs the memory of one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::lut {

/// Where a file names a column in its header; nothing is said about the rest. Throws InputError
/// for a file that cannot be read or is empty.
[[nodiscard]] bool HeaderNames(const std::filesystem::path& file, std::string_view column);

class CsvReader {
 public:
  /// Opens the file and reads its header. Throws InputError, here and in every other member, naming
  /// file, line and what is wrong: a missing, unknown or repeated column, a field too few or too
  /// many, text that is no number, a value out of range, a file without lines.
  /// @param columns  their names; a column's index in the list is its number below.
  CsvReader(const std::filesystem::path& file, std::span<const std::string_view> columns)
      : CsvReader(file, columns, {columns.size(), false}) {}

  struct Rules {
    std::size_t needed;      // the first so many columns must be there, the others may
    bool comments;           // lines that are blank and what follows a `#` are passed over
    bool cut_short = false;  // a last line without its end is passed over: its writer was killed
  };
  CsvReader(const std::filesystem::path& file, std::span<const std::string_view> columns,
            const Rules& rules);

  /// Whether the file has the column. Field and Number are of columns that it has.
  [[nodiscard]] bool Has(std::size_t column) const { return position_[column] != columns_.size(); }

  /// Goes to the next line; false at the end.
  [[nodiscard]] bool Next();

  /// Of the current line, without blanks around it.
  [[nodiscard]] std::string_view Field(std::size_t column) const;
  [[nodiscard]] double Number(std::size_t column, double low, double high) const;

  /// An InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const;
  /// The current line's number in the file, from 1.
  [[nodiscard]] std::size_t line() const { return line_number_; }

  /// How far it is, for progress.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  [[nodiscard]] bool ReadLine();
  [[nodiscard]] bool ReadLineOfData();
  void ReadHeader();

  std::filesystem::path file_;
  std::vector<std::string_view> columns_;
  std::ifstream stream_;
  std::uint64_t bytes_ = 0;
  std::uint64_t bytes_read_ = 0;
  std::size_t line_number_ = 0;
  bool any_ = false;
  Rules rules_;
  std::size_t fields_in_header_ = 0;
  std::string line_;
  std::vector<std::string_view> fields_;  // of line_
  std::vector<std::size_t> position_;     // of each column in the file; columns_.size(): none
};

}  // namespace alpenglow::lut
