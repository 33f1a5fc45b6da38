// SPDX-License-Identifier: MIT
#include "atmosphere/base/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

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

}  // namespace

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

void RefuseName(std::string_view refusal, std::string_view name,
                std::span<const std::string> known) {
  const std::string all = fmt::format("{}", fmt::join(known, ", "));
  const std::string before = fmt::format("{}", fmt::join(known.begin(), known.end() - 1, ", "));
  throw InputError(
      fmt::format(fmt::runtime(refusal), name, all, fmt::format("{} or {}", before, known.back())));
}

}  // namespace alpenglow::atmosphere
