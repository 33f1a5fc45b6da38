// SPDX-License-Identifier: MIT
#include "atmosphere/base/toml_table.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/names.h"

namespace alpenglow::atmosphere {
namespace {

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

void TomlTable::FailInRow(const std::string& key, std::size_t row, const std::string& fault) const {
  const toml::node* node = level_->Find(key);
  const toml::node* item =
      node != nullptr && node->is_array() ? node->as_array()->get(row) : nullptr;
  if (item == nullptr) Fail(key, fault);
  throw InputError(fmt::format("{}:{}: {}", level_->origin,
                               std::max<std::size_t>(1, item->source().begin.line), fault));
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

std::optional<std::vector<std::vector<double>>> TomlTable::Rows(
    const std::string& key, const std::vector<TomlColumn>& columns, std::size_t required) const {
  const toml::node* node = level_->Find(key);
  if (node == nullptr) return std::nullopt;
  std::vector<std::string> names;
  for (const TomlColumn& column : columns) names.push_back(column.name);
  const std::string wanted = fmt::format("a list of {}", fmt::join(names, ", "));
  if (!node->is_array())
    Fail(key, fmt::format("{} is {}; it must be a list, each item {}", FullName(key), KindOf(*node),
                          wanted));
  std::vector<std::vector<double>> rows;
  for (const toml::node& item : *node->as_array()) {
    const std::string name = fmt::format("{}[{}]", FullName(key), rows.size());
    if (!item.is_array())
      FailInRow(key, rows.size(),
                fmt::format("{} is {}; it must be {}", name, KindOf(item), wanted));
    const toml::array& numbers = *item.as_array();
    if (numbers.size() < required || numbers.size() > columns.size())
      FailInRow(key, rows.size(),
                fmt::format("{} has {} numbers; it must have {} to {}: {}", name, numbers.size(),
                            required, columns.size(), fmt::join(names, ", ")));
    std::vector<double> row;
    for (const toml::node& number : numbers) {
      const TomlColumn& column = columns[row.size()];
      const NumberOrFault found =
          NumberIn(number, fmt::format("{} of {}", column.name, name), column.low, column.high);
      if (!found.fault.empty()) FailInRow(key, rows.size(), found.fault);
      row.push_back(found.number);
    }
    rows.push_back(std::move(row));
  }
  return rows;
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

}  // namespace alpenglow::atmosphere
