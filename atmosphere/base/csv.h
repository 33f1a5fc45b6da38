// SPDX-License-Identifier: MIT
// Records of CSV text (RFC 4180): fields may stand in quotes, in which the separator has no meaning
// and two quotes are one. Unlike there, a record ends with its line, and blanks around a field are
// removed, within quotes too: fields are numbers and names.
//
// Embedded tables are read here; csv_reader.h reads files.
#pragma once

#include <algorithm>
#include <forward_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {

struct CsvSyntax {
  char separator = ',';
  bool has_comments = false;  // text after a '#' outside quotes does not belong to the record
};

struct CsvRecord {
  std::vector<std::string_view> fields;      // one, which is empty, for an empty line
  std::forward_list<std::string> unescaped;  // the fields that contain a quote
  std::string fault;                         // why the line is no record; empty: it is one
};

/// Splits a line without its end. The line must outlive the record.
[[nodiscard]] CsvRecord SplitCsv(std::string_view line, const CsvSyntax& syntax = {});

/// Returns the line without the byte-order mark of UTF-8.
[[nodiscard]] std::string_view WithoutByteOrderMark(std::string_view line);

/// Returns the separator of a header, in which text after a '#' is a comment: a semicolon or a tab
/// if it has no comma but one of these outside quotes, as spreadsheets write them; else a comma.
[[nodiscard]] char SeparatorOf(std::string_view header);

/// Calls `visit` with the records of an embedded table: lines that start with '#', a line of names,
/// then the records. Throws InternalError for other text.
template <typename Visit>
void VisitCsvRows(std::string_view text, const Visit& visit) {
  bool names_seen = false;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.empty() || line.front() == '#' || !std::exchange(names_seen, true)) continue;
    const CsvRecord record = SplitCsv(line);
    if (!record.fault.empty()) throw InternalError(record.fault);
    visit(record);
  }
}

/// Returns the requested columns of an embedded table: lines that start with '#', a line of names,
/// then numbers. One list per column, in the order requested. Throws InternalError for a field that
/// is not a number.
/// @param file  as for EmbeddedText.
[[nodiscard]] std::vector<std::vector<double>> ReadColumns(std::string_view file,
                                                           const std::vector<int>& columns);

/// Returns one column of an embedded table as text.
[[nodiscard]] std::vector<std::string> ReadTextColumn(std::string_view file, int column);

}  // namespace alpenglow::atmosphere
