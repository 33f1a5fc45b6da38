// SPDX-License-Identifier: MIT
// Names that users write: the values of an enumeration, and the nearest name to a mistyped one.
//
// One table of an enumeration serves both directions, and the messages that list the names.
//
//   constexpr EnumNames kNames{{std::pair{ToneCurve::kAgx, "agx"}, {ToneCurve::kAces, "aces"}}};
//
// The compiler counts the entries, so that a table has no entry without a name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {

/// Returns the element of `known` with the smallest edit distance to `name`, if the distance is
/// small enough for a typing error: a third of the characters of the name, and one for short ones.
/// Otherwise it returns the first that begins with the name, or with which the name begins (three
/// characters at least), or std::nullopt. It never returns the name itself.
[[nodiscard]] std::optional<std::string> NearestName(std::string_view name,
                                                     const std::vector<std::string>& known);

/// Throws an InputError about a name that is not in a table.
/// @param refusal  the message, where {0} is the name, {1} "a, b, c" and {2} "a, b or c".
[[noreturn]] void RefuseName(std::string_view refusal, std::string_view name,
                             std::span<const std::string> known);

template <typename Enum, std::size_t N>
class EnumNames {
 public:
  constexpr explicit EnumNames(const std::pair<Enum, const char*> (&names)[N]) {
    std::copy(std::begin(names), std::end(names), names_.begin());
  }

  /// Throws InternalError for a value without a name.
  [[nodiscard]] constexpr const char* Of(Enum value) const {
    for (const auto& [known, name] : names_) {
      if (known == value) return name;
    }
    throw InternalError("a value of an enumeration has no name");
  }
  [[nodiscard]] constexpr std::optional<Enum> Find(std::string_view name) const {
    for (const auto& [value, known] : names_) {
      if (name == known) return value;
    }
    return std::nullopt;
  }
  /// Returns the value with a name; throws InputError for another name.
  /// @param refusal  as for RefuseName.
  [[nodiscard]] Enum Named(std::string_view name, std::string_view refusal) const {
    if (const std::optional<Enum> found = Find(name)) return *found;
    RefuseName(refusal, name, All());
  }
  /// Returns the names in the order of the table.
  [[nodiscard]] std::vector<std::string> All() const {
    std::vector<std::string> names;
    for (const auto& entry : names_) names.emplace_back(entry.second);
    return names;
  }

 private:
  std::array<std::pair<Enum, const char*>, N> names_{};
};

}  // namespace alpenglow::atmosphere
