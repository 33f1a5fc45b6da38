// SPDX-License-Identifier: MIT
#include "atmosphere/base/toml_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

std::vector<std::string> NamesOf(const std::vector<TomlKey>& keys) {
  std::vector<std::string> names;
  for (const TomlKey& key : keys) names.push_back(key.key);
  return names;
}

template <typename Type>
std::optional<Type> As(const std::optional<TomlValue>& value) {
  if (!value) return std::nullopt;
  const Type* const typed = std::get_if<Type>(&*value);
  if (typed == nullptr) throw InternalError("a key of a TOML file has another type");
  return *typed;
}

}  // namespace

TomlSection::TomlSection(const TomlTable& table, std::vector<TomlKey> keys)
    : TomlTable(table), keys_(std::move(keys)) {
  AllowOnly(NamesOf(keys_));
  for (const TomlKey& key : keys_) {
    if (Has(key.key)) static_cast<void>(Checked(key));
  }
}

TomlValue TomlSection::Checked(const TomlKey& key) const {
  const TomlType& type = key.type;
  switch (type.kind) {
    case TomlType::Kind::kTruth:
      return *TomlTable::Truth(key.key);
    case TomlType::Kind::kNumber:
      return *TomlTable::Number(key.key, type.low, type.high);
    case TomlType::Kind::kNumbers:
      return *TomlTable::Numbers(key.key, type.low, type.high);
    case TomlType::Kind::kRows:
      return *TomlTable::Rows(key.key, type.columns, type.required_columns);
    case TomlType::Kind::kText:
      break;
  }
  std::string text = *TomlTable::Text(key.key);
  if (!type.names.empty() &&
      std::find(type.names.begin(), type.names.end(), text) == type.names.end()) {
    const auto nearest = NearestName(text, type.names);
    Fail(key.key,
         fmt::format("{} is \"{}\"; it must be {}{}", FullName(key.key), text, type.expected,
                     nearest ? fmt::format("; did you mean \"{}\"?", *nearest) : ""));
  }
  return text;
}

std::optional<TomlValue> TomlSection::Value(const std::string& key) const {
  const auto row =
      std::find_if(keys_.begin(), keys_.end(), [&](const TomlKey& one) { return one.key == key; });
  if (row == keys_.end()) throw InternalError(FullName(key) + " has no row in its table of fields");
  if (!Has(key)) return std::nullopt;
  return Checked(*row);
}

std::optional<double> TomlSection::Number(const std::string& key) const {
  return As<double>(Value(key));
}
std::optional<std::vector<double>> TomlSection::Numbers(const std::string& key) const {
  return As<std::vector<double>>(Value(key));
}
std::optional<std::string> TomlSection::Text(const std::string& key) const {
  return As<std::string>(Value(key));
}
std::optional<TomlRows> TomlSection::Rows(const std::string& key) const {
  return As<TomlRows>(Value(key));
}
std::optional<bool> TomlSection::Truth(const std::string& key) const {
  return As<bool>(Value(key));
}

std::string OneOf(const std::vector<std::string>& names) {
  return fmt::format("one of {}", fmt::join(names, ", "));
}

std::string OneOfQuoted(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(fmt::format("\"{}\"", name));
  if (quoted.size() == 2) return fmt::format("{} or {}", quoted[0], quoted[1]);
  return OneOf(quoted);
}

}  // namespace alpenglow::atmosphere
