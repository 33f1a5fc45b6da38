// SPDX-License-Identifier: MIT
#include "atmosphere/base/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "atmosphere/base/parsing.h"
#include "atmosphere/embedded_text.h"

namespace alpenglow::atmosphere {
namespace {

constexpr char kQuote = '"';

class RecordReader {
 public:
  RecordReader(std::string_view line, const CsvSyntax& syntax) : rest_(line), syntax_(syntax) {}

  CsvRecord Read() {
    while (true) {
      SkipBlanks();
      record_.fields.push_back(Next() == kQuote ? Quoted() : Plain());
      SkipBlanks();
      if (!record_.fault.empty() || AtEnd()) return std::move(record_);
      if (Next() != syntax_.separator) {
        record_.fault = "has text behind a closing quote";
        return std::move(record_);
      }
      rest_.remove_prefix(1);
    }
  }

 private:
  [[nodiscard]] char Next() const { return rest_.empty() ? '\0' : rest_.front(); }
  [[nodiscard]] bool AtEnd() const {
    return rest_.empty() || (syntax_.has_comments && rest_.front() == '#');
  }
  [[nodiscard]] bool IsBlank(char letter) const {
    return letter == ' ' || (letter == '\t' && syntax_.separator != '\t');
  }
  void SkipBlanks() {
    while (!rest_.empty() && IsBlank(rest_.front())) rest_.remove_prefix(1);
  }

  std::string_view Plain() {
    const auto ends = [&](char letter) {
      return letter == syntax_.separator || (syntax_.has_comments && letter == '#');
    };
    const auto length =
        static_cast<std::size_t>(std::find_if(rest_.begin(), rest_.end(), ends) - rest_.begin());
    const std::string_view field = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return Trimmed(field);
  }

  std::string_view Quoted() {
    const std::string_view begin = rest_.substr(1);
    std::size_t escaped = 0, end = 0;
    for (;; end += 2, ++escaped) {
      end = begin.find(kQuote, end);
      if (end == std::string_view::npos) {
        record_.fault = "has a quote that is not closed on its line";
        return {};
      }
      if (begin.substr(end, 2) != "\"\"") break;
    }
    rest_ = begin.substr(end + 1);
    const std::string_view field = begin.substr(0, end);
    return Trimmed(escaped == 0 ? field : Unescaped(field));
  }

  std::string_view Unescaped(std::string_view field) {
    std::string& text = record_.unescaped.emplace_front();
    for (std::size_t i = 0; i < field.size(); ++i) {
      text += field[i];
      if (field[i] == kQuote) ++i;
    }
    return text;
  }

  std::string_view rest_;
  CsvSyntax syntax_;
  CsvRecord record_;
};

}  // namespace

CsvRecord SplitCsv(std::string_view line, const CsvSyntax& syntax) {
  return RecordReader(line, syntax).Read();
}

std::string_view WithoutByteOrderMark(std::string_view line) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  return line;
}

char SeparatorOf(std::string_view header) {
  for (const char separator : {',', ';', '\t'}) {
    const CsvSyntax syntax{.separator = separator, .has_comments = true};
    if (SplitCsv(header, syntax).fields.size() > 1) return separator;
  }
  return ',';
}

std::vector<std::vector<double>> ReadColumns(std::string_view file,
                                             const std::vector<int>& columns) {
  std::vector<std::vector<double>> values(columns.size());
  VisitCsvRows(EmbeddedText(file), [&](const CsvRecord& row) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view field = row.fields.at(static_cast<std::size_t>(columns[i]));
      const std::optional<double> number = ParseNumber(field);
      if (!number) throw InternalError(fmt::format("{}: \"{}\" is not a number", file, field));
      values[i].push_back(*number);
    }
  });
  return values;
}

std::vector<std::string> ReadTextColumn(std::string_view file, int column) {
  std::vector<std::string> values;
  VisitCsvRows(EmbeddedText(file), [&](const CsvRecord& row) {
    values.emplace_back(row.fields.at(static_cast<std::size_t>(column)));
  });
  return values;
}

}  // namespace alpenglow::atmosphere
