// SPDX-License-Identifier: MIT
#include "atmosphere/base/enum_names.h"

#include <fmt/format.h>

namespace alpenglow::atmosphere {

void RefuseName(std::string_view refusal, std::string_view name,
                std::span<const std::string> known) {
  const std::string all = fmt::format("{}", fmt::join(known, ", "));
  const std::string before = fmt::format("{}", fmt::join(known.begin(), known.end() - 1, ", "));
  throw InputError(
      fmt::format(fmt::runtime(refusal), name, all, fmt::format("{} or {}", before, known.back())));
}

}  // namespace alpenglow::atmosphere
