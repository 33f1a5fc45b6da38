// SPDX-License-Identifier: MIT
// Tables of fields: one row for each key of a table in a TOML file. A row states which values the
// key accepts, which member holds its value, and what the manual says about it.
//
//   const TomlFields<Rain> kRain{
//       "rain",
//       {{"rate_mm_per_h", Number(&Rain::rate_mm_per_h, {0.0, 300.0}), "mm/h", "", "At the ground"},
//        {"drop_mm", Number(&Rain::drop_m, {0.1, 6.0}, 1e-3), "mm", "", "Diameter of the drops"},
//        {"kind", Name(&Rain::kind, kKinds), "", "", "Kind of the precipitation"},
//        {"bands", Number<Rain>({3.0, 40.0}), "", "", "A row without a member"}}};
//
//   const TomlSection section(document.Table("rain"), kRain.Keys());   // refuses
//   kRain.Read(section, rain);                                         // sets the members
//   section.Number("bands");                                           // a row without a member
//
// A section refuses unknown keys, values of another type, numbers out of range and unknown names
// when it is made, before any value is used. What several keys say together is left to the reader
// of the file.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "atmosphere/base/names.h"
#include "atmosphere/base/toml_table.h"

namespace alpenglow::atmosphere {

using TomlRows = std::vector<std::vector<double>>;
using TomlValue = std::variant<bool, double, std::vector<double>, std::string, TomlRows>;

/// The values that a key accepts.
struct TomlType {
  enum class Kind { kTruth, kNumber, kNumbers, kText, kRows };
  Kind kind = Kind::kText;
  double low = 0.0, high = 0.0;  // of numbers, and of the numbers of a list
  bool one_for_all = false;      // one number may stand for a list with one number per wavelength
  std::vector<std::string> names = {};   // of a text; empty: any text
  std::string expected = {};             // the names in messages: "\"y\" or \"z\""
  std::vector<TomlColumn> columns = {};  // of rows
  std::size_t required_columns = 0;      // the first ones
};

/// A key as messages and manuals show it.
struct TomlKey {
  std::string key;
  TomlType type;
  std::string unit;
  std::string limits;        // what else limits the value, as a continuation of its range or names
  std::string text;          // the meaning
  std::string example = {};  // a value in the manual's example; "# 5" in a line that has no effect
};

/// A table of a TOML file, all of whose values are accepted by its keys.
class TomlSection : public TomlTable {
 public:
  /// Throws InputError for an unknown key, or a value that its key does not accept.
  TomlSection(const TomlTable& table, std::vector<TomlKey> keys);

  /// Return the value of a key; throw InternalError unless the key has a row of this type.
  [[nodiscard]] std::optional<double> Number(const std::string& key) const;
  [[nodiscard]] std::optional<std::vector<double>> Numbers(const std::string& key) const;
  [[nodiscard]] std::optional<std::string> Text(const std::string& key) const;
  [[nodiscard]] std::optional<TomlRows> Rows(const std::string& key) const;
  [[nodiscard]] std::optional<bool> Truth(const std::string& key) const;
  /// Returns the value of a key whatever its type is.
  [[nodiscard]] std::optional<TomlValue> Value(const std::string& key) const;

 private:
  [[nodiscard]] TomlValue Checked(const TomlKey& key) const;

  std::vector<TomlKey> keys_;
};

/// The type of a value, and the functions that move it into an object and out of it. Both functions
/// are empty if the reader of the file takes the value itself.
template <typename Object>
struct TomlMember {
  TomlType type;
  std::function<void(const TomlValue&, Object&)> set = nullptr;
  std::function<std::optional<TomlValue>(const Object&)> get = nullptr;  // nullopt: not given
};

/// Returns the member without `set`: the reader of the file takes the value itself.
template <typename Object>
TomlMember<Object> ReadApart(TomlMember<Object> member) {
  member.set = nullptr;
  return member;
}

/// A row of a table of fields.
template <typename Object>
struct TomlField {
  std::string key;
  TomlMember<Object> member;
  std::string unit, limits, text, example = {};  // as in TomlKey
  /// True if records of an object (hashes, headers of pictures) contain the key and its value
  /// wherever the value is not the default; false if they contain it in their own words.
  bool is_recorded_by_name = false;
};

template <typename Object>
struct TomlFields {
  std::string name;  // of the table in the file
  std::vector<TomlField<Object>> fields;
  std::string text = {};  // the meaning
  bool is_list = false;   // [[name]], any number of times

  [[nodiscard]] std::vector<TomlKey> Keys() const {
    std::vector<TomlKey> keys;
    for (const TomlField<Object>& field : fields)
      keys.push_back(
          {field.key, field.member.type, field.unit, field.limits, field.text, field.example});
    return keys;
  }
  /// Sets the members of the keys that the section has.
  void Read(const TomlSection& section, Object& object) const {
    for (const TomlField<Object>& field : fields) {
      if (!field.member.set) continue;
      if (const auto value = section.Value(field.key)) field.member.set(*value, object);
    }
  }
};

/// Returns a list of names in messages: `one of a, b`.
[[nodiscard]] std::string OneOf(const std::vector<std::string>& names);
/// Returns a list of names in messages: `"a" or "b"`, or `one of "a", "b", "c"`.
[[nodiscard]] std::string OneOfQuoted(const std::vector<std::string>& names);

/// Return the member of a row. Numbers are in [low, high] in the file; the member holds `scale`
/// times the number.
template <typename Object>
TomlMember<Object> Number(double Object::*member, std::pair<double, double> range,
                          double scale = 1.0) {
  return {{TomlType::Kind::kNumber, range.first, range.second},
          [=](const TomlValue& value, Object& object) {
            object.*member = scale * std::get<double>(value);
          },
          [=](const Object& object) { return TomlValue(object.*member / scale); }};
}
template <typename Object>
TomlMember<Object> Number(std::optional<double> Object::*member, std::pair<double, double> range,
                          double scale = 1.0) {
  return {{TomlType::Kind::kNumber, range.first, range.second},
          [=](const TomlValue& value, Object& object) {
            object.*member = scale * std::get<double>(value);
          },
          [=](const Object& object) -> std::optional<TomlValue> {
            if (!(object.*member)) return std::nullopt;
            return TomlValue(*(object.*member) / scale);
          }};
}
/// The member is a part of a part of the object.
template <typename Object, typename Part>
TomlMember<Object> Number(Part Object::*part, double Part::*member,
                          std::pair<double, double> range) {
  return {{TomlType::Kind::kNumber, range.first, range.second},
          [=](const TomlValue& value, Object& object) {
            object.*part.*member = std::get<double>(value);
          },
          [=](const Object& object) { return TomlValue(object.*part.*member); }};
}
template <typename Object, typename Part>
TomlMember<Object> Number(Part Object::*part, std::optional<double> Part::*member,
                          std::pair<double, double> range) {
  return {{TomlType::Kind::kNumber, range.first, range.second},
          [=](const TomlValue& value, Object& object) {
            object.*part.*member = std::get<double>(value);
          },
          [=](const Object& object) -> std::optional<TomlValue> {
            if (!(object.*part.*member)) return std::nullopt;
            return TomlValue(*(object.*part.*member));
          }};
}
template <typename Object>
TomlMember<Object> Number(std::pair<double, double> range) {
  return {{TomlType::Kind::kNumber, range.first, range.second}};
}

template <typename Object>
TomlMember<Object> Numbers(std::vector<double> Object::*member, std::pair<double, double> range) {
  return {{TomlType::Kind::kNumbers, range.first, range.second},
          [=](const TomlValue& value, Object& object) {
            object.*member = std::get<std::vector<double>>(value);
          },
          [=](const Object& object) { return TomlValue(object.*member); }};
}
template <typename Object>
TomlMember<Object> Numbers(std::pair<double, double> range) {
  return {{TomlType::Kind::kNumbers, range.first, range.second}};
}
/// Returns the member for which one number may stand for all wavelengths.
template <typename Object>
TomlMember<Object> OneForAll(TomlMember<Object> member) {
  member.type.one_for_all = true;
  return member;
}

template <typename Object>
TomlMember<Object> Truth(bool Object::*member) {
  return {{TomlType::Kind::kTruth},
          [=](const TomlValue& value, Object& object) { object.*member = std::get<bool>(value); },
          [=](const Object& object) { return TomlValue(object.*member); }};
}
template <typename Object>
TomlMember<Object> Truth() {
  return {{TomlType::Kind::kTruth}};
}

template <typename Object>
TomlMember<Object> Text() {
  return {{TomlType::Kind::kText}};
}
template <typename Object>
TomlMember<Object> Text(std::optional<std::string> Object::*member) {
  return {{TomlType::Kind::kText},
          [=](const TomlValue& value, Object& object) {
            object.*member = std::get<std::string>(value);
          },
          [=](const Object& object) -> std::optional<TomlValue> {
            if (!(object.*member)) return std::nullopt;
            return TomlValue(*(object.*member));
          }};
}

/// The member is the value that `names` gives to a text.
/// @param expected  OneOf or OneOfQuoted.
template <typename Object, typename Enum, std::size_t N>
TomlMember<Object> Name(Enum Object::*member, const EnumNames<Enum, N>& names,
                        std::string (*expected)(const std::vector<std::string>&)) {
  return {{.names = names.All(), .expected = expected(names.All())},
          [=](const TomlValue& value, Object& object) {
            object.*member = *names.Find(std::get<std::string>(value));
          },
          [=](const Object& object) { return TomlValue(std::string(names.Of(object.*member))); }};
}
template <typename Object, typename Part, typename Enum, std::size_t N>
TomlMember<Object> Name(Part Object::*part, Enum Part::*member, const EnumNames<Enum, N>& names,
                        std::string (*expected)(const std::vector<std::string>&)) {
  return {
      {.names = names.All(), .expected = expected(names.All())},
      [=](const TomlValue& value, Object& object) {
        object.*part.*member = *names.Find(std::get<std::string>(value));
      },
      [=](const Object& object) { return TomlValue(std::string(names.Of(object.*part.*member))); }};
}

}  // namespace alpenglow::atmosphere
