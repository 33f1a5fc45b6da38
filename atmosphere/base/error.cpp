// SPDX-License-Identifier: MIT
#include "atmosphere/base/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace alpenglow::atmosphere {

void RefuseFile(const std::filesystem::path& file, std::string_view fault) {
  throw InputError(fmt::format("{}: {}", file.string(), fault));
}

std::string LastSystemError() { return std::generic_category().message(errno); }

double RequireInRange(double value, double low, double high, std::string_view name) {
  if (!(value >= low && value <= high)) {  // written so that NaN fails
    throw InputError(fmt::format("{} is {}; it must lie in [{}, {}]", name, value, low, high));
  }
  return value;
}

std::string EnsuredText(double value) { return fmt::format("{}", value); }
std::string EnsuredText(long long value) { return fmt::format("{}", value); }
std::string EnsuredText(unsigned long long value) { return fmt::format("{}", value); }

void FailEnsured(const char* file, int line, const char* claim, const std::string& left,
                 const std::string& right) {
  throw InternalError(
      fmt::format("{}:{}: expected {}, got {} and {}", file, line, claim, left, right));
}

}  // namespace alpenglow::atmosphere
