// SPDX-License-Identifier: MIT
#include "atmosphere/base/parsing.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <utility>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/embedded_text.h"

namespace alpenglow::atmosphere {

namespace {

/// Returns the text without a plus sign, which std::from_chars does not accept.
std::string_view WithoutPlus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return has_plus ? text.substr(1) : text;
}

template <typename Number>
std::optional<Number> ParseAs(std::string_view text) {
  const std::string_view digits = WithoutPlus(text);
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

constexpr std::string_view kBlanks = " \t\r\n";

namespace fs = std::filesystem;

/// Returns the characters of UTF-8; each byte of other text.
std::vector<std::string_view> CharactersOf(std::string_view text) {
  constexpr unsigned kKind = 0xC0U, kContinues = 0x80U;
  std::vector<std::string_view> characters;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & kKind) == kContinues)
      ++end;
    characters.push_back(text.substr(i, end - i));
    i = end;
  }
  return characters;
}

/// Computes the edit distance of Levenshtein (1966) in characters, in which two adjacent characters
/// in the other order are one edit (Damerau 1964, Commun. ACM 7, 171).
std::size_t EditDistance(const std::vector<std::string_view>& a,
                         const std::vector<std::string_view>& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substituted});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last.back();
}

/// Returns whether one of two names begins with the other, of three characters at least.
bool BeginsWithOther(std::string_view a, std::string_view b) {
  return std::min(a.size(), b.size()) >= 3 && (a.starts_with(b) || b.starts_with(a));
}

std::string KindOf(const toml::node& node) {
  if (node.is_string()) return fmt::format("the text \"{}\"", **node.as_string());
  if (node.is_boolean()) return **node.as_boolean() ? "true" : "false";
  if (node.is_integer()) return fmt::format("{}", **node.as_integer());
  if (node.is_floating_point()) return fmt::format("{}", **node.as_floating_point());
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  return "a date or time";
}

// The parser and the destructor of its tables recurse once for each part of a dotted key, without a
// limit of their own: a hundred thousand parts overflow the stack.
void RequireShallowKeys(std::string_view text, const std::string& origin) {
  constexpr int kMostDots = 256;
  int line = 1;
  int dots = 0;
  for (const char letter : text) {
    if (letter == '\n') ++line;
    if (letter == '\n' || letter == ',') dots = 0;
    if (letter == '.' && ++dots > kMostDots) {
      throw InputError(
          fmt::format("{}:{}: more than {} dots in a row of keys", origin, line, kMostDots));
    }
  }
}

toml::table Parse(std::string_view text, const std::string& origin) {
  // A document in UTF-16 is full of zero bytes, and the parser's message would not name this cause.
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}:1: holds zero bytes; it must be UTF-8 text", origin));
  }
  RequireShallowKeys(text, origin);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const std::optional<FileFormat> format = FormatOf(text, text.size());
    if (format && format->is_text) RefuseFormat(origin, *format, "TOML is read");
    throw InputError(fmt::format("{}:{}: not valid TOML: {}", origin, error.source().begin.line,
                                 error.description()));
  }
}

/// The number, or the reason why there is none.
struct NumberOrFault {
  double number = 0.0;
  std::string fault;
};

NumberOrFault NumberIn(const toml::node& node, const std::string& name, double low, double high) {
  if (!node.is_number()) {
    return {0.0, fmt::format("{} is {}; it must be a number in [{}, {}]", name, KindOf(node), low,
                             high)};
  }
  const double number = *node.value<double>();
  if (number >= low && number <= high) return {number, ""};  // written so that NaN is a fault
  return {0.0, fmt::format("{} is {}; it must lie in [{}, {}]", name, number, low, high)};
}

}  // namespace

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) letter = LowerCase(letter);
  return lower;
}

std::string_view Trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::vector<std::string_view> WordsOf(std::string_view text) {
  std::vector<std::string_view> words;
  while (!(text = Trimmed(text)).empty()) {
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

std::optional<double> ParseNumber(std::string_view text) { return ParseAs<double>(text); }

std::optional<int> ParseWholeNumber(std::string_view text) { return ParseAs<int>(text); }

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

std::string ReadTextFile(const fs::path& file) {
  constexpr std::size_t kMostBytes = 16U << 20U;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (error) RefuseFile(file, fmt::format("cannot be read: {}", error.message()));
  if (status.type() == fs::file_type::directory) RefuseFile(file, "is a folder");
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  for (std::array<char, 1U << 16U> part; stream && text.size() <= kMostBytes;) {
    stream.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream && !stream.eof()) RefuseFile(file, "cannot be read");
  if (text.size() > kMostBytes)
    RefuseFile(file, fmt::format("has more than {} bytes, the most of a text file", kMostBytes));
  const std::optional<FileFormat> format = FormatOf(text, text.size());
  if (format && !format->is_text) RefuseFormat(file, *format, "text is read");
  return text;
}

fs::path FolderOf(const fs::path& file) {
  std::error_code ignored;
  const fs::file_type type = fs::status(file, ignored).type();
  const bool is_pipe = type == fs::file_type::fifo || type == fs::file_type::character;
  return is_pipe ? fs::path() : file.parent_path();
}

std::optional<std::string> NearestName(std::string_view name,
                                       const std::vector<std::string>& known) {
  const std::vector<std::string_view> characters = CharactersOf(name);
  if (characters.size() < 2) return std::nullopt;
  std::optional<std::string> nearest, longer;
  std::size_t least = std::max<std::size_t>(1, (characters.size() + 1) / 3) + 1;
  for (const std::string& candidate : known) {
    if (candidate == name) continue;
    if (!longer && BeginsWithOther(name, candidate)) longer = candidate;
    const std::size_t distance = EditDistance(characters, CharactersOf(candidate));
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest ? nearest : longer;
}

struct TomlTable::Level {
  std::string origin;
  std::string path;  // "" for the document, "camera." within [camera]
  std::shared_ptr<const toml::table> document;
  const toml::table* table;

  [[nodiscard]] const toml::node* Find(const std::string& key) const { return table->get(key); }
  [[nodiscard]] std::size_t LineOf(const std::string& key) const {
    const toml::node* node = Find(key);
    const toml::source_region& source = node != nullptr ? node->source() : table->source();
    return std::max<std::size_t>(1, source.begin.line);
  }
};

TomlTable::TomlTable(std::shared_ptr<const Level> level) : level_(std::move(level)) {}

TomlTable::TomlTable(std::string_view text, const std::string& origin) {
  const auto document = std::make_shared<const toml::table>(Parse(text, origin));
  level_ = std::make_shared<const Level>(Level{origin, "", document, document.get()});
}

std::string TomlTable::FullName(const std::string& key) const { return level_->path + key; }

void TomlTable::Fail(const std::string& key, const std::string& fault) const {
  throw InputError(fmt::format("{}:{}: {}", level_->origin, level_->LineOf(key), fault));
}

void TomlTable::AllowOnly(const std::vector<std::string>& keys) const {
  for (const auto& [toml_key, node] : *level_->table) {
    const std::string key(toml_key.str());
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::optional<std::string> nearest = NearestName(key, keys);
    Fail(key, fmt::format("unknown key {}{}", FullName(key),
                          nearest ? fmt::format("; did you mean {}?", *nearest)
                                  : fmt::format("; known are {}", fmt::join(keys, ", "))));
  }
}

bool TomlTable::Has(const std::string& key) const { return level_->Find(key) != nullptr; }

std::optional<double> TomlTable::Number(const std::string& key, double low, double high) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return std::nullopt;
  const NumberOrFault found = NumberIn(*node, FullName(key), low, high);
  if (!found.fault.empty()) Fail(key, found.fault);
  return found.number;
}

std::optional<std::vector<double>> TomlTable::Numbers(const std::string& key, double low,
                                                      double high) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_array()) return std::vector<double>{*Number(key, low, high)};
  std::vector<double> numbers;
  for (const toml::node& item : *node->as_array()) {
    const std::string name = fmt::format("{}[{}]", FullName(key), numbers.size());
    const NumberOrFault found = NumberIn(item, name, low, high);
    if (!found.fault.empty()) Fail(key, found.fault);
    numbers.push_back(found.number);
  }
  return numbers;
}

std::optional<std::string> TomlTable::Text(const std::string& key) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) {
    Fail(key, fmt::format("{} is {}; it must be text in quotes", FullName(key), KindOf(*node)));
  }
  return **node->as_string();
}

std::optional<bool> TomlTable::Truth(const std::string& key) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) {
    Fail(key, fmt::format("{} is {}; it must be true or false", FullName(key), KindOf(*node)));
  }
  return **node->as_boolean();
}

std::optional<TomlTable> TomlTable::Table(const std::string& key) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) {
    Fail(key, fmt::format("{} is {}; it must be a table, [{}]", FullName(key), KindOf(*node),
                          FullName(key)));
  }
  return TomlTable(std::make_shared<const Level>(
      Level{level_->origin, FullName(key) + ".", level_->document, node->as_table()}));
}

std::vector<TomlTable> TomlTable::Tables(const std::string& key) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return {};
  if (!node->is_array()) {
    Fail(key, fmt::format("{} is {}; it must be a list of tables, [[{}]]", FullName(key),
                          KindOf(*node), FullName(key)));
  }
  std::vector<TomlTable> tables;
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_table()) {
      Fail(key, fmt::format("{} holds {}; it must be a list of tables, [[{}]]", FullName(key),
                            KindOf(item), FullName(key)));
    }
    tables.push_back(TomlTable(std::make_shared<const Level>(
        Level{level_->origin, fmt::format("{}[{}].", FullName(key), tables.size()),
              level_->document, item.as_table()})));
  }
  return tables;
}

void RefuseName(std::string_view refusal, std::string_view name,
                std::span<const std::string> known) {
  const std::string all = fmt::format("{}", fmt::join(known, ", "));
  const std::string before = fmt::format("{}", fmt::join(known.begin(), known.end() - 1, ", "));
  throw InputError(
      fmt::format(fmt::runtime(refusal), name, all, fmt::format("{} or {}", before, known.back())));
}

}  // namespace alpenglow::atmosphere
